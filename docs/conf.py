"""How Sphinx builds these pages: `python -m sphinx -W docs docs/_build`."""

import os
import sys
from pathlib import Path

import tomllib

DOCS = Path(__file__).parent
sys.path.insert(0, str(DOCS))
# Examples draw into files.
os.environ["MPLBACKEND"] = "agg"

import site_parts  # noqa: E402

from meshlab_willmore import __version__  # noqa: E402

ABOUT = tomllib.loads((DOCS.parent / "pyproject.toml").read_text(encoding="utf-8"))["project"]

project = ABOUT["name"].replace("-", "_")
author = ABOUT["authors"][0]["name"]
copyright = author
version = release = __version__
language = "en"

extensions = [
    "myst_parser",
    "numpydoc",
    "sphinx.ext.autodoc",
    "sphinx_click",
    "sphinx_copybutton",
    "sphinx_gallery.gen_gallery",
]
exclude_patterns = ["_build", "examples"]
# The scraper is a function, which Sphinx can't store.
suppress_warnings = ["config.cache"]

myst_enable_extensions = ["deflist"]
myst_heading_anchors = 3
numpydoc_show_class_members = False
autodoc_typehints = "none"

sphinx_gallery_conf = {
    "examples_dirs": "examples",
    "gallery_dirs": "gallery",
    "image_scrapers": (site_parts.figure_scraper,),
    "abort_on_example_error": True,
    "download_all_examples": False,
    "show_signature": False,
    "write_computation_times": False,
}

html_theme = "pydata_sphinx_theme"
html_title = project
html_baseurl = ABOUT["urls"]["Documentation"]
html_static_path = ["static"]
html_css_files = ["site.css"]
html_copy_source = False
# Pages with nothing below them have no list of it at the side.
html_sidebars = {
    name: []
    for name in (
        "changelog",
        "contributing",
        "cube",
        "limits",
        "method",
        "presets",
        "scale",
        "settings",
        "speed",
        "start",
        "virtual_points",
    )
}
html_show_sourcelink = False
html_theme_options = {
    "header_links_before_dropdown": 6,
    "navbar_end": ["theme-switcher"],
    "footer_start": ["copyright"],
    "footer_end": [],
    "secondary_sidebar_items": ["page-toc"],
    "show_toc_level": 2,
}


def setup(app):
    app.add_directive("filter-reference", site_parts.FilterReference)
    app.connect("sphinx-click-process-description", site_parts.plain_text)
    app.connect("sphinx-click-process-options", site_parts.plain_options)
    app.connect("sphinx-click-process-epilog", site_parts.examples_as_code)

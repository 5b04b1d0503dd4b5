"""Parts of the site: texts on the filters, pictures of the examples, help texts."""

import re

from filter_texts import described
from matplotlib.figure import Figure
from sphinx.util.docutils import SphinxDirective
from sphinx_gallery.scrapers import figure_rst


class FilterReference(SphinxDirective):
    """The parameters and returns of the filter that the argument names, as lists."""

    required_arguments = 1

    def run(self):
        return self.parse_text_to_nodes(described(self.arguments[0]))


def figure_scraper(_, block_vars, gallery_conf):
    """Save the matplotlib figures that a block of an example leaves in variables."""
    found = block_vars["example_globals"]
    paths = []
    for name in [name for name, value in found.items() if isinstance(value, Figure)]:
        path = next(block_vars["image_path_iterator"])
        found.pop(name).savefig(path, dpi=80, bbox_inches="tight")
        paths.append(path)
    return figure_rst(paths, gallery_conf["src_dir"])


def plain_text(app, context, lines):
    """Change lines of help, which are plain text, into reStructuredText, in place."""
    lines[:] = [re.sub(r"([*`])", r"\\\1", line) for line in lines]


def plain_options(app, context, lines):
    """The same for the lines of an option, whose fields are reStructuredText already."""
    lines[:] = [
        line if re.match(r"\s*(\.\.|:default:)", line) else re.sub(r"\*", r"\\*", line)
        for line in lines
    ]


def examples_as_code(app, context, lines):
    """Change the examples at the end of a help text into a block of code, in place."""
    shown = [f"   {line.removeprefix('| ')}" for line in lines]
    lines[:] = [".. code-block:: text", "", *shown, ""]

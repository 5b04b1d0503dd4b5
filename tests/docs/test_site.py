"""The site builds without a warning, from its sources alone, and has the package's own texts."""

import html
import re
import shutil
import subprocess
import sys

import pytest

from meshlab_willmore.meshset.filters import FILTERS
from meshlab_willmore.options import OPTIONS
from tests.extras import needs

from .pages import DOCS, GENERATED, ROOT, name_of, pages

pytestmark = [pytest.mark.heavy, pytest.mark.slow, needs("sphinx", "docs")]


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """The folder of the built site."""
    folder = tmp_path_factory.mktemp("site")
    shutil.copytree(DOCS, folder / "docs", ignore=shutil.ignore_patterns(*GENERATED, "__pycache__"))
    shutil.copytree(ROOT / "filter_scripts", folder / "filter_scripts")
    for name in ("README.md", "CHANGELOG.md", "pyproject.toml"):
        shutil.copy(ROOT / name, folder)
    command = [sys.executable, "-m", "sphinx", "-W", "--keep-going", "-q", "docs", "docs/_build"]
    done = subprocess.run(command, cwd=folder, text=True, capture_output=True)
    assert done.returncode == 0, done.stdout + done.stderr
    return folder / "docs" / "_build"


def shown(page):
    """The text of a page, without its tags."""
    text = re.sub(r"<(dd|li|p|td|th)\b", r" <\1", page.read_text(encoding="utf-8"))
    text = re.sub(r"<[^>]+>", "", text)
    return re.sub(r"\s+", " ", html.unescape(text))


def plain(text):
    """A text as Sphinx prints it: with curly quotes but in code, which are all made straight."""
    for curly, straight in (("\u2019", "'"), ("\u2018", "'"), ("\u201c", '"'), ("\u201d", '"')):
        text = text.replace(curly, straight)
    return re.sub(r"\s+", " ", text)


def test_each_page_is_built(site):
    for page in pages()[1:]:
        assert (site / page.relative_to(DOCS)).with_suffix(".html").exists(), name_of(page)


def test_pictures_of_readme_and_of_all_examples_are_there(site):
    names = {path.name for path in (site / "_images").iterdir()}
    assert {path.name for path in (DOCS / "pictures").iterdir()} <= names
    for example in (DOCS / "examples").glob("plot_*.py"):
        assert f"sphx_glr_{example.stem}_001.png" in names


def test_the_reference_has_all_filters_with_the_help_text_of_each_parameter(site):
    text = plain(shown(site / "reference" / "filters.html"))
    for one in FILTERS:
        for part in (one.name, one.meshlab_name, one.summary, one.info):
            assert plain(part) in text
        for name, kind, meaning in one.returns:
            assert plain(f"{name}, {kind} {meaning}") in text
    for option in OPTIONS:
        default = {"selection": "on where faces are selected", "maxdeviation": "100%"}.get(
            option.name,
            f"{option.default:g}" if option.type in (int, float) else repr(option.default),
        )
        assert plain(f"{option.name}, default: {default} {option.help}") in text


def test_the_reference_has_all_commands_and_functions(site):
    import meshlab_willmore
    from meshlab_willmore.cli import main

    text = shown(site / "reference" / "command_line.html")
    for name, command in main.commands.items():
        assert f"meshlab-willmore {name} [OPTIONS]" in text
        for parameter in command.params:
            for spelling in parameter.opts if parameter.param_type_name == "option" else ():
                assert getattr(parameter, "hidden", False) or spelling in text
    arrays = shown(site / "reference" / "arrays.html")
    for name in set(meshlab_willmore.__all__) - {"__version__", "batch", "report", "script"}:
        assert name in arrays
    assert "report.page(" in shown(site / "reference" / "reports.html")
    scripts = shown(site / "reference" / "scripts.html")
    for name in meshlab_willmore.script.__all__:
        assert name in scripts


def test_no_page_asks_another_host_for_anything(site):
    """Links may lead away; what the browser loads by itself may not."""
    for page in site.rglob("*.html"):
        tags = re.findall(r"<(?:script|img|link|iframe)\b[^>]*>", page.read_text(encoding="utf-8"))
        assert tags
        away = [tag for tag in tags if re.search(r"""(src|href)=["']?(https?:)?//""", tag)]
        assert all('rel="canonical"' in tag for tag in away), away

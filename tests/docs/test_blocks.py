"""The code on the pages runs as it is printed."""

import ast
import importlib.util
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from tests.extras import IS_CI

from .pages import COMMAND, EXAMPLE, NOT_RUN, PRINTED, README, blocks, name_of, pages

pytestmark = [pytest.mark.heavy, pytest.mark.slow]


def runs_daily(page):
    """Whether it is README, or starts no commands: those run where changes are checked only."""
    return IS_CI or page == README or all(b.language != "sh" for b in blocks(page) if b.runs)


PAGES = [
    pytest.param(page, marks=() if runs_daily(page) else pytest.mark.nightly, id=name_of(page))
    for page in pages()
    if any(block.runs for block in blocks(page))
]


def missing(page):
    """The packages that the Python on a page imports, and that are not installed."""
    found = set()
    for block in blocks(page):
        if block.language == "python" and block.runs:
            for node in ast.walk(ast.parse(block.text)):
                if isinstance(node, ast.Import):
                    found |= {one.name.partition(".")[0] for one in node.names}
                elif isinstance(node, ast.ImportFrom):
                    found.add(node.module.partition(".")[0])
    return sorted(name for name in found if importlib.util.find_spec(name) is None)


def run_python(text, names, where):
    exec(compile(text, where, "exec"), names)


def run_shell(text, path):
    """Run a block in the working folder, which is the user's home, too."""
    done = subprocess.run(
        ["bash", "-euo", "pipefail", "-c", text],
        env={**os.environ, "PATH": path, "HOME": str(Path.cwd())},
        text=True,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
    )
    assert done.returncode == 0, f"{text}\n{done.stdout}"
    return done.stdout


def without_numbers(text):
    """The lines of a text, in which all numbers are the same."""
    return {re.sub(r"\d+(\.\d+)?", "#", line).strip() for line in text.splitlines()}


@pytest.mark.parametrize("page", PAGES)
def test_the_code_of_a_page_runs(page, checkout, monkeypatch):
    """All blocks in order, in one folder, Python in one process. README activates by itself."""
    if not IS_CI and missing(page):
        pytest.skip(f"needs {', '.join(missing(page))}")
    monkeypatch.chdir(checkout)
    path = os.environ["PATH"]
    if page != README:
        path = f"{Path(sys.executable).parent}{os.pathsep}{path}"
    names = {"__name__": "__main__"}
    for block in blocks(page):
        if block.language == "python" and block.runs:
            run_python(block.text, names, name_of(page))
        elif block.runs:
            printed = run_shell(block.text, path)
        elif block.note == PRINTED:
            assert without_numbers(block.text) <= without_numbers(printed)


@pytest.mark.parametrize("page", pages(), ids=name_of)
def test_a_block_that_does_not_run_says_why(page):
    for block in blocks(page):
        assert not block.note or block.note.startswith((NOT_RUN, COMMAND, EXAMPLE, PRINTED)), block
        if block.note.startswith(NOT_RUN):
            assert len(block.note) > len(NOT_RUN) + 5, block

"""`manual`: the man page has all that the help of the commands has."""

import re
import shutil
import subprocess

import click
import pytest

from meshlab_willmore.cli import main, manual

from .conftest import call


def plain(text):
    """The text of a page without what is meant for roff."""
    return text.replace(r"\-", "-").replace(r"\(aq", "'").replace(r"\e", "\\").replace(r"\&", "")


def test_page_has_all_commands_options_and_examples():
    page = plain(call("manual").stdout)
    parts = re.split(r'^\.SS "(.+)"$', page, flags=re.MULTILINE)
    sections = dict(zip(parts[1::2], parts[2::2], strict=True))
    assert list(sections) == list(main.commands)
    for name, command in main.commands.items():
        with click.Context(command) as ctx:
            for param in command.get_params(ctx):
                if isinstance(param, click.Option):
                    heads = re.findall(r"\n\.TP\n\.B (.*)", sections[name])
                    assert any(set(param.opts) <= set(re.split("[ ,]+", head)) for head in heads)
                    assert " ".join((param.help or "").split()) in sections[name]
        for line in command.epilog.splitlines():
            assert line in ("", "\b") or f"\n{line}\n" in sections[name]
    assert ".TH " in page.splitlines()[0]


def test_no_text_is_taken_for_a_request():
    assert manual._escaped(".nf") == r"\&.nf"
    requests = {line.split()[0] for line in call("manual").stdout.splitlines() if line[:1] == "."}
    assert requests <= {".TH", ".SH", ".SS", ".B", ".PP", ".TP", ".nf", ".fi", ".nh", ".ad"}


def test_hyphens_can_be_copied():
    _, _, body = call("manual").stdout.partition("\n")
    assert re.search(r"(?<!\\)-", body) is None


def test_examples_fit_into_80_columns():
    """Man indents them by 7."""
    for command in main.commands.values():
        assert max(map(len, (command.epilog or "").splitlines()), default=0) <= 80 - 7


@pytest.mark.skipif(not shutil.which("man"), reason="there is no man")
def test_man_shows_the_page_without_warnings(tmp_path):
    path = tmp_path / "page.1"
    path.write_text(call("manual").stdout, encoding="utf-8")
    done = subprocess.run(
        ["man", "--warnings", "-l", str(path)],
        capture_output=True,
        text=True,
        check=True,
        env={"MANWIDTH": "80", "LC_ALL": "C.UTF-8", "PATH": "/usr/bin:/bin"},
    )
    assert done.stderr == ""
    assert max(map(len, done.stdout.splitlines())) <= 80
    assert "meshlab-willmore flip scan.ply flipped.ply --search variable-depth\n" in done.stdout
    assert "'virtual-willmore'" in done.stdout

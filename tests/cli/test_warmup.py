"""`warmup`: its output and its errors."""

import sys

import numba

from meshlab_willmore import warmup
from meshlab_willmore.cli import main

from .conftest import Terminal, call

FOLDER = "/the/folder"


def ending(monkeypatch, compiled):
    def warm_up(say, processes, end):
        assert processes >= 1
        end("one")
        say("one: compiled in 1.0 s")
        return warmup.Warmed(compiled, 1.0, 2.04, FOLDER)

    monkeypatch.setattr(warmup, "warm_up", warm_up)


def test_result_is_one_line(monkeypatch):
    for compiled, text in (
        (0, "everything was compiled already"),
        (1, "1 kernel compiled"),
        (3, "3 kernels compiled"),
    ):
        ending(monkeypatch, compiled)
        result = call("warmup")
        assert (result.exit_code, result.stderr) == (0, "")
        assert result.stdout == f"{text}, in 2.0 s: {FOLDER}\n"


def test_terminal_shows_what_is_compiled(monkeypatch):
    ending(monkeypatch, 1)
    monkeypatch.setattr(sys, "stderr", Terminal())
    main(["warmup"], standalone_mode=False)
    assert "one: compiled in 1.0 s\n" in sys.stderr.getvalue()


def test_error_is_one_line(monkeypatch):
    monkeypatch.setattr(warmup, "cache_folder", lambda: None)
    monkeypatch.setattr(numba.config, "DISABLE_JIT", 0)
    result = call("warmup")
    assert result.exit_code == 1
    assert result.stderr.startswith("Error: Numba finds no folder that it can write its cache to")
    assert result.stderr.count("\n") == 1

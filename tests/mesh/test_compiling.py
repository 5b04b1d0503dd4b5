"""Compilations are announced on a terminal, followed, counted and forbidden."""

import contextlib
import io
import os
import subprocess
import sys

import pytest
from numba import njit

from meshlab_willmore.mesh import compiling

pytestmark = pytest.mark.heavy
LINE = "Compiling it on first use, this can take a minute ...\n"


def kernels(module="meshlab_willmore.of_a_test"):
    """A new pair: the second kernel calls the first."""

    def half(x):
        return 0.5 * x

    def quarter(x):
        return inner(inner(x))

    half.__module__ = quarter.__module__ = module
    inner = njit(half)
    return inner, njit(quarter)


class Terminal(io.StringIO):
    def isatty(self):
        return True


def announcement(run, what="it", **given):
    """What is printed on a terminal while something runs."""
    stream = Terminal()
    with contextlib.redirect_stderr(stream), compiling.announced(what, **given):
        run()
    return stream.getvalue()


def test_a_terminal_gets_one_line():
    half, quarter = kernels()
    other, _ = kernels()
    assert announcement(lambda: (quarter(8.0), other(8.0))) == LINE
    assert announcement(lambda: (quarter(4.0), half(4.0), other(4.0))) == ""


def test_where_compilations_are_followed_nothing_is_printed():
    names = []

    def run():
        with compiling.followed(names.append), compiling.announced("it"):
            kernels()[1](1.0)

    assert announcement(run) == ""
    assert [name.partition(".")[0] for name in names] == ["of_a_test", ""]
    assert announcement(lambda: kernels()[0](1.0)) == LINE


def test_each_run_that_compiles_is_announced():
    assert [announcement(lambda: kernels()[0](1.0)) for _ in range(2)] == [LINE, LINE]


def test_nothing_else_is_announced():
    assert announcement(lambda: kernels()[1](1.0), silent=True) == ""
    assert announcement(lambda: kernels("somebody")[1](1.0)) == ""
    assert announcement(lambda: kernels("meshlab_willmore_2.of_others")[1](1.0)) == ""
    for stream in (io.StringIO(), None):
        with contextlib.redirect_stderr(stream), compiling.announced("it"):
            assert kernels()[1](8.0) == 2.0
        assert stream is None or stream.getvalue() == ""


def test_runs_inside_runs_have_their_own_line():
    def run():
        with compiling.announced("inside"):
            kernels()[0](1.0)
        kernels()[0](1.0)

    assert announcement(run) == LINE.replace("it", "inside", 1) + LINE


def test_the_outermost_kernels_are_counted():
    half, quarter = kernels()
    with compiling.counted() as found:
        quarter(1.0)
        half(1.0)
        quarter(1)
    names = [compiled.name.rpartition(".")[2] for compiled in found]
    assert names == ["quarter", "quarter"]
    assert all(compiled.seconds > 0.0 for compiled in found)
    with compiling.counted() as found:
        quarter(1.0)
    assert found == []


def test_all_of_the_time_counts(monkeypatch):
    monkeypatch.setattr(compiling.time, "perf_counter", iter([1.0, 3.0]).__next__)
    with compiling.counted() as found:
        kernels()[1](1.0)
    assert [compiled.seconds for compiled in found] == [2.0]


def test_a_compilation_that_was_forbidden_before_is_counted():
    half, _ = kernels()
    with contextlib.ExitStack() as stack:
        stack.enter_context(compiling.forbidden())
        inner = contextlib.ExitStack()
        found = inner.enter_context(compiling.counted())
        with pytest.raises(compiling.NotCompiledError):
            half(1.0)
    with inner:
        half(1.0)
    assert len(found) == 1


def test_what_is_forbidden_is_not_compiled_and_may_be_later():
    half, quarter = kernels()
    half(1.0)

    def refused():
        with compiling.counted(), compiling.forbidden(), compiling.counted() as found:
            assert half(2.0) == 1.0
            with pytest.raises(compiling.NotCompiledError, match=r"\.quarter$"):
                quarter(1.0)
        assert found == []

    assert announcement(refused) == ""
    assert not quarter.signatures
    assert announcement(lambda: quarter(8.0)) == LINE
    with compiling.counted() as found:
        kernels()[0](1.0)
    assert len(found) == 1


def test_after_an_error_the_next_one_is_announced():
    def wrong(x):
        return x.no_such_thing

    wrong.__module__ = "meshlab_willmore.of_a_test"

    def run():
        with pytest.raises(Exception, match="no_such_thing"):
            njit(wrong)(1.0)

    assert announcement(run) == LINE
    assert announcement(lambda: kernels()[0](1.0)) == LINE


MEASURED = """
import numpy as np
from meshlab_willmore.measure import triangle_shapes
print(triangle_shapes(np.eye(3), np.array([[0, 1, 2]])))
"""


@pytest.mark.skipif(sys.platform == "win32", reason="terminals of Unix")
@pytest.mark.slow
def test_a_cold_cache_is_announced_and_a_warm_one_is_not(tmp_path):
    def printed():
        import pty

        ours, its = pty.openpty()
        environment = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path)}
        run = subprocess.run(
            [sys.executable, "-c", MEASURED], env=environment, stderr=its, capture_output=False
        )
        os.set_blocking(ours, False)
        try:
            said = os.read(ours, 10_000).decode()
        except OSError:
            said = ""
        os.close(its)
        os.close(ours)
        assert run.returncode == 0, said
        return said.replace("\r\n", "\n")

    assert printed() == LINE.replace("it", "meshlab_willmore", 1)
    assert printed() == ""

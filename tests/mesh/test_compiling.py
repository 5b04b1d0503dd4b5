"""What is compiled: told of on a terminal, counted, forbidden."""

import contextlib
import io
import os
import subprocess
import sys
import types

import pytest
from numba import njit

from meshlab_willmore.mesh import compiling

pytestmark = pytest.mark.heavy
LINE = "Compiling it once; this takes some seconds ...\n"


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


def said(run, what="it", **given):
    """What a terminal is told while something runs."""
    stream = Terminal()
    with contextlib.redirect_stderr(stream), compiling.announced(what, **given):
        run()
    return stream.getvalue()


def test_a_terminal_is_told_once():
    half, quarter = kernels()
    other, _ = kernels()
    assert said(lambda: (quarter(8.0), other(8.0))) == LINE
    assert said(lambda: (quarter(4.0), half(4.0), other(4.0))) == ""


def test_what_is_compiled_is_told_until_it_ends(monkeypatch):
    now = [10.0]
    monkeypatch.setattr(compiling.time, "monotonic", lambda: now[0])
    teller = compiling._Teller()
    stream = Terminal()
    monkeypatch.setattr(teller, "_tick", lambda: None)
    with contextlib.redirect_stderr(stream):
        teller.begin("meshlab_willmore.search.one")
        now[0] = 15.0
        assert teller.tell_how_far()
        teller.end("meshlab_willmore.search.one")
        assert not teller.tell_how_far()
        teller.begin("meshlab_willmore.search.other")
        now[0] = 20.4
        assert teller.tell_how_far()
    assert stream.getvalue() == (
        "Compiling meshlab_willmore once; this takes some seconds ...\n"
        "  compiling search.one, 5 s so far\n"
        "  compiling search.other, 10 s so far\n"
    )


def test_who_follows_tells_and_nothing_is_printed():
    names = []

    def run():
        with compiling.followed(names.append), compiling.announced("it"):
            kernels()[1](1.0)

    assert said(run) == ""
    assert [name.partition(".")[0] for name in names] == ["of_a_test", ""]
    assert said(lambda: kernels()[0](1.0)) == LINE


def test_each_run_that_compiles_tells():
    assert [said(lambda: kernels()[0](1.0)) for _ in range(2)] == [LINE, LINE]


def test_nobody_else_is_told():
    assert said(lambda: kernels()[1](1.0), silent=True) == ""
    assert said(lambda: kernels("somebody")[1](1.0)) == ""
    assert said(lambda: kernels("meshlab_willmore_2.of_others")[1](1.0)) == ""
    for stream in (io.StringIO(), None):
        with contextlib.redirect_stderr(stream), compiling.announced("it"):
            assert kernels()[1](8.0) == 2.0
        assert stream is None or stream.getvalue() == ""


def test_runs_inside_runs_have_their_own_line():
    def run():
        with compiling.announced("inside"):
            kernels()[0](1.0)
        kernels()[0](1.0)

    assert said(run) == LINE.replace("it", "inside", 1) + LINE


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


def test_one_that_never_heard_of_what_was_forbidden_counts_the_next():
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

    assert said(refused) == ""
    assert not quarter.signatures
    assert said(lambda: quarter(8.0)) == LINE
    with compiling.counted() as found:
        kernels()[0](1.0)
    assert len(found) == 1


def test_after_an_error_the_next_one_is_told_of():
    def wrong(x):
        return x.no_such_thing

    wrong.__module__ = "meshlab_willmore.of_a_test"

    def run():
        with pytest.raises(Exception, match="no_such_thing"):
            njit(wrong)(1.0)

    assert said(run) == LINE
    assert said(lambda: kernels()[0](1.0)) == LINE


def test_a_numba_without_events_tells_nothing(monkeypatch):
    monkeypatch.setitem(sys.modules, "numba.core.event", None)
    copy = types.ModuleType("copy_of_compiling")
    copy.__name__, copy.__package__ = compiling.__name__, compiling.__package__
    with open(compiling.__file__, encoding="utf-8") as source:
        exec(source.read(), copy.__dict__)
    assert not copy.CAN_TELL
    half, _ = kernels()
    with copy.announced("it"), copy.counted() as found:
        assert half(1.0) == 0.5
    assert found == []


MEASURED = """
import numpy as np
from meshlab_willmore.measure import triangle_shapes
print(triangle_shapes(np.eye(3), np.array([[0, 1, 2]])))
"""


@pytest.mark.skipif(sys.platform == "win32", reason="terminals of Unix")
@pytest.mark.slow
def test_a_cold_cache_is_told_of_and_a_warm_one_is_not(tmp_path):
    def told():
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

    # On a slow machine lines follow that tell how far it is.
    assert told().startswith("Compiling meshlab_willmore once; this takes some seconds ...\n")
    assert told() == ""

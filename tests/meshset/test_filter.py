"""Applying our filters: what they say while they compile."""

import contextlib

import pymeshlab
import pytest

from meshlab_willmore.mesh import compiling

MEASURE = "get_willmore_measures"


@pytest.fixture
def announced(monkeypatch):
    """What would be said, and whether it is to be kept silent."""
    calls = []

    @contextlib.contextmanager
    def note(what, *, silent):
        calls.append((what, silent))
        yield

    monkeypatch.setattr(compiling, "announced", note)
    return calls


def test_a_filter_that_compiles_says_so_unless_the_set_is_silent(announced):
    ms = pymeshlab.MeshSet()
    ms.create_cube()
    ms.apply_filter(MEASURE)
    ms.set_parameter_verbosity(False)
    ms.apply_filter(MEASURE)
    ms.set_verbosity(False)
    ms.apply_filter(MEASURE)
    what = "what 'Willmore measures' needs"
    assert announced == [(what, False), (what, False), (what, True)]


def test_a_verbose_set_says_so_too(announced, capfd):
    ms = pymeshlab.MeshSet(verbose=True)
    ms.create_cube()
    ms.apply_filter(MEASURE)
    assert [silent for _, silent in announced] == [False]

"""Numba imported quickly: nothing else is different afterwards."""

import contextlib
import gc
import subprocess
import sys

import pytest

from meshlab_willmore import quick_start

WITHOUT = "import sys; sys.modules['numba'] = None; "
# SciPy is there, but nobody asked for its linear algebra.
SPARED = """
import sys
import meshlab_willmore.optimize
print("scipy.linalg" in sys.modules)
"""
# A kernel of somebody else's that multiplies matrices finds all that it takes.
MULTIPLIED = """
import meshlab_willmore.optimize
import numba, numpy as np
from numba.np import arraymath, linalg
assert linalg.ensure_blas.__name__ == "ensure_blas"
assert arraymath._HAVE_BLAS
@numba.njit
def square(a):
    return np.dot(a, a), np.linalg.inv(a)
product, inverse = square(np.array([[1.0, 2.0], [3.0, 5.0]]))
print((product == [[7, 12], [18, 31]]).all() and abs(inverse - [[-5, 2], [3, -1]]).max() < 1e-12)
"""


def run(program):
    return subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)


@pytest.mark.parametrize("was_on", [True, False])
def test_the_collector_is_as_it_was(was_on):
    before = gc.isenabled()
    try:
        (gc.enable if was_on else gc.disable)()
        with contextlib.suppress(ValueError), quick_start.paused_collector():
            assert not gc.isenabled()
            raise ValueError
        assert gc.isenabled() == was_on
    finally:
        (gc.enable if before else gc.disable)()


def test_without_numba_the_import_goes_on_and_its_use_says_why():
    done = run(WITHOUT + "import meshlab_willmore; print('there'); meshlab_willmore.measures")
    assert done.stdout == "there\n"
    assert "numba" in done.stderr.splitlines()[-1]


@pytest.mark.slow
def test_linear_algebra_is_not_imported_in_vain():
    assert run(SPARED).stdout == "False\n"


@pytest.mark.heavy
@pytest.mark.slow
def test_linear_algebra_of_others_works():
    done = run(MULTIPLIED)
    assert (done.stdout, done.stderr) == ("True\n", "")


def test_a_numba_that_is_made_otherwise_is_left_alone(monkeypatch):
    from numba.np import linalg

    look = linalg.ensure_blas
    quick_start.load_numba()
    assert linalg.ensure_blas is look
    monkeypatch.delattr(linalg, "ensure_blas")
    quick_start.load_numba()
    monkeypatch.setitem(sys.modules, "numba.np.linalg", None)
    monkeypatch.setitem(sys.modules, "numba.core.registry", None)
    quick_start.load_numba()

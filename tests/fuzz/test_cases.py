"""Fuzzed runs of `optimize_flips`: some hundreds always, thousands with ``-m nightly``.

The first ones may have to wait for the compiler, for every energy and search.
"""

import pytest

from .cases import Case, failures

PARTS, CASES = 10, 50
NIGHTLY_PARTS, NIGHTLY_CASES = 40, 500

pytestmark = [pytest.mark.heavy, pytest.mark.timeout(1800)]


def check(seed, part, cases):
    found = failures(seed, range(part * cases, (part + 1) * cases))
    assert not found, "\n\n".join(found)


@pytest.mark.parametrize("part", range(PARTS))
@pytest.mark.slow
def test_every_promise_is_kept(part):
    check(0, part, CASES)


@pytest.mark.slow
@pytest.mark.parametrize("number", [983, 3497, 3508, 3558, 3974])
def test_a_second_run_makes_no_more_chains(number):
    """Ties that went by the order of faces, and runs cut off by `maxflips`."""
    Case(71, number).check()


@pytest.mark.nightly
@pytest.mark.parametrize("part", range(NIGHTLY_PARTS))
def test_every_promise_is_kept_all_night(part):
    check(1, part, NIGHTLY_CASES)

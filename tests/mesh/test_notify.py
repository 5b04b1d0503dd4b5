"""Reports of how far a search is."""

import threading

import pytest

from meshlab_willmore import optimize_flips
from meshlab_willmore.mesh.notify import listening, report, stage
from meshlab_willmore.options import SEARCH
from tests import meshes


def test_stages_come_before_reports():
    heard = []
    report("nobody hears")
    with listening(heard.append):
        with stage("start 2 of 3"):
            report("5 flips")
            with stage("part 1 of 2"):
                report("6 flips")
        report("done")
    report("nobody hears")
    assert heard == [
        "start 2 of 3",
        "start 2 of 3, 5 flips",
        "start 2 of 3, part 1 of 2",
        "start 2 of 3, part 1 of 2, 6 flips",
        "done",
    ]


def test_other_threads_are_not_heard():
    heard = []

    def work():
        with stage("elsewhere"):
            report("more")

    with listening(heard.append):
        thread = threading.Thread(target=work)
        thread.start()
        thread.join()
        report("here")
    assert heard == ["here"]


@pytest.mark.heavy
@pytest.mark.parametrize(
    ("search", "words"),
    [
        ("parallel greedy", "round 1, "),
        ("greedy", " edges left"),
        ("variable depth", "chains, "),
        ("annealing", "temperature 3 of 3, "),
        ("thorough", "start 2 of 2, chains, "),
    ],
)
def test_every_search_reports_how_far_it_is(search, words):
    heard = []
    with listening(heard.append):
        optimize_flips(*meshes.bumpy_sphere(60), energy="willmore", search=search, sweeps=3)
    assert any(words in text for text in heard)
    assert search in SEARCH.choices

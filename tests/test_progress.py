"""Reports of how far work is, and a callable that hears them."""

import itertools
import logging
import threading
import time

import numpy as np
import pytest

import meshlab_willmore
from meshlab_willmore import Cancelled, optimize_flips
from meshlab_willmore.options import SEARCH
from meshlab_willmore.presets import PRESETS
from meshlab_willmore.progress import DONE, listening, logged, report, stage
from meshlab_willmore.progress import was_raised_by_listener as was_raised
from tests import meshes


class Heard(list):
    """What a callable was called with."""

    def __call__(self, fraction, text):
        self.append((fraction, text))

    def fractions(self):
        return [fraction for fraction, _ in self]

    def check(self):
        """Check what is promised of every run that ends."""
        found = self.fractions()
        assert found[0] == 0.0
        assert self[-1] == (1.0, DONE)
        assert found.count(1.0) == 1
        assert found == sorted(found)


def everything(heard):
    """A listener that hears every report."""
    return listening(heard, seconds=0.0)


# --- reports -------------------------------------------------------------------------------------


def test_a_stage_is_a_part_of_the_whole_and_has_a_name():
    heard = Heard()
    report(0.5, "nobody hears")
    with everything(heard):
        with stage(0.5, "start 2 of 3"):
            report(0.5, "5 flips")
            with stage(0.5, "part 1 of 2"):
                report(1.0, "6 flips")
        with stage(0.5):
            report(0.5, "late")
    report(0.5, "nobody hears")
    assert heard == [
        (0.0, "start 2 of 3"),
        (0.25, "start 2 of 3, 5 flips"),
        (0.25, "start 2 of 3, part 1 of 2"),
        (0.375, "start 2 of 3, part 1 of 2, 6 flips"),
        (0.625, "late"),
        (1.0, DONE),
    ]


def test_fractions_never_fall_and_are_1_only_once():
    heard = Heard()
    with everything(heard):
        for fraction in (0.0, 0.7, 0.2, 1.0, 3.0):
            report(fraction, "")
        with stage():
            report(-1.0, "")
    heard.check()
    assert heard.fractions() == [0.0, 0.7, 0.7, 1.0]


def test_fractions_never_fall_by_rounding():
    rng = np.random.default_rng(0)

    def work(depth):
        for _ in range(3):
            with stage(rng.random() or 1.0):
                if depth:
                    work(depth - 1)
                report(1.0, "")

    heard = Heard()
    with everything(heard):
        report(0.0, "")
        work(5)
    heard.check()


def test_calls_are_rare_but_the_first_and_the_last_are_there(monkeypatch):
    now = [0.0]
    monkeypatch.setattr(time, "monotonic", lambda: now[0])
    heard = Heard()
    with listening(heard):
        for place in range(1000):
            now[0] = place / 1000
            report(place / 1000, str(place))
    heard.check()
    assert len(heard) == 11
    assert all(b - a >= 0.09 for a, b in itertools.pairwise(heard.fractions()[:-1]))


@pytest.mark.parametrize("answer", [False, np.False_])
def test_false_stops_the_work(answer):
    heard = []

    def work():
        report(0.0, "")
        report(0.4, "here")
        raise AssertionError

    def call(fraction, text):
        heard.append(text)
        return answer if fraction else None

    with pytest.raises(Cancelled, match=r"cancelled at 40 % \(here\)"), everything(call):
        work()
    assert heard == ["", "here"]
    report(0.5, "nobody hears")


@pytest.mark.parametrize("answer", [None, True, 0, 0.0, "", []])
def test_other_values_stop_nothing(answer):
    with everything(lambda fraction, text: answer):
        report(0.4, "")


def test_false_at_the_end_stops_nothing():
    with everything(lambda fraction, text: fraction < 1.0):
        report(0.4, "")


def test_an_exception_of_the_callable_comes_through_as_it_is():
    error = KeyError("mine")

    def fail(fraction, text):
        raise error

    with everything(Heard()):
        with pytest.raises(KeyError) as caught, everything(fail):
            report(0.5, "")
        assert caught.value is error


def test_what_a_callable_raised_can_be_told_from_what_the_work_raised():
    def work(error):
        with everything(Heard()):
            report(0.5, "")
            raise error

    own, other = ValueError("of the callable"), ValueError("of the work")

    def fail(fraction, text):
        raise own

    with everything(lambda *_: None):
        for call, expected in ((fail, own), (lambda *_: None, other)):
            with pytest.raises(ValueError, match="of the") as caught, everything(call):  # noqa: PT012
                try:
                    work(other)
                finally:
                    assert was_raised(own) == (expected is own)
                    assert not was_raised(other)
            assert caught.value is expected
            assert not was_raised(own)


def test_a_listener_inside_another_is_a_part_of_its_work():
    outer, inner = Heard(), Heard()
    with everything(outer):
        report(0.5, "")
        with stage(0.5, "step 2"), everything(inner):
            report(0.5, "half")
    assert outer.fractions() == sorted(outer.fractions())
    assert inner == [(0.5, "half"), (1.0, DONE)]
    assert (0.625, "step 2, half") in outer


def test_what_a_callable_does_itself_is_not_heard():
    heard = Heard()

    def call(fraction, text):
        heard(fraction, text)
        report(0.9, "of the callable")
        with stage(0.5, "of the callable"):
            report(1.0, "")

    with everything(call):
        report(0.5, "")
    assert heard == [(0.5, ""), (1.0, DONE)]


def test_each_thread_has_its_own_listeners():
    heard, others = Heard(), Heard()
    both = threading.Barrier(2)

    def work():
        report(0.5, "nobody hears")
        with everything(others):
            both.wait()
            report(0.25, "elsewhere")
            both.wait()

    with everything(heard):
        thread = threading.Thread(target=work)
        thread.start()
        both.wait()
        report(0.5, "here")
        both.wait()
        thread.join()
    assert heard == [(0.5, "here"), (1.0, DONE)]
    assert others == [(0.25, "elsewhere"), (1.0, DONE)]


# --- optimize_flips ------------------------------------------------------------------------------


@pytest.mark.parametrize("wrong", [1, "yes", True])
def test_progress_must_be_callable(wrong):
    with pytest.raises(TypeError, match="progress must be None or a callable that takes a fract"):
        optimize_flips(*meshes.octahedron(), progress=wrong)


def test_a_wrong_argument_is_refused_before_the_first_call():
    heard = Heard()
    with pytest.raises(ValueError, match="maxflips"):
        optimize_flips(*meshes.octahedron(), maxflips=-1, progress=heard)
    assert heard == []


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
    heard = Heard()
    with everything(heard):
        optimize_flips(*meshes.bumpy_sphere(60), energy="willmore", search=search, sweeps=3)
    heard.check()
    assert any(words in text for _, text in heard)
    assert len(set(heard.fractions())) >= 5
    assert search in SEARCH.choices


@pytest.mark.parametrize("preset", ["faithful", "smooth"])
def test_passes_are_named_and_weighted(preset):
    heard = Heard()
    with everything(heard):
        optimize_flips(*meshes.bumpy_sphere(60), preset=preset)
    heard.check()
    names = [text.split(",")[0] for _, text in heard if text.startswith("pass")]
    count = len(PRESETS[preset].passes)
    assert list(dict.fromkeys(names)) == [f"pass {n} of {count}" for n in range(1, count + 1)]
    begin = {name: f for f, name in reversed([(f, t.split(",")[0]) for f, t in heard])}
    assert begin["pass 1 of " + str(count)] > 0.0
    assert begin[f"pass {count} of {count}"] > 0.3


def test_a_stop_at_any_report_leaves_the_arrays_and_the_next_run_as_they_were():
    vertices, faces = meshes.bumpy_sphere(60)
    vertices.flags.writeable = faces.flags.writeable = False
    heard = Heard()
    with everything(heard):
        expected = optimize_flips(vertices, faces).faces
    for place in range(len(heard) - 1):
        calls = itertools.count()
        with pytest.raises(Cancelled), everything(lambda *_: next(calls) < place):  # noqa: B023
            optimize_flips(vertices, faces)
        assert next(calls) == place + 1
    np.testing.assert_array_equal(optimize_flips(vertices, faces).faces, expected)


# --- the log -------------------------------------------------------------------------------------


def test_the_log_is_silent_by_default(capsys):
    package = logging.getLogger("meshlab_willmore")
    assert [type(handler) for handler in package.handlers] == [logging.NullHandler]
    assert package.level == logging.NOTSET
    optimize_flips(*meshes.bumpy_sphere(60))
    assert capsys.readouterr() == ("", "")
    assert meshlab_willmore.Cancelled is Cancelled


def test_the_log_has_passes_and_runs(caplog):
    caplog.set_level(logging.INFO, "meshlab_willmore")
    result = optimize_flips(*meshes.bumpy_sphere(60), preset="smooth")
    lines = [record.getMessage() for record in caplog.records]
    assert len(lines) == 3
    assert lines[0].startswith("pass 1 of 2, delaunay by parallel greedy: ")
    assert lines[-1].startswith(
        f"{len(result.faces)} faces: {result.flips} flips, Willmore energy "
    )
    assert {record.name.split(".")[0] for record in caplog.records} == {"meshlab_willmore"}


def test_the_log_in_detail_has_the_progress_too(caplog):
    caplog.set_level(logging.DEBUG, "meshlab_willmore.progress")
    heard = Heard()
    with everything(heard), logged():
        report(0.256, "flips")
    lines = [record.getMessage() for record in caplog.records]
    assert lines == ["25 %: flips", "100 %: done"]
    assert heard == [(0.256, "flips"), (1.0, DONE)]

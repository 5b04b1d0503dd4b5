"""Progress of filters and scripts: what is heard and printed, and how a run is stopped."""

import itertools
import re

import numpy as np
import pymeshlab
import pytest

from meshlab_willmore import Cancelled, script
from meshlab_willmore import progress as reports
from meshlab_willmore.meshset import layers, native
from meshlab_willmore.progress import DONE, listening
from meshlab_willmore.script import Step
from tests import meshes
from tests.meshset.conftest import FLIP, script_of, set_of

FLIPS = Step("Willmore flipping optimization")
SMOOTH = Step("Taubin Smooth")
STEPS = (SMOOTH, FLIPS, Step("Willmore measures"))


@pytest.fixture(autouse=True)
def _every_report(monkeypatch):
    """Every report is heard, however soon it comes."""
    monkeypatch.setattr(reports.Listener.__init__, "__defaults__", (0.0,))
    monkeypatch.setattr(listening.__wrapped__, "__defaults__", (0.0,))


def small():
    return set_of(*meshes.bumpy_sphere(100))


def faces(ms):
    return ms.current_mesh().face_matrix()


def state(ms):
    """What a stop must not change."""
    mesh = ms.current_mesh()
    return [ms.current_mesh_id(), len(ms), mesh.face_matrix().tolist(), script_of(ms)]


def run_heard(ms, steps=STEPS):
    heard = []
    script.run(steps, ms, progress=lambda fraction, text: heard.append((fraction, text)))
    return heard


def test_a_script_reports_its_steps_and_the_parts_of_ours():
    heard = run_heard(small())
    fractions = [fraction for fraction, _ in heard]
    assert fractions == sorted(fractions)
    assert fractions.count(1.0) == 1
    assert heard[-1] == (1.0, DONE)
    begins = {text: fraction for fraction, text in reversed(heard)}
    assert begins["step 1 (apply_coord_taubin_smoothing)"] == 0.0
    assert begins[f"step 2 ({FLIP})"] == pytest.approx(1 / 3)
    assert begins["step 3 (get_willmore_measures)"] == pytest.approx(2 / 3)
    inside = [f for f, text in heard if f"step 2 ({FLIP}), round " in text]
    assert inside
    assert all(1 / 3 < fraction < 2 / 3 for fraction in inside)


def test_an_empty_script_is_done():
    assert run_heard(small(), ()) == [(1.0, DONE)]


def test_a_stop_at_any_report_changes_nothing_in_the_set():
    heard = run_heard(small(), (FLIPS,))
    ms = small()
    before = state(ms)
    for place in range(len(heard) - 1):
        calls = itertools.count()
        with pytest.raises(Cancelled, match="cancelled at"):
            script.run((FLIPS,), ms, progress=lambda *_: next(calls) < place)  # noqa: B023
        assert next(calls) == place + 1
        assert state(ms) == before
    expected = small()
    script.run((FLIPS,), expected)
    script.run((FLIPS,), ms)
    np.testing.assert_array_equal(faces(ms), faces(expected))


def test_the_steps_before_a_stop_stay_and_no_other_runs():
    expected, ms, after = small(), small(), []
    script.run((SMOOTH,), expected)
    with pytest.raises(Cancelled, match=r"step 2 \("):
        script.run(STEPS, ms, after=after.append, progress=lambda f, text: "step 2" not in text)
    assert [played.number for played in after] == [1]
    np.testing.assert_array_equal(
        ms.current_mesh().vertex_matrix(), expected.current_mesh().vertex_matrix()
    )
    np.testing.assert_array_equal(faces(ms), faces(expected))


@pytest.mark.parametrize("kind", [KeyError, pymeshlab.PyMeshLabException, KeyboardInterrupt])
def test_an_exception_of_the_callable_comes_through_as_it_is(kind):
    ms, error = small(), kind("mine")
    before = state(ms)

    def fail(fraction, text):
        if "round" in text:
            raise error

    with pytest.raises(kind) as caught:
        script.run((FLIPS,), ms, progress=fail)
    assert caught.value is error
    assert state(ms) == before
    # The exception is held here, with all its frames.
    assert ms.apply_filter(FLIP)["flips"] > 0
    assert not layers.parked(ms)
    assert len(native.ids(ms)) == 1


def test_an_error_of_a_step_is_as_without_progress():
    messages = []
    for given in ({}, {"progress": lambda fraction, text: None}):
        with pytest.raises(pymeshlab.PyMeshLabException) as caught:
            script.run((FLIPS,), set_of(np.eye(3), np.empty((0, 3), np.int32)), **given)
        messages.append(str(caught.value))
    assert messages[0] == messages[1]
    assert messages[0].startswith("filter script, step 1 (")


def test_a_verbose_set_prints_progress_as_native_filters_do(capfd):
    ms = small()
    ms.set_verbosity(True)
    capfd.readouterr()
    ms.apply_filter(FLIP)
    lines = capfd.readouterr().err.splitlines()
    shown = [re.fullmatch(r"LOG: 2 (.*)    \[ (\d+)% \]", line) for line in lines]
    percents = [int(found[2]) for found in shown if found]
    assert percents == sorted(percents)
    assert percents[-1] == 100
    assert percents.count(100) == 1
    assert any("round 1, " in line for line in lines)
    assert lines[-1].startswith(f"LOG: 2 {FLIP} applied!")


def test_a_verbose_set_in_a_script_is_heard_too(capfd):
    ms = small()
    ms.set_verbosity(True)
    heard = run_heard(ms, (FLIPS,))
    assert any("round 1, " in text for _, text in heard)
    assert "round 1, " in capfd.readouterr().err


def test_a_silent_set_prints_nothing(capfd):
    small().apply_filter(FLIP)
    assert capfd.readouterr() == ("", "")


def test_steps_and_filters_are_logged(caplog):
    caplog.set_level("DEBUG", "meshlab_willmore")
    script.run(STEPS, small())
    text = "\n".join(record.getMessage() for record in caplog.records)
    assert re.search(r"filter script: step 1 \(apply_coord_taubin_smoothing\) of 3, \d", text)
    assert re.search(rf"{FLIP}: \d+ Willmore edge flips performed in", text)
    assert f"{FLIP} with {{'preset': 'paper', " in text
    assert re.search(r"pass 1 of 1, virtual willmore by parallel greedy: \d+ flips", text)

"""Progress of a batch, and how it is stopped."""

import json
import time
from contextlib import closing
from pathlib import Path

import pytest

from meshlab_willmore import Cancelled, batch
from meshlab_willmore.batch.pool import Pool, PoolSettings
from meshlab_willmore.batch.process import DONE, Task
from tests.cli.conftest import cube_file
from tests.cli.test_compare_row import wait_for

NAMES = [f"in/{letter}.ply" for letter in "abcd"]


@pytest.fixture
def inputs():
    Path("in").mkdir()
    Path("out").mkdir()
    for name in NAMES:
        cube_file(name)
    return NAMES


def nothing(ms):
    """Leave the mesh as it is."""


def slow(ms):
    """Take a while."""
    time.sleep(1.5)


def run(inputs, progress, what=nothing, **given):
    return batch.run(
        what, inputs, "out/{name}.ply", workers=1, log="log.jsonl", progress=progress, **given
    )


def recorded():
    lines = [json.loads(line) for line in Path("log.jsonl").read_text().splitlines()]
    return [line["input"] for line in lines if "input" in line]


@pytest.fixture(autouse=True)
def _every_report(monkeypatch):
    monkeypatch.setattr("meshlab_willmore.progress.Listener.__init__.__defaults__", (0.0,))


def test_meshes_done_of_all_with_their_names(inputs):
    heard = []
    results = list(run(inputs, lambda *call: heard.append(call)))
    fractions = [fraction for fraction, _ in heard]
    assert fractions == sorted(fractions)
    assert sorted(set(fractions)) == [0.0, 0.25, 0.5, 0.75, 1.0]
    assert heard[-1] == (1.0, "done")
    assert fractions.count(1.0) == 1
    for result in results[:-1]:
        assert any(f" of 4 meshes, {result.input}: done" in text for _, text in heard)


@pytest.mark.slow
def test_a_stop_ends_the_batch_with_all_that_was_done_on_record(inputs):
    taken = []

    def stop(fraction, text):
        if fraction < 0.5:
            return True
        # The worker goes on: with the last one's output, the one before has ended.
        wait_for(lambda: len(list(Path("out").iterdir())) == 4)
        return False

    def take():
        for result in run(inputs, stop):
            taken.append(result.input)  # noqa: PERF401

    with pytest.raises(Cancelled, match=r"cancelled at 50 % \(2 of 4 meshes, in/.\.ply: done"):
        take()
    assert len(taken) == 2
    assert len(recorded()) >= 3
    assert set(taken) < set(recorded())
    again = list(run(inputs, None, resume=True))
    assert len(again) <= 1
    assert sorted(recorded()) == NAMES


def test_a_stop_does_not_wait_for_the_mesh_that_is_being_done(inputs):
    heard = []

    def stop(fraction, text):
        heard.append((time.monotonic(), text))
        return "in/a.ply: " not in text or "slow" not in text

    with pytest.raises(Cancelled, match="in/a.ply: slow"):
        list(run(inputs[:1], stop, slow))
    assert recorded() == []
    assert list(Path("out").iterdir()) == []


def test_an_exception_of_the_callable_comes_through(inputs):
    error = KeyError("mine")

    def fail(fraction, text):
        if fraction:
            raise error

    with pytest.raises(KeyError) as caught:
        list(run(inputs, fail))
    assert caught.value is error
    assert len(recorded()) >= 1


def test_nothing_to_do_is_done():
    heard = []
    assert list(batch.run(nothing, [], progress=lambda *call: heard.append(call))) == []
    assert heard == [(1.0, "done")]


def test_progress_must_be_callable(inputs):
    with pytest.raises(TypeError, match="progress must be None or a callable"):
        list(run(inputs, 3))


def test_what_has_ended_but_was_not_taken_is_left_over():
    with closing(Pool(PoolSettings())) as pool:
        tasks = ((key, Task("tests.batch.tasks:give", key)) for key in range(3))
        ended = pool.ended(tasks)
        next(ended)
        for thread in pool._threads:
            thread.join()
        left = list(pool.left_over())
    assert [key for key, _ in left] == [1, 2]
    assert all(one.status == DONE for _, one in left)

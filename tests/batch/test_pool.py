"""Whatever a task does, it costs itself only, and nothing of it is left."""

import os
import sys
import threading
import time
from contextlib import closing
from pathlib import Path

import pytest

from meshlab_willmore.batch.pool import Pool, PoolSettings, Seat
from meshlab_willmore.batch.process import CRASH, DONE, ERROR, MEMORY, TIMEOUT, Task
from tests.cli.test_compare_row import is_running, wait_for

POSIX = pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
LINUX = pytest.mark.skipif(sys.platform != "linux", reason="limits memory on Linux only")
GIB = 2**30


def task(name, argument=None, seconds=None):
    return Task(f"tests.batch.tasks:{name}", argument, seconds)


def ended(tasks, settings):
    """How each task ended, by its place."""
    with closing(Pool(settings)) as pool:
        return dict(pool.ended(enumerate(tasks)))


def seated(*tasks, **settings):
    """How tasks ended one after the other in one place."""
    seat = Seat(PoolSettings(**settings))
    try:
        return [seat.attempt(each, lambda message: None) for each in tasks]
    finally:
        seat.close()


def thing_left():
    return set(os.listdir("/proc/self/fd")), threading.active_count()


@POSIX
@pytest.mark.slow
def test_bad_tasks_cost_themselves_only():
    bad = [
        task("crash"),
        task("hang", "hung", 1.0),
        task("fail"),
        task("leave"),
        task("crash_with_a_child", "crashed"),
        task("make_a_file"),
        task("crash_while_saving", "half.ply")._replace(folders=(".",)),
    ]
    good = [task("give", number) for number in range(8)]
    before = thing_left() if sys.platform == "linux" else None
    found = ended([*good[:4], *bad, *good[4:]], PoolSettings(workers=2))
    outcomes = [found[place] for place in range(15)]
    assert [e.value for e in (*outcomes[:4], *outcomes[11:])] == list(range(8))
    crash, hang, fail, leave, crashed, untidy, half = outcomes[4:11]
    assert (crash.status, crash.reason) == (CRASH, "crashed (SIGSEGV)")
    assert (hang.status, hang.reason) == (TIMEOUT, "not finished within 1 s")
    assert hang.phase == "hanging"
    assert (fail.status, fail.reason) == (ERROR, "a reason of two lines")
    assert fail.trace.startswith("Traceback")
    assert (leave.status, leave.reason) == (CRASH, "the process ended with exit code 3")
    assert {each.reason for each in (crashed, untidy, half)} == {"crashed (SIGABRT)"}
    assert sorted(os.listdir()) == ["crashed", "hung"]
    for name in ("hung", "crashed"):
        child = int(Path(name).read_text())
        wait_for(lambda child=child: not is_running(child))
    if before is not None:
        # A thread may end a moment after its work.
        wait_for(lambda: thing_left() == before)


@POSIX
def test_task_is_not_blamed_for_what_others_left_behind():
    first, second, third = seated(task("give", 1), task("crash_unless_fresh", 2), task("give", 3))
    assert (second.status, second.value, second.attempts) == (DONE, 2, 1)
    assert (first.value, third.value) == (1, 3)


@POSIX
def test_crash_of_a_fresh_worker_is_the_tasks_own():
    """Each attempt adds a letter."""
    (crashed,) = seated(task("crash_and_count", "count"), warm_up=task("give", 0))
    assert (crashed.status, Path("count").read_text()) == (CRASH, "x")


def test_worker_stays_alive_and_is_renewed():
    counts = [a.value for a in seated(*[task("count")] * 3, renewed_after=2)]
    assert [number for number, _ in counts] == [1, 2, 1]
    assert counts[0][1] == counts[1][1] != counts[2][1]


def test_failed_task_is_done_again():
    once, never = seated(task("fail_once", "mark"), task("fail"), retries=1)
    assert (once.value, once.attempts) == ("at last", 2)
    assert (never.status, never.attempts) == (ERROR, 2)


@LINUX
@pytest.mark.slow
def test_memory_is_limited():
    eaten, given = seated(task("eat"), task("give", 1), memory=GIB // 2)
    assert eaten.status == MEMORY
    assert eaten.reason == "needs more than the memory limit of 0.5 GiB"
    assert given.value == 1
    assert 0 < given.memory < GIB


@LINUX
def test_a_warm_up_is_not_limited():
    limited, free = seated(task("limit"), task("limit")._replace(is_limited=False), memory=GIB)
    assert 0 < limited.value < free.value or free.value == -1


@pytest.mark.slow
def test_output_of_a_task_is_no_answer():
    (printed,) = seated(task("print_noise", "answer"))
    assert printed.value == "answer"


@POSIX
@pytest.mark.slow
def test_end_in_the_middle_is_quick_and_leaves_nothing():
    pool = Pool(PoolSettings(workers=1))
    hung = threading.Thread(
        target=lambda: list(pool.ended([(0, task("hang", "hung"))])), daemon=True
    )
    hung.start()
    wait_for(lambda: pool.running.get(0) == (0, "hanging"))
    start = time.monotonic()
    pool.close()
    assert time.monotonic() - start < 2.0
    hung.join(2.0)
    assert not hung.is_alive()
    child = int(Path("hung").read_text())
    wait_for(lambda: not is_running(child))


@POSIX
@pytest.mark.slow
def test_idle_worker_that_is_killed_is_replaced():
    """As the system does for lack of memory."""
    seat = Seat(PoolSettings())
    (_, pid) = seat.attempt(task("count"), lambda message: None).value
    os.kill(pid, 9)
    assert seat.attempt(task("give", 1), lambda message: None).value == 1
    seat.close()

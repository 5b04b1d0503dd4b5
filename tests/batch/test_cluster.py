"""A Dask cluster on this machine: a real scheduler, and two real worker processes."""

import json
import os
import shutil
import subprocess
import sys
import threading
import time
from contextlib import ExitStack, contextmanager
from pathlib import Path

import pytest

from meshlab_willmore.batch.cluster import Cluster, client_of
from meshlab_willmore.batch.pool import PoolSettings
from meshlab_willmore.batch.process import CRASH, ERROR, MEMORY, TIMEOUT, Task
from tests.cli.conftest import TAUBIN, call, cube_file, listing, script_file
from tests.cli.test_compare_row import wait_for

pytest.importorskip("distributed")
pytestmark = [
    pytest.mark.skipif(sys.platform != "linux", reason="limits memory on Linux only"),
    # Dask's own.
    pytest.mark.filterwarnings("ignore"),
]
LOOPBACK = ["--host", "127.0.0.1", "--no-dashboard"]


@pytest.fixture(autouse=True)
def _scratch_of_dask(temporary):
    yield
    shutil.rmtree(temporary / "dask-scratch-space", ignore_errors=True)


@contextmanager
def started(*arguments):
    """A process of Dask's command line."""
    program = [sys.executable, "-m", "dask", *arguments]
    # Workers import the functions of `tests.batch.tasks`.
    environment = {**os.environ, "PYTHONPATH": str(Path(__file__).parents[2])}
    process = subprocess.Popen(
        program, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env=environment
    )
    try:
        yield process
    finally:
        process.kill()
        process.wait()


@contextmanager
def scheduler(port=0):
    """A scheduler; gives its address."""
    file = Path("scheduler.json")
    file.unlink(missing_ok=True)
    with started("scheduler", *LOOPBACK, "--port", str(port), "--scheduler-file", str(file)):
        wait_for(lambda: file.exists() and file.read_text().strip().endswith("}"))
        yield json.loads(file.read_text())["address"]


def worker(address):
    """A worker of one thread, without a nanny that would start it again."""
    return started(
        "worker", address, *LOOPBACK, "--nthreads", "1", "--no-nanny", "--local-directory", "dask"
    )


def task(name, argument=None, seconds=None):
    return Task(f"tests.batch.tasks:{name}", argument, seconds)


@pytest.mark.slow
def test_command_line_on_a_cluster():
    cube_file("one.ply")
    cube_file("two.ply")
    script = script_file(TAUBIN)
    with scheduler() as address, worker(address):
        result = call(
            "run", script, "-i", "*.ply", "-o", "{name}.off", "--scheduler", address, "--summary"
        )
    assert result.exit_code == 0, result.stderr
    assert "2 inputs: 2 done; " in result.stdout
    assert {"one.off", "two.off"} <= set(listing())


@pytest.mark.nightly
def test_bad_tasks_and_a_lost_machine_cost_no_good_task():
    tasks = [task("give_slowly", number) for number in range(20)]
    bad = {
        "crash": (task("crash"), CRASH),
        "hang": (task("hang", "hung", 3.0), TIMEOUT),
        "fail": (task("fail"), ERROR),
        "eat": (task("eat"), MEMORY),
    }
    named = [*enumerate(tasks[:10]), *((name, t) for name, (t, _) in bad.items())]
    named += [*enumerate(tasks[10:], 10)]
    with ExitStack() as stack:
        address = stack.enter_context(scheduler())
        first = stack.enter_context(worker(address))
        stack.enter_context(worker(address))
        client = stack.enter_context(client_of(address))
        client.wait_for_workers(2)
        threading.Timer(6.0, first.kill).start()
        settings = PoolSettings(memory=2**29, folder=str(Path.cwd()))
        ended = dict(Cluster(client, settings).ended(named))
    assert [ended[number].value for number in range(20)] == list(range(20))
    assert {name: ended[name].status for name in bad} == {n: s for n, (_, s) in bad.items()}


@pytest.mark.nightly
def test_scheduler_that_is_lost_ends_the_batch_and_it_goes_on():
    for number in range(12):
        cube_file(f"{number}.ply")
    script = script_file(TAUBIN, ("Laplacian Smooth", {"stepSmoothNum": ("RichInt", 100_000)}))
    arguments = ["run", script, "-i", "*.ply", "-o", "out/{name}.off", "--json", "log.jsonl"]
    Path("out").mkdir()
    with ExitStack() as stack:
        running = stack.enter_context(scheduler())
        stack.enter_context(worker(running))
        done = []
        batch = threading.Thread(
            target=lambda: done.append(call(*arguments, "--scheduler", running))
        )
        batch.start()
        wait_for(lambda: len(listing("out")) >= 3)
    batch.join(60)
    (lost,) = done
    assert lost.exit_code == 1
    assert "the scheduler" in lost.stderr
    assert "is lost" in lost.stderr
    time.sleep(1.0)
    with scheduler() as address, worker(address):
        again = call(*arguments, "--scheduler", address, "--resume")
    assert again.exit_code == 0, again.stderr
    assert len(listing("out")) == 12
    # Whole files only, and each mesh is recorded once.
    records = [json.loads(line) for line in Path("log.jsonl").read_text().splitlines()]
    inputs = [record["input"] for record in records if "input" in record]
    assert sorted(inputs) == sorted(set(inputs))
    assert len(inputs) == 12

"""A batch with meshes that are bad in all ways, killed at random moments, and resumed."""

import hashlib
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pymeshlab
import pytest

from tests.cli.conftest import FLIP, SAMPLES, TAUBIN, call, listing, script_file
from tests.cli.test_compare_row import is_running, wait_for

pytestmark = [
    pytest.mark.nightly,
    pytest.mark.skipif(sys.platform != "linux", reason="reads the system's list of processes"),
]
KILLS = 6
GOOD = 48
SQUARE = "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n"
# A step that never ends on the one mesh, and one with which the process crashes on the other.
PROGRAM = """
import json
from meshlab_willmore import batch, script
def work(ms):
    faces = ms.current_mesh().face_number()
    if faces == 320:
        ms.apply_coord_laplacian_smoothing(stepsmoothnum=10**9)
    if faces == 12:
        ms.meshing_decimation_quadric_edge_collapse(targetfacenum=-5, targetperc=0.0)
    script.run("script.mlx", ms)
given = {"workers": 2, "timeout": 5.0, "log": "log.jsonl", "resume": True}
for result in batch.run(work, "in/*", "out/{name}.ply", **given):
    pass
"""
BAD = {
    "empty.ply": "bad file",
    "garbage.ply": "bad file",
    "cut.off": "bad file",
    "corner.off": "bad file",
    "hang.ply": "timeout",
    "crash.ply": "crash",
}


def make_inputs():
    for folder in ("in", "out", "alone"):
        Path(folder).mkdir()
    for number in range(GOOD):
        source = SAMPLES / ("bone.ply", "cow.obj", "airplane.obj")[number % 3]
        shutil.copy(source, f"in/{number:02}{source.suffix}")
    Path("in/empty.ply").touch()
    Path("in/garbage.ply").write_text("no mesh")
    Path("in/cut.off").write_text(SQUARE[:40])
    Path("in/corner.off").write_text(SQUARE.replace("3 0 2 3", "3 0 2 77"))
    ms = pymeshlab.MeshSet()
    ms.create_sphere(subdiv=2)
    ms.save_current_mesh("in/hang.ply")
    ms.create_cube()
    ms.save_current_mesh("in/crash.ply")


def outputs():
    return {path.name: hashlib.sha256(path.read_bytes()).digest() for path in Path("out").iterdir()}


def statuses():
    """The last record of each input."""
    records = [json.loads(line) for line in Path("log.jsonl").read_text().splitlines()]
    return {r["input"].removeprefix("in/"): r["status"] for r in records if "input" in r}


def family(pid):
    """A process with all that it has started."""
    found = [pid]
    for parent in found:
        for path in Path(f"/proc/{parent}/task").glob("*/children"):
            found += map(int, path.read_text().split())
    return found


def kill(process, number, all_of_it):
    """Send a signal at a random moment, and wait until nothing is left of the batch."""
    processes = family(process.pid)
    for pid in processes if all_of_it else [process.pid]:
        if is_running(pid):
            os.kill(pid, number)
    process.wait()
    start = time.monotonic()
    for pid in processes:
        wait_for(lambda pid=pid: not is_running(pid))
    assert time.monotonic() - start < 2.0


@pytest.mark.timeout(900)
def test_killed_and_resumed_batch_ends_the_same(temporary):
    script_file(FLIP, TAUBIN)
    make_inputs()
    Path("program.py").write_text(PROGRAM)
    program = [sys.executable, "program.py"]
    moments = random.Random(7)
    for _ in range(KILLS):
        number, all_of_it = moments.choice(
            [(signal.SIGKILL, True), (signal.SIGKILL, False), (signal.SIGTERM, False)]
        )
        process = subprocess.Popen(program, stderr=subprocess.DEVNULL)
        time.sleep(moments.uniform(0.5, 10.0))
        kill(process, number, all_of_it)
    subprocess.run(program, check=True)
    found, of_inputs = outputs(), statuses()
    assert {name: of_inputs[name] for name in BAD} == BAD
    assert sum(status == "done" for status in of_inputs.values()) == GOOD
    assert len(found) == GOOD
    # As each model alone, in a process of its own.
    for number in range(3):
        (source,) = Path("in").glob(f"{number:02}.*")
        assert (
            call("run", "script.mlx", "-i", source, "-o", "alone/mesh.ply", "--force").exit_code
            == 0
        )
        alone = hashlib.sha256(Path("alone/mesh.ply").read_bytes()).digest()
        copies = {found[f"{other:02}.ply"] for other in range(number, GOOD, 3)}
        assert copies == {alone}
    # What killed processes left is removed in the end.
    assert listing(temporary) == []

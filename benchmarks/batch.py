"""Throughput of a batch: one process, one worker, two workers, and a Dask cluster on this machine.

Run by hand, from the top of the repository, on a machine that does nothing else:

    python -m benchmarks.batch
    python -m benchmarks.batch --count 1000 --models airplane.obj

Each mesh is loaded, cleaned of duplicate vertices, flipped, smoothed and saved. In one process that
is done without a batch and without measures; the models are PyMeshLab's.
"""

import argparse
import contextlib
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

import pymeshlab

from benchmarks import machine
from meshlab_willmore import batch, script
from meshlab_willmore.batch.cluster import client_of
from meshlab_willmore.mlx.steps import Step
from studies.models import print_table

SAMPLES = pathlib.Path(pymeshlab.__file__).parent / "tests" / "sample_meshes"
# From 5,800 to 166,000 faces.
MODELS = ("cow.obj", "airplane.obj", "bunny.obj", "rangemaps/face000.ply", "cow.obj")
STEPS = [
    Step("meshing_remove_duplicate_vertices"),
    Step("meshing_edge_flip_by_willmore_optimization"),
    Step("apply_coord_taubin_smoothing"),
]


def inputs(folder, models, count):
    """Copies of models in a folder."""
    paths = []
    for number in range(count):
        source = SAMPLES / models[number % len(models)]
        paths.append(folder / f"{number:05}{source.suffix}")
        shutil.copy(source, paths[-1])
    return paths


def alone(paths, folder):
    """Process meshes in this process; return the seconds without those of the first one."""
    for number, path in enumerate(paths):
        if number == 1:
            start = time.perf_counter()
        ms = pymeshlab.MeshSet()
        ms.load_new_mesh(str(path))
        script.run(STEPS, ms)
        ms.save_current_mesh(str(folder / f"{path.stem}.ply"))
    return time.perf_counter() - start


def batched(paths, folder, **given):
    """Process meshes as a batch; return the seconds after the first result, and their work."""
    work = []
    for result in batch.run(STEPS, paths, folder / "{name}.ply", **given):
        assert result.is_done, result
        if not work:
            start = time.perf_counter()
        work.append(result.seconds)
    return time.perf_counter() - start, sum(work[1:])


@contextlib.contextmanager
def cluster(folder):
    """A client of a scheduler and two workers, on loopback."""
    file = folder / "scheduler.json"
    common = ["--host", "127.0.0.1", "--no-dashboard", "--scheduler-file", str(file)]
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, "cwd": folder}
    with contextlib.ExitStack() as stack:

        def start(*arguments):
            program = [sys.executable, "-m", "dask", *arguments, *common]
            process = subprocess.Popen(program, **quiet)
            stack.callback(process.wait)
            stack.callback(process.terminate)

        start("scheduler", "--port", "0")
        while not file.exists() or not file.read_text().strip().endswith("}"):
            time.sleep(0.1)
        for _ in range(2):
            start("worker", "--nthreads", "1", "--no-nanny")
        client = stack.enter_context(client_of(json.loads(file.read_text())["address"]))
        yield client


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=60)
    parser.add_argument("--models", nargs="+", default=MODELS)
    chosen = parser.parse_args()
    rows = []
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "in").mkdir()
        paths = inputs(folder / "in", chosen.models, chosen.count)

        def add(label, run):
            out = folder / label.replace(" ", "_")
            out.mkdir()
            before = os.times()
            found = run(out)
            after = os.times()
            seconds, work = found if isinstance(found, tuple) else (found, None)
            cpu = sum(after[:4]) - sum(before[:4])
            rate = 60.0 * (len(paths) - 1) / seconds
            # What one worker takes beyond the work itself. Dask's processes are none of ours.
            pool = ""
            if label == "1 worker":
                pool = f"{1000.0 * (seconds - work) / (len(paths) - 1):.1f}"
            shown = "" if label.startswith("Dask") else f"{cpu:.1f}"
            rows.append((label, f"{seconds:.1f}", f"{rate:.0f}", shown, pool))

        add("one process", lambda out: alone(paths, out))
        add("1 worker", lambda out: batched(paths, out, workers=1))
        add("2 workers", lambda out: batched(paths, out, workers=2))
        with cluster(folder) as client:
            client.wait_for_workers(2, timeout=60)
            add("Dask 2 workers", lambda out: batched(paths, out, client=client))
    print("\n".join(machine.description()))
    print_table(("", "seconds", "meshes a minute", "CPU seconds", "pool, ms a mesh"), rows)


if __name__ == "__main__":
    main()

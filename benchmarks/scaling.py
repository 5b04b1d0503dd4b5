"""Time and memory of the flips on arrays, from ten thousand faces to ten million.

Run by hand, from the top of the repository, on a machine that does nothing else:

    python -m benchmarks.scaling
    python -m benchmarks.scaling --most 10000000

Each size has a process of its own, which gets its mesh from a file, so that the peak of its memory
is that of the flips. It is counted above what the process holds with the mesh (vertices and faces)
in memory and all kernels loaded.
"""

import argparse
import functools
import inspect
import json
import pathlib
import resource
import statistics
import subprocess
import sys
import tempfile

import numpy as np

from benchmarks import machine, surfaces
from meshlab_willmore import optimize_flips
from studies.models import print_table

DEFAULT_SEARCH = inspect.signature(optimize_flips).parameters["search"].default
LEAST = 10_000
STEP = 10
SMALL = 1_000
MICRO = 1e-6
MIB = 2**20
KIB = 2**10
STATUS = pathlib.Path("/proc/self/status")
CLEAR = pathlib.Path("/proc/self/clear_refs")
# What makes the kernel forget the peak so far (proc(5)).
FORGET_PEAK = "5"


def sizes(most):
    """Numbers of faces, tenfold each time."""
    size = LEAST
    while size <= most:
        yield size
        size *= STEP


def measured(faces, options):
    """What the process for one size says."""
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder, "mesh.npz")
        vertices, triangles = surfaces.sheared_torus(faces)
        np.savez(path, vertices=vertices, faces=triangles)
        program = [sys.executable, "-m", "benchmarks.scaling", "--mesh", str(path)]
        given = ["--search", options.search, "--rounds", str(options.rounds)]
        done = subprocess.run([*program, *given], capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


def rows(options):
    """Lines of the table."""
    for size in sizes(options.most):
        found = measured(size, options)
        seconds, faces = found["seconds"], found["faces"]
        yield [
            f"{faces}",
            f"{found['flips']}",
            f"{seconds:.3f}",
            f"{seconds / faces / MICRO:.2f}",
            f"{found['above'] / MIB:.0f}",
            f"{found['above'] / faces:.0f}",
        ]


# --- in the process of one size ------------------------------------------------------------------


def one(options):
    """Flip the mesh of a file, and print the figures."""
    optimize_flips(*surfaces.sheared_torus(SMALL), search=options.search)
    with np.load(options.mesh) as file:
        vertices, faces = file["vertices"], file["faces"]
    forget_peak()
    before = memory("VmRSS")
    run = functools.partial(optimize_flips, vertices, faces, search=options.search)
    seconds = []
    for _ in range(options.rounds):
        # What the round before returned is gone by now.
        taken, flips = _flipped(run)
        seconds.append(taken)
    figures = {
        "faces": len(faces),
        "flips": flips,
        "seconds": statistics.median(seconds),
        "above": memory("VmHWM") - before,
    }
    print(json.dumps(figures))


def _flipped(run):
    """Seconds and number of flips; the new mesh itself is let go."""
    seconds, result = machine.timed(run)
    return seconds, result.flips


def memory(line):
    """Bytes in memory now ("VmRSS") or at most so far ("VmHWM").

    Not from the resource usage where it can be helped: Linux hands its peak on to new programs.
    """
    if not STATUS.exists():
        unit = 1 if sys.platform == "darwin" else KIB
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit
    fields = dict(text.split(":", 1) for text in STATUS.read_text().splitlines())
    return int(fields[line].split()[0]) * KIB


def forget_peak():
    """Let the peak begin anew, where that can be done."""
    if CLEAR.exists():
        CLEAR.write_text(FORGET_PEAK)


def main(arguments):
    parser = argparse.ArgumentParser(prog="python -m benchmarks.scaling")
    parser.add_argument("--most", type=int, default=1_000_000, help="faces")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--search", default=DEFAULT_SEARCH)
    parser.add_argument("--mesh", help=argparse.SUPPRESS)
    options = parser.parse_args(arguments)
    if options.mesh:
        one(options)
        return
    # Nothing is compiled in the processes.
    optimize_flips(*surfaces.sheared_torus(SMALL), search=options.search)
    print("\n".join(machine.description()), end="\n\n")
    head = ["faces", "flips", "seconds", "us a face", "peak, MiB", "bytes a face"]
    print_table(head, rows(options))


if __name__ == "__main__":
    main(sys.argv[1:])

"""Where the time of a filter call goes, stage by stage, and what PyMeshLab alone takes of it.

Run by hand, from the top of the repository, on a machine that does nothing else (a minute):

    pip install '.[test]'
    python -m benchmarks.stages [--held] [--cpu]

The floor is what PyMeshLab's own calls take for the same mesh: saving it, and loading the flipped
one. No other calls bring all of a mesh out of a set and back, so no filter in Python is faster by
more than the rest.
"""

import argparse
import contextlib
import functools
import statistics
import tempfile
import time
from pathlib import Path

import pymeshlab

from benchmarks import machine
from meshlab_willmore import optimize
from meshlab_willmore.demo.scan import scan_file
from meshlab_willmore.meshset import exchange, flips, late, layers, native, ply, recording, snapshot
from studies import models
from tests import meshes

PLANAR = {"planartype": "delaunay", "pthreshold": 60.0, "iterations": 0}
SMALL, LARGE = 200, 200_000
# Each stage is a function; an indented one is a part of that above it.
STAGES = (
    ("flips on arrays", optimize, "optimize_flips"),
    ("reading what flips depend on", late, "surface_of"),
    ("reading a small mesh", flips, "take"),
    ("reading a large mesh", late, "take"),
    ("  PyMeshLab: save", native, "save"),
    ("  reading the file", ply, "read"),
    ("making the new mesh", exchange, "with_faces"),
    ("replacing the mesh", exchange, "give"),
    ("  writing the file", exchange, "_write"),
    ("  trying a part", exchange, "_try_a_part"),
    ("  PyMeshLab: load", native, "load"),
    ("  comparing", exchange, "_lost"),
    ("  is it held?", layers, "_is_held"),
    ("script", recording, "catch_up"),
)
ALL, REST = "the filter", "the rest"


def surfaces():
    """Name and mesh of each model, and how often it is flipped."""
    yield "torus", meshes.torus(LARGE, 0.3, 8), 7
    yield "face scan", models.cleaned(scan_file()), 7
    yield "small torus", meshes.torus(SMALL, 0.3, 8), 50


@contextlib.contextmanager
def listened(clock, seconds):
    """Add up in a dict what each stage takes inside."""
    with contextlib.ExitStack() as stack:
        for label, module, name in STAGES:
            function = getattr(module, name)
            stack.callback(setattr, module, name, function)
            setattr(module, name, _timed(function, label, clock, seconds))
        yield


def _timed(function, label, clock, seconds):
    @functools.wraps(function)
    def timed(*args, **kwargs):
        start = clock()
        try:
            return function(*args, **kwargs)
        finally:
            seconds[label] = seconds.get(label, 0.0) + clock() - start

    return timed


def shares(surface, rounds, clock, held):
    """The median of what each stage of a call takes, in seconds, of the planar flip and the floor.

    Parameters
    ----------
    surface : pair of ndarray
        Vertices and faces.
    rounds : int
        One more is not counted.
    clock : callable
        Returns seconds.
    held : bool
        Whether a `Mesh` object is held meanwhile.
    """
    found = []
    for _ in range(rounds + 1):
        seconds = {}
        ms = made(surface)
        mesh = ms.current_mesh() if held else None
        with listened(clock, seconds):
            start = clock()
            ms.meshing_edge_flip_by_willmore_optimization()
            seconds[ALL] = clock() - start
        del mesh
        whole = sum(taken for label, taken in seconds.items() if label[0] != " ")
        seconds[REST] = 2 * seconds[ALL] - whole
        found.append({**seconds, **floor(surface, clock)})
    labels = [label for label, *_ in STAGES] + [REST, ALL, *floor_labels()]
    return {
        label: statistics.median(taken.get(label, 0.0) for taken in found[1:]) for label in labels
    }


def made(surface):
    """A set with the mesh, which nobody holds."""
    ms = pymeshlab.MeshSet()
    ms.add_mesh(pymeshlab.Mesh(*surface))
    return ms


def floor_labels():
    return "PyMeshLab: planar flip", "PyMeshLab: save", "PyMeshLab: load", "PyMeshLab: copy"


def floor(surface, clock):
    """What PyMeshLab's planar flip takes, and what saving, loading and copying the mesh does."""
    seconds = []

    def take(call, *args, **options):
        start = clock()
        call(*args, **options)
        seconds.append(clock() - start)

    ms, target, other = made(surface), pymeshlab.MeshSet(), pymeshlab.MeshSet()
    take(made(surface).meshing_edge_flip_by_planar_optimization, **PLANAR)
    with tempfile.TemporaryDirectory() as folder:
        saved, plain = (str(Path(folder, name)) for name in ("saved.ply", "plain.ply"))
        flags = snapshot._save_flags(ms.current_mesh())
        take(ms.save_current_mesh, saved, save_textures=False, **flags)
        no_flags = {**flags, "save_vertex_flag": False, "save_face_flag": False}
        ms.save_current_mesh(plain, **{**no_flags, "save_vertex_normal": True})
        take(target.load_new_mesh, plain)
    take(other.add_mesh, ms.current_mesh())
    return dict(zip(floor_labels(), seconds, strict=True))


def print_shares(name, faces, found):
    print(f"\n{name}, {len(faces):,} faces")
    for label, taken in found.items():
        share = "" if label in floor_labels() else f"{100 * taken / found[ALL]:7.1f} %"
        print(f"{label:<30}{1000 * taken:9.2f} ms{share}")
    ours = found[ALL] / found["PyMeshLab: planar flip"]
    least = sum(found[label] for label in ("flips on arrays", "PyMeshLab: save", "PyMeshLab: load"))
    print(f"filter / planar {ours:.2f}; arrays, save and load alone {least / found[ALL]:.0%} of it")


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--held", action="store_true", help="hold a Mesh object meanwhile")
    parser.add_argument("--cpu", action="store_true", help="time of processors, not by the clock")
    options = parser.parse_args()
    print("\n".join(machine.description()))
    clock = time.process_time if options.cpu else time.perf_counter
    for name, surface, rounds in surfaces():
        print_shares(name, surface[1], shares(surface, rounds, clock, options.held))


if __name__ == "__main__":
    main()

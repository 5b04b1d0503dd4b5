"""Flips of other libraries and ours, side by side: times and ratios.

Run by hand, from the top of the repository, on a machine that does nothing else (some minutes):

    pip install '.[test,peers]'
    python -m benchmarks.peers

All take turns in one process on the same meshes; medians of wall-clock time. MeshLab's curvature
flip, which need not end, runs once in a process of its own that is killed after `--limit` seconds.
MeshLib and libigl are left out where they are not installed (MeshLib's licence allows evaluation
and non-commercial use only). They flip to other ends than ours: MeshLib, libigl and MeshLab's
planar flip aim at Delaunay triangulations.
"""

import argparse
import functools
import importlib
import sys

import numba
import numpy as np
import pymeshlab

from benchmarks import machine
from meshlab_willmore import optimize_flips
from meshlab_willmore.demo.scan import scan_file
from studies import models, tools
from tests import meshes

OUR_FILTER = "our filter"
OUR_KERNEL = "our kernel"
PLANAR = "MeshLab planar"
CURVATURE = "MeshLab curvature"
MESHLIB = "MeshLib"
PLANAR_OPTIONS = {"planartype": "delaunay", "pthreshold": 60.0, "iterations": 0}
CURVATURE_OPTIONS = {"curvtype": "mean"}
# More than it takes; after one, a quarter of the flips are still to be made.
MESHLIB_ITERATIONS = 100
# At most so much of the other's time, by (ours, other, model).
GOALS = {
    (OUR_FILTER, CURVATURE, "torus"): 1 / 20,
    (OUR_FILTER, PLANAR, "torus"): 0.7,
    (OUR_KERNEL, MESHLIB, "torus"): 1.5,
    (OUR_FILTER, PLANAR, "face scan"): 1.3,
}


def surfaces(points):
    """Name, vertices, faces of the meshes, one at a time."""
    yield "torus", *meshes.torus(points, 0.3, 8)
    yield "face scan", *models.cleaned(scan_file())


# --- contenders: each is prepared, and returns the seconds that it took --------------------------


def applied(name, options, vertices, faces):
    """A filter, from a set with the mesh to a set with the flipped mesh."""
    ms = pymeshlab.MeshSet()
    ms.add_mesh(pymeshlab.Mesh(vertices, faces))
    return machine.seconds_of(functools.partial(ms.apply_filter, name, **options))


def flipped(vertices, faces, threads):
    """Our flips on arrays, with so many threads."""
    with machine.threads_set(threads):
        return machine.seconds_of(functools.partial(optimize_flips, vertices, faces))


def flipped_by_meshlib(vertices, faces, is_building_counted):
    """MeshLib's flips, until none is left; its mesh is built before, or with it."""
    numeric = importlib.import_module("meshlib.mrmeshnumpy")
    library = importlib.import_module("meshlib.mrmeshpy")
    building, mesh = machine.timed(lambda: numeric.meshFromFacesVerts(faces, vertices))
    flipping = machine.seconds_of(
        lambda: library.makeDeloneEdgeFlips(mesh, numIters=MESHLIB_ITERATIONS)
    )
    return flipping + building * is_building_counted


def flipped_by_igl(vertices, faces):
    """libigl's intrinsic Delaunay triangulation; lengths of edges are not counted."""
    igl = importlib.import_module("igl")
    faces = faces.astype(np.int64)
    lengths = igl.edge_lengths(vertices, faces)
    return machine.seconds_of(lambda: igl.intrinsic_delaunay_triangulation(lengths, faces))


def contenders(vertices, faces):
    """All that take turns, by name."""
    given = {"vertices": vertices, "faces": faces}
    most = numba.config.NUMBA_NUM_THREADS
    ours = "meshing_edge_flip_by_willmore_optimization"
    planar = "meshing_edge_flip_by_planar_optimization"
    found = {
        OUR_FILTER: functools.partial(applied, ours, {}, **given),
        OUR_KERNEL: functools.partial(flipped, threads=most, **given),
        f"{OUR_KERNEL}, one thread": functools.partial(flipped, threads=1, **given),
        PLANAR: functools.partial(applied, planar, PLANAR_OPTIONS, **given),
    }
    if is_installed("meshlib"):
        found[MESHLIB] = functools.partial(flipped_by_meshlib, is_building_counted=False, **given)
        found[f"{MESHLIB}, mesh built too"] = functools.partial(
            flipped_by_meshlib, is_building_counted=True, **given
        )
    if is_installed("igl"):
        found["libigl intrinsic"] = functools.partial(flipped_by_igl, **given)
    return found


def is_installed(name):
    """Whether a library can be imported."""
    try:
        importlib.import_module(name)
    except ImportError:
        return False
    return True


# --- MeshLab's curvature flip --------------------------------------------------------------------


def curvature_seconds(vertices, faces, limit):
    """Its time in a process of its own, or None if that takes longer than `limit`."""
    flipped = tools.flipped_by_curvature(limit, CURVATURE_OPTIONS, vertices, faces)
    return None if flipped is None else flipped[1]


# --- the tables ----------------------------------------------------------------------------------


def rows(found, curvature, limit):
    """Lines of the table of one mesh."""
    ours = found[OUR_FILTER][0]
    for name, (median, least, most) in found.items():
        spread = f"{least:.3f} to {most:.3f}"
        yield [name, f"{median:.3f}", spread, f"{median / ours:.2f}", f"{ours / median:.3f}"]
    if curvature is None:
        yield [CURVATURE, f"> {limit:g}", "", f"> {limit / ours:.2f}", f"< {ours / limit:.3f}"]
    else:
        ratios = [f"{curvature / ours:.2f}", f"{ours / curvature:.3f}"]
        yield [CURVATURE, f"{curvature:.3f}", "one run", *ratios]


def goals(model, found, curvature, limit):
    """Lines of the table of goals."""
    medians = {name: figures[0] for name, figures in found.items()}
    # Not to end within the limit is to take at least as long.
    medians[CURVATURE] = limit if curvature is None else curvature
    for (ours, other, where), goal in GOALS.items():
        if where == model and other in medians:
            share = medians[ours] / medians[other]
            is_bound = other == CURVATURE and curvature is None
            missed = f"not known, --limit {limit:g} is too short" if is_bound else "no"
            yield [
                model,
                f"{ours} / {other}",
                f"{'< ' * is_bound}{share:.3f}",
                f"{goal:.3f}",
                "yes" if share <= goal else missed,
            ]


def main(arguments):
    options = _options(arguments)
    print("\n".join(machine.description()))
    reached = []
    for model, vertices, faces in surfaces(options.points):
        taking_turns = contenders(vertices, faces)
        # Once, so that nothing is compiled or loaded later.
        machine.interleaved(taking_turns, 1)
        found = machine.interleaved(taking_turns, options.rounds)
        curvature = curvature_seconds(vertices, faces, options.limit)
        print(f"\n{model}: {len(vertices)} vertices, {len(faces)} faces; n = {options.rounds}\n")
        head = ["", "median, s", "least to most", "of our filter", "our filter of it"]
        models.print_table(head, rows(found, curvature, options.limit))
        reached += goals(model, found, curvature, options.limit)
    print()
    models.print_table(["mesh", "ratio", "is", "goal", "reached"], reached)


def _options(arguments):
    parser = argparse.ArgumentParser(prog="python -m benchmarks.peers")
    parser.add_argument("--points", type=int, default=200_000, help="of the torus")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument(
        "--limit", type=float, default=60.0, help="seconds for MeshLab's curvature flip"
    )
    return parser.parse_args(arguments)


if __name__ == "__main__":
    main(sys.argv[1:])

"""Does it matter where the virtual points are? Prints the tables of docs/virtual_points.md.

Run by hand, from the top of the repository (some minutes):

    python -m studies.virtual_points
"""

import numpy as np

from meshlab_willmore import optimize_flips
from meshlab_willmore.energy import virtual, virtual_at, virtual_closest, willmore
from meshlab_willmore.guards import fold_limits
from meshlab_willmore.measure import measures
from meshlab_willmore.mesh.build import build, faces_of
from meshlab_willmore.search import parallel_greedy
from meshlab_willmore.search.rules import Rules
from studies import models
from studies.both_points import BOTH
from tests import meshes
from tests.connectivity import can_flip

PLACES = ["midpoint", "closest", 0.4, 0.3, 0.2, 0.1, 0.01]
HEAD = ["model", "virtual points", "flips", "W", "area", "M", "normal error"]


def row(name, place, vertices, faces, flips=""):
    """One line of a table."""
    totals = measures(vertices, faces)
    is_torus = name.startswith("torus")
    return [
        name,
        str(place),
        str(flips),
        f"{totals.willmore_energy:.1f}",
        f"{totals.area:.6g}",
        f"{totals.absolute_mean_curvature:.5g}",
        f"{models.torus_normal_error(vertices, faces):.2f}" if is_torus else "",
    ]


def searched(surfaces, search="greedy", **options):
    """Some models with all places under one search, and with the Willmore energy to compare."""
    options["search"] = search
    for name, vertices, faces in surfaces:
        yield row(name, "(initial)", vertices, faces)
        for place in PLACES:
            result = optimize_flips(vertices, faces, virtualpoint=place, **options)
            yield row(name, place, vertices, result.faces, result.flips)
        result = optimize_flips(vertices, faces, energy="willmore", **options)
        yield row(name, "none (energy W)", vertices, result.faces, result.flips)


def both_at_once():
    """Two points on each diagonal at the same time, under the monotone rule."""
    for name, vertices, faces in models.tori():
        for t in (0.4, 0.3, 0.2, 0.1):
            mesh = build(vertices, faces)
            rules = Rules(fold_limits(90.0), virtualpoint=t)
            flips = parallel_greedy.run(BOTH, mesh, rules).flips
            yield row(name, f"{t} and {1.0 - t:.1f}", vertices, faces_of(mesh), flips)


def agreement():
    """How often a place says of an edge what the Willmore energy says: does the flip help?"""
    for name, vertices, faces in models.tori():
        mesh = build(vertices, faces)
        edges = [h for h in range(len(mesh.origin)) if h < mesh.twin[h] and can_flip(mesh, h)]
        wanted = np.sign([willmore.cost_reduction(mesh, h) for h in edges])
        for place in PLACES:
            found = np.sign([_gain(mesh, h, place) for h in edges])
            yield [name, str(place), f"{100.0 * (found == wanted).mean():.1f} %"]


def _gain(mesh, h, place):
    if place == "midpoint":
        return virtual.cost_reduction(mesh, h)
    if place == "closest":
        return virtual_closest.cost_reduction(mesh, h)
    return virtual_at.cost_reduction(mesh, h, place)


def tables():
    yield "Greedy, monotone", searched(models.all_models())
    yield "Greedy, literal", searched(models.all_models(), monotone=False)
    chains = {"search": "variable depth", "depth": 3}
    yield "Variable depth, depth 3", searched(models.tori(), **chains)
    yield "Two points at once, parallel greedy, monotone", both_at_once()


if __name__ == "__main__":
    optimize_flips(*meshes.cube())
    for title, rows in tables():
        print(f"\n## {title}\n")
        models.print_table(HEAD, rows)
    print("\n## Signs as of W, initial meshes\n")
    models.print_table(["model", "virtual points", "agree"], agreement())

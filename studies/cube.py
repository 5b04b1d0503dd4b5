"""What minimises what on the paper's cube? Prints the tables of docs/cube.md.

Run by hand, from the top of the repository; the number says from how many triangulations the
search beyond the cube's own edges goes on (5,000 take some ten minutes):

    python -m studies.cube 5000
"""

import sys

import numpy as np
import pymeshlab

from meshlab_willmore import optimize_flips
from meshlab_willmore.energy.table import ENERGIES
from meshlab_willmore.mesh.build import build
from studies.models import print_table
from studies.triangulations import (
    CORNERS,
    FAN,
    TOTALS,
    Found,
    best_first,
    classes,
    faces_of_ways,
    totals,
)
from tests.meshes import cube

PUSHES = [0.01, 0.05, 0.1, 0.2, 0.3, 0.4]
SEARCHES = ["greedy", "variable depth"]
MOST_TRIED = 5000
STEP = 0.0025
DEEPEST = 0.5
FANS = [FAN] * 6
NEAR_FANS = 300
# Totals of one triangulation, summed in different orders, agree up to this.
SAME = 1e-9


def intersecting(vertices, faces):
    """How many faces MeshLab says cut another one."""
    meshes = pymeshlab.MeshSet()
    meshes.add_mesh(pymeshlab.Mesh(vertices, faces))
    meshes.compute_selection_by_self_intersections_per_face()
    return meshes.current_mesh().selected_face_number()


def measured(vertices, faces):
    """The totals (5,) in the order of `TOTALS`; W as the sum of W(v)."""
    found = np.array(totals(build(vertices, faces)))
    found[TOTALS.index("W")] -= 2.0 * np.pi * len(vertices)
    return found


def texts(values):
    return [f"{value:.4f}" for value in values]


def descents():
    """Rows for each push, energy and search."""
    for push in PUSHES:
        vertices, faces = cube(push)
        yield [str(push), "(initial)", "", "", *texts(measured(vertices, faces)), "0"]
        for energy in ENERGIES:
            for search in SEARCHES:
                result = optimize_flips(vertices, faces, energy=energy, search=search)
                found = measured(vertices, result.faces)
                cuts = intersecting(vertices, result.faces)
                yield [str(push), energy, search, str(result.flips), *texts(found), str(cuts)]


def all_ways(push):
    """The totals (c, 5) of each class of the 5^6 triangulations."""
    vertices, _ = cube(push)
    return np.array([measured(vertices, faces_of_ways(ways)) for ways in classes()[0]])


def enumerated():
    """Rows for each push and total: the least and the most of the 5^6, and where two are."""
    sizes = classes()[1]
    for push in PUSHES:
        vertices, faces = cube(push)
        every = all_ways(push)
        initial = measured(vertices, faces)
        fans = measured(vertices, faces_of_ways(FANS))
        for column, name in enumerate(TOTALS):
            least, most = every[:, column].min(), every[:, column].max()
            count = sizes[every[:, column] < least + SAME].sum()
            values = least, most, initial[column], fans[column]
            yield [str(push), name, *texts(values), str(count)]


def beyond(limit):
    """Rows for each push and total: what flips of any edge lead to, from all of the 5^6."""
    starts = [faces_of_ways(ways) for ways in classes()[0]]
    for push in PUSHES:
        vertices, _ = cube(push)
        every = all_ways(push)

        def is_embedded(faces, vertices=vertices):
            return intersecting(vertices, faces) == 0

        for column, name in enumerate(TOTALS):
            free = best_first(vertices, starts, name, limit)
            embedded = best_first(vertices, starts, name, limit, is_embedded)
            # The free search passes through triangulations of both kinds, and may miss the better.
            free = min(free, embedded, key=lambda found: found.value)
            yield [
                str(push),
                name,
                f"{every[:, column].min():.4f}",
                *described(vertices, free, column),
                *described(vertices, embedded, column)[:2],
            ]


def described(vertices, found: Found, column):
    """The total of the best one, its valences at the centres, and the number of cut faces."""
    valences = np.bincount(found.faces.ravel(), minlength=len(vertices))[CORNERS:]
    return [
        f"{measured(vertices, found.faces)[column]:.4f}",
        "".join(map(str, sorted(valences))),
        str(intersecting(vertices, found.faces)),
    ]


def where_it_changes():
    """Rows for the pushes at which the result of greedy flips changes."""
    last = None
    for push in np.arange(STEP, DEEPEST - STEP / 2, STEP):
        vertices, faces = cube(push)
        result = optimize_flips(vertices, faces, search="greedy")
        valences = np.bincount(result.faces.ravel())[CORNERS:]
        kind = result.flips, sorted(valences.tolist())
        if kind != last:
            found = measured(vertices, result.faces)
            cuts = intersecting(vertices, result.faces)
            sorted_valences = "".join(map(str, kind[1]))
            fans = measured(vertices, faces_of_ways(FANS))[0]
            values = *texts(found), f"{fans:.4f}"
            yield [f"{push:.4f}", str(result.flips), sorted_valences, *values, str(cuts)]
        last = kind


def where_fans_stop():
    """Rows for the totals that the fans have least: up to which push flips of cube edges say so."""
    for name in ("extrinsic", "M"):
        shallow, deep = PUSHES[0], DEEPEST
        while deep - shallow > STEP:
            middle = (shallow + deep) / 2.0
            vertices, _ = cube(middle)
            faces = faces_of_ways(FANS)
            least = totals(build(vertices, faces))[TOTALS.index(name)] - SAME
            if best_first(vertices, [faces], name, NEAR_FANS).value > least:
                shallow = middle
            else:
                deep = middle
        yield [name, f"{shallow:.3f}"]


def main(limit):
    for title, head, rows in (
        ("Descents", ["push", "energy", "search", "flips", *TOTALS, "cut"], descents()),
        (
            "All 5^6",
            ["push", "total", "least", "most", "initial", "fans", "least ones"],
            enumerated(),
        ),
        (
            "Where virtual Willmore changes",
            ["from push", "flips", "valences", *TOTALS, "area of fans", "cut"],
            where_it_changes(),
        ),
        ("Up to where the fans are least", ["total", "up to push"], where_fans_stop()),
        (
            f"Flips of any edge, {limit} triangulations left",
            ["push", "total", "of 5^6", "least", "valences", "cut", "least uncut", "valences"],
            beyond(limit),
        ),
    ):
        print(f"\n## {title}\n")
        print_table(head, rows)


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else MOST_TRIED)

"""What to use when: prints the tables of docs/settings.md.

Run by hand, from the top of the repository, on a machine that does nothing else (some minutes):

    python -m studies.settings
"""

import time

import numpy as np

from meshlab_willmore import optimize_flips
from meshlab_willmore.demo.scan import scan_file
from meshlab_willmore.measure import triangle_shapes, willmore_energy
from meshlab_willmore.mesh.build import build, faces_of
from studies import models
from tests import meshes
from tests.search.ways import scramble

THOROUGH = {"energy": "willmore", "search": "thorough"}
SETTINGS = [
    {},
    {"virtualpoint": 0.05},
    {"energy": "willmore"},
    {"energy": "uniform virtual willmore"},
    {"energy": "area"},
    {"energy": "delaunay"},
    {"energy": "mean curvature"},
    {"energy": "gaussian curvature"},
    {"energy": "willmore", "search": "variable depth", "depth": 3},
    {"energy": "willmore", "search": "variable depth"},
    {"energy": "willmore", "search": "annealing"},
    THOROUGH,
]
SEEDS = range(100, 120)
FLIPS_PER_EDGE = 2
WORST = 0.01


def surfaces():
    """Name, vertices, faces of the models."""
    yield from models.tori()
    yield "face, stretched", *models.face()
    yield "face scan", *models.cleaned(scan_file())


def row(name, setting, vertices, faces, seconds):
    """One line of the first table."""
    is_torus = name.startswith("torus")
    return [
        name,
        setting,
        f"{willmore_energy(vertices, faces):.6g}",
        f"{models.torus_normal_error(vertices, faces):.2f}" if is_torus else "",
        f"{np.quantile(triangle_shapes(vertices, faces), WORST):.3f}",
        seconds,
    ]


def settings():
    """All settings on all models, warm."""
    for name, vertices, faces in surfaces():
        yield row(name, "(initial)", vertices, faces, "")
        for options in SETTINGS:
            optimize_flips(*meshes.cube(), **options)
            start = time.perf_counter()
            result = optimize_flips(vertices, faces, **options)
            seconds = f"{time.perf_counter() - start:.2f}"
            yield row(name, str(options), vertices, result.faces, seconds)


def starts():
    """What scrambles of the tori end in: the Willmore energies, from low to high."""
    for name, vertices, faces in models.tori():
        for options in (
            {"energy": "willmore"},
            {"energy": "willmore", "search": "variable depth", "depth": 3},
            {"energy": "willmore", "search": "variable depth"},
            THOROUGH,
        ):
            first = optimize_flips(vertices, faces, **options).willmore_after
            found = [
                optimize_flips(vertices, scrambled(vertices, faces, seed), **options).willmore_after
                for seed in SEEDS
            ]
            middle = float(np.median(found))
            yield [
                name,
                str(options),
                *(f"{w:.5g}" for w in (first, min(found), middle, max(found))),
            ]


def scrambled(vertices, faces, seed):
    """The faces after random legal flips, under the fold guard."""
    return faces_of(scramble(build(vertices, faces), seed, FLIPS_PER_EDGE))


if __name__ == "__main__":
    models.print_table(
        ["model", "options", "W", "normal error", "1 % worst", "seconds"], settings()
    )
    print()
    models.print_table(["model", "options", "initial", "least", "median", "most"], starts())

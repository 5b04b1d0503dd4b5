"""Random valid options of `optimize_flips`."""

import numpy as np

from meshlab_willmore.options import ENERGY, PRESET, SEARCH
from meshlab_willmore.passes import PASS_OPTIONS
from meshlab_willmore.presets import SEARCH_OPTIONS
from tests import reference


def _angle(rng, usual):
    return float(rng.choice([usual, usual, 0.0, 30.0, 90.0, 180.0, rng.uniform(0.0, 180.0)]))


def _deviation(rng, vertices, faces):
    size = float(np.abs(vertices[faces]).max(initial=0.0))
    return float(rng.choice([0.0, size, size * 10.0 ** rng.uniform(-6.0, 0.0)]))


def random_passes(rng, vertices, faces):
    """A preset, or a few passes of random options, and options that are for all of them."""
    options = random_options(rng, vertices, faces)
    shared = {name: value for name, value in options.items() if name not in SEARCH_OPTIONS}
    if rng.random() < 0.5:
        return {**shared, "preset": str(rng.choice(PRESET.choices[1:]))}
    passes = []
    for _ in range(int(rng.integers(1, 4))):
        options = random_options(rng, vertices, faces)
        kept = rng.random(len(options)) < 0.7
        chosen = zip(options.items(), kept, strict=True)
        passes.append({k: v for (k, v), keep in chosen if keep and k in PASS_OPTIONS})
    # With numbers of their own: the others of a case stay as they were.
    (own,) = rng.spawn(1)
    return {**shared, "passes": [{**one, **_only_of_passes(own, one)} for one in passes]}


def _only_of_passes(rng, given):
    """What only passes take, for one with the options that are given."""
    chosen = {}
    if rng.random() < 0.3:
        chosen["mingain"] = float(rng.choice([0.0, 0.05, rng.random()]))
    if given.get("energy") == "mean curvature" and rng.random() < 0.7:
        chosen["vertexnormals"] = True
    elif rng.random() < 0.2:
        chosen["atfolds"] = True
    return chosen


def random_mapping(rng, vertices, faces):
    """Texture coordinates (m, 3, 2): charts with seams between them, folds, ties, odd values."""
    points = vertices[:, rng.permutation(3)[:2]] / max(np.abs(vertices[faces]).max(), 1e-300)
    if rng.random() < 0.3:
        points = rng.random((len(vertices), 2))
    if rng.random() < 0.3:
        points = np.round(4.0 * points)
    uv = points[faces] * rng.choice([1.0, -1.0], 2)
    other_chart = rng.random(len(faces)) < rng.choice([0.0, 0.1, 0.5])
    uv[other_chart] += 1.0
    if rng.random() < 0.2:
        uv[rng.random(len(faces)) < 0.2] = rng.choice([0.0, np.nan])
    return uv * 10.0 ** rng.choice([0.0, rng.uniform(-100.0, 100.0)])


def random_options(rng, vertices, faces):
    """Options by name."""
    search = str(rng.choice(SEARCH.choices, p=[0.4, 0.15, 0.2, 0.1, 0.15]))
    options = {
        "energy": str(rng.choice(ENERGY.choices)),
        "search": search,
        "checkintersections": bool(rng.random() < 0.5),
        "foldangle": _angle(rng, 90.0),
    }
    if rng.random() < 0.3:
        options["minshape"] = float(rng.choice([0.0, 0.0, 1.0, rng.random()]))
    if rng.random() < 0.3:
        options["maxdeviation"] = _deviation(rng, vertices, faces)
    if rng.random() < 0.3:
        options["featuredeg"] = _angle(rng, 30.0)
    if rng.random() < 0.2:
        options["selected_faces"] = rng.random(len(faces)) < 0.8
    edges = sorted(reference.edge_set(faces)) if len(faces) else []
    if edges and rng.random() < 0.2:
        some = np.array(edges)[rng.random(len(edges)) < 0.2]
        options["locked_edges"] = np.where(rng.random((len(some), 1)) < 0.5, some, some[:, ::-1])
    if len(faces) and rng.random() < 0.15:
        options["wedge_uv"] = random_mapping(rng, vertices, faces)
    if rng.random() < 0.15:
        options["maxflips"] = int(rng.integers(0, 12))
    if options["energy"] == "virtual willmore":
        options["monotone"] = bool(rng.random() < 0.7)
        place = float(rng.uniform(0.01, 0.99))
        options["virtualpoint"] = ("midpoint", "midpoint", "closest", place)[rng.integers(4)]
    if search in ("variable depth", "thorough"):
        options["depth"] = int(rng.integers(1, 7))
        options["breadth"] = int(rng.choice([1, 2, 3, 3, 12]))
    if search == "annealing":
        options["sweeps"] = int(rng.integers(1, 12))
        options["seed"] = int(rng.integers(2**31))
    return options

"""Random valid options of `optimize_flips`."""

import numpy as np

from meshlab_willmore.optimize import KERNELS, SEARCHES
from tests import reference


def _angle(rng, usual):
    return float(rng.choice([usual, usual, 0.0, 30.0, 90.0, 180.0, rng.uniform(0.0, 180.0)]))


def random_options(rng, vertices, faces):
    """Options by name."""
    search = str(rng.choice(SEARCHES, p=[0.4, 0.15, 0.2, 0.1, 0.15]))
    options = {
        "energy": str(rng.choice(list(KERNELS))),
        "search": search,
        "checkintersections": bool(rng.random() < 0.5),
        "foldangle": _angle(rng, 90.0),
    }
    if rng.random() < 0.3:
        options["featuredeg"] = _angle(rng, 30.0)
    if rng.random() < 0.2:
        options["selected_faces"] = rng.random(len(faces)) < 0.8
    edges = sorted(reference.edge_set(faces)) if len(faces) else []
    if edges and rng.random() < 0.2:
        some = np.array(edges)[rng.random(len(edges)) < 0.2]
        options["locked_edges"] = np.where(rng.random((len(some), 1)) < 0.5, some, some[:, ::-1])
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
    if rng.random() < 0.25:
        mappings = [_mapping(rng, vertices, faces) for _ in range(rng.integers(1, 3))]
        options["wedge_uv"] = np.concatenate(mappings, axis=2)
    return options


def _mapping(rng, vertices, faces):
    """Texture coordinates of corners, (m, 3, 2): plain, mirrored, folded, in charts, with holes."""
    unit = vertices / (np.abs(vertices).max(initial=0.0) or 1.0)
    uv = (
        unit[:, :2],
        unit[:, :2] * (-1.0, 1.0),
        unit[:, :2] + rng.normal(0.0, 0.1, (len(unit), 2)),
        np.round(8.0 * unit[:, :2]) / 10.0,
        unit @ rng.normal(size=(3, 2)),
        rng.integers(0, 4, (len(unit), 2)).astype(float),
    )[rng.integers(6)]
    wedges = uv[faces].reshape(-1, 3, 2)
    if rng.random() < 0.4:
        chart = unit[faces].reshape(-1, 3, 3).mean(axis=1) @ rng.normal(size=3) > 0.0
        wedges[chart] = wedges[chart] * rng.choice([-1.0, 1.0], 2) + rng.choice([0.0, 3.0])
    if rng.random() < 0.2:
        wedges[rng.random(len(faces)) < 0.3] = 0.0
    if rng.random() < 0.1:
        wedges[rng.random((len(faces), 3)) < 0.02] = rng.choice([np.nan, np.inf])
    return wedges * rng.choice([1.0, 1.0, 1.0, 2.0**-490, 2.0**480, 1e-20])

"""The presets: lists of passes of flips, each with an energy, a search and limits of its own.

Nothing in this module needs Numba or PyMeshLab. `docs/presets.md` says how they were chosen.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

# The bounding box's diagonal is 100.
FULL_DIAGONAL = 100.0


class PresetPass(NamedTuple):
    """A pass of a preset.

    Attributes
    ----------
    options : mapping
        Its options by name; all others have the values that the caller gives.
    stays_near : bool
        Whether `maxdeviation` is a limit for this pass, counted from its own beginning.
    defaults : mapping
        Its options that give way to those of the caller.
    """

    options: Mapping[str, Any]
    stays_near: bool = False
    defaults: Mapping[str, Any] = {}


class Preset(NamedTuple):
    """A preset.

    Attributes
    ----------
    help : str
        What it is for, in a few words.
    passes : tuple of PresetPass
        One after the other; none: the pass that the other options describe.
    maxdeviation : float
        The default of that option, in percent of the bounding box's diagonal; all of it is no
        limit.
    keeps_cuts : bool
        Whether the number of faces that cut others must not grow: if it does, all is done again
        with the guard against intersections, which is slow.
    """

    help: str
    passes: tuple[PresetPass, ...] = ()
    maxdeviation: float = FULL_DIAGONAL
    keeps_cuts: bool = False


# The guards would keep folds that are there already.
_UNFOLD = {"foldangle": 180.0, "minshape": 0.0}
# Smaller gains say nothing of the surface, and good triangulations lose by such flips.
_NOISE = 0.05

# The first is the default.
PRESETS = {
    "paper": Preset("the paper's method, or what the other parameters say"),
    "faithful": Preset(
        "the true surface, creases too, then good triangles",
        (
            PresetPass({"energy": "mean curvature", "mingain": _NOISE}, defaults=_UNFOLD),
            # Single flips leave tangles behind, where chains of two find the way out.
            PresetPass(
                {
                    "energy": "mean curvature",
                    "search": "variable depth",
                    "depth": 2,
                    "breadth": 1,
                    "atfolds": True,
                },
                defaults=_UNFOLD,
            ),
            PresetPass(
                {"energy": "mean curvature", "vertexnormals": True, "mingain": _NOISE},
                defaults=_UNFOLD,
            ),
            PresetPass({"energy": "delaunay"}, stays_near=True),
        ),
        maxdeviation=0.03,
        keeps_cuts=True,
    ),
    "smooth": Preset(
        "the lowest Willmore energy",
        (
            PresetPass({"energy": "delaunay"}),
            PresetPass({"energy": "willmore"}),
        ),
    ),
    "shape": Preset(
        "the best triangles near the input",
        (PresetPass({"energy": "delaunay"}, stays_near=True),),
        maxdeviation=0.03,
    ),
}

# What the passes of a preset are made of, and so can't be given beside one.
SEARCH_OPTIONS = (
    "energy",
    "search",
    "depth",
    "breadth",
    "sweeps",
    "seed",
    "virtualpoint",
    "monotone",
)


def conflict(name: str, preset: str) -> str:
    """What to say of an option that is given beside a preset which decides it."""
    return f"{name} can't be given beside preset={preset!r}, which decides it; leave one out"


def decided_by(preset: str) -> frozenset[str]:
    """The names of the options that a preset decides itself."""
    passes = PRESETS[preset].passes
    if not passes:
        return frozenset()
    return frozenset(SEARCH_OPTIONS).union(*(one.options for one in passes))

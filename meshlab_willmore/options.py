"""The options of the flips: name, default, limits, choices and help text of each.

`meshlab_willmore.optimize_flips`, the filter, the command line and the site's reference have them
from here. Nothing in this module needs Numba or PyMeshLab.
"""

from __future__ import annotations

import math
import numbers
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Literal, NamedTuple, TypedDict

import numpy as np
from numpy.typing import ArrayLike

from .energy.table import ENERGIES, VIRTUAL_POINTS
from .presets import FULL_DIAGONAL, PRESETS
from .progress import Listen

# The filter whose parameters these are.
FILTER = "meshing_edge_flip_by_willmore_optimization"
# The value of `maxflips` that sets no limit; for `optimize_flips` that is None.
UNLIMITED = -1
MOST_DEPTH = 100
MOST_BREADTH = 12

SEARCHES = {
    "parallel greedy": "all flips at once that gain more than any other around them, on all cores; "
    "the quickest",
    "greedy": "one flip after another, always the best of all",
    "variable depth": "greedy, then chains of several flips that may go through a loss; much "
    "better where the triangulation is bad",
    "annealing": "greedy, then random flips that cool down; slow",
    "thorough": "chains from several starts, for a result that hardly depends on how the mesh was "
    "triangulated",
}

# The names, for type checkers, which don't read tables.
PresetName = Literal["paper", "faithful", "smooth", "shape"]
EnergyName = Literal[
    "virtual willmore",
    "willmore",
    "uniform virtual willmore",
    "area",
    "mean curvature",
    "gaussian curvature",
    "delaunay",
]
SearchName = Literal["parallel greedy", "greedy", "variable depth", "annealing", "thorough"]
VirtualPoint = Literal["midpoint", "closest"] | float


class CommonOptions(TypedDict, total=False):
    """The options of one pass or of several; `meshlab_willmore.optimize_flips` explains them."""

    energy: EnergyName
    search: SearchName
    depth: int
    breadth: int
    sweeps: int
    seed: int
    virtualpoint: VirtualPoint
    monotone: bool
    foldangle: float
    minshape: float
    maxdeviation: float | None
    checkintersections: bool
    maxflips: int | None


class PassOptions(CommonOptions, total=False):
    """The options that a pass in a list of passes can have."""

    atfolds: bool
    vertexnormals: bool
    mingain: float


class FlipOptions(CommonOptions, total=False):
    """The options of `meshlab_willmore.optimize_flips`, which explains them."""

    preset: PresetName
    passes: Sequence[PassOptions] | None
    featuredeg: float
    selected_faces: ArrayLike | None
    locked_edges: ArrayLike | None
    wedge_uv: ArrayLike | None
    progress: Listen | None


class Length(float):
    """A length in units of the coordinates; the filter takes percentages of a diagonal, too."""


class Option(NamedTuple):
    """An option of the flips."""

    # The keyword: lower case, without underscores.
    name: str
    # bool, int, float, `Length`, or str: a choice, or what can be a text as well as a number.
    type: type
    # That of the filter; None: it depends on the mesh. Of a `Length`, in percent of the bounding
    # box's diagonal.
    default: Any
    # What MeshLab would write beside the field; and what the option does, in whole sentences.
    label: str
    help: str
    # Checks a value of the option; see `checked`.
    rule: Callable[[Option, Any], Any]
    # The names that a value can be.
    choices: tuple[str, ...] = ()
    # The limits of an integer.
    least: int = 0
    most: int | None = None

    @property
    def is_choice(self) -> bool:
        """Whether a value can be nothing but one of `choices`."""
        return self.rule is _choice

    def checked(self, value: Any) -> Any:
        """The value in the option's own type.

        Raises
        ------
        TypeError
            If it is of another type.
        ValueError
            If it is out of range, or no choice.
        """
        return self.rule(self, value)


# --- rules ---------------------------------------------------------------------------------------


def _flag(option: Option, value: Any) -> bool:
    if not isinstance(value, (bool, np.bool_)):
        raise TypeError(f"{option.name} must be True or False, not {type(value).__name__}")
    return bool(value)


def _choice(option: Option, value: Any) -> str:
    if not isinstance(value, str) or value not in option.choices:
        raise ValueError(f"unknown {option.name} {value!r}; choose one of {_listed(option)}")
    return value


def _integer(option: Option, value: Any, expected: str = "an integer") -> int:
    if isinstance(value, (bool, np.bool_)) or not isinstance(value, numbers.Integral):
        raise TypeError(f"{option.name} must be {expected}, not {type(value).__name__}")
    number = int(value)
    if option.most is not None and not option.least <= number <= option.most:
        raise ValueError(f"{option.name} must lie in {option.least} .. {option.most}, not {number}")
    if number < option.least:
        raise ValueError(f"{option.name} must not be negative, not {number}")
    return number


def _limit(option: Option, value: Any) -> int | None:
    return None if value is None else _integer(option, value, "an integer or None")


def _degrees(option: Option, value: Any) -> float:
    degrees = _real(option, value, "a number of degrees")
    if not (math.isfinite(degrees) and 0.0 <= degrees <= 180.0):
        raise ValueError(f"{option.name} must lie in 0 .. 180 degrees, not {degrees}")
    return degrees


def _place(option: Option, value: Any) -> str | float:
    allowed = f"{_listed(option)} or a number between 0 and 1"
    if isinstance(value, str):
        if value not in option.choices:
            raise ValueError(f"unknown {option.name} {value!r}; choose {allowed}")
        return value
    part = _real(option, value, allowed)
    if not 0.0 < part < 1.0:
        raise ValueError(f"{option.name} must be {allowed}, not {part}")
    return part


def _real(option: Option, value: Any, expected: str) -> float:
    if isinstance(value, (bool, np.bool_)) or not isinstance(value, numbers.Real):
        raise TypeError(f"{option.name} must be {expected}, not {type(value).__name__}")
    return float(value)


def _share(option: Option, value: Any) -> float:
    share = _real(option, value, "a number")
    if not 0.0 <= share <= 1.0:
        raise ValueError(f"{option.name} must lie in 0 .. 1, not {share}")
    return share


def _length(option: Option, value: Any) -> float | None:
    if value is None:
        return None
    length = _real(option, value, "a length or None")
    if not length >= 0.0:
        raise ValueError(f"{option.name} must be a length of 0 or more, not {length}")
    return length


def _listed(option: Option) -> str:
    return ", ".join(map(repr, option.choices))


# --- the options ---------------------------------------------------------------------------------


def described(choices: Mapping[str, str]) -> str:
    """A sentence for each choice: its name in quotes, and its help text."""
    return " ".join(f"{name!r}: {text}." for name, text in choices.items())


PRESET = Option(
    "preset",
    str,
    next(iter(PRESETS)),
    "Preset",
    "What to aim at. " + described({name: row.help for name, row in PRESETS.items()}) + " All but "
    "the first choose energy and search themselves.",
    _choice,
    tuple(PRESETS),
)
SELECTION = Option(
    "selection",
    bool,
    None,
    "Only on selection",
    "Flip only edges between two selected faces. On by default where faces are selected.",
    _flag,
)
ENERGY = Option(
    "energy",
    str,
    next(iter(ENERGIES)),
    "Energy",
    "What the flips lower. " + described({name: row.help for name, row in ENERGIES.items()}),
    _choice,
    tuple(ENERGIES),
)
SEARCH = Option(
    "search",
    str,
    next(iter(SEARCHES)),
    "Search",
    "How the energy is minimised. " + described(SEARCHES),
    _choice,
    tuple(SEARCHES),
)
DEPTH = Option(
    "depth",
    int,
    5,
    "Depth of chains",
    f"Most flips of a chain in the searches 'variable depth' and 'thorough', 1 to {MOST_DEPTH}. 3 "
    "is quicker, 7 finds a little more.",
    _integer,
    least=1,
    most=MOST_DEPTH,
)
BREADTH = Option(
    "breadth",
    int,
    3,
    "Breadth of chains",
    "In the searches 'variable depth' and 'thorough': how many ways a chain tries at its second "
    f"flip, 1 to {MOST_BREADTH}; half as many at the third, and so on. 1 is the quickest.",
    _integer,
    least=1,
    most=MOST_BREADTH,
)
SWEEPS = Option(
    "sweeps",
    int,
    200,
    "Sweeps of the annealing",
    "At how many temperatures the search 'annealing' tries as many flips as there are edges. The "
    "time grows in proportion.",
    _integer,
    least=1,
    most=10**9,
)
SEED = Option(
    "seed",
    int,
    0,
    "Seed of the annealing",
    "The search 'annealing' draws its random numbers from this seed. The same seed gives the same "
    "mesh.",
    _integer,
)
VIRTUALPOINT = Option(
    "virtualpoint",
    str,
    next(iter(VIRTUAL_POINTS)),
    "Virtual points",
    "Where the energy 'virtual willmore' puts its virtual points on an edge. 'midpoint': as in the "
    "paper. 'closest': where the edge passes nearest the flipped one. Or a number between 0 and 1, "
    "the part of the edge from either end: 0.05 makes the greedy search smooth much more, at twice "
    "the time.",
    _place,
    tuple(VIRTUAL_POINTS),
)
MONOTONE = Option(
    "monotone",
    bool,
    True,
    "Never raise the Willmore energy",
    "With the energy 'virtual willmore': refuse flips that raise the Willmore energy itself, the "
    "sum of the circles' angles over all edges. Without this rule the virtual energy can make a "
    "surface worse; off is for research.",
    _flag,
)
FOLDANGLE = Option(
    "foldangle",
    float,
    90.0,
    "Fold angle (deg)",
    "Refuse a flip if the faces at the new edge would be bent by more than this angle (0 is flat) "
    "and by more than at the old edge. 180 allows folds. Where this is 90, the preset 'faithful' "
    "allows them until its last pass.",
    _degrees,
)
MINSHAPE = Option(
    "minshape",
    float,
    0.05,
    "Least shape",
    "Refuse a flip if the worse of its two triangles would have a shape below this one and below "
    "the worse one before. The shape is 1 for an equilateral triangle and 0 for one without area. "
    "0 allows slivers. Where this is 0.05, the preset 'faithful' allows them until its last pass.",
    _share,
)
MAXDEVIATION = Option(
    "maxdeviation",
    Length,
    FULL_DIAGONAL,
    "Largest deviation",
    "Refuse a flip if the surface could be farther from the input than this anywhere, in either "
    "direction. The whole diagonal of the bounding box, 100%, is no limit. The presets 'faithful' "
    "and 'shape' have 0.03% by themselves; in 'faithful' this is the distance from the surface "
    "before its last pass.",
    _length,
)
CHECKINTERSECTIONS = Option(
    "checkintersections",
    bool,
    False,
    "No new self-intersections",
    "Refuse flips after which a face would cut or touch another one. Takes longer; worth it where "
    "parts of the surface nearly touch, or folds are allowed. Merge close vertices before: faces "
    "along an unmerged seam touch.",
    _flag,
)
FEATUREDEG = Option(
    "featuredeg",
    float,
    180.0,
    "Feature angle (deg)",
    "Keep edges whose faces are bent by this angle or more (0 is flat), but not those of slivers, "
    "whose normals are not reliable; 180 keeps none. 30 suits technical parts.",
    _degrees,
)
MAXFLIPS = Option(
    "maxflips",
    int,
    UNLIMITED,
    "Most flips",
    f"Stop after this many flips; {UNLIMITED} sets no limit.",
    _limit,
)
ALLOWLOSS = Option(
    "allowloss",
    bool,
    False,
    "Allow loss of data",
    "Go on although the mesh has data that PyMeshLab can't put on a mesh with new faces (principal "
    "curvature directions, for one); they are lost. Off: such a mesh is an error.",
    _flag,
)

# Those of the filter, in the order of its parameters.
OPTIONS = (
    PRESET,
    SELECTION,
    ENERGY,
    SEARCH,
    DEPTH,
    BREADTH,
    SWEEPS,
    SEED,
    VIRTUALPOINT,
    MONOTONE,
    FOLDANGLE,
    MINSHAPE,
    MAXDEVIATION,
    CHECKINTERSECTIONS,
    FEATUREDEG,
    MAXFLIPS,
    ALLOWLOSS,
)

# What only a pass of a preset, or of a list of passes, can have.
ATFOLDS = Option(
    "atfolds",
    bool,
    False,
    "Only at folds",
    "Flip only faces at edges that are bent by more than 100 degrees, and their neighbours.",
    _flag,
)

VERTEXNORMALS = Option(
    "vertexnormals",
    bool,
    False,
    "Along the normals of vertices",
    "With 'mean curvature': turn the faces to the normals of their vertices too, where the surface "
    "is bent by 10 to 60 degrees.",
    _flag,
)
MINGAIN = Option(
    "mingain",
    float,
    0.0,
    "Least gain",
    "Make only flips that lower the energy by more than this, where the median edge has length 1.",
    _share,
)
OF_PASSES = (ATFOLDS, VERTEXNORMALS, MINGAIN)

BY_NAME = {option.name: option for option in (*OPTIONS, *OF_PASSES)}

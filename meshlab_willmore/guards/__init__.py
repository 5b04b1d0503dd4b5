"""Which flips are allowed beyond what the connectivity says.

`locks` are set once for the input. `fold` keeps the surface from folding, `texture` textures, and
`deviation` the surface near the input.
`intersections` keeps faces from intersecting others: `bvh` finds those nearby, `triangles` tests
them exactly, with the signs of `predicates`, and `meshlab_tests` as MeshLab would.
"""

from .deviation import add_deviation, deviates
from .fold import (
    FLAT_ANGLE,
    FoldLimits,
    dihedral_angle,
    fold_limits,
    folds,
    triangle_shape,
)
from .locks import lock_creases, lock_edges, lock_seams, lock_unselected
from .texture import texture_coordinates

__all__ = [
    "FLAT_ANGLE",
    "FoldLimits",
    "add_deviation",
    "deviates",
    "dihedral_angle",
    "fold_limits",
    "folds",
    "lock_creases",
    "lock_edges",
    "lock_seams",
    "lock_unselected",
    "texture_coordinates",
    "triangle_shape",
]

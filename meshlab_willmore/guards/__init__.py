"""Which flips are allowed beyond what the connectivity says.

`locks` are set once for the input. `fold` keeps the surface from folding, and `mapping` textures.
`intersections` keeps faces from intersecting others: `bvh` finds those nearby, `triangles` tests
them exactly, with the signs of `predicates`, and `meshlab_tests` as MeshLab would.
"""

from .fold import (
    FLAT_ANGLE,
    FoldLimits,
    dihedral_angle,
    fold_limits,
    folds,
    triangle_shape,
)
from .locks import lock_creases, lock_edges, lock_seams, lock_unselected
from .mapping import mapping_of

__all__ = [
    "FLAT_ANGLE",
    "FoldLimits",
    "dihedral_angle",
    "fold_limits",
    "folds",
    "lock_creases",
    "lock_edges",
    "lock_seams",
    "lock_unselected",
    "mapping_of",
    "triangle_shape",
]

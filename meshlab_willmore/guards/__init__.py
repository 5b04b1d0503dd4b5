"""Which flips are allowed beyond what the connectivity says.

Locks, set once for the input; the fold guard, for the surface and, in `mapping`, for textures; and,
in `space`, the guard against self-intersections, with what it stands on: `predicates`, `triangles`,
`rounded`, `faces`.
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

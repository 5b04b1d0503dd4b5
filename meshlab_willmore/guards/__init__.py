"""Which flips are allowed beyond what the connectivity says: locks and the fold guard."""

from .fold import (
    FLAT_ANGLE,
    FoldLimits,
    dihedral_angle,
    fold_limits,
    folds,
    triangle_shape,
)
from .locks import lock_creases, lock_edges, lock_unselected

__all__ = [
    "FLAT_ANGLE",
    "FoldLimits",
    "dihedral_angle",
    "fold_limits",
    "folds",
    "lock_creases",
    "lock_edges",
    "lock_unselected",
    "triangle_shape",
]

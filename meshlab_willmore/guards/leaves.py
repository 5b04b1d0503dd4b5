"""Which faces of a mesh share a leaf: they are halved by place, and the halves again.

All halves have the same number of faces, or one more.
"""

from typing import NamedTuple

import numpy as np

from ..mesh.jit import at, inner, jit
from ..mesh.workers import crew

# Parts that are sorted side by side.
BLOCKS = 16


@inner
def first_place(leaf, faces, leaves):
    """Return the first place of a leaf in the order; all leaves are the same size, or one more."""
    return np.int64(leaf) * faces // leaves


@jit
def _middles(mesh):
    """Return the middles of the boxes of all faces, twice as large (3, m)."""
    middles = np.empty((3, len(mesh.origin) // 3))
    for f in range(middles.shape[1]):
        first = 3 * f
        u, v, w = mesh.origin[at(first)], mesh.origin[at(first + 1)], mesh.origin[at(first + 2)]
        for axis in range(3):
            a = mesh.vertices[at(u), at(axis)]
            b, c = mesh.vertices[at(v), at(axis)], mesh.vertices[at(w), at(axis)]
            middles[at(axis), at(f)] = min(a, b, c) + max(a, b, c)
    return middles


@inner
def _longest_axis(order, middles, start, stop):
    """Return the axis along which the middles of some faces lie farthest apart."""
    longest, best = -1.0, 0
    for axis in range(3):
        along = middles[axis]
        least = most = along[order[start]]
        for place in range(start + 1, stop):
            middle = along[at(order[at(place)])]
            least, most = min(least, middle), max(most, middle)
        if most - least > longest:
            longest, best = most - least, axis
    return best


@inner
def _select(order, keys, first, last, middle):
    """Reorder the places `first` .. `last`, so that no key before `middle` is above one after it.

    Hoare's algorithm "Find".
    """
    while first < last:
        pivot = keys[order[(first + last) // 2]]
        i, j = first, last
        while i <= j:
            while keys[at(order[at(i)])] < pivot:
                i += 1
            while keys[at(order[at(j)])] > pivot:
                j -= 1
            if i <= j:
                order[at(i)], order[at(j)] = order[at(j)], order[at(i)]
                i += 1
                j -= 1
        if middle <= j:
            last = j
        elif middle >= i:
            first = i
        else:
            return


class _Sorting(NamedTuple):
    """Faces that are being sorted into leaves.

    Attributes
    ----------
    order : (m,) int32
        The faces, changed in place.
    middles : (3, m) float64
        Their middles.
    leaves, width : int
        The number of all leaves, and of those that are sorted by themselves.
    """

    order: np.ndarray
    middles: np.ndarray
    leaves: int
    width: int


@jit
def _split(sorting, first, last, least):
    """Sort the faces of the leaves `first` up to `last`: halve them, then each half, and so on.

    Until only `least` leaves are together.
    """
    order, faces, leaves = sorting.order, len(sorting.order), sorting.leaves
    width = last - first
    while width > least:
        for leaf in range(first, last, width):
            start = first_place(leaf, faces, leaves)
            middle = first_place(leaf + width // 2, faces, leaves)
            stop = first_place(leaf + width, faces, leaves)
            axis = _longest_axis(order, sorting.middles, start, stop)
            _select(order, sorting.middles[axis], start, stop - 1, middle)
        width //= 2


@jit
def _split_blocks(sorting, start, stop):
    """Sort the faces of each of the blocks from `start` up to `stop` by themselves."""
    for block in range(start, stop):
        first = block * sorting.width
        _split(sorting, first, first + sorting.width, 1)


def by_leaf(mesh, leaves):
    """Return the faces leaf by leaf (m,) int32, neighbours together, in O(m log m) time.

    Parameters
    ----------
    mesh : Mesh
    leaves : int
        Their number, a power of two. Leaf x has the faces from ``first_place(x, m, leaves)`` up to
        that of x + 1.
    """
    order = np.arange(len(mesh.origin) // 3, dtype=np.int32)
    blocks = min(leaves, BLOCKS)
    sorting = _Sorting(order, _middles(mesh), leaves, leaves // blocks)
    _split(sorting, 0, leaves, leaves // blocks)
    with crew() as share:
        share(_split_blocks, sorting, blocks, piece=1)
    return order

"""Where the faces of a mesh are: an index that follows the flips.

A perfect binary tree of boxes. Its leaves hold a few faces each, split by the median of their
middles along the longest side, once for the input. A flip changes two faces within the outline of
their quad, and faces keep their leaves: only the boxes from these two leaves up to the first one
that stays as it was are computed again, or made to hold the quad. So all arrays keep their size,
and one huge face, or all points on a line, do no harm. The tree stands in an array, node p over
2 p + 1 and 2 p + 2, and is walked without a stack.
"""

from typing import NamedTuple

import numpy as np
from numba import types
from numba.extending import overload

from ..mesh.halfedge import NONE, Mesh, diamond
from ..mesh.jit import at, inner, jit
from ..mesh.workers import crew
from .leaves import by_leaf, first_place

# Faces in a leaf: half as many up to as many. More cost more tests, fewer cost memory.
LEAF_FACES = 4
SIDES = 6


class Space(NamedTuple):
    """Where the faces of a mesh are.

    Attributes
    ----------
    active : bool
        Whether anything is refused at all. If not, the arrays are empty.
    area_scale : float
        Area in squared units of the input's coordinates of what has the area 1 in the mesh.
    box : (2 b - 1, 6) float64
        Least x, y, z and largest x, y, z of the faces below each node; the last b are leaves.
    order : (m,) int32
        Faces leaf by leaf.
    leaf : (m,) int32
        Leaf of each face, 0 .. b - 1.
    changed : (m,) int32
        The round of flips in which each face last changed, for searches that make rounds; else 0.
    changed_below : (2 b - 1,) int32
        The last of these rounds among the faces below each node.
    """

    active: bool
    area_scale: float
    box: np.ndarray
    order: np.ndarray
    leaf: np.ndarray
    changed: np.ndarray
    changed_below: np.ndarray


class NoSpace(NamedTuple):
    """The space that refuses nothing, as a type of its own.

    Kernels that get it are compiled without the tests for cuts, which are more than all the rest.

    Attributes
    ----------
    active : bool
        False.
    order : (0,) int32
    """

    active: bool
    order: np.ndarray


def no_space():
    """Return the space that refuses nothing, for kernels that are compiled for both."""
    empty = np.empty(0, np.int32)
    return Space(False, 1.0, np.empty((0, SIDES)), empty, empty, empty, empty)


def without(space):
    """Return the space for kernels that are compiled anew for each kind: `NoSpace` if inactive."""
    return space if space.active else NoSpace(False, np.empty(0, np.int32))


def is_none(kind):
    """Tell whether a Numba type is that of `NoSpace`."""
    return isinstance(kind, types.NamedTuple) and kind.instance_class is NoSpace


def space_of(mesh, exponent=0):
    """Return the index of a mesh, in O(m log m) time.

    Parameters
    ----------
    mesh : Mesh
        At unit scale.
    exponent : int
        The input's coordinates are those of the mesh times ``2**exponent``.
    """
    faces = len(mesh.origin) // 3
    if not faces:
        return no_space()
    leaves = 1
    while leaves * LEAF_FACES < faces:
        leaves *= 2
    with np.errstate(over="ignore", under="ignore"):
        area_scale = float(np.ldexp(1.0, 2 * exponent))
    nodes = 2 * leaves - 1
    space = Space(
        True,
        area_scale,
        np.empty((nodes, SIDES)),
        by_leaf(mesh, leaves),
        np.empty(faces, np.int32),
        np.zeros(faces, np.int32),
        np.zeros(nodes, np.int32),
    )
    with crew() as share:
        share(_fill_leaves, _Index(mesh, space), leaves)
    _bound_nodes(space)
    return space


def renewed(space, mesh):
    """Return the index of a mesh that flips have made of the one that `space` belongs to."""
    if isinstance(space, NoSpace):
        return space
    other = space._replace(
        box=np.empty_like(space.box),
        changed=np.zeros_like(space.changed),
        changed_below=np.zeros_like(space.changed_below),
    )
    _fill_leaves(_Index(mesh, other), 0, (len(other.box) + 1) // 2)
    _bound_nodes(other)
    return other


class _Index(NamedTuple):
    """A mesh and its index."""

    mesh: Mesh
    space: Space


@inner
def _bound_leaf(mesh, space, leaf):
    """Compute the box of a leaf again; tell whether it has changed."""
    faces, leaves = len(space.order), (len(space.box) + 1) // 2
    node, changed = leaves - 1 + leaf, False
    for axis in range(3):
        least, most = np.inf, -np.inf
        for place in range(first_place(leaf, faces, leaves), first_place(leaf + 1, faces, leaves)):
            for h in range(3 * space.order[at(place)], 3 * space.order[at(place)] + 3):
                value = mesh.vertices[at(mesh.origin[at(h)]), at(axis)]
                least, most = min(least, value), max(most, value)
        changed |= _set_span(space, node, axis, least, most)
    return changed


@inner
def _bound_node(space, node):
    """Compute the box of an inner node again; tell whether it has changed."""
    changed = False
    left, right = 2 * node + 1, 2 * node + 2
    for axis in range(3):
        least = min(space.box[at(left), at(axis)], space.box[at(right), at(axis)])
        most = max(space.box[at(left), at(3 + axis)], space.box[at(right), at(3 + axis)])
        changed |= _set_span(space, node, axis, least, most)
    return changed


@inner
def _set_span(space, node, axis, least, most):
    row, low, high = at(node), at(axis), at(3 + axis)
    if space.box[row, low] == least and space.box[row, high] == most:
        return False
    space.box[row, low], space.box[row, high] = least, most
    return True


@jit
def _fill_leaves(index, first, last):
    """Write which faces the leaves from `first` up to `last` have, and their boxes."""
    space, leaves = index.space, (len(index.space.box) + 1) // 2
    for leaf in range(first, last):
        stop = first_place(leaf + 1, len(space.order), leaves)
        for place in range(first_place(leaf, len(space.order), leaves), stop):
            space.leaf[space.order[place]] = leaf
        _bound_leaf(index.mesh, space, leaf)


@jit
def _bound_nodes(space):
    for node in range(len(space.box) // 2 - 1, -1, -1):
        _bound_node(space, node)


@inner
def _rebound(mesh, space, f):
    """Compute the boxes that hold the face `f` again."""
    leaf = np.int64(space.leaf[f])
    changed = _bound_leaf(mesh, space, leaf)
    node = len(space.box) // 2 + leaf
    while changed and node > 0:
        node = (node - 1) // 2
        changed = _bound_node(space, node)


def follow(mesh, space, h):
    """Bring the index up to date, in place, after the flip of `h` (or several in one quad)."""
    if space.active:
        _rebound(mesh, space, h // 3)
        _rebound(mesh, space, mesh.twin[h] // 3)


@overload(follow)
def _compiled_follow(mesh, space, h):
    return (lambda mesh, space, h: None) if is_none(space) else follow


@inner
def _hold(space, f, box, number):
    """Make the boxes above the face `f`, changed in this round, hold `box`."""
    space.changed[f] = number
    node = len(space.box) // 2 + np.int64(space.leaf[f])
    while True:
        row = at(node)
        # If so, all above know too.
        is_done = space.changed_below[row] == number
        space.changed_below[row] = number
        for axis in range(3):
            low, high = at(axis), at(3 + axis)
            if box[axis] < space.box[row, low]:
                space.box[row, low], is_done = box[axis], False
            if box[3 + axis] > space.box[row, high]:
                space.box[row, high], is_done = box[3 + axis], False
        if is_done or node == 0:
            return
        node = (node - 1) // 2


@inner
def grow(mesh, space, h, number):
    """Do what `follow` does, before or after the flip, and note the round.

    That takes less time. The boxes get larger: they hold the faces as they are and as they were.

    Parameters
    ----------
    mesh : Mesh
    space : Space
        Changed in place.
    h : int
        Half-edge of the flip.
    number : int
        Number of the round, at least 1.
    """
    box = box_around(*diamond(mesh, h))
    _hold(space, np.int64(h // 3), box, number)
    _hold(space, np.int64(mesh.twin[at(h)] // 3), box, number)


@inner
def box_around(a, b, c, d):
    """Return least x, y, z and largest x, y, z of four points."""
    return (
        min(a.x, b.x, c.x, d.x),
        min(a.y, b.y, c.y, d.y),
        min(a.z, b.z, c.z, d.z),
        max(a.x, b.x, c.x, d.x),
        max(a.y, b.y, c.y, d.y),
        max(a.z, b.z, c.z, d.z),
    )


@inner
def next_leaf(space, node, box, since):
    """Return the first node from `node` on, in the order of the tree, that is a leaf in reach.

    Returns
    -------
    int
        A leaf whose box meets `box`, with a face that changed in the round `since` or later, or
        `NONE` if there is none. Go on with `after`.
    """
    first_leaf = len(space.box) // 2
    while node != NONE:
        row = at(node)
        meets = (
            (space.box[row, at(0)] <= box[3])
            & (space.box[row, at(1)] <= box[4])
            & (space.box[row, at(2)] <= box[5])
            & (space.box[row, at(3)] >= box[0])
            & (space.box[row, at(4)] >= box[1])
            & (space.box[row, at(5)] >= box[2])
            & (space.changed_below[row] >= since)
        )
        if not meets:
            node = after(node)
        elif node < first_leaf:
            node = 2 * node + 1
        else:
            return node
    return NONE


@inner
def after(node):
    """Return the node that follows `node` and all below it, or `NONE`."""
    # Right children have even numbers.
    while node > 0 and node % 2 == 0:
        node = (node - 1) // 2
    return node + 1 if node > 0 else NONE


@inner
def faces_at(space, node):
    """Return where the faces of a leaf start and stop in ``space.order``."""
    first_leaf = len(space.box) // 2
    faces, leaf = len(space.order), node - first_leaf
    leaves = first_leaf + 1
    return first_place(leaf, faces, leaves), first_place(leaf + 1, faces, leaves)

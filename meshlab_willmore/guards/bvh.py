"""Bounding volume hierarchy over the faces of a mesh, kept up to date while edges are flipped.

A perfect binary tree of axis-aligned boxes in an array, node p above 2 p + 1 and 2 p + 2. It is
built once: all faces, then each part of them, are sorted along the axis on which their box centres
lie farthest apart, and cut into equal parts, down to leaves of a few faces, which all have the
same number of faces, or one more. A flip changes two faces within the outline of their quad, and
faces keep their leaves. So only the boxes from these two leaves up to the first unchanged one are
computed again, or expanded to hold the quad: all arrays keep their size, and one huge face, or
points on a line, do no harm. Queries need no stack.
"""

from typing import NamedTuple

import numpy as np
from numba import types
from numba.extending import overload

from ..mesh.halfedge import NONE, Mesh, diamond
from ..mesh.jit import at, inlined, inner, jit
from ..mesh.parallel import thread_pool

# Faces in a leaf: half as many up to as many. More cost more tests, fewer cost memory.
LEAF_FACES = 8
# Most levels of the tree that one sort is for, and blocks of faces that are sorted in parallel.
LEVELS, BLOCKS = 4, 16
BOUNDS = 6
# A place along an axis, in steps, above the number of a face.
STEPS, NUMBER_BITS, LOW_BITS = 2.0**32, np.uint64(32), np.uint64(2**32 - 1)


class Bvh(NamedTuple):
    """A bounding volume hierarchy of m faces with b leaves.

    Attributes
    ----------
    active : bool
        Whether there is one. If not, no flip is refused, and the arrays are empty.
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
    """

    active: bool
    area_scale: float
    box: np.ndarray
    order: np.ndarray
    leaf: np.ndarray
    changed: np.ndarray


class NoBvh(NamedTuple):
    """An inactive BVH, as a type of its own.

    Kernels that get it are compiled without intersection tests, which are more than all the rest.

    Attributes
    ----------
    active : bool
        False.
    order : (0,) int32
    """

    active: bool
    order: np.ndarray


def inactive_bvh():
    """Return an inactive BVH, for kernels that are compiled for both cases."""
    empty = np.empty(0, np.int32)
    return Bvh(False, 1.0, np.empty((0, BOUNDS)), empty, empty, empty)


def specialized(bvh):
    """Return a BVH for kernels that are compiled for each case: `NoBvh` if it is inactive."""
    return bvh if bvh.active else NoBvh(False, np.empty(0, np.int32))


def is_no_bvh(kind):
    """Whether a Numba type is that of `NoBvh`."""
    return isinstance(kind, types.NamedTuple) and kind.instance_class is NoBvh


# --- build ---------------------------------------------------------------------------------------


def build_bvh(mesh, exponent=0):
    """Return the BVH of a mesh, in O(m log m) time.

    Parameters
    ----------
    mesh : Mesh
        At unit scale.
    exponent : int
        The input's coordinates are those of the mesh times ``2**exponent``.
    """
    faces = len(mesh.origin) // 3
    if not faces:
        return inactive_bvh()
    leaves = 1
    while leaves * LEAF_FACES < faces:
        leaves *= 2
    with np.errstate(over="ignore", under="ignore"):
        area_scale = float(np.ldexp(1.0, 2 * exponent))
    with thread_pool() as parallel_for:
        order = _leaf_order(mesh, leaves, parallel_for)
        box, changed = np.empty((2 * leaves - 1, BOUNDS)), np.zeros(faces, np.int32)
        bvh = Bvh(True, area_scale, box, order, np.empty(faces, np.int32), changed)
        parallel_for(_fill_leaves, _Refit(mesh, bvh), leaves)
    _refit_inner_nodes(box)
    return bvh


class _Sort(NamedTuple):
    """Faces that are being sorted into leaves.

    Attributes
    ----------
    centres : (3, m) float64
        Centres of their boxes, twice as large.
    keys : (m,) uint64
        The faces part by part, each number in the low 32 bits; above it what to sort by.
    leaves, width : int
        The number of all leaves, and of those in a part.
    """

    centres: np.ndarray
    keys: np.ndarray
    leaves: int
    width: int


def _leaf_order(mesh, leaves, parallel_for):
    """Return the faces leaf by leaf (m,) int32; `leaves` is a power of two."""
    faces, levels = len(mesh.origin) // 3, leaves.bit_length() - 1
    centres, keys = np.empty((3, faces)), np.arange(faces, dtype=np.uint64)
    parallel_for(_find_centres, (mesh.vertices, mesh.origin, centres), faces)
    rounds = -(-levels // LEVELS)
    for left in range(rounds, 0, -1):
        width = 1 << levels * left // rounds
        state, parts = _Sort(centres, keys, leaves, width), leaves // width
        chunk = -(-parts // BLOCKS)
        parallel_for(_write_keys, state, parts, chunk)
        parallel_for(_sort_parts, state, parts, chunk)
    return keys.astype(np.uint32).view(np.int32)


@jit
def _find_centres(task, start, stop):
    """Write the centres of the boxes of the faces from `start` up to `stop`, twice as large."""
    vertices, origin, centres = task
    for f in range(start, stop):
        u, v, w = at(origin[at(3 * f)]), at(origin[at(3 * f + 1)]), at(origin[at(3 * f + 2)])
        for axis in range(3):
            a, b, c = vertices[u, at(axis)], vertices[v, at(axis)], vertices[w, at(axis)]
            centres[at(axis), at(f)] = min(a, b, c) + max(a, b, c)


@jit
def _write_keys(state, first_part, last_part):
    """Write what to sort the faces of some parts by: the part, the place along its longest axis."""
    faces, steps = len(state.keys), STEPS // (last_part - first_part)
    for part in range(first_part, last_part):
        start = _leaf_start(part * state.width, faces, state.leaves)
        stop = _leaf_start((part + 1) * state.width, faces, state.leaves)
        axis, low, extent = _longest_axis(state.centres, state.keys, start, stop)
        for place in range(start, stop):
            f = state.keys[at(place)] & LOW_BITS
            along = (state.centres[at(axis), f] - low) / extent
            step = (part - first_part) * steps + along * (steps - 1.0)
            state.keys[at(place)] = np.uint64(step) << NUMBER_BITS | f


def _sort_parts(state, first_part, last_part):
    """Sort these parts, for which `_write_keys` was called at once. All keys are different."""
    # The places are those of `_leaf_start`, which is for kernels.
    faces = state.width * len(state.keys)
    start, stop = (part * faces // state.leaves for part in (first_part, last_part))
    state.keys[start:stop].sort()


@inlined
def _longest_axis(centres, keys, start, stop):
    """Return on which axis the centres of some faces lie farthest apart, from where, and how far.

    1 where they coincide.
    """
    axis, low, extent = 0, 0.0, -1.0
    for other in range(3):
        least, most = np.inf, -np.inf
        for place in range(start, stop):
            centre = centres[at(other), keys[at(place)] & LOW_BITS]
            least, most = min(least, centre), max(most, centre)
        if most - least > extent:
            axis, low, extent = other, least, most - least
    return axis, low, extent if extent > 0.0 else 1.0


@inlined
def _leaf_start(leaf, faces, leaves):
    """Return the first place of a leaf in the order; all leaves are the same size, or one more."""
    return leaf * faces // leaves


# --- update --------------------------------------------------------------------------------------


class _Refit(NamedTuple):
    """A mesh and its BVH."""

    mesh: Mesh
    bvh: Bvh


def refitted(bvh, mesh):
    """Return the BVH of a mesh that flips have made of the one that `bvh` belongs to."""
    if isinstance(bvh, NoBvh):
        return bvh
    other = bvh._replace(box=np.empty_like(bvh.box), changed=np.zeros_like(bvh.changed))
    _fill_leaves(_Refit(mesh, other), 0, (len(other.box) + 1) // 2)
    _refit_inner_nodes(other.box)
    return other


@jit
def _fill_leaves(task, first, last):
    """Write which faces the leaves from `first` up to `last` have, and their boxes."""
    bvh, mesh, first_leaf = task.bvh, task.mesh, len(task.bvh.box) // 2
    for leaf in range(first, last):
        start, stop = leaf_range(bvh.box, len(bvh.order), first_leaf + leaf)
        for place in range(start, stop):
            bvh.leaf[at(bvh.order[at(place)])] = leaf
        box = _box_of_leaf(mesh.vertices, mesh.origin, bvh.order, start, stop)
        _set_box(bvh.box, first_leaf + leaf, box)


@jit
def _refit_inner_nodes(boxes):
    for node in range(len(boxes) // 2 - 1, -1, -1):
        _set_box(boxes, node, _box_of_children(boxes, node))


@inlined
def _box_of_leaf(vertices, origin, order, start, stop):
    """Return the box of the faces at some places of the order."""
    x = y = z = np.inf
    far_x = far_y = far_z = -np.inf
    for place in range(start, stop):
        first = 3 * np.int64(order[at(place)])
        for corner in range(3):
            v = at(origin[at(first + corner)])
            a, b, c = vertices[v, at(0)], vertices[v, at(1)], vertices[v, at(2)]
            x, y, z = min(x, a), min(y, b), min(z, c)
            far_x, far_y, far_z = max(far_x, a), max(far_y, b), max(far_z, c)
    return x, y, z, far_x, far_y, far_z


@inlined
def _box_of_children(boxes, node):
    one, other = at(2 * node + 1), at(2 * node + 2)
    return (
        min(boxes[one, at(0)], boxes[other, at(0)]),
        min(boxes[one, at(1)], boxes[other, at(1)]),
        min(boxes[one, at(2)], boxes[other, at(2)]),
        max(boxes[one, at(3)], boxes[other, at(3)]),
        max(boxes[one, at(4)], boxes[other, at(4)]),
        max(boxes[one, at(5)], boxes[other, at(5)]),
    )


@inlined
def _set_box(boxes, node, box):
    """Write the box of a node; return whether it has changed."""
    row, changed = at(node), False
    for bound in range(BOUNDS):
        changed |= boxes[row, at(bound)] != box[bound]
        boxes[row, at(bound)] = box[bound]
    return changed


@inner
def _refit_above(vertices, origin, bvh, f):
    """Compute the boxes that hold the face `f` again."""
    node = len(bvh.box) // 2 + np.int64(bvh.leaf[at(f)])
    start, stop = leaf_range(bvh.box, len(bvh.order), node)
    changed = _set_box(bvh.box, node, _box_of_leaf(vertices, origin, bvh.order, start, stop))
    while changed and node > 0:
        node = (node - 1) // 2
        changed = _set_box(bvh.box, node, _box_of_children(bvh.box, node))


def refit(mesh, bvh, h):
    """Bring the boxes up to date, in place, after the flip of `h` (or several in one quad)."""
    if bvh.active:
        _refit_above(mesh.vertices, mesh.origin, bvh, h // 3)
        _refit_above(mesh.vertices, mesh.origin, bvh, mesh.twin[h] // 3)


@overload(refit, inline="always")
def _compiled_refit(mesh, bvh, h):
    return (lambda mesh, bvh, h: None) if is_no_bvh(bvh) else refit


@inlined
def _expand_above(boxes, node, box):
    """Make the boxes of a node and those above hold `box`."""
    while True:
        row, grows = at(node), False
        for axis in range(3):
            low, high = at(axis), at(3 + axis)
            grows |= (box[axis] < boxes[row, low]) | (box[3 + axis] > boxes[row, high])
            boxes[row, low] = min(boxes[row, low], box[axis])
            boxes[row, high] = max(boxes[row, high], box[3 + axis])
        if not grows or node == 0:
            return
        node = (node - 1) // 2


@inlined
def expand(mesh, bvh, h, number):
    """Do what `refit` does, before or after the flip, and note the round.

    That takes less time. The boxes get larger: they hold the faces as they are and as they were.

    Parameters
    ----------
    mesh : Mesh
    bvh : Bvh
        Changed in place.
    h : int
        Half-edge of the flip.
    number : int
        Number of the round, at least 1.
    """
    box, first_leaf = box_around(*diamond(mesh, h)), len(bvh.box) // 2
    for side in (h, np.int64(mesh.twin[at(h)])):
        f = at(side // 3)
        bvh.changed[f] = number
        _expand_above(bvh.box, first_leaf + np.int64(bvh.leaf[f]), box)


# --- query ---------------------------------------------------------------------------------------


@inlined
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


@inlined
def next_leaf(boxes, node, box):
    """Return the first node from `node` on, in depth-first order, that is a leaf in reach.

    Parameters
    ----------
    boxes : (2 b - 1, 6) float64
        Those of a `Bvh`.
    node : int
        Node, or `NONE`.
    box : tuple of 6 floats

    Returns
    -------
    int
        A leaf whose box meets `box`, or `NONE` if there is none. Go on with `skip_subtree`.
    """
    first_leaf = len(boxes) // 2
    while node != NONE:
        row = at(node)
        meets = (
            (boxes[row, at(0)] <= box[3])
            & (boxes[row, at(1)] <= box[4])
            & (boxes[row, at(2)] <= box[5])
            & (boxes[row, at(3)] >= box[0])
            & (boxes[row, at(4)] >= box[1])
            & (boxes[row, at(5)] >= box[2])
        )
        if not meets:
            node = skip_subtree(node)
        elif node < first_leaf:
            node = 2 * node + 1
        else:
            return node
    return NONE


@inlined
def skip_subtree(node):
    """Return the node that follows `node` and all below it in depth-first order, or `NONE`."""
    # Right children have even numbers.
    while node > 0 and node % 2 == 0:
        node = (node - 1) // 2
    return node + 1 if node > 0 else NONE


@inlined
def leaf_range(boxes, faces, node):
    """Return where the faces of a leaf start and stop in the order of so many faces."""
    leaves = len(boxes) // 2 + 1
    leaf = node + 1 - leaves
    return _leaf_start(leaf, faces, leaves), _leaf_start(leaf + 1, faces, leaves)

"""Bounding volume hierarchy over the faces of a mesh, kept up to date while edges are flipped.

A perfect binary tree of axis-aligned boxes in an array, node p above 2 p + 1 and 2 p + 2. It is
built once: faces are halved at the median of their box centres along the longest axis, down to
leaves of a few faces, which all have the same number of faces, or one more. A flip changes two
faces within the outline of their quad, and faces keep their leaves. So only the boxes from these
two leaves up to the first unchanged one are computed again, or expanded to hold the quad: all
arrays keep their size, and one huge face, or points on a line, do no harm. Queries need no stack.
"""

from typing import NamedTuple

import numpy as np
from numba import types
from numba.extending import overload

from ..mesh.halfedge import NONE, Mesh, diamond
from ..mesh.jit import allocating_jit, at, inner, jit
from ..mesh.parallel import thread_pool

# Faces in a leaf: half as many up to as many. More cost more tests, fewer cost memory.
LEAF_FACES = 4
# Subtrees that are built in parallel.
BLOCKS = 16
BOUNDS = 6


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
    return Bvh(False, 1.0, np.empty((0, BOUNDS)), empty, empty, empty, empty)


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
    nodes = 2 * leaves - 1
    bvh = Bvh(
        True,
        area_scale,
        np.empty((nodes, BOUNDS)),
        _leaf_order(mesh, leaves),
        np.empty(faces, np.int32),
        np.zeros(faces, np.int32),
        np.zeros(nodes, np.int32),
    )
    with thread_pool() as parallel_for:
        parallel_for(_fill_leaves, _Refit(mesh, bvh), leaves)
    _refit_inner_nodes(bvh)
    return bvh


class _Build(NamedTuple):
    """Faces that are being sorted into leaves.

    Attributes
    ----------
    order : (m,) int32
        The faces, changed in place.
    centres : (3, m) float64
        Centres of their boxes, twice as large.
    leaves, width : int
        The number of all leaves, and of those in a block.
    """

    order: np.ndarray
    centres: np.ndarray
    leaves: int
    width: int


def _leaf_order(mesh, leaves):
    """Return the faces leaf by leaf (m,) int32; `leaves` is a power of two."""
    order = np.arange(len(mesh.origin) // 3, dtype=np.int32)
    blocks = min(leaves, BLOCKS)
    state = _Build(order, _centres(mesh), leaves, leaves // blocks)
    _split(state, 0, leaves, leaves // blocks)
    with thread_pool() as parallel_for:
        parallel_for(_split_blocks, state, blocks, chunk=1)
    return order


@allocating_jit
def _centres(mesh):
    """Return the centres of the boxes of all faces, twice as large (3, m)."""
    centres = np.empty((3, len(mesh.origin) // 3))
    for f in range(centres.shape[1]):
        first = 3 * f
        u, v, w = mesh.origin[at(first)], mesh.origin[at(first + 1)], mesh.origin[at(first + 2)]
        for axis in range(3):
            a = mesh.vertices[at(u), at(axis)]
            b, c = mesh.vertices[at(v), at(axis)], mesh.vertices[at(w), at(axis)]
            centres[at(axis), at(f)] = min(a, b, c) + max(a, b, c)
    return centres


@jit
def _split_blocks(state, start, stop):
    """Sort the faces of each of the blocks from `start` up to `stop` by themselves."""
    for block in range(start, stop):
        first = block * state.width
        _split(state, first, first + state.width, 1)


@jit
def _split(state, first, last, least):
    """Halve the faces of the leaves `first` up to `last`, again and again, down to `least`."""
    order, faces, leaves = state.order, len(state.order), state.leaves
    width = last - first
    while width > least:
        for leaf in range(first, last, width):
            start = _leaf_start(leaf, faces, leaves)
            middle = _leaf_start(leaf + width // 2, faces, leaves)
            stop = _leaf_start(leaf + width, faces, leaves)
            axis = _longest_axis(order, state.centres, start, stop)
            _quickselect(order, state.centres[axis], start, stop - 1, middle)
        width //= 2


@inner
def _leaf_start(leaf, faces, leaves):
    """Return the first place of a leaf in the order; all leaves are the same size, or one more."""
    return np.int64(leaf) * faces // leaves


@inner
def _longest_axis(order, centres, start, stop):
    """Return the axis along which the centres of some faces lie farthest apart."""
    longest, best = -1.0, 0
    for axis in range(3):
        along = centres[axis]
        least = most = along[order[start]]
        for place in range(start + 1, stop):
            centre = along[at(order[at(place)])]
            least, most = min(least, centre), max(most, centre)
        if most - least > longest:
            longest, best = most - least, axis
    return best


@inner
def _quickselect(order, keys, first, last, middle):
    """Reorder the places `first` .. `last`, so that no key before `middle` is above one after it.

    C. A. R. Hoare, "Algorithm 65: Find", 1961.
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


# --- update --------------------------------------------------------------------------------------


class _Refit(NamedTuple):
    """A mesh and its BVH."""

    mesh: Mesh
    bvh: Bvh


def refitted(bvh, mesh):
    """Return the BVH of a mesh that flips have made of the one that `bvh` belongs to."""
    if isinstance(bvh, NoBvh):
        return bvh
    other = bvh._replace(
        box=np.empty_like(bvh.box),
        changed=np.zeros_like(bvh.changed),
        changed_below=np.zeros_like(bvh.changed_below),
    )
    _fill_leaves(_Refit(mesh, other), 0, (len(other.box) + 1) // 2)
    _refit_inner_nodes(other)
    return other


@jit
def _fill_leaves(task, first, last):
    """Write which faces the leaves from `first` up to `last` have, and their boxes."""
    bvh, leaves = task.bvh, (len(task.bvh.box) + 1) // 2
    for leaf in range(first, last):
        stop = _leaf_start(leaf + 1, len(bvh.order), leaves)
        for place in range(_leaf_start(leaf, len(bvh.order), leaves), stop):
            bvh.leaf[bvh.order[place]] = leaf
        _refit_leaf(task.mesh, bvh, leaf)


@jit
def _refit_inner_nodes(bvh):
    for node in range(len(bvh.box) // 2 - 1, -1, -1):
        _refit_node(bvh, node)


@inner
def _refit_leaf(mesh, bvh, leaf):
    """Compute the box of a leaf again; return whether it has changed."""
    faces, leaves = len(bvh.order), (len(bvh.box) + 1) // 2
    node, changed = leaves - 1 + leaf, False
    for axis in range(3):
        least, most = np.inf, -np.inf
        for place in range(_leaf_start(leaf, faces, leaves), _leaf_start(leaf + 1, faces, leaves)):
            for h in range(3 * bvh.order[at(place)], 3 * bvh.order[at(place)] + 3):
                value = mesh.vertices[at(mesh.origin[at(h)]), at(axis)]
                least, most = min(least, value), max(most, value)
        changed |= _set_bounds(bvh, node, axis, least, most)
    return changed


@inner
def _refit_node(bvh, node):
    """Compute the box of an inner node again; return whether it has changed."""
    changed = False
    left, right = 2 * node + 1, 2 * node + 2
    for axis in range(3):
        least = min(bvh.box[at(left), at(axis)], bvh.box[at(right), at(axis)])
        most = max(bvh.box[at(left), at(3 + axis)], bvh.box[at(right), at(3 + axis)])
        changed |= _set_bounds(bvh, node, axis, least, most)
    return changed


@inner
def _set_bounds(bvh, node, axis, least, most):
    row, low, high = at(node), at(axis), at(3 + axis)
    if bvh.box[row, low] == least and bvh.box[row, high] == most:
        return False
    bvh.box[row, low], bvh.box[row, high] = least, most
    return True


@inner
def _refit_above(mesh, bvh, f):
    """Compute the boxes that hold the face `f` again."""
    leaf = np.int64(bvh.leaf[f])
    changed = _refit_leaf(mesh, bvh, leaf)
    node = len(bvh.box) // 2 + leaf
    while changed and node > 0:
        node = (node - 1) // 2
        changed = _refit_node(bvh, node)


def refit(mesh, bvh, h):
    """Bring the boxes up to date, in place, after the flip of `h` (or several in one quad)."""
    if bvh.active:
        _refit_above(mesh, bvh, h // 3)
        _refit_above(mesh, bvh, mesh.twin[h] // 3)


@overload(refit, inline="always")
def _compiled_refit(mesh, bvh, h):
    return (lambda mesh, bvh, h: None) if is_no_bvh(bvh) else refit


@inner
def _expand_above(bvh, f, box, number):
    """Make the boxes above the face `f`, changed in this round, hold `box`."""
    bvh.changed[f] = number
    node = len(bvh.box) // 2 + np.int64(bvh.leaf[f])
    while True:
        row = at(node)
        # If so, all nodes above have the number too.
        is_done = bvh.changed_below[row] == number
        bvh.changed_below[row] = number
        for axis in range(3):
            low, high = at(axis), at(3 + axis)
            if box[axis] < bvh.box[row, low]:
                bvh.box[row, low], is_done = box[axis], False
            if box[3 + axis] > bvh.box[row, high]:
                bvh.box[row, high], is_done = box[3 + axis], False
        if is_done or node == 0:
            return
        node = (node - 1) // 2


@inner
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
    box = box_around(*diamond(mesh, h))
    _expand_above(bvh, np.int64(h // 3), box, number)
    _expand_above(bvh, np.int64(mesh.twin[at(h)] // 3), box, number)


# --- query ---------------------------------------------------------------------------------------


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
def next_leaf(bvh, node, box, since):
    """Return the first node from `node` on, in depth-first order, that is a leaf in reach.

    Returns
    -------
    int
        A leaf whose box meets `box`, with a face that changed in the round `since` or later, or
        `NONE` if there is none. Go on with `skip_subtree`.
    """
    first_leaf = len(bvh.box) // 2
    while node != NONE:
        row = at(node)
        meets = (
            (bvh.box[row, at(0)] <= box[3])
            & (bvh.box[row, at(1)] <= box[4])
            & (bvh.box[row, at(2)] <= box[5])
            & (bvh.box[row, at(3)] >= box[0])
            & (bvh.box[row, at(4)] >= box[1])
            & (bvh.box[row, at(5)] >= box[2])
            & (bvh.changed_below[row] >= since)
        )
        if not meets:
            node = skip_subtree(node)
        elif node < first_leaf:
            node = 2 * node + 1
        else:
            return node
    return NONE


@inner
def skip_subtree(node):
    """Return the node that follows `node` and all below it in depth-first order, or `NONE`."""
    # Right children have even numbers.
    while node > 0 and node % 2 == 0:
        node = (node - 1) // 2
    return node + 1 if node > 0 else NONE


@inner
def leaf_range(bvh, node):
    """Return where the faces of a leaf start and stop in ``bvh.order``."""
    first_leaf = len(bvh.box) // 2
    faces, leaf = len(bvh.order), node - first_leaf
    leaves = first_leaf + 1
    return _leaf_start(leaf, faces, leaves), _leaf_start(leaf + 1, faces, leaves)

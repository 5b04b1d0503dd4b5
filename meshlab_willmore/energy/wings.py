"""The wings of the diamond: the four faces outside, at whose sides a flip changes angles."""

from typing import NamedTuple

from ..mesh.halfedge import NONE, apex, following, previous
from ..mesh.jit import at, inlined
from ..mesh.points import Point, point, subtract
from .angles import NO_ANGLES, ComplexAngle, add, complex_angle


class View(NamedTuple):
    """A side of the diamond seen from inside: vectors from the face's third corner to its ends."""

    start: Point
    end: Point


class Views(NamedTuple):
    """The four sides of the diamond, each seen from the face inside the quad that has it."""

    j_k: View
    k_i: View
    i_l: View
    l_j: View


class Wing(NamedTuple):
    """The third corner of the face outside a side, and whether there is such a face."""

    apex: Point
    exists: bool


class Wings(NamedTuple):
    """The wings at the four sides of the diamond."""

    j_k: Wing
    k_i: Wing
    i_l: Wing
    l_j: Wing


@inlined
def _wing(mesh, side):
    t = mesh.twin[at(side)]
    if t == NONE:
        # Any point will do: it does not count.
        return Wing(point(mesh.vertices, mesh.origin[at(side)]), False)
    return Wing(point(mesh.vertices, apex(mesh, t)), True)


@inlined
def wings_of(mesh, h):
    """Return the wings of the diamond of `h`, which must have a twin."""
    t = mesh.twin[at(h)]
    return Wings(
        _wing(mesh, following(h)),
        _wing(mesh, previous(h)),
        _wing(mesh, following(t)),
        _wing(mesh, previous(t)),
    )


@inlined
def _angle_at(a, b, view, wing):
    """Return the angle at the side a-b, seen from inside as `view`; 0 without a wing."""
    beta = complex_angle(view.start, view.end, subtract(a, wing.apex), subtract(b, wing.apex))
    return ComplexAngle(beta.r if wing.exists else 1.0, beta.s if wing.exists else 0.0)


@inlined
def side_angles(quad, wings, views):
    """Return the sum of the angles at the four sides of a quad.

    Boundary sides have no angle and add nothing.

    Parameters
    ----------
    quad : Diamond
        Its corners.
    wings : Wings
        The faces outside.
    views : Views
        The sides as seen from inside the quad.

    Returns
    -------
    AngleSum
    """
    total = add(NO_ANGLES, _angle_at(quad.j, quad.k, views.j_k, wings.j_k))
    total = add(total, _angle_at(quad.k, quad.i, views.k_i, wings.k_i))
    total = add(total, _angle_at(quad.i, quad.l, views.i_l, wings.i_l))
    return add(total, _angle_at(quad.l, quad.j, views.l_j, wings.l_j))

"""The other way to use a place t symmetrically: two virtual points on a diagonal, at t and 1 - t.

Each diagonal is cut in three, and each of the two faces at it as well. It is here to be compared
with what the package does, the mean over one point at t and one at 1 - t.
"""

import math
import sys

from meshlab_willmore.energy.angles import angle, radians
from meshlab_willmore.energy.wings import View, Views, side_angles, wings_of
from meshlab_willmore.mesh.halfedge import diamond
from meshlab_willmore.mesh.jit import generic, jit
from meshlab_willmore.mesh.points import Point, subtract
from meshlab_willmore.search import scoring
from meshlab_willmore.search.compiled import KERNELS
from meshlab_willmore.search.copies import with_globals


@jit
def _between(a, b, t):
    u = subtract(b, a)
    return Point(a.x + t * u.x, a.y + t * u.y, a.z + t * u.z)


@jit
def _view(v, start, end):
    return View(subtract(start, v), subtract(end, v))


@jit
def _inside(a, b, p, q, v, w):
    """Angles at the three parts of a-b, and at the edges from v and w to the corners p and q."""
    along = angle(a, v, p, q) + angle(v, w, p, q) + angle(w, b, p, q)
    return along + angle(v, p, a, w) + angle(w, p, v, b) + angle(v, q, a, w) + angle(w, q, v, b)


@jit
def cost_reduction(mesh, h, t):
    """What the flip of `h` gains with both points in, in radians."""
    quad, wings = diamond(mesh, h), wings_of(mesh, h)
    i, j, k, l = quad
    v, w = _between(i, j, t), _between(j, i, t)
    seen = Views(_view(w, j, k), _view(v, k, i), _view(v, i, l), _view(w, l, j))
    before = _inside(i, j, k, l, v, w) + radians(side_angles(quad, wings, seen))
    v, w = _between(k, l, t), _between(l, k, t)
    seen = Views(_view(v, j, k), _view(v, k, i), _view(w, i, l), _view(w, l, j))
    after = _inside(k, l, i, j, v, w) + radians(side_angles(quad, wings, seen))
    gain = 2.0 * (before - after)
    return gain if math.isfinite(gain) else -math.inf


# The greedy search in rounds on it. Without a cache on disk, which would not notice an edit here.
_NAMES = {"energy": sys.modules[__name__]}
_SCORE = generic(with_globals(scoring.score_each, "score_both_points", _NAMES))
BOTH = KERNELS["virtual willmore"]._replace(score=_SCORE)

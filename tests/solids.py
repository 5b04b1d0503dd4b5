"""Triangles in fractions: what points two of them share, by clipping one with the other.

Slow, exact and independent of the kernels. A triangle is a list of three points, a point a tuple
of fractions; triangles may be degenerate.
"""

from fractions import Fraction


def exact(points):
    """Points (..., 3) of floats as tuples of fractions."""
    return [tuple(map(Fraction, map(float, point))) for point in points]


def minus(a, b):
    return tuple(x - y for x, y in zip(a, b, strict=True))


def dot(a, b):
    return sum(x * y for x, y in zip(a, b, strict=True))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def volume(a, b, c, d):
    return dot(minus(a, d), cross(minus(b, d), minus(c, d)))


def projected_area(a, b, c, axis):
    return cross(minus(b, a), minus(c, a))[axis]


def _along(a, b, t):
    return tuple(x + t * (y - x) for x, y in zip(a, b, strict=True))


def _clip(points, height):
    """The part of the convex hull of `points`, in order round it, where `height` is not negative.

    Also right for hulls that are a segment or a point, whose points come more than once.
    """
    kept = []
    for place, b in enumerate(points):
        a = points[place - 1]
        ha, hb = height(a), height(b)
        if ha * hb < 0:
            kept.append(_along(a, b, ha / (ha - hb)))
        if hb >= 0:
            kept.append(b)
    return kept


def _span(triangle):
    """The triangle's normal and direction: one of both is zero where it is degenerate."""
    a, b, c = triangle
    normal = cross(minus(b, a), minus(c, a))
    longest = max((minus(b, a), minus(c, b), minus(a, c)), key=lambda side: dot(side, side))
    return normal, longest


def common_points(one, other):
    """The corners of the convex set that two triangles share, maybe more than once each."""
    normal, longest = _span(other)
    points = list(one)
    if any(normal):
        points = _clip(points, lambda p: dot(normal, minus(p, other[0])))
        points = _clip(points, lambda p: -dot(normal, minus(p, other[0])))
        for a, b in zip(other, other[1:] + other[:1], strict=True):
            inward = cross(normal, minus(b, a))
            points = _clip(points, lambda p, a=a, w=inward: dot(w, minus(p, a)))
        return points
    # On the line of the segment, then between its ends.
    for axis in range(3):
        e = tuple(Fraction(axis == x) for x in range(3))
        across = cross(e, longest) if any(longest) else e
        for sign in (1, -1):
            points = _clip(points, lambda p, s=sign, w=across: s * dot(w, minus(p, other[0])))
    if any(longest):
        heights = [dot(longest, p) for p in other]
        points = _clip(points, lambda p: dot(longest, p) - min(heights))
        points = _clip(points, lambda p: max(heights) - dot(longest, p))
    return points


def on_segment(p, a, b):
    if a == b:
        return p == a
    along = minus(b, a)
    if any(cross(minus(p, a), along)):
        return False
    return 0 <= dot(minus(p, a), along) <= dot(along, along)


def cut(points, one, other):
    """Whether two faces of vertices `points` share more than their common vertices."""
    shared = sorted(set(one) & set(other))
    if len(shared) == 3:
        return True
    common = common_points([points[v] for v in one], [points[v] for v in other])
    if not shared:
        return bool(common)
    ends = points[shared[0]], points[shared[-1]]
    return any(not on_segment(p, *ends) for p in common)


def cutting_faces(vertices, faces):
    """The set of faces that cut others, by trying all pairs whose boxes meet."""
    points = exact(vertices)
    faces = [tuple(map(int, face)) for face in faces]
    boxes = [
        [(min(x), max(x)) for x in zip(*(points[v] for v in face), strict=True)] for face in faces
    ]
    found = set()
    for f, one in enumerate(faces):
        for g in range(f):
            apart = any(p[1] < q[0] or q[1] < p[0] for p, q in zip(boxes[f], boxes[g], strict=True))
            if not apart and cut(points, one, faces[g]):
                found |= {f, g}
    return found

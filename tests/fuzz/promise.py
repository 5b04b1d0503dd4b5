"""What a result of flips must be, whatever the mesh, the search and the options."""

from collections import Counter, defaultdict
from fractions import Fraction

import numpy as np


def half_edges(faces):
    """Each half-edge as a pair, and how often it occurs."""
    return Counter(
        (face[c], face[(c + 1) % 3]) for face in np.asarray(faces).tolist() for c in range(3)
    )


def _pairs(counted):
    """The edges with exactly one half-edge each way."""
    return {
        (a, b)
        for (a, b), count in counted.items()
        if a < b and count == 1 and counted.get((b, a)) == 1
    }


def odd_edges(counted):
    """The half-edges of all other edges, and how often they occur: no flip may touch these."""
    pairs = _pairs(counted)
    return {(a, b): n for (a, b), n in counted.items() if (min(a, b), max(a, b)) not in pairs}


def edges(counted):
    return {(min(pair), max(pair)) for pair in counted}


def _is_one_fan(link):
    """Whether the edges opposite to a vertex form one path or one ring."""
    around = defaultdict(list)
    for a, b in link:
        around[a].append(b)
        around[b].append(a)
    if max(map(len, around.values())) > 2:
        return False
    seen, waiting = set(), [link[0][0]]
    while waiting:
        v = waiting.pop()
        if v not in seen:
            seen.add(v)
            waiting += around[v]
    return len(seen) == len(around)


def fans(faces):
    """For each vertex with faces whether these form one fan around it."""
    links = defaultdict(list)
    for a, b, c in np.asarray(faces).tolist():
        links[a].append((b, c))
        links[b].append((c, a))
        links[c].append((a, b))
    return {v: _is_one_fan(link) for v, link in links.items()}


def check_connectivity(before, after):
    """The same vertices, numbers of faces and edges, boundary and orientation; nothing torn."""
    old, new = half_edges(before), half_edges(after)
    assert after.shape == before.shape
    assert all(len(set(face)) == 3 for face in after.tolist()), "a face has a vertex twice"
    assert odd_edges(new) == odd_edges(old), "boundary or non-manifold edges differ"
    assert len(edges(new)) == len(edges(old)), "the number of edges differs"
    one, other = fans(before), fans(after)
    assert one.keys() == other.keys(), "a vertex lost all of its faces"
    had, has = (Counter(v for edge in edges(counted) for v in edge) for counted in (old, new))
    bare = [v for v in has if has[v] < min(had[v], 3)]
    assert not bare, f"vertices {bare} are left with less than three edges"
    torn = [v for v in one if one[v] and not other[v]]
    assert not torn, f"new non-manifold vertices {torn}"


def check_kept(after, kept):
    """All edges of a set are there."""
    missing = kept - edges(half_edges(after))
    assert not missing, f"edges that had to stay are gone: {sorted(missing)}"


def _sectors(faces, barred):
    """The corners at each vertex, in groups that no barred edge separates.

    Returns
    -------
    dict
        For each corner (f, c) a label: the vertex, the half-edges at it that bound the group, and
        the least corner of the group, which distinguishes groups without such.
    """
    faces = np.asarray(faces).tolist()
    corner_at = {}
    for f, face in enumerate(faces):
        for c in range(3):
            corner_at[face[c], face[(c + 1) % 3]] = f, c
    parent = {(f, c): (f, c) for f in range(len(faces)) for c in range(3)}

    def root(x):
        while parent[x] != x:
            x = parent[x]
        return x

    bounds = defaultdict(list)
    for f, face in enumerate(faces):
        for c in range(3):
            a, b = face[c], face[(c + 1) % 3]
            if (min(a, b), max(a, b)) in barred:
                continue
            # The face on the other side has its corner at a after that at b.
            g, d = corner_at[b, a]
            parent[root((f, c))] = root((g, (d + 1) % 3))
    for f, face in enumerate(faces):
        for c in range(3):
            for a, b in ((face[c], face[(c + 1) % 3]), (face[c - 1], face[c])):
                if (min(a, b), max(a, b)) in barred:
                    bounds[root((f, c))].append((a, b))
    return {x: (root(x), sorted(bounds[root(x)])) for x in parent}


def check_corners(before, after, corners, locked):
    """Each corner goes back to one at the same vertex, between the same locked edges."""
    np.testing.assert_array_equal(before.ravel()[corners.ravel()], after.ravel())
    counted = half_edges(before)
    barred = locked | edges(odd_edges(counted))
    old, new = _sectors(before, barred), _sectors(after, barred)
    there = {}
    for (f, c), (group, bounds) in new.items():
        source = divmod(int(corners[f, c]), 3)
        was, were = old[source]
        assert were == bounds, f"corner {(f, c)} comes from the other side of a locked edge"
        assert there.setdefault(group, was) == was, f"corner {(f, c)} comes from another fan"
    assert len(set(there.values())) == len(there), "two fans have become one"


def seams(faces, wedge_uv):
    """The edges with two faces that have other texture coordinates at one of its ends."""
    there, found = {}, set()
    for face, uv in zip(np.asarray(faces).tolist(), np.asarray(wedge_uv).tolist(), strict=True):
        for c in range(3):
            there[face[c], face[(c + 1) % 3]] = uv[c], uv[(c + 1) % 3]
    for a, b in _pairs(half_edges(faces)):
        if there[a, b] != there[b, a][::-1]:
            found.add((a, b))
    return found


def signs(wedge_uv):
    """How many texture triangles have an area of each sign, exactly; None: not finite."""
    counted = Counter()
    for uv in np.asarray(wedge_uv):
        if not np.isfinite(uv).all():
            counted[None] += 1
            continue
        (ax, ay), (bx, by), (cx, cy) = ([Fraction(x) for x in corner] for corner in uv.tolist())
        area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        counted[(area > 0) - (area < 0)] += 1
    return counted


def check_mapping(before, after):
    """No texture triangle is turned over, and none became flat."""
    old, new = signs(before), signs(after)
    assert new[None] == old[None], "texture coordinates that are not finite have spread"
    assert new[1] >= old[1], f"{old[1] - new[1]} texture triangles turned over"
    assert new[-1] >= old[-1], f"{old[-1] - new[-1]} texture triangles turned over"


def check_progress(fractions):
    """They begin at 0, never fall, and end at 1, which is there only once."""
    assert fractions[0] == 0.0, f"progress begins at {fractions[0]}"
    assert fractions == sorted(fractions), f"progress falls: {fractions}"
    assert fractions[-1] == 1.0, f"progress ends at {fractions[-1]}"
    assert fractions.count(1.0) == 1, f"progress is 1 before the end: {fractions}"

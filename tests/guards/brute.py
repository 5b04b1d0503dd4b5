"""The intersection guard without a BVH: every face is tested."""

from meshlab_willmore.guards.intersections import (
    face_of,
    intersect,
    meshlab_may_count,
    shared_vertices,
)
from meshlab_willmore.mesh.build import faces_of
from meshlab_willmore.mesh.halfedge import flip
from meshlab_willmore.search.snapshots import copy_of


def are_refused(vertices, corners, f, g, area_scale):
    """Whether the faces f and g of `corners` (m, 3) intersect, or MeshLab may say so."""
    f, g = min(f, g), max(f, g)
    one, other = (
        face_of(vertices, *corners[f]),
        face_of(vertices, *corners[g]),
    )
    shared = shared_vertices(one, other)
    return bool(intersect(one, other, shared) or meshlab_may_count(one, other, shared, area_scale))


def box(points):
    return points.min(axis=0), points.max(axis=0)


def blockers(mesh, h, area_scale=1.0):
    """All faces that the new faces intersect; the face of `h` if these intersect each other."""
    flipped = copy_of(mesh)
    flip(flipped, h)
    corners = faces_of(flipped)
    boxes = mesh.vertices[corners].min(axis=1), mesh.vertices[corners].max(axis=1)
    own, found = (int(h) // 3, int(mesh.twin[h]) // 3), set()
    for f in own:
        least, most = box(mesh.vertices[corners[f]])
        near = ((boxes[0] <= most) & (boxes[1] >= least)).all(axis=1)
        for e in near.nonzero()[0].tolist():
            if e not in own and are_refused(mesh.vertices, corners, f, e, area_scale):
                found.add(e)
    if are_refused(mesh.vertices, corners, *own, area_scale):
        found.add(own[0])
    return found

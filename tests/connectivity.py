"""The invariants of half-edge connectivity, and which flips keep them."""

import numpy as np

from meshlab_willmore.mesh.build import build, faces_of
from meshlab_willmore.mesh.halfedge import NONE, is_free, makes_new_edge
from meshlab_willmore.mesh.jit import jit


@jit
def can_flip(mesh, h):
    """Whether the connectivity and the locks allow to flip `h`."""
    return is_free(mesh, h) and makes_new_edge(mesh, h)


def validate_connectivity(mesh):
    """Check the invariants of `meshlab_willmore.mesh.halfedge` on the whole mesh.

    Raises
    ------
    ValueError
        Names the first half-edge at which an invariant is broken.
    """
    everywhere = np.arange(len(mesh.origin))
    h = np.flatnonzero(mesh.twin != NONE)
    t = mesh.twin[h]
    ahead = mesh.origin[everywhere + 1 - 3 * (everywhere % 3 == 2)]
    _refuse(h, mesh.twin[t] != h, "is not the twin of its twin")
    _refuse(h, (mesh.origin[h] != ahead[t]) | (mesh.origin[t] != ahead[h]), "and its twin differ")
    _refuse(h, mesh.locked[h] != mesh.locked[t], "is locked on one side only")
    _refuse(everywhere, mesh.origin == ahead, "starts and ends at the same vertex")
    rebuilt = build(mesh.vertices, faces_of(mesh))
    _refuse(everywhere, mesh.twin != rebuilt.twin, "has not the twin that the faces give")
    fans = np.flatnonzero(mesh.several_fans != rebuilt.several_fans)
    _refuse(fans, np.ones(len(fans), bool), "as a vertex changed its number of fans")


def _refuse(which, broken, what):
    if broken.any():
        raise ValueError(f"half-edge {which[np.argmax(broken)]} {what}")

"""Edges that wait for a face: their flip is refused as long as that face stays as it is.

Each face has a list of the edges that wait for it, linked both ways, so that an edge can be moved
to another face's list at once. An edge stands under the same half-edge as in the queue.
"""

from typing import NamedTuple

import numpy as np

from ..mesh.jit import inner

NONE = -1


class Waiting(NamedTuple):
    """For m faces; all empty where no flip is ever refused for a face.

    Attributes
    ----------
    first : (m,) int32
        First half-edge that waits for each face, or `NONE`.
    ahead, behind : (3 m,) int32
        The next and the previous half-edge of the list, or `NONE`.
    face : (3 m,) int32
        What each half-edge waits for, or `NONE`.
    """

    first: np.ndarray
    ahead: np.ndarray
    behind: np.ndarray
    face: np.ndarray


def nothing_waits(faces):
    """Return empty lists for so many faces."""
    return Waiting(
        np.full(faces, NONE, np.int32),
        np.full(3 * faces, NONE, np.int32),
        np.full(3 * faces, NONE, np.int32),
        np.full(3 * faces, NONE, np.int32),
    )


@inner
def wait(waiting, h, face):
    """Let `h` wait for `face` instead of what it waited for, in place."""
    leave(waiting, h)
    following = waiting.first[face]
    waiting.first[face], waiting.face[h] = h, face
    waiting.ahead[h], waiting.behind[h] = following, NONE
    if following != NONE:
        waiting.behind[following] = h


@inner
def leave(waiting, h):
    """Let `h` wait for nothing any more, in place."""
    face = waiting.face[h]
    if face == NONE:
        return
    before, behind = waiting.behind[h], waiting.ahead[h]
    if before == NONE:
        waiting.first[face] = behind
    else:
        waiting.ahead[before] = behind
    if behind != NONE:
        waiting.behind[behind] = before
    waiting.face[h] = NONE

"""Corners of faces whose vertex is not there, for which PyMeshLab reads anywhere in memory.

It looks for them itself in PLY files and, nearly, in OBJ files.
"""

from __future__ import annotations

from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import pymeshlab

# Vertices and faces; a third number, of edges, can be left out.
_COUNTS = 2


def check_text(path: Path) -> None:
    """Raise `OSError` if a face of an OFF file, line by line as usual, has a corner too many."""
    if path.suffix.lower() != ".off":
        return
    with path.open("rb") as file:
        lines = (text for line in file if (text := line.partition(b"#")[0].split()))
        head = next(lines, [])
        counts = head[1:] or next(lines, [])
        if len(counts) < _COUNTS or not all(number.isdigit() for number in counts[:_COUNTS]):
            return
        vertices, faces = (int(number) for number in counts[:_COUNTS])
        for face, numbers in enumerate(islice(lines, vertices, vertices + faces)):
            size = int(numbers[0]) if numbers[0].isdigit() else 0
            for number in numbers[1 : size + 1]:
                if number.isdigit() and int(number) >= vertices:
                    raise _no_vertex(face, vertices)


def check_loaded(mesh: pymeshlab.Mesh) -> None:
    """Raise `OSError` if a face leads out of the vertices."""
    count, faces = mesh.vertex_number(), mesh.face_matrix()
    is_bad = ((faces < 0) | (faces >= count)).any(axis=1)
    if is_bad.any():
        raise _no_vertex(int(is_bad.argmax()), count)


def _no_vertex(face: int, vertices: int) -> OSError:
    return OSError(f"face {face} has a vertex that is not in 0 .. {vertices - 1}")

"""`page`: a mesh before and after, in one file that any browser shows without a network."""

from __future__ import annotations

import base64
import hashlib
import json
import os
import time
from collections.abc import Mapping, Sequence
from functools import cache
from html import escape
from importlib import resources
from pathlib import Path
from string import Template
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import thumbnail
from .._version import __version__
from ..files import write
from ..results import FlipResult
from . import decimate, histograms, places, rows
from .examine import Examined, examined, side_numbers
from .pack import Grid, Shown, grid_of, packed, used_by

# The pictures that are seen until the viewer has begun, in pixels.
POSTER = (640, 480)
# Of the size of the mesh, around it.
MARGIN = 1.06
MODES = {
    "faces": "Faces",
    "wires": "Wireframe",
    "energy": "Willmore energy",
    "dihedral": "Dihedral angles",
    "flips": "Flipped edges",
    "reflection": "Reflection lines",
}
# Those that make sense where the viewer shows fewer faces than there are.
_OF_FEWER_FACES = ("faces", "energy", "reflection")


def page(
    before: Any,
    after: Any,
    path: str | os.PathLike[str],
    *,
    title: str = "",
    settings: Mapping[str, object] | None = None,
    seconds: float | None = None,
    notes: Sequence[str] = (),
) -> None:
    """Write a page that shows a mesh before and after: in 3D, in numbers and in histograms.

    The page is one HTML file that needs no network. Both meshes are seen by one camera: their faces
    and wireframes, the Willmore energy of the vertices, dihedral angles, flipped edges, and
    reflection lines. Of meshes with more than a million faces, a simplified one is shown; numbers
    and histograms are always of the whole mesh.

    Parameters
    ----------
    before, after : mesh
        A pair of vertices (n, 3) and faces (m, 3); or what has these as `vertices` and `faces`, as
        meshes of trimesh do, or as `vertex_matrix()` and `face_matrix()`, as those of PyMeshLab.
        `after` may be a `FlipResult` for the vertices of `before`.
    path : path
        The file, which is written atomically; an existing one is replaced.
    title : str, optional
        The heading; by default the name of the file.
    settings : mapping, optional
        What else to list, by name: parameters, for instance.
    seconds : float, optional
        How long the work took.
    notes : sequence of str
        Messages to show, for instance on what was lost.

    Raises
    ------
    TypeError
        If one of the meshes is none of these, or has arrays of a wrong type.
    ValueError
        As `meshlab_willmore.mesh.validate.check_mesh`.
    OSError
        In one line, if the file can't be written.

    Examples
    --------
    >>> result = optimize_flips(vertices, faces, preset="faithful")  # doctest: +SKIP
    >>> page((vertices, faces), result, "flips.html")  # doctest: +SKIP
    """
    file = Path(path)
    vertices, faces = mesh_arrays(before, "before")
    is_result = isinstance(after, FlipResult)
    pair = (vertices, after.faces) if is_result else mesh_arrays(after, "after")
    text = document(
        examined(vertices, faces),
        examined(*pair),
        title or file.stem,
        {**dict(settings or {}), **dict(rows.of_result(after) if is_result else {})},
        seconds,
        notes,
    )
    write(file, text.encode())


def mesh_arrays(mesh: Any, name: str) -> tuple[Any, Any]:
    """The vertices and faces of a mesh of any kind that `page` takes."""
    if hasattr(mesh, "vertex_matrix"):
        return mesh.vertex_matrix(), mesh.face_matrix()
    if hasattr(mesh, "vertices") and hasattr(mesh, "faces"):
        return mesh.vertices, mesh.faces
    if isinstance(mesh, Sequence) and len(mesh) == 2:
        return mesh[0], mesh[1]
    raise TypeError(
        f"{name} must be a pair (vertices, faces) or a mesh of PyMeshLab or trimesh, not "
        f"{type(mesh).__name__}"
    )


def document(
    before: Examined,
    after: Examined,
    title: str,
    settings: Mapping[str, object],
    seconds: float | None,
    notes: Sequence[str],
) -> str:
    """Return the page of two meshes that were examined."""
    is_same = np.array_equal(before.vertices, after.vertices)
    flipped = _flipped(before, after), _flipped(after, before)
    flips = len(np.unique(side_numbers(after.faces)[flipped[1].ravel()])) if is_same else None
    most = max(len(before.faces), len(after.faces))
    is_whole = most <= decimate.MOST_FACES
    shown = _shown(before, after, flipped, is_whole)
    modes = {
        name: text
        for name, text in MODES.items()
        if (is_whole or name in _OF_FEWER_FACES) and (is_same or name != "flips")
    }
    grid = grid_of(*shown)
    seen = after if len(after.faces) else before
    view = thumbnail.view_of(seen.vertices, seen.faces)
    is_flipped = is_same and len(before.faces) == len(after.faces)
    groups = places.groups(before, after, is_flipped)
    head, meshes = packed(*shown, grid)
    head |= {
        "view": view.tolist(),
        "half": _half(shown, grid, view),
        "places": [_as_json(group, place, grid) for group in groups for place in group.places],
    }
    found = rows.rows(before, after, flips)
    body = Template(part("comparison.html")).substitute(
        title=escape(title),
        made=f"meshlab_willmore {__version__}, {time.strftime('%d %B %Y, %H:%M')}",
        tiles=_tiles(found, seconds),
        notes=_notes(notes),
        modes=_modes(modes),
        mode_count=len(modes),
        panes=_panes(*shown, view),
        alternative=escape(_alternative(found, title)),
        legends=part("legends.html"),
        simplified="" if is_whole else _of_fewer(most, len(shown[1].faces)),
        places_help="Click on one to fly there." if groups else "There are none.",
        places=_places(groups),
        rows=rows.table_rows(found),
        histograms=histograms.figures(before, after),
        settings=_settings(settings, seconds),
        version=__version__,
    )
    shaders = "\n".join(
        f'<script type="x-shader" id="{stage}">{part(name)}</script>'
        for stage, name in (("VERTEX_SHADER", "viewer.vert"), ("FRAGMENT_SHADER", "viewer.frag"))
    )
    data = (
        f'<script type="application/json" id="head">{for_script(head)}</script>\n'
        f'<script type="text/plain" id="meshes">{meshes}</script>\n{shaders}'
    )
    return assembled(title, body, data, part("viewer.js"))


def assembled(title: str, body: str, data: str, script: str) -> str:
    """Return a whole page, whose security policy allows these scripts and styles and no others."""
    style = part("page.css")
    return Template(part("page.html")).substitute(
        version=__version__,
        title=escape(title),
        style=style,
        style_hash=_hash(style),
        script=script,
        script_hash=_hash(script),
        body=body,
        data=data,
    )


@cache
def part(name: str) -> str:
    """A file of the folder `parts`."""
    return (resources.files(__package__) / "parts" / name).read_text(encoding="utf-8")


def for_script(value: object) -> str:
    """JSON that ends no script, whatever is in it."""
    return json.dumps(value).replace("<", "\\u003c")


def _hash(text: str) -> str:
    digest = base64.b64encode(hashlib.sha256(text.encode()).digest()).decode("ascii")
    return f"'sha256-{digest}'"


# --- what the viewer shows -----------------------------------------------------------------------


def _flipped(mesh: Examined, other: Examined) -> NDArray[np.bool_]:
    """The sides of faces (m, 3) that the other mesh does not have."""
    if not len(other.edges):
        return np.ones(mesh.faces.shape, np.bool_)
    sides = side_numbers(mesh.faces)
    places = np.minimum(np.searchsorted(other.edges, sides), len(other.edges) - 1)
    return (other.edges[places] != sides).reshape(-1, 3)


def _shown(
    before: Examined,
    after: Examined,
    flipped: tuple[NDArray[np.bool_], NDArray[np.bool_]],
    is_whole: bool,
) -> tuple[Shown, Shown]:
    if is_whole:
        return (
            Shown(before.vertices, before.faces, before.energy, before.dihedral, flipped[0]),
            Shown(after.vertices, after.faces, after.energy, after.dihedral, flipped[1]),
        )
    size = decimate.cell_size(before, after)
    return decimate.decimated(before, size), decimate.decimated(after, size)


def _half(shown: Sequence[Shown], grid: Grid, view: NDArray[np.float64]) -> float:
    """From the middle of the picture to its sides, so that the whole mesh is seen."""
    points = [grid.on_grid(mesh.vertices[used_by(mesh.faces, mesh.vertices)]) for mesh in shown]
    flat = np.concatenate(points) @ view[:2].T
    return MARGIN * float(np.abs(flat).max()) if len(flat) else 1.0


def _as_json(group: places.Group, place: places.Place, grid: Grid) -> dict[str, Any]:
    normal = place.normal if place.normal.any() else np.array([0.0, 0.0, 1.0])
    was = f", {place.was}" if place.was else ""
    return {
        "target": grid.on_grid(place.point).tolist(),
        "normal": normal.tolist(),
        "half": max(place.half / grid.half, 1e-4),
        "text": f"{group.title}: {place.value}{was}",
    }


# --- parts of the page ---------------------------------------------------------------------------


def _tiles(found: Sequence[rows.Row], seconds: float | None) -> str:
    by_name = {row.name: row for row in found}
    tiles = []
    for name in (
        "Edges that differ",
        "Willmore energy W",
        "Absolute mean curvature M",
        "Mean shape",
        "Faces that cut or touch others",
    ):
        row = by_name.get(name)
        if row is not None:
            note = rows.change(row)
            tiles.append((name, rows.written(row.after, row.unit), note))
    if seconds is not None:
        tiles.append(("Time", f"{seconds:.3g} s", ""))
    return "".join(
        f'<div class="tile"><span>{escape(name)}</span><b>{value}</b><span>{note}</span></div>'
        for name, value, note in tiles
    )


def _notes(notes: Sequence[str]) -> str:
    lines = "".join(f"<p>{escape(text)}</p>" for text in notes)
    return f'<section class="card note" aria-label="Notes">{lines}</section>' if lines else ""


def _modes(modes: Mapping[str, str]) -> str:
    return "".join(
        f'<label><input type="radio" name="mode" value="{name}">{text}</label>'
        for name, text in modes.items()
    )


def _panes(before: Shown, after: Shown, view: NDArray[np.float64]) -> str:
    panes = []
    for name, mesh in (("Before", before), ("After", after)):
        inside = '<p class="empty">no faces</p>'
        if len(mesh.faces):
            poster = thumbnail.data_uri(thumbnail.picture(mesh.vertices, mesh.faces, *POSTER, view))
            inside = f'<img src="{poster}" alt="The mesh {name.lower()}, shaded">'
        panes.append(
            f'<div class="pane"><b>{name}</b>{inside}<span class="ring" hidden></span></div>'
        )
    return "".join(panes)


def _alternative(found: Sequence[rows.Row], title: str) -> str:
    wanted = ("Faces", "Willmore energy W")
    numbers = "; ".join(
        f"{row.name} {rows.written(row.before)} before, {rows.written(row.after)} after"
        for row in found
        if row.name in wanted
    )
    return f"{title} in 3D, before and after side by side. {numbers}."


def _of_fewer(faces: int, shown: int) -> str:
    return (
        f"<p><b>Simplified:</b> {shown:,} of {faces:,} faces are shown. Numbers, histograms and "
        "worst places are of the whole mesh.</p>"
    )


def _places(groups: Sequence[places.Group]) -> str:
    columns, number = [], 0
    for group in groups:
        items = []
        for place in group.places:
            was = f"<small>{escape(place.was)}</small>" if place.was else ""
            items.append(
                f'<li><button type="button" data-place="{number}" aria-pressed="false">'
                f"<span>{escape(place.value)}</span>{was}</button></li>"
            )
            number += 1
        columns.append(f"<div><h3>{escape(group.title)}</h3><ol>{''.join(items)}</ol></div>")
    return "".join(columns)


def _settings(settings: Mapping[str, object], seconds: float | None) -> str:
    given = {name: str(value) for name, value in settings.items()}
    if seconds is not None:
        given["Seconds"] = f"{seconds:.2f}"
    given["meshlab_willmore"] = __version__
    return "".join(
        f"<dt>{escape(name)}</dt><dd>{escape(value)}</dd>" for name, value in given.items()
    )

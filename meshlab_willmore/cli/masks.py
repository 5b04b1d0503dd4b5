"""`-m`: which data of a mesh are saved, in the short names of `meshlabserver`."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import click

from . import formats

# Short name: PyMeshLab's keyword of save_current_mesh, and what it is.
PARTS = {
    "vc": ("save_vertex_color", "vertex colours"),
    "vf": ("save_vertex_flag", "vertex flags"),
    "vq": ("save_vertex_quality", "vertex quality"),
    "vn": ("save_vertex_normal", "vertex normals"),
    "vt": ("save_vertex_coord", "vertex texture coordinates"),
    "vr": ("save_vertex_radius", "vertex radii"),
    "fc": ("save_face_color", "face colours"),
    "ff": ("save_face_flag", "face flags"),
    "fq": ("save_face_quality", "face quality"),
    "fn": ("save_face_normal", "face normals"),
    "wc": ("save_wedge_color", "wedge colours"),
    "wn": ("save_wedge_normal", "wedge normals"),
    "wt": ("save_wedge_texcoord", "wedge texture coordinates"),
}
# Those that are no data: PyMeshLab's keyword and its value.
MANNERS = {"mp": ("save_polygonal", True), "sa": ("binary", False)}
TEXTURED = frozenset({"vt", "wt"})

mask_option = click.option(
    "--mask",
    "-m",
    "parts",
    multiple=True,
    type=click.Choice([*PARTS, *MANNERS]),
    metavar="PART...",
    help="What is saved beside positions and faces, nothing else: v, f or w (vertex, face, wedge) "
    "with c, f, q, n, t or r (colour, flags, quality, normal, texture, radius), such as: vc fq wt. "
    "mp keeps polygons, sa writes text. Without it: what PyMeshLab saves of itself.",
)


def is_part(word: str) -> bool:
    """Whether a word is one of the short names."""
    return word in PARTS or word in MANNERS


def by_output(order: Iterable[str], parts: Sequence[str]) -> list[tuple[str, ...]]:
    """The parts for each output: what stands before the first one is for all of them.

    Parameters
    ----------
    order : iterable of str
        "patterns" for each output and "parts" for each part, in the order of the command line.
    parts : sequence of str
        The parts in that order.
    """
    rest = iter(parts)
    groups: list[list[str]] = [[]]
    for name in order:
        if name == "patterns":
            groups.append([])
        elif name == "parts":
            groups[-1].append(next(rest))
    common, *own = groups
    return [(*common, *group) for group in own]


def keywords(parts: Iterable[str], ending: str) -> dict[str, bool]:
    """What ``save_current_mesh`` is told for a format; nothing if nothing was asked for."""
    wanted = set(parts)
    data = {keyword: part in wanted for part, (keyword, _) in PARTS.items()}
    manners = {key: value for part, (key, value) in MANNERS.items() if part in wanted}
    given = {**data, **manners} if wanted else {}
    return {key: value for key, value in given.items() if formats.holds(ending, key)}


def not_held(parts: Iterable[str], ending: str) -> str:
    """What was asked for and files with this ending have no place for, in words; or nothing."""
    asked = {part: PARTS[part] for part in parts if part in PARTS}
    missing = [
        f"{name} ({p})" for p, (key, name) in asked.items() if not formats.holds(ending, key)
    ]
    return f".{ending} files hold no {' and no '.join(missing)}" if missing else ""

"""Report pages: of a mesh before and after, and of a batch."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..demo.models import Surface
from ..demo.models import surface_of as current_surface
from ..files import write
from ..messages import counted, note, one_line
from ..mlx.steps import Step
from . import steplog
from .jobs import Job
from .process import ERROR
from .records import BAD_FILE, Result, StepResult, versions

if TYPE_CHECKING:
    import pymeshlab

    from ..report.table import Entry

# A picture is drawn of so many faces at most.
MOST_FACES = 1_000_000
# What a step returns may be so far from 0 that it should be.
_ROUNDING_ERROR = 1e-12

COLUMNS = ("Faces", "Flips made", "W before", "W after", "W %", "Seconds", "MiB")
LEGEND = (
    "W: Willmore energy, 0 on spheres and planes. Flips made: by all steps; an edge can be flipped "
    "several times. MiB: the most memory of the worker."
)
HINT = "With --report 'pages/{name}.html' each mesh gets a page of its own, in 3D."


class Layer(NamedTuple):
    """The current layer: its surface, its name, how many layers there are, and its matrix."""

    surface: Surface
    name: str
    layers: int
    has_matrix: bool


def current_layer(ms: pymeshlab.MeshSet) -> Layer | None:
    """The current layer; None without one."""
    if not ms.mesh_number():
        return None
    mesh = ms.current_mesh()
    name = f"{mesh.label()!r}" if mesh.label() else f"{mesh.id()}"
    has_matrix = not np.array_equal(mesh.transform_matrix(), np.eye(4))
    return Layer(current_surface(ms), name, ms.mesh_number(), has_matrix)


def _notes_on_layers(before: Layer, after: Layer) -> Iterator[str]:
    """What a page of several layers does not show, and where its numbers are others."""
    was, now = (f"layer {one.name} of {one.layers}" for one in (before, after))
    if (before.name, before.layers) != (after.name, after.layers) and max(
        before.layers, after.layers
    ) > 1:
        yield (
            f"This page compares two layers: {was} before, and {now} after, which may be different "
            "meshes. It shows no other layers."
        )
    elif after.layers > 1:
        yield f"This page shows {now}, which is the current one, and no other layers."
    if before.has_matrix or after.has_matrix:
        yield (
            "The layer has a matrix. Meshes and numbers of this page are those with the matrix "
            "applied; edge flips, and what they return, go by the coordinates without it."
        )


@contextmanager
def _noted(name: str) -> Iterator[None]:
    """Inside, a failure is a note that `name` is not written: the mesh is saved all the same.

    A mesh may have coordinates that are not finite, or be too large for the memory or the disk.
    """
    try:
        yield
    except (MemoryError, OSError, ValueError) as error:
        reason = one_line(error).removeprefix(f"cannot write {name}: ")
        note(f"{name} is not written: {reason}")


def current_picture(ms: pymeshlab.MeshSet) -> bytes | None:
    """A small picture of the current mesh; None without a mesh, or with a note if that fails."""
    with _noted("its picture"):
        layer = current_layer(ms)
        return None if layer is None else picture(layer.surface)
    return None


def picture(surface: Surface) -> bytes:
    """A small picture of a mesh; empty if it has coordinates that are not finite."""
    from .. import thumbnail
    from ..report.table import PICTURE

    if not np.isfinite(surface.vertices).all():
        return b""
    # Of more faces, some are enough: they are far smaller than pixels.
    step = len(surface.faces) // MOST_FACES + 1
    return thumbnail.picture(surface.vertices, surface.faces[::step], *PICTURE)


def write_page(
    job: Job,
    before: Layer | None,
    ms: pymeshlab.MeshSet,
    steps: Sequence[Step] | bytes,
    returned: Sequence[StepResult],
    seconds: float,
    notes: Sequence[str],
) -> None:
    """Write the report page of a job, if it has one: the current mesh, and the one `before`.

    The seconds are those of all steps. If there is no such page, as a mesh has coordinates that are
    not finite, or the memory or the disk has no room, there is a note.
    """
    from ..report import page

    if job.page is None:
        return
    with _noted(str(job.page)):
        after = current_layer(ms)
        if before is None or after is None:
            note(f"{job.page} is not written: there is no mesh {'after' if before else 'before'}")
            return
        settings = {
            **({} if isinstance(steps, bytes) else _steps(steps)),
            **{f"Step {one.number} returned": _listed(_rounded(one.returned)) for one in returned},
            "Inputs": job.name,
            "Outputs": ", ".join(output.name for output in job.outputs) or "none",
            **{name: number for name, number in versions().items() if name != "meshlab_willmore"},
        }
        title = ", ".join(path.name for path in job.inputs)
        if after.layers > 1:
            title += f", layer {after.name} of {after.layers}"
        notes = [*notes, *_notes_on_layers(before, after)]
        page(
            before.surface,
            after.surface,
            job.page,
            title=title,
            settings=settings,
            seconds=seconds,
            notes=notes,
        )


def _steps(steps: Iterable[Step]) -> dict[str, str]:
    return {
        f"Step {number}": ": ".join(
            filter(None, (step.filter, _listed({p.name: p.value for p in step.params})))
        )
        for number, step in enumerate(steps, 1)
    }


def _rounded(returned: Mapping[str, Any]) -> dict[str, Any]:
    """What a step returned, with 0 in place of rounding errors such as -8.88e-16."""
    return {
        key: 0.0 if type(value) is float and abs(value) < _ROUNDING_ERROR else value
        for key, value in returned.items()
    }


def _listed(values: Mapping[str, Any]) -> str:
    return ", ".join(f"{key} = {_text(value)}" for key, value in values.items())


def _text(value: Any) -> str:
    return f"{value:.6g}" if type(value) is float else steplog.in_line(value)


def write_table(path: Path, source: str, jobs: Sequence[Job], results: Iterable[Result]) -> None:
    """Write the report page of a batch: a table of results, each linked to its own page.

    Parameters
    ----------
    source : str
        What the script or function is called.
    jobs : sequence of Job
        All of the batch; the results come in their order. One mesh may be the input of several.
    """
    from ..report.table import table_page

    entries = [
        _entry(result, path, jobs[result.place].page)
        for result in sorted(results, key=lambda one: one.place)
    ]
    title = f"{source}, {counted(len(jobs), 'input')}"
    legend = LEGEND if any(job.page for job in jobs) else f"{LEGEND} {HINT}"
    write(path, table_page(title, "Batch", COLUMNS, entries, legend).encode())


def _entry(result: Result, path: Path, page: Path | None) -> Entry:
    from ..report.examine import meaningful
    from ..report.table import Entry, link, percent

    before, after = result.before or {}, result.after or {}
    energies = [found.get("willmore_energy") for found in (before, after)]
    energies = [None if energy is None else meaningful(energy) for energy in energies]
    flips = [one.returned["flips"] for one in result.returned if "flips" in one.returned]
    says_all = result.status in (ERROR, BAD_FILE)
    failure = result.reason if says_all else f"{result.step}: {result.reason}"
    return Entry(
        result.input,
        result.status,
        result.is_done,
        result.notes if result.is_done else (failure, *result.notes),
        result.picture,
        link(path, page),
        {
            "Faces": after.get("faces", before.get("faces")),
            "Flips made": sum(flips) if flips else None,
            "W before": energies[0],
            "W after": energies[1],
            "W %": percent(*energies),
            "Seconds": result.seconds,
            "MiB": None if result.memory is None else result.memory // 2**20,
        },
    )

"""What a run takes from files and puts into files, with a line in the log for each."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from . import inputs, progress
from .columns import counted

if TYPE_CHECKING:
    import pymeshlab

    from .jobs import Job
    from .runlog import Log


class Wishes(NamedTuple):
    """How outputs are to be saved.

    Attributes
    ----------
    parts : tuple of tuple of str
        For each output, the short names of `masks`.
    layers : tuple of str
        For each output, the layer as `output_words` has it; empty for none.
    force : bool
        Replace files that are there.
    placed : set of Path
        What this run has written; changed in place.
    """

    parts: tuple[tuple[str, ...], ...]
    layers: tuple[str, ...]
    force: bool
    placed: set[Path]


def loaded(job: Job, log: Log) -> pymeshlab.MeshSet:
    """The inputs as layers of one set; the first is current, as in `meshlabserver`."""

    def note(ms: pymeshlab.MeshSet, path: Path) -> None:
        log.say(f"input {path} ({_size(ms)})")

    with progress.shown(job.name) as status:
        status.begin("reading")
        ms = inputs.loaded(*job.inputs, after=note)
    if len(job.inputs) > 1:
        ms.set_current_mesh(0)
    return ms


def save(ms: pymeshlab.MeshSet, job: Job, wishes: Wishes, log: Log) -> str:
    """Save the current mesh, or the first layers; returns which files there are now.

    Raises
    ------
    OSError
        In one line, if there is not a mesh for each output, or one can't be written.
    """
    from . import saving

    if not job.outputs:
        return "not saved (no -o)"
    if ms.mesh_number() == 0:
        raise OSError(f"cannot write {job.outputs[0]}: the script leaves no mesh")
    chosen = _chosen(ms, job, wishes)
    origin = job.inputs[0].parent if job.inputs else None
    texts = []
    for path, parts, layer in zip(job.outputs, wishes.parts, chosen, strict=True):
        ms.set_current_mesh(layer)
        with progress.shown(job.name) as status:
            status.begin(f"saving {path}")
            wish = saving.Wish(parts, wishes.force, origin, wishes.placed)
            files = saving.save(ms, path, wish)
        log.say(f"output {' '.join(map(str, files))} ({_size(ms)})")
        texts.append(f"{path} ({_size(ms)})")
    return ", ".join(texts)


def _chosen(ms: pymeshlab.MeshSet, job: Job, wishes: Wishes) -> list[int]:
    """The id of the layer for each output."""
    current, layers = ms.current_mesh().id(), [mesh.id() for mesh in ms]
    left = counted(len(layers), "layer")
    if any(wishes.layers):
        numbers = [int(layer) for layer in wishes.layers if layer.isdecimal()]
        if numbers and max(numbers) >= len(layers):
            raise OSError(f"there is no layer {max(numbers)}: the script leaves {left}, from 0")
        ends = {"c": current, "x": layers[-1]}
        return [ends[name] if name in ends else layers[int(name)] for name in wishes.layers]
    if len(job.outputs) == 1:
        return [current]
    if len(job.outputs) > len(layers):
        raise OSError(f"{len(job.outputs)} outputs, but the script leaves {left}")
    return layers[: len(job.outputs)]


def _size(ms: pymeshlab.MeshSet) -> str:
    mesh = ms.current_mesh()
    return f"{mesh.vertex_number()} vertices, {mesh.face_number()} faces"

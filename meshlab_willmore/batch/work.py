"""The work on one job: load its meshes, run the steps, measure, and save what comes out.

`do` is what a worker process does. The command line does the same in its own process for one job.
"""

from __future__ import annotations

import logging
import pickle
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager, nullcontext, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import pymeshlab

from .. import memory
from ..compare.rows import warm_up as warm_up_filter
from ..demo.models import dented_cube
from ..mesh_files import loading, projects
from ..mesh_files.paths import Output, is_project
from ..mesh_files.saving import SaveOptions, save
from ..meshset import native
from ..meshset.check import resolve
from ..meshset.play import Played, play
from ..messages import counted, notes_kept, notes_taken_by
from ..mlx.steps import Step
from . import lost_kernels, pages, steplog
from .jobs import Job
from .process import Phase
from .records import Saved, StepResult
from .steplog import log

if TYPE_CHECKING:
    from ..meshset.check import Call

READING = "reading"
MEASURING = "measuring"
SAVING = "saving"

Say = Callable[[Any], None]


class Note(NamedTuple):
    """A message: what was lost."""

    text: str


class Line(NamedTuple):
    """A message: a line of the log."""

    text: str


class Picture(NamedTuple):
    """A message: a PNG file of the mesh; a later one replaces it."""

    png: bytes


class Work(NamedTuple):
    """The argument of `do`.

    Attributes
    ----------
    job : Job
        What is read and written.
    steps : tuple of Step or bytes
        The script, or a pickled function of a `MeshSet`.
    source : str
        What messages call the script or function.
    force : bool
        Whether files from before the batch are replaced.
    begun : float
        When the batch began.
    is_measured, must_be_measured : bool
        Whether meshes are measured before and after, and whether it is an error if that fails.
    dry_run : bool
        Only read and check.
    is_pictured : bool
        Whether pictures of meshes are sent.
    """

    job: Job
    steps: tuple[Step, ...] | bytes
    source: str
    force: bool = False
    begun: float = 0.0
    is_measured: bool = True
    must_be_measured: bool = False
    dry_run: bool = False
    is_pictured: bool = False


class Made(NamedTuple):
    """What `do` returns: outputs, what steps returned, how many ran, and measures."""

    outputs: tuple[Saved, ...]
    returned: tuple[StepResult, ...]
    steps: int
    before: dict[str, Any] | None
    after: dict[str, Any] | None


def do(work: Work, say: Say) -> Made:
    """Do the work on a job in a process that may crash; `say` sends what happens."""

    def begin(phase: str) -> None:
        say(Phase(phase))

    with _noted(say), notes_kept() as notes:
        say(Phase(READING, _time_to_read(work.job)))
        with memory.limited(memory.reachable()):
            ms = load(work.job, is_isolated=True)
        begin(MEASURING)
        layer = pages.current_layer(ms) if work.job.page else None
        _send_picture(work, ms, say)
        with lost_kernels.noted():
            before = _measures(ms, work)
            start = time.perf_counter()
            returned, steps = _steps(work, ms, begin)
            seconds = time.perf_counter() - start
        if work.dry_run:
            return Made((), (), steps, before, None)
        begin(SAVING)
        options = SaveOptions(force=work.force, begun=work.begun)
        outputs = tuple(save_all(ms, work.job, options))
        begin(MEASURING)
        after = _measures(ms, work) if work.steps else None
        _send_picture(work, ms, say)
        pages.write_page(work.job, layer, ms, work.steps, returned, seconds, notes)
    return Made(outputs, tuple(returned), steps, before, after)


def _send_picture(work: Work, ms: pymeshlab.MeshSet, say: Say) -> None:
    if work.is_pictured and (png := pages.current_picture(ms)) is not None:
        say(Picture(png))


def _time_to_read(job: Job) -> float | None:
    """The seconds for reading the inputs of a job; no limit without any."""
    with suppress(OSError):
        return sum(map(loading.time_limit, job.sources)) or None
    return None


@contextmanager
def _noted(say: Say) -> Iterator[None]:
    """Inside, notes and lines of the log are sent."""

    class Sender(logging.Handler):
        def emit(self, record: logging.LogRecord) -> None:
            say(Line(record.getMessage()))

    sender = Sender()
    log.addHandler(sender)
    try:
        with notes_taken_by(lambda text: say(Note(text))):
            yield
    finally:
        log.removeHandler(sender)


def _steps(
    work: Work, ms: pymeshlab.MeshSet, begin: Callable[[str], None]
) -> tuple[list[StepResult], int]:
    """Run the steps; return what those returned that did return something, and how many ran."""
    if isinstance(work.steps, bytes):
        begin(work.source)
        start = time.perf_counter()
        value = pickle.loads(work.steps)(ms)
        seconds = time.perf_counter() - start
        returned = value if isinstance(value, dict) else {"value": value}
        results = [StepResult(1, work.source, seconds, steplog.for_json(returned))]
        return results if value is not None else [], 1
    calls = resolve(work.steps, work.source, [mesh.id() for mesh in ms])
    if work.dry_run:
        return [], len(calls)
    with ExitStack() as quiet:

        def before(call: Call) -> None:
            begin(f"step {call.number} ({call.known.name})")
            steplog.log_call(call, len(calls))
            quiet.enter_context(native.muted())

        def after(played: Played) -> None:
            quiet.close()
            steplog.log_result(played)

        done = play(ms, calls, work.source, before, after)
    results = [
        StepResult(p.number, p.name, p.seconds, steplog.for_json(p.returned))
        for p in done
        if p.returned
    ]
    return results, len(calls)


def _measures(ms: pymeshlab.MeshSet, work: Work) -> dict[str, Any] | None:
    """The totals of the current mesh; None if it has none."""
    if not work.is_measured or work.dry_run or ms.mesh_number() == 0:
        return None
    try:
        return steplog.for_json(measured(ms))
    except native.ERRORS:
        if work.must_be_measured:
            raise
        return None


def measured(ms: pymeshlab.MeshSet) -> dict[str, Any]:
    """How large the current mesh is, and its totals."""
    totals = ms.apply_filter("get_willmore_measures")
    mesh = ms.current_mesh()
    sizes = {"vertices": mesh.vertex_number(), "faces": mesh.face_number()}
    return {**sizes, **totals}


def warm_up(steps: tuple[Step, ...], say: Say) -> None:
    """Compile the kernels that the steps and the measures need, or load them from the cache."""
    with lost_kernels.followed():
        warm_up_filter("get_willmore_measures", {})
        for call in resolve(steps, "warm-up"):
            if call.known.is_willmore:
                ms = pymeshlab.MeshSet()
                ms.add_mesh(pymeshlab.Mesh(*dented_cube()))
                play(ms, [call])


# --- loading and saving ------------------------------------------------------------------------


def load(job: Job, is_isolated: bool = False) -> pymeshlab.MeshSet:
    """The inputs as layers of one set; the first is current, as in `meshlabserver`."""
    ms = pymeshlab.MeshSet()
    for path in job.inputs:
        if is_project(path):
            projects.load_project(ms, path, is_isolated)
            log.info("input %s (%s)", path, counted(ms.mesh_number(), "layer"))
        else:
            loading.load(ms, path, is_isolated)
            log.info("input %s (%s)", path, size(ms))
    if len(job.inputs) > 1 or any(map(is_project, job.inputs)):
        ms.set_current_mesh(0)
    return ms


def save_all(
    ms: pymeshlab.MeshSet,
    job: Job,
    options: SaveOptions,
    saving: Callable[[Path], Any] = lambda path: nullcontext(),
) -> Iterator[Saved]:
    """Save the layer of each output of a job; `saving` gives a context for each."""
    if not job.outputs:
        return
    if ms.mesh_number() == 0:
        raise OSError(f"cannot write {job.outputs[0].name}: the script leaves no mesh")
    origins = tuple(dict.fromkeys(path.parent for path in job.sources))
    layers = iter(_layers(ms, [output for output in job.outputs if not output.is_project]))
    for output in job.outputs:
        how = options._replace(
            parts=output.parts,
            is_text=output.is_text,
            is_single=output.is_single,
            origins=origins,
        )
        if output.is_project:
            files = projects.save_project(ms, output.path, how, saving)
            meshes = [*ms]
            what = counted(len(meshes), "layer")
        else:
            ms.set_current_mesh(next(layers))
            with saving(output.path):
                files = save(ms, output.path, how)
            meshes, what = [ms.current_mesh()], size(ms)
        log.info("output %s (%s)", " ".join(map(str, files)), what)
        yield Saved(
            str(output.path),
            output.path.stat().st_size,
            sum(mesh.vertex_number() for mesh in meshes),
            sum(mesh.face_number() for mesh in meshes),
        )


def _layers(ms: pymeshlab.MeshSet, outputs: Sequence[Output]) -> Sequence[int]:
    """The id of the layer for each output that is a mesh."""
    if not outputs:
        return []
    current, layers = ms.current_mesh().id(), [mesh.id() for mesh in ms]
    left = counted(len(layers), "layer")
    chosen = [output.layer for output in outputs]
    if any(chosen):
        highest = max((int(layer) for layer in chosen if layer.isdecimal()), default=0)
        if highest >= len(layers):
            raise OSError(f"there is no layer {highest}: the script leaves {left}, from 0")
        ends = {"c": current, "x": layers[-1]}
        return [ends[layer] if layer in ends else layers[int(layer)] for layer in chosen]
    if len(chosen) == 1:
        return [current]
    if len(chosen) > len(layers):
        raise OSError(f"{len(chosen)} outputs, but the script leaves {left}")
    return layers[: len(chosen)]


def size(ms: pymeshlab.MeshSet) -> str:
    """The size of the current mesh, for messages."""
    mesh = ms.current_mesh()
    return f"{mesh.vertex_number()} vertices, {mesh.face_number()} faces"

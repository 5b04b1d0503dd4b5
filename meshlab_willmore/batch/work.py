"""The work on one job: load its meshes, run the steps, measure, and save what comes out.

`run_job` is the same in a worker process, which calls it by `do`, and in the command line's own
process.
"""

from __future__ import annotations

import logging
import pickle
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, ExitStack, contextmanager, nullcontext, suppress
from typing import TYPE_CHECKING, Any, NamedTuple

import pymeshlab

from .. import memory
from ..compare.rows import warm_up as warm_up_filter
from ..demo.models import dented_cube, set_of
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
from .recipe import Recipe
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
    """What is read and written, and what is done to it.

    `force` allows to replace files from before the run. Workers of a batch may replace those that
    are newer than `begun`, when the batch began.
    """

    job: Job
    recipe: Recipe
    force: bool = False
    begun: float | None = None


class Made(NamedTuple):
    """What `run_job` returns: fields of a `Result`."""

    outputs: tuple[Saved, ...] = ()
    returned: tuple[StepResult, ...] = ()
    steps: int = 0
    before: dict[str, Any] | None = None
    after: dict[str, Any] | None = None


def do(work: Work, say: Say) -> Made:
    """Do the work on a job in a process that may crash; `say` sends what happens."""
    with _noted(say):
        made = run_job(work, say, is_isolated=True)
    returned = (one._replace(returned=steplog.for_json(one.returned)) for one in made.returned)
    return made._replace(returned=tuple(returned))


def run_job(
    work: Work,
    say: Say,
    around: Callable[[Call], AbstractContextManager[object]] = lambda call: nullcontext(),
    is_isolated: bool = False,
) -> Made:
    """Do the work on a job.

    Parameters
    ----------
    say : callable
        Called with a `Phase` for what begins, and with pictures.
    around : callable
        Gives a context for each step.
    is_isolated : bool
        Whether this process may crash. If not, files are tried in another one before, and meshes
        are only measured if they must be.
    """
    job, recipe = work.job, work.recipe
    is_measured = (is_isolated or recipe.must_be_measured) and not recipe.dry_run
    with notes_kept() as notes:
        say(Phase(READING, _time_to_read(job)))
        with memory.limited(memory.reachable() if is_isolated else None):
            ms = load(job, is_isolated)
        if is_measured:
            say(Phase(MEASURING))
        layer = pages.current_layer(ms) if job.page else None
        _send_picture(recipe, ms, say)
        with lost_kernels.noted() if is_isolated else nullcontext():
            before = _measures(ms, recipe) if is_measured else None
            returned, steps, seconds = _run_steps(recipe, ms, say, around)
        if recipe.dry_run:
            return Made(steps=steps)
        outputs = tuple(_save_all(ms, work, say))
        if is_measured:
            say(Phase(MEASURING))
        after = _measures(ms, recipe) if is_measured and recipe.steps else None
        _send_picture(recipe, ms, say)
        if job.page is not None:
            say(Phase(MEASURING, text=f"writing {job.page}"))
            pages.write_page(job, layer, ms, recipe.steps, returned, seconds, notes)
    return Made(outputs, tuple(returned), steps, before, after)


def _send_picture(recipe: Recipe, ms: pymeshlab.MeshSet, say: Say) -> None:
    if recipe.is_pictured and (png := pages.current_picture(ms)) is not None:
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


def _run_steps(
    recipe: Recipe,
    ms: pymeshlab.MeshSet,
    say: Say,
    around: Callable[[Call], AbstractContextManager[object]],
) -> tuple[list[StepResult], int, float]:
    """Run the steps; return what those returned that did, how many ran, and their seconds."""
    if isinstance(recipe.steps, bytes):
        say(Phase(recipe.source))
        start = time.perf_counter()
        value = pickle.loads(recipe.steps)(ms)
        seconds = time.perf_counter() - start
        returned = value if isinstance(value, dict) else {"value": value}
        results = [StepResult(1, recipe.source, seconds, returned)]
        return results if value is not None else [], 1, seconds
    calls = resolve(recipe.steps, recipe.source, [mesh.id() for mesh in ms])
    if recipe.dry_run:
        return [], len(calls), 0.0
    with ExitStack() as quiet:

        def before(call: Call) -> None:
            steplog.log_call(call, len(calls))
            say(Phase(f"step {call.number} ({call.known.name})"))
            quiet.enter_context(around(call))
            quiet.enter_context(native.muted())

        def after(played: Played) -> None:
            quiet.close()
            steplog.log_result(played)

        done = play(ms, calls, recipe.source, before, after)
    results = [StepResult(p.number, p.name, p.seconds, p.returned) for p in done if p.returned]
    return results, len(calls), sum(played.seconds for played in done)


def _measures(ms: pymeshlab.MeshSet, recipe: Recipe) -> dict[str, Any] | None:
    """How large the current mesh is, and its totals; None if there is none."""
    if ms.mesh_number() == 0:
        return None
    try:
        totals = ms.apply_filter("get_willmore_measures")
    except native.ERRORS:
        if recipe.must_be_measured:
            raise
        return None
    mesh = ms.current_mesh()
    sizes = {"vertices": mesh.vertex_number(), "faces": mesh.face_number()}
    return steplog.for_json({**sizes, **totals})


def warm_up(steps: tuple[Step, ...], say: Say) -> None:
    """Compile the kernels that the steps and the measures need, or load them from the cache."""
    with lost_kernels.followed():
        warm_up_filter("get_willmore_measures", {})
        for call in resolve(steps, "warm-up"):
            if call.known.is_willmore:
                play(set_of(dented_cube()), [call])


# --- loading and saving ------------------------------------------------------------------------


def load(job: Job, is_isolated: bool) -> pymeshlab.MeshSet:
    """The inputs as layers of one set; the first is current, as in `meshlabserver`."""
    ms = pymeshlab.MeshSet()
    for path in job.inputs:
        if is_project(path):
            projects.load_project(ms, path, is_isolated)
            log.info("input %s (%s)", path, counted(ms.mesh_number(), "layer"))
        else:
            loading.load(ms, path, is_isolated)
            log.info("input %s (%s)", path, _size(ms))
    if len(job.inputs) > 1 or any(map(is_project, job.inputs)):
        ms.set_current_mesh(0)
    return ms


def _save_all(ms: pymeshlab.MeshSet, work: Work, say: Say) -> Iterator[Saved]:
    """Save the layer of each output of a job."""
    job = work.job
    if not job.outputs:
        return
    say(Phase(SAVING))
    if ms.mesh_number() == 0:
        raise OSError(f"cannot write {job.outputs[0].name}: the script leaves no mesh")
    options = SaveOptions(
        force=work.force,
        begun=work.begun,
        origins=tuple(dict.fromkeys(path.parent for path in job.sources)),
        written=set(),
    )
    layers = iter(_layers(ms, [output for output in job.outputs if not output.is_project]))
    for output in job.outputs:
        say(Phase(SAVING, text=f"saving {output.path}"))
        how = options._replace(
            parts=output.parts, is_text=output.is_text, is_single=output.is_single
        )
        if output.is_project:
            files = projects.save_project(ms, output.path, how)
            meshes = [*ms]
            what = counted(len(meshes), "layer")
        else:
            ms.set_current_mesh(next(layers))
            files = save(ms, output.path, how)
            meshes, what = [ms.current_mesh()], _size(ms)
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


def _size(ms: pymeshlab.MeshSet) -> str:
    """The size of the current mesh, for messages."""
    mesh = ms.current_mesh()
    return f"{mesh.vertex_number()} vertices, {mesh.face_number()} faces"

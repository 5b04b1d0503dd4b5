"""`meshlab-willmore run`: a filter script on meshes."""

from __future__ import annotations

import time
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple

import click

from . import outputs, playing
from .columns import counted
from .errors import debug_option, one_line, wrong_use
from .masks import is_part, mask_option
from .spelling import SeveralValues

if TYPE_CHECKING:
    import pymeshlab

    from ..mlx.steps import Step
    from .jobs import Job
    from .runlog import Log

EXAMPLES = """\b
A script:
  <!DOCTYPE FilterScript>
  <FilterScript>
   <filter name="Remove Duplicate Vertices"/>
   <filter name="Willmore flipping optimization"/>
  </FilterScript>

\b
Examples:
  meshlab-willmore run clean.mlx -i scan.ply -o clean.ply
  meshlab-willmore run clean.mlx -i 'scans/*.ply' -o 'out/{name}_clean.{ext}'
  meshlab-willmore run clean.mlx -i scan.ply -o clean.obj -m vc vn wt -l log.txt
  meshlab-willmore run clean.mlx -i scan.ply -o clean.ply --set 2.stepsmoothnum=5
  meshlab-willmore run align.mlx -i a.ply b.ply --layers -o both.ply
  meshlab-willmore run makes-a-sphere.mlx -o sphere.ply
  meshlab-willmore run clean.mlx -i scan.ply -o clean.ply --dry-run
"""


class Orders(NamedTuple):
    """What the command line asks for."""

    source: str
    steps: tuple[Step, ...]
    parts: tuple[str, ...]
    force: bool
    stop: bool
    dry_run: bool


class RunCommand(SeveralValues):
    """`run`, with several values after -i and -m; a script's name is never an input."""

    several: ClassVar = {
        "-i": lambda word: not word.endswith(".mlx"),
        "--input": lambda word: not word.endswith(".mlx"),
        "-m": is_part,
        "--mask": is_part,
    }


def _placeholders() -> str:
    return ", ".join(f"{{{name}}} ({what})" for name, what in outputs.PLACEHOLDERS.items())


@click.command("run", cls=RunCommand, short_help="Run a filter script.", epilog=EXAMPLES)
@click.argument("script", required=False, metavar="SCRIPT.mlx")
@click.option("-s", "--script", "also", metavar="FILE", help="The script, as meshlabserver had it.")
@click.option(
    "-i",
    "--input",
    "inputs",
    multiple=True,
    metavar="FILE...",
    help="Meshes, or quoted patterns such as 'scans/*.ply'.",
)
@click.option(
    "-o",
    "--output",
    "patterns",
    multiple=True,
    metavar="FILE",
    help=f"Where the result goes; its ending tells the format. With {_placeholders()} in it, "
    "several inputs have an output each.",
)
@mask_option
@click.option(
    "-l", "--log", metavar="FILE", help="Add what each step did to this file; - for the terminal."
)
@click.option(
    "--set",
    "settings",
    multiple=True,
    metavar="STEP.PARAM=VALUE",
    help="Another value for a parameter; STEP is its number, or the filter's name.",
)
@click.option(
    "--layers", is_flag=True, help="All inputs are layers of one set, for filters of two meshes."
)
@click.option("--force", is_flag=True, help="Replace files that are there already.")
@click.option("--stop", is_flag=True, help="End with the first input that fails.")
@click.option("--dry-run", is_flag=True, help="Check all, read the inputs, and say what would be.")
@debug_option
def command(script: str | None, also: str | None, **given: Any) -> None:
    """Run a MeshLab filter script (.mlx) on meshes, and save what comes out.

    The whole script is checked before its first step. An output is there when it is whole, not
    before. Several inputs are run one after the other; if one fails, the others go on, and the
    exit code is 1 in the end.

    With --layers the first input is the current layer, as in meshlabserver. One -o saves the mesh
    that is current in the end; several save the first layers, in their order.

    MeshLab's window saves scripts ("Show current filter script"), and so does PyMeshLab; a short
    one stands below. 'meshlab-willmore filters' has the names, 'lint' finds what is wrong.
    """
    from . import inputs, jobs, runlog

    path = _script_of(script, also)
    orders = Orders(
        str(path),
        _steps(path, given["settings"]),
        given["parts"],
        given["force"],
        given["stop"],
        given["dry_run"],
    )
    todo = jobs.plan(
        inputs.expand(given["inputs"]), given["patterns"], given["layers"], orders.force
    )
    with runlog.opened(None if orders.dry_run else given["log"]) as log:
        log.say(f"{time.strftime('%Y-%m-%d %H:%M:%S')} run {path}")
        _run_all(orders, todo, log)


def _script_of(script: str | None, also: str | None) -> Path:
    if (script is None) == (also is None):
        raise wrong_use(
            "name the script once, such as: run clean.mlx -i scan.ply -o clean.ply"
            if script
            else "there is no script; name one, such as: run clean.mlx -i scan.ply -o clean.ply"
        )
    path = Path(script or also or "")
    if not path.is_file():
        raise wrong_use(f"there is no filter script {path}")
    return path


def _steps(path: Path, settings: Sequence[str]) -> tuple[Step, ...]:
    """The script, changed and checked as far as that is possible without meshes."""
    from ..meshset.check import faults_of
    from ..mlx.read import read
    from ..mlx.steps import ScriptError
    from .settings import with_settings

    steps = with_settings(read(path), settings)
    faults = faults_of(steps)
    if faults:
        raise ScriptError(str(path), faults)
    return steps


def _run_all(orders: Orders, todo: Sequence[Job], log: Log) -> None:
    debug = click.get_current_context().meta.get("debug", False)
    ends_at_once = len(todo) == 1 or orders.stop or debug
    failed = sum(not _succeeds(orders, job, log, ends_at_once) for job in todo)
    if failed:
        raise click.ClickException(f"{failed} of {len(todo)} inputs failed; the others are done")


def _succeeds(orders: Orders, job: Job, log: Log, ends_at_once: bool) -> bool:
    try:
        click.echo(_run_one(orders, job, log))
    except Exception as error:
        # A log that can't be written is no news beside what went wrong before.
        with suppress(OSError):
            log.say(f"error: {one_line(error)}")
        if ends_at_once or isinstance(error, ImportError):
            raise
        click.echo(f"Error: {_told(job, error)}", err=True)
        return False
    return True


def _told(job: Job, error: Exception) -> str:
    """What went wrong, with the input's name where the error has not got it."""
    text = one_line(error)
    return text if job.name in text else f"{job.name}: {text}"


def _run_one(orders: Orders, job: Job, log: Log) -> str:
    """Run the script on one set of meshes; returns a line that says what was done."""
    from ..meshset.check import resolve

    start = time.perf_counter()
    ms = _loaded(job, log)
    calls = resolve(orders.steps, orders.source, [mesh.id() for mesh in ms])
    if orders.dry_run:
        there = " and ".join(map(str, job.outputs)) or "no file"
        return f"{job.name}: fine; {counted(len(calls), 'step')} to run, then {there} to write"
    playing.play(ms, calls, orders.source, Path(job.name).name, log)
    results = _saved(ms, orders, job, log)
    seconds = time.perf_counter() - start
    return f"{job.name} -> {results}: {counted(len(calls), 'step')}, {seconds:.1f} s"


def _loaded(job: Job, log: Log) -> pymeshlab.MeshSet:
    import pymeshlab

    from .inputs import load

    ms = pymeshlab.MeshSet()
    for path in job.inputs:
        load(ms, path)
        log.say(f"input {path} ({_size(ms)})")
    if len(job.inputs) > 1:
        ms.set_current_mesh(0)
    return ms


def _size(ms: pymeshlab.MeshSet) -> str:
    mesh = ms.current_mesh()
    return f"{mesh.vertex_number()} vertices, {mesh.face_number()} faces"


def _layers(ms: pymeshlab.MeshSet) -> list[int]:
    """The ids of the layers, in the order in which the script would count them."""
    from ..meshset import layers, numbering

    return sorted(layers.visible_ids(ms), key=lambda i: numbering.logical_id(ms, i))


def _saved(ms: pymeshlab.MeshSet, orders: Orders, job: Job, log: Log) -> str:
    from .saving import Wish, save

    if not job.outputs:
        return "not saved (no -o)"
    if ms.mesh_number() == 0:
        raise OSError(f"cannot write {job.outputs[0]}: the script leaves no mesh")
    layers = _layers(ms)
    if len(job.outputs) > len(layers):
        left = counted(len(layers), "layer")
        raise OSError(f"{len(job.outputs)} outputs, but the script leaves {left}")
    origin = job.inputs[0].parent if job.inputs else None
    wish = Wish(orders.parts, orders.force, origin)
    texts = []
    for place, path in enumerate(job.outputs):
        if len(job.outputs) > 1:
            ms.set_current_mesh(layers[place])
        files = save(ms, path, wish)
        log.say(f"output {' '.join(map(str, files))} ({_size(ms)})")
        texts.append(f"{path} ({_size(ms)})")
    return ", ".join(texts)

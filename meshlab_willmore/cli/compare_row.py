"""One row of a comparison, computed in a worker process of a batch.

A native filter can't be interrupted, and may crash. Each row gets a fresh process.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from contextlib import closing
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from ..batch.pool import STARTING, PoolSettings, Seat
from ..batch.process import DONE, TIMEOUT, Phase, Task
from ..machine import core_count
from ..mesh_files import loading
from ..mesh_files.paths import check_input
from ..messages import WrongUse

if TYPE_CHECKING:
    from ..compare.reference import Reference, Sphere, Torus
    from ..compare.rows import Row

# The phases, in their order.
READING = "reading"
WARMING = "warming up"
RUNNING = "running"
MEASURING = "measuring"

REFERENCES = "sphere, sphere:2 or torus:3,1"

_COMPUTE = f"{__name__}:compute"


class Comparison(NamedTuple):
    """The mesh file, the reference surface (see `read_reference`) and the seconds for a filter."""

    source: str
    reference: str | None
    timeout: float


class Pages(NamedTuple):
    """What a row adds to a report: its own page, if there is one, and whether a picture."""

    page: Path | None = None
    is_pictured: bool = False


class Outcome(NamedTuple):
    """The result of a row."""

    # Of the filter alone; None if there was none, or it did not end.
    seconds: float | None = None
    # As `meshlab_willmore.compare.quality.Quality`.
    quality: dict[str, Any] | None = None
    # In one line; a filter that takes too long is no error.
    error: str | None = None
    # Whether the machine is at fault, not the mesh or the filter.
    of_machine: bool = False
    timed_out: bool = False
    # The traceback of an error.
    trace: str = ""
    # A PNG file, if one was asked for.
    picture: bytes = b""


class Computation(NamedTuple):
    """The argument of `compute`: what is compared, a filter and its parameters, and pages."""

    comparison: Comparison
    filter: str
    given: dict[str, Any]
    name: str = ""
    pages: Pages = Pages()


class Computed(NamedTuple):
    """What `compute` returns: the fields of an `Outcome`."""

    seconds: float | None
    quality: dict[str, Any]
    picture: bytes = b""


def run(
    comparison: Comparison, row: Row, notify: Callable[[str], None], pages: Pages | None = None
) -> Outcome:
    """Compute one row in a process of its own; `notify` is called with each phase that begins."""

    def listen(message: Any) -> None:
        if message != STARTING:
            notify(message.name)

    computation = Computation(comparison, row.filter, row.given, row.name, pages or Pages())
    task = Task(_COMPUTE, computation)
    with closing(Seat(PoolSettings(threads=core_count()))) as seat:
        ended = seat.attempt(task, listen).ended
    if ended.status == DONE:
        return Outcome(**ended.value._asdict())
    if ended.status == TIMEOUT:
        return Outcome(timed_out=True)
    return Outcome(error=ended.reason, of_machine=ended.of_machine, trace=ended.trace)


def compute(task: Computation, say: Callable[[Any], None]) -> Computed:
    """The seconds of a filter (None if there is none), and the quality of its mesh."""
    from ..batch.pages import picture
    from ..compare.quality import quality_of
    from ..compare.rows import warm_up
    from ..demo.models import surface_of

    ms = loading.loaded(Path(task.comparison.source))
    before = surface_of(ms)
    if len(before.faces) == 0:
        raise ValueError("the mesh has no faces, it is a point cloud")
    reference = task.comparison.reference
    surface = read_reference(reference) if reference else None
    seconds = None
    if task.filter:
        say(Phase(WARMING))
        warm_up(task.filter, task.given)
        say(Phase(RUNNING, task.comparison.timeout))
        start = time.perf_counter()
        ms.apply_filter(task.filter, **task.given)
        seconds = time.perf_counter() - start
    say(Phase(MEASURING))
    quality = quality_of(ms, before.faces, surface)._asdict()
    after = surface_of(ms)
    if task.pages.page is not None and task.filter:
        from ..report import page

        title = f"{Path(task.comparison.source).name}, {task.name}"
        settings = {
            "Filter": task.filter,
            **task.given,
            "Cuts, as in the table of compare": f"{quality['self_intersecting']} after, counted by "
            "MeshLab's filter for faces that intersect others",
        }
        page(before, after, task.pages.page, title=title, settings=settings, seconds=seconds)
    return Computed(seconds, quality, picture(after) if task.pages.is_pictured else b"")


# --- the reference -----------------------------------------------------------------------------


def check_reference(text: str) -> None:
    """Raise `WrongUse` unless it is the name of a surface, or a file that can be read."""
    if _named_surface(text) is None:
        try:
            check_input(Path(text))
        except WrongUse as error:
            raise WrongUse(
                f"--reference: {error} (nor is it a surface such as {REFERENCES})"
            ) from error


def read_reference(text: str) -> Reference:
    """The surface of a name, or of a file; raises `OSError` if that holds no faces."""
    from ..compare.reference import ReferenceMesh
    from ..demo.models import surface_of

    named = _named_surface(text)
    if named is not None:
        return named
    check_reference(text)
    mesh = ReferenceMesh(*surface_of(loading.loaded(Path(text))))
    if len(mesh.faces) == 0:
        raise OSError(f"{text} can't be the reference: it is a point cloud, without faces")
    return mesh


def _named_surface(text: str) -> Sphere | Torus | None:
    """The sphere or torus; None if it must be a file."""
    from ..compare.reference import Sphere, Torus

    name, colon, sizes = text.partition(":")
    if text != "sphere" and not (colon and name in ("sphere", "torus")):
        return None
    radii = [_radius(text, size) for size in sizes.split(",")] if colon else []
    if name == "sphere" and len(radii) <= 1:
        return Sphere(*radii)
    if name == "torus" and len(radii) == 2:
        return Torus(*radii)
    raise WrongUse(f"--reference {text}: it can be {REFERENCES} (ring, tube), or a file")


def _radius(text: str, size: str) -> float:
    try:
        radius = float(size)
    except ValueError:
        radius = math.nan
    if not (math.isfinite(radius) and radius > 0.0):
        raise WrongUse(f"--reference {text}: {size!r} is no radius; it can be {REFERENCES}")
    return radius

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

from ..batch.pool import PoolSettings, Seat
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
    """The mesh file, the reference surface (see `read_reference`) and the seconds for a filter.

    If `is_pictured`, outcomes have pictures.
    """

    source: str
    reference: str | None
    timeout: float
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
    """The argument of `compute`: what is compared, a row, and the page to write."""

    comparison: Comparison
    row: Row
    page: Path | None = None


def run(
    comparison: Comparison, row: Row, notify: Callable[[str], None], page: Path | None = None
) -> Outcome:
    """Compute one row in a process of its own; `notify` is called with each phase that begins."""
    task = Task(_COMPUTE, Computation(comparison, row, page))
    with closing(Seat(PoolSettings(threads=core_count()))) as seat:
        ended = seat.attempt(task, lambda phase: notify(phase.name))
    if ended.status == DONE:
        outcome: Outcome = ended.value
        return outcome
    if ended.status == TIMEOUT:
        return Outcome(timed_out=True)
    return Outcome(error=ended.reason, of_machine=ended.of_machine, trace=ended.trace)


def compute(task: Computation, say: Callable[[Any], None]) -> Outcome:
    """Apply the filter of a row, if it has one, and measure the mesh."""
    from ..batch.pages import picture
    from ..compare.quality import quality_of
    from ..compare.rows import warm_up
    from ..demo.models import surface_of

    comparison, row, page_file = task
    source = Path(comparison.source)
    ms = loading.loaded(source)
    before = surface_of(ms)
    if len(before.faces) == 0:
        raise ValueError("the mesh has no faces, it is a point cloud")
    reference = read_reference(comparison.reference) if comparison.reference else None
    seconds = None
    if row.filter:
        say(Phase(WARMING))
        warm_up(row.filter, row.given)
        say(Phase(RUNNING, comparison.timeout))
        start = time.perf_counter()
        ms.apply_filter(row.filter, **row.given)
        seconds = time.perf_counter() - start
    say(Phase(MEASURING))
    quality = quality_of(ms, before.faces, reference)._asdict()
    after = surface_of(ms)
    if page_file is not None:
        from ..report import page

        settings = {
            "Filter": row.filter,
            **row.given,
            "Cuts, as in the table of compare": f"{quality['self_intersecting']} after, counted by "
            "MeshLab's filter for faces that intersect others",
        }
        title = f"{source.name}, {row.name}"
        page(before, after, page_file, title=title, settings=settings, seconds=seconds)
    return Outcome(seconds, quality, picture=picture(after) if comparison.is_pictured else b"")


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

"""What of a batch is left to do, and what an earlier run of it has done already."""

from __future__ import annotations

import time
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from ..mesh_files.paths import check_output
from ..mesh_files.projects import check_layers
from . import records
from .jobs import Job
from .records import Result


class Left(NamedTuple):
    """A job to do, its place among all, and the stamp of its inputs before they are read."""

    job: Job
    place: int
    stamp: tuple[int, int]


class Divided(NamedTuple):
    """Jobs to do, results that still hold, and when the batch began."""

    left: list[Left]
    earlier: list[Result]
    begun: float


def divided(
    jobs: Sequence[Job], recipe: str, log: Path | None, retry_failed: bool, force: bool
) -> Divided:
    """Divide jobs by the records of an earlier run; without such a `log`, all are left.

    Raises `WrongUse` if an output exists that is not of this batch, unless `force` is given.
    """
    known = records.Earlier({}, {}) if log is None else records.read(log)
    found = Divided([], [], known.begun.get(recipe, time.time()))
    for place, job in enumerate(jobs):
        outputs = [str(output.path) for output in job.outputs]
        stamp = records.stamp(job.sources)
        settled = known.settles(job.name, recipe, stamp, outputs)
        if settled is not None and (settled.is_done or not retry_failed):
            found.earlier.append(settled._replace(place=place))
        else:
            found.left.append(Left(job, place, stamp))
    if log is not None:
        _check_outputs(found, force)
    return found


def _check_outputs(found: Divided, force: bool) -> None:
    def is_own(path: Path) -> bool:
        return path.exists() and path.stat().st_mtime >= found.begun

    for one in found.left:
        for output in one.job.outputs:
            check_output(output.path, force or is_own(output.path))
            if output.is_project and not force:
                check_layers(output.path, is_own)

"""One job of `run`, `flip` or `measure` in this process, while its progress is shown."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext, suppress
from pathlib import Path
from typing import TYPE_CHECKING

import click

from ..batch.process import DONE, Phase
from ..batch.steplog import log
from ..machine import fault_of, stops_all
from ..messages import one_line, reason
from ..options import FILTER
from ..signals import killable
from . import progress
from .errors import is_debug

if TYPE_CHECKING:
    from ..batch.jobs import Job
    from ..batch.recipe import Recipe
    from ..batch.records import Result
    from ..meshset.check import Call


def run_here(recipe: Recipe, job: Job, force: bool, has_script: bool) -> Result:
    """Do a job; an error is logged, and names the input if there is no script that it names."""
    try:
        return _run(recipe, job, force)
    except Exception as error:
        # This error is more important than one of the log.
        with suppress(OSError):
            log.info("error: %s", one_line(error))
        text = reason(error).removeprefix(f"{recipe.source}, step 1 ({FILTER}): ")
        is_of_machine = fault_of(error) is not None or stops_all(error)
        if has_script or is_of_machine or is_debug() or job.name in text:
            raise
        raise click.ClickException(f"{job.name}: {text}") from error


def _run(recipe: Recipe, job: Job, force: bool) -> Result:
    from ..batch import work
    from ..batch.records import Result

    start = time.perf_counter()
    with progress.shown(Path(job.name).name, len(recipe.steps)) as status:

        def say(phase: Phase) -> None:
            if phase.name == work.SAVING:
                status.end()
            status.begin(phase.text or phase.name)

        @contextmanager
        def around(call: Call) -> Iterator[None]:
            status.next(call.known.name)
            # No output is begun before the last step has ended: native ones can be killed.
            is_ours = call.known.is_willmore
            with progress.with_details(status, is_part=True) if is_ours else killable():
                yield

        with progress.with_details(status) if recipe.must_be_measured else nullcontext():
            made = work.run_job(work.Work(job, recipe, force), say, around)
    return Result(job.name, DONE, seconds=time.perf_counter() - start, **made._asdict())

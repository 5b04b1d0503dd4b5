"""Running a batch: in Python `run`, and for the command line `Batch`."""

from __future__ import annotations

import logging
import os
import socket
import threading
import time
import warnings
from collections.abc import Callable, Generator, Iterable, Iterator, Sequence
from contextlib import ExitStack, closing, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from .. import memory
from ..files import place_of
from ..machine import MachineError, MachineWarning, core_count
from ..mesh_files.paths import Output, find_inputs
from ..messages import WrongUse, one_line
from ..numba_settings import check_variables
from ..progress import Listen, Listener
from . import records
from .cluster import Cluster
from .jobs import Job, check_apart, plan, reports_of
from .pages import write_table
from .pool import RENEWED_AFTER, Pool, PoolSettings, remove_stale
from .process import CRASH, DONE, ERROR, MEMORY, TIMEOUT, Ended, Task
from .recipe import Recipe, Script, described, recipe_of
from .records import BAD_FILE, Records, Result
from .resuming import divided
from .shards import shard_of
from .work import READING, Line, Made, Note, Picture, Work

if TYPE_CHECKING:
    from distributed import Client

_log = logging.getLogger(__name__)

_WORK = "meshlab_willmore.batch.work:do"
_WARM_UP = "meshlab_willmore.batch.work:warm_up"
# A worker itself takes a good part of that.
LEAST_MEMORY = 2**28


class BatchOptions(NamedTuple):
    """How a batch is run; the parameters of `run` describe the fields."""

    workers: int | None = None
    timeout: float | None = None
    memory: int | None = None
    retries: int = 0
    force: bool = False
    log: Path | None = None
    resume: bool = False
    retry_failed: bool = False
    stop: bool = False
    client: Client | None = None
    renewed_after: int = RENEWED_AFTER
    # The page with a table of all, which is written in the end.
    table: Path | None = None


def run(
    script: Script,
    inputs: str | os.PathLike[str] | Iterable[str | os.PathLike[str]],
    output: str | os.PathLike[str] | None = None,
    *,
    workers: int | None = None,
    timeout: float | None = None,
    memory: int | None = None,
    retries: int = 0,
    force: bool = False,
    log: str | os.PathLike[str] | None = None,
    resume: bool = False,
    retry_failed: bool = False,
    stop: bool = False,
    shard: str | None = None,
    client: Client | None = None,
    renewed_after: int = RENEWED_AFTER,
    report: str | os.PathLike[str] | None = None,
    progress: Listen | None = None,
) -> Iterator[Result]:
    """Run a script on many meshes, in worker processes that may crash.

    Parameters
    ----------
    script : path, iterable of Step, or callable
        A filter script, its steps, or a function that gets a `pymeshlab.MeshSet` with the mesh and
        changes it; what it returns is recorded.
    inputs : path, pattern, or iterable of these
        Meshes. ``**`` in a pattern goes through folders.
    output : path, optional
        The output of each input: a name with placeholders such as ``out/{dir}/{name}.ply``.
        Nothing is saved without it.
    workers : int, optional
        How many meshes are processed at the same time; as many as there are cores if left out.
    timeout : float, optional
        The most seconds for a mesh.
    memory : int, optional
        The most bytes that a worker may use. Only some systems can limit it.
    retries : int
        How often a mesh that fails is done again.
    force : bool
        Overwrite files that existed before.
    log : path, optional
        A file that gets a line of JSON for each mesh as it ends.
    resume, retry_failed : bool
        Go on with the batch in `log`: leave out what is done, and what failed unless it is to be
        retried.
    stop : bool
        Stop at the first mesh that fails.
    shard : str, optional
        Only this share of the inputs, such as "3/32"; "auto" is what SLURM's or Kubernetes'
        variables say.
    client : distributed.Client, optional
        Run on its Dask cluster; then `workers` is the cluster's.
    renewed_after : int
        A worker is replaced after so many meshes.
    report : path, optional
        A page for a browser, with a table of all meshes, that is written in the end, also where the
        caller ends the batch. With a placeholder, such as ``pages/{name}.html``, each mesh gets a
        page of its own instead. With a `shard` the name of a table needs ``{shard}``, which becomes
        the share's number.
    progress : callable, optional
        Called with the fraction of the meshes that are done (without those that `resume` leaves
        out) and a text with their names: after each result that was taken, twice a second while
        workers are busy (not with `client`), and last with exactly 1, unless `stop` ends the
        batch. If it returns False, or raises an exception, the batch ends as by Ctrl-C: `log` has
        all that was done.

    Yields
    ------
    Result
        For each mesh as it ends. What is left out by `resume` is not among them.

    Raises
    ------
    ScriptError
        The script has faults.
    ValueError
        Inputs and outputs don't fit together, an output exists already, or a number is wrong.
    OSError
        Outputs can't be written.
    Cancelled
        If `progress` returns False.
    """
    listener = None if progress is None else Listener(progress)
    recipe = recipe_of(script)
    names = [inputs] if isinstance(inputs, (str, os.PathLike)) else list(inputs)
    if not names:
        # Without an input the command `run` does the script once, on no mesh.
        if listener is not None:
            listener.end()
        return
    outputs = [] if output is None else [Output(os.fspath(output))]
    share = None if shard is None else shard_of(shard)
    is_continued = resume or retry_failed
    pages = [] if report is None else [os.fspath(report)]
    page, table = reports_of(pages, True, force, share, is_continued)
    jobs = plan(
        find_inputs([os.fspath(name) for name in names], takes_projects=True),
        outputs,
        False,
        force,
        share,
        page,
        is_continued=is_continued,
    )
    options = BatchOptions(
        workers=workers,
        timeout=timeout,
        memory=memory,
        retries=retries,
        force=force,
        log=None if log is None else Path(log),
        resume=is_continued,
        retry_failed=retry_failed,
        stop=stop,
        client=client,
        renewed_after=renewed_after,
        table=table,
    )
    own = [(table, "the table of the report"), (options.log, "the log")]
    check_apart([*(use for job in jobs for use in job.uses), *own])
    with closing(Batch(recipe, jobs, options)) as batch:
        yield from batch.results(listener)


class Batch:
    """The jobs of a batch that are left to do, and what was done earlier.

    Attributes
    ----------
    earlier : list of Result
        What stays as an earlier run has left it.
    """

    def __init__(self, recipe: Recipe, jobs: Sequence[Job], options: BatchOptions) -> None:
        _check(options)
        self._recipe = recipe._replace(is_pictured=options.table is not None)
        self._options = options
        self._all_jobs = jobs
        self._hash = records.recipe_of(*described(recipe), *_manners(jobs))
        if options.log is not None:
            records.check(options.log, options.resume, options.force)
        log = options.log if options.resume else None
        self._left, self.earlier, self._begun = divided(
            jobs, self._hash, log, options.retry_failed, options.force
        )
        if options.resume and not recipe.dry_run:
            remove_stale({output.path.parent for one in self._left for output in one.job.outputs})
        self._pool: Pool[int] | None = None
        # The results that the table shows.
        self._shown = [*self.earlier]
        # How many results were taken.
        self._done = 0

    @property
    def count(self) -> int:
        """How many jobs `results` does."""
        return len(self._left)

    @property
    def running(self) -> list[tuple[str, str]]:
        """The names of what is processed at the moment, and the phase that each is in."""
        now = list(self._pool.running.values()) if self._pool is not None else []
        return [(self._left[key].job.name, phase) for key, phase in now]

    def close(self) -> None:
        """End all workers at once, and write the table."""
        if self._pool is not None:
            self._pool.close()
        if self._options.table is not None:
            write_table(self._options.table, self._recipe.source, self._all_jobs, self._shown)

    def results(self, listener: Listener | None = None) -> Generator[Result, None, None]:
        """Do the jobs; give the result of each as it ends, when that is recorded.

        Raises `MachineError` where all others would fail in the same way.
        """
        log = None if self._recipe.dry_run else self._options.log
        with ExitStack() as stack:
            if log is not None:
                own = stack.enter_context(closing(Records(log, self._hash)))
                stack.callback(self._record_left_over, own)
            for result in self._results(lambda: self._hear(listener)):
                if log is not None:
                    own.add(result)
                _log.info("%s: %s, %.3f s", result.input, result.status, result.seconds)
                if self._options.table is not None:
                    self._shown.append(result)
                yield result
                if self._options.stop and not result.is_done:
                    return
                self._done += 1
                self._hear(listener, f"{result.input}: {result.status}")
            if listener is not None:
                listener.end()

    def _hear(self, listener: Listener | None, *last: str) -> None:
        """Let a listener hear how many meshes are done, the last one, and what is being done."""
        if listener is not None:
            done = f"{self._done} of {self.count} meshes"
            now = [f"{name}: {phase}" for name, phase in self.running]
            listener.hear(self._done / self.count, ", ".join([done, *last, *now]))

    def _record_left_over(self, own: Records) -> None:
        """Record what has ended meanwhile, where the caller takes no more results."""
        for key, ended in self._pool.left_over() if self._pool is not None else ():
            # Why the caller stops is more important than an error of the log.
            with suppress(OSError):
                own.add(self._result(key, ended))

    def _results(self, tick: Callable[[], object]) -> Iterator[Result]:
        check_variables()
        tasks = []
        for key, (job, _, _) in enumerate(self._left):
            if job.problem is None:
                tasks.append((key, self._task(job)))
            else:
                ended = Ended(ERROR, reason=one_line(job.problem), phase=READING)
                yield self._result(key, ended)
        if not tasks:
            return
        tick()
        for key, ended in self._engine(len(tasks)).ended(tasks, tick):
            if ended.stops_all:
                raise MachineError(ended.reason)
            yield self._result(key, ended)

    def _engine(self, count: int) -> Pool[int] | Cluster[int]:
        options, recipe = self._options, self._recipe
        steps = recipe.steps if not isinstance(recipe.steps, bytes) else ()
        settings = PoolSettings(
            retries=options.retries,
            renewed_after=options.renewed_after,
            # For lack of memory, the compiler may hang.
            warm_up=None if recipe.dry_run else Task(_WARM_UP, steps, is_limited=False),
            memory=options.memory,
        )
        if options.client is not None:
            return Cluster(options.client, settings._replace(folder=os.getcwd()))
        workers = min(options.workers or core_count(), count)
        threads = max(1, core_count() // workers)
        self._pool = Pool(settings._replace(workers=workers, threads=threads))
        return self._pool

    def _task(self, job: Job) -> Task:
        work = Work(job, self._recipe, self._options.force, self._begun)
        folders = tuple({str(place_of(output.path).parent) for output in job.outputs})
        return Task(_WORK, work, self._options.timeout, folders)

    def _result(self, key: int, ended: Ended) -> Result:
        (job, place, stamp), heard = self._left[key], ended.messages
        made = ended.value if ended.status == DONE else Made()
        is_replaced = ended.status == DONE and job.is_in_place
        size, modified = records.stamp(job.sources) if is_replaced else stamp
        status, reason = self._outcome(job, ended)
        return Result(
            job.name,
            status,
            **made._asdict(),
            step="" if status == DONE else ended.phase,
            reason=reason,
            seconds=ended.seconds,
            memory=ended.memory,
            attempts=ended.attempts,
            notes=tuple(message.text for message in heard if isinstance(message, Note)),
            size=size,
            modified=modified,
            recipe=self._hash,
            versions=records.versions(),
            host=ended.host or socket.gethostname(),
            ended=time.strftime("%Y-%m-%d %H:%M:%S"),
            trace=ended.trace,
            lines=tuple(message.text for message in heard if isinstance(message, Line)),
            picture=next((one.png for one in reversed(heard) if isinstance(one, Picture)), b""),
            place=place,
        )

    def _outcome(self, job: Job, ended: Ended) -> tuple[str, str]:
        """The status of a job and the reason: a failure in reading is the file's, if no limit's."""
        limits = {TIMEOUT: self._options.timeout, MEMORY: self._options.memory}
        is_limit = limits.get(ended.status) is not None
        if ended.phase != READING or ended.status == DONE or ended.of_machine or is_limit:
            return ended.status, ended.reason
        what = ended.reason
        if ended.status == CRASH:
            signal = ended.reason.removeprefix("crashed ")
            what = f"PyMeshLab crashes on it {signal}; the file is damaged, or ends early"
        elif ended.status == TIMEOUT:
            what = f"PyMeshLab does {ended.reason.replace('finished', 'finish')}"
        elif ended.status == ERROR:
            return BAD_FILE, what
        return BAD_FILE, f"cannot read {job.name}: {what}"


def _check(options: BatchOptions) -> None:
    """Raise `WrongUse` for a number that makes no sense."""
    for name, value, least in (
        ("workers", options.workers, 1),
        ("retries", options.retries, 0),
        ("renewed_after", options.renewed_after, 1),
        ("memory", options.memory, LEAST_MEMORY),
    ):
        if value is not None and value < least:
            raise WrongUse(f"{name} is {value}, but must be {least} or more")
    if options.memory is not None and not memory.can_limit():
        warnings.warn(
            "this system can't limit the memory of a process: the limit has no effect",
            MachineWarning,
            stacklevel=2,
        )
    if options.timeout is not None and not 0.0 < options.timeout <= threading.TIMEOUT_MAX:
        raise WrongUse(f"timeout is {options.timeout:g}, which is no number of seconds to wait")
    if options.resume and options.log is None:
        raise WrongUse(
            "to go on with a batch its log is needed: the file with a line for each mesh"
        )


def _manners(jobs: Sequence[Job]) -> list[tuple[Any, ...]]:
    """How outputs are saved: all but their names, in an order that is always the same."""
    return sorted({output[1:] for job in jobs for output in job.outputs})

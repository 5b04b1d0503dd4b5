"""The jobs of a batch: which inputs are read together, and where their results are written."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

from ..files import is_stream, writable_folder
from ..mesh_files.paths import (
    Input,
    NoMatchError,
    Output,
    check_format,
    check_output,
    check_place,
)
from ..mesh_files.projects import check_layers, files_of, project_of
from ..messages import WrongUse
from .shards import Shard

# What report pages have among their first bytes.
_GENERATOR = b'<meta name="generator" content="meshlab_willmore '
_ENOUGH = 2048


class Job(NamedTuple):
    """One run of the script on its input, or on several as layers; why it can't be read.

    One output is for the layer that is current in the end, several are for the first layers. The
    report page is for the first input and its result.
    """

    inputs: tuple[Path, ...]
    outputs: tuple[Output, ...]
    problem: WrongUse | None = None
    page: Path | None = None

    @property
    def sources(self) -> tuple[Path, ...]:
        """The inputs, and the meshes that projects among them name."""
        return tuple(file for path in self.inputs for file in files_of(path))

    @property
    def files(self) -> tuple[Path, ...]:
        """All files that are read or written, as far as their names are known."""
        outputs = [output.path for output in self.outputs]
        materials = (path.with_name(f"{path.name}.mtl") for path in outputs)
        pages = [] if self.page is None else [self.page]
        return (*self.sources, *outputs, *materials, *pages)

    @property
    def uses(self) -> Iterator[tuple[Path | None, str]]:
        """The files that are written, and what messages call them."""
        yield from ((output.path, f"the output of {self.name}") for output in self.outputs)
        yield self.page, f"the page of {self.name}"

    @property
    def is_in_place(self) -> bool:
        """Whether a result replaces an input."""
        inputs = set(map(_identity, self.inputs))
        return any(_identity(output.path) in inputs for output in self.outputs)

    @property
    def name(self) -> str:
        """What messages call it."""
        return ", ".join(map(str, self.inputs)) or "no input"


def plan(
    inputs: Sequence[Input],
    outputs: Sequence[Output],
    layers: bool,
    force: bool,
    shard: Shard | None = None,
    page: Output | None = None,
    makes_folders: bool = True,
    is_continued: bool = False,
) -> list[Job]:
    """Divide inputs and outputs into jobs, and check every output as `check_output` does.

    Folders with a placeholder in their name are made, if that is wanted. An input that can't be
    read has a job without outputs; the others go on. Only the jobs of the shard are returned, and
    only their files checked: those of other shards may have been written already. Each job has a
    report page if one is given. Where an earlier batch goes on (`is_continued`), its outputs and
    report pages may exist, but no other file may have the name of a page. Raises `WrongUse` if
    inputs and outputs don't fit together.
    """
    planned = list(_jobs(inputs, outputs, layers, page))
    _check_distinct(planned, [path for path, _ in inputs] if len(planned) > 1 else ())
    jobs = [job for job in planned if shard is None or shard.has(job.name)]
    for job in jobs:
        for output, pattern in zip(job.outputs, outputs, strict=False):
            if _has_folder(job, output.path, pattern, makes_folders):
                check_output(output.path, force or is_continued)
                if output.is_project and not (force or is_continued):
                    check_layers(output.path)
            else:
                check_format(output.path)
        if page is None or job.page is None:
            continue
        if _has_folder(job, job.page, page, makes_folders):
            _check_page(job.page, force, is_continued, "{name}.html")
    return jobs


class Reports(NamedTuple):
    """The page of each mesh, a pattern if there are several; and the page of all."""

    page: Output | None = None
    table: Path | None = None


def reports_of(
    names: Sequence[str],
    is_several: bool,
    force: bool,
    shard: Shard | None = None,
    is_continued: bool = False,
) -> Reports:
    """The pages for names of which one can have a placeholder.

    With `is_several` there may be several meshes: then a name without a placeholder is that of
    their table, as it always is beside one with a placeholder. Raises `WrongUse` if a table can't
    be written (see `_check_page`), has the same name as those of the other shares, or is named
    twice; a name with a placeholder is checked by `plan`.
    """
    page, table = None, None
    is_several = is_several or len(names) > 1
    for name in names:
        output = Output(name if shard is None else shard.in_name(name))
        is_table = is_several and not output.has_placeholder
        if (table if is_table else page) is not None:
            what = "the table of all meshes" if is_table else "the page of a mesh"
            raise WrongUse(f"--report {name}: {what} has a name already; name it once")
        if is_table:
            if shard is not None:
                shard.check_table(name)
            _check_page(output.path, force, is_continued)
            table = output.path
        else:
            page = output
    return Reports(page, table)


def _check_page(path: Path, force: bool, is_continued: bool, example: str = "report.html") -> None:
    """Raise `WrongUse` as `check_place`; a batch that goes on may replace report pages only."""
    check_place(path, force or (is_continued and _is_page(path)), example)


def _is_page(path: Path) -> bool:
    """Whether a file is a report page of this package."""
    try:
        with path.open("rb") as file:
            return _GENERATOR in file.read(_ENOUGH)
    except OSError:
        return False


def _has_folder(job: Job, path: Path, pattern: Output, makes_folders: bool) -> bool:
    """Make the folder of an output, if that is wanted; return whether it is there."""
    if "{" not in os.path.dirname(pattern.name):
        return True
    fixed = _fixed_part(pattern.name)
    _check_folder(job, path, fixed)
    if fixed.is_dir() and makes_folders:
        writable_folder(path.parent)
    elif fixed.is_dir() and not path.parent.exists():
        # It would be made.
        writable_folder(fixed)
        return False
    return True


def _check_folder(job: Job, path: Path, fixed: Path) -> None:
    """Raise `WrongUse` unless the folder of an output is in the folder `fixed`."""
    if not fixed.exists():
        raise WrongUse(f"cannot write {path}: the folder {fixed} does not exist")
    # Without such a folder, as in {dir}/{name}_clean.ply, outputs are beside their inputs.
    is_inside = (
        fixed == Path() or Path(os.path.abspath(fixed)) in Path(os.path.abspath(path)).parents
    )
    if not is_inside:
        raise WrongUse(
            f"the result of {job.name} would be written to {path}, outside of {fixed}; name the "
            "inputs with their whole paths, or start in a folder above them"
        )


def _fixed_part(pattern: str) -> Path:
    """The folder that is the same for all inputs."""
    return Path(os.path.dirname(pattern.partition("{")[0]) or ".")


def _jobs(
    inputs: Sequence[Input], outputs: Sequence[Output], layers: bool, page: Output | None
) -> Iterator[Job]:
    def page_of(path: Path, index: int) -> Path | None:
        return None if page is None else page.of(path, index).path

    if not inputs:
        for output in outputs:
            if output.has_placeholder:
                raise WrongUse(f"-o {output.name}: there is no input to take a name from")
        yield Job((), tuple(output.of(Path(), 1) for output in outputs))
    elif layers or len(inputs) == 1:
        for _, problem in inputs:
            if problem is not None:
                raise problem
        paths = tuple(path for path, _ in inputs)
        filled = tuple(output.of(paths[0], 1) for output in outputs)
        yield Job(paths, filled, page=page_of(paths[0], 1))
    elif len(outputs) > 1 or (outputs and not outputs[0].has_placeholder):
        raise WrongUse(
            f"{len(inputs)} inputs need one -o with a placeholder, such as "
            "-o '{name}_flipped.ply'; with --layers they become the layers of one set"
        )
    else:
        index = 0
        for path, problem in inputs:
            # A file keeps its number, whatever is wrong with those before it.
            index += not isinstance(problem, NoMatchError)
            filled = () if problem else tuple(output.of(path, index) for output in outputs)
            yield Job((path,), filled, problem, None if problem else page_of(path, index))


def _check_distinct(jobs: Sequence[Job], inputs: Iterable[Path]) -> None:
    """Raise `WrongUse` if two outputs have one name, or one that of an input yet to be read.

    The names of all layers that a project may have are its own. An input may be replaced by its own
    result.
    """
    projects = {
        _identity(output.path.with_suffix("")): (job, output.path)
        for job in jobs
        for output in job.outputs
        if output.is_project
    }
    readers = {_identity(path): path for path in inputs}
    for path in readers.values():
        writer, _ = projects.get(_project_key(path), (None, None))
        if writer is not None and writer.inputs[0] != path:
            raise WrongUse(f"the result of {writer.name} would replace the input {path}")
    writers: dict[str, Job] = {}
    for job in jobs:
        source = job.inputs[0] if job.inputs else Path("the script's own mesh")
        pages = [] if job.page is None else [job.page]
        for path in [*(output.path for output in job.outputs), *pages]:
            key = _identity(path)
            other = writers.get(key)
            if other is job:
                raise WrongUse(f"{path} is named twice as an output; name it once")
            if other is not None:
                raise _clash(other.inputs[0], source, path)
            if readers.get(key, source) != source:
                raise WrongUse(f"the result of {source} would replace the input {path}")
            if (project := projects.get(_project_key(path))) is not None:
                raise WrongUse(f"{path} may become a layer of {project[1]}; use another name")
            writers[key] = job


def check_apart(
    uses: Iterable[tuple[Path | None, str]], cure: str = "use another name for one"
) -> None:
    """Raise `WrongUse` if a file has two uses; streams and None can have many."""
    known: dict[str, str] = {}
    for path, use in uses:
        if path is None or is_stream(path):
            continue
        other = known.setdefault(_identity(path), use)
        if other != use:
            raise WrongUse(f"{path} would be both {use} and {other}; {cure}")


def _project_key(file: Path) -> str:
    """The key of the project that may save a layer as this file; empty without one."""
    project = project_of(file)
    return "" if project is None else _identity(project)


def _clash(first: Path, second: Path, output: Path) -> WrongUse:
    """The error for two inputs with one output; it names placeholders that tell them apart."""
    if first == second:
        return WrongUse(
            f"{first} is named twice as an input; name it once, or use {{index}} in the output's "
            "name"
        )
    parts = {
        "{name}": first.stem != second.stem,
        "{ext}": first.suffix != second.suffix,
        "{dir}": first.parent != second.parent,
        "{index}": True,
    }
    useful = " or ".join(part for part, differs in parts.items() if differs)
    return WrongUse(
        f"{first} and {second} would both be written to {output}; use {useful} in the name"
    )


def _identity(path: Path) -> str:
    return os.path.normcase(os.path.realpath(path))

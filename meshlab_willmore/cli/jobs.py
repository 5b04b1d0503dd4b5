"""What a `run` has to do: which inputs make which outputs."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

from .errors import WrongUse, wrong_use
from .inputs import Input, NoMatchError
from .outputs import check_distinct, check_target, has_placeholder, name_for


class Job(NamedTuple):
    """One run of the script.

    Attributes
    ----------
    inputs : tuple of Path
        The layers, in their order; none if the script makes its own mesh.
    outputs : tuple of Path
        One: the current mesh in the end. Several: the first layers, in their order.
    refusal : WrongUse or None
        Why there is nothing to run it on.
    """

    inputs: tuple[Path, ...]
    outputs: tuple[Path, ...]
    refusal: WrongUse | None = None

    @property
    def files(self) -> tuple[Path, ...]:
        """All that is read or written, as far as its name is known."""
        materials = (path.with_name(f"{path.name}.mtl") for path in self.outputs)
        return (*self.inputs, *self.outputs, *materials)

    @property
    def name(self) -> str:
        """What messages call it."""
        return ", ".join(map(str, self.inputs)) or "no input"


def plan(inputs: Sequence[Input], patterns: Sequence[str], layers: bool, force: bool) -> list[Job]:
    """Share inputs and outputs out, and check every output.

    An input that can't be read has a job of its own, without outputs; the others go on.

    Raises
    ------
    WrongUse
        If they don't fit together, the only set of inputs can't be read, or an output can't be
        right.
    OSError
        If a folder can't be written into.
    """
    jobs = _shared_out(inputs, patterns, layers)
    results = [
        (output, job.inputs[0] if job.inputs else Path("the script's own mesh"))
        for job in jobs
        for output in job.outputs
    ]
    check_distinct(results, [path for path, _ in inputs] if len(jobs) > 1 else ())
    for output, _ in results:
        check_target(output, force)
    return jobs


def _shared_out(inputs: Sequence[Input], patterns: Sequence[str], layers: bool) -> list[Job]:
    if not inputs:
        return [Job((), tuple(_own_name(pattern) for pattern in patterns))]
    if layers or len(inputs) == 1:
        for _, refusal in inputs:
            if refusal is not None:
                raise refusal
        paths = tuple(path for path, _ in inputs)
        return [Job(paths, tuple(name_for(p, paths[0], 1) for p in patterns))]
    if len(patterns) > 1 or (patterns and not has_placeholder(patterns[0])):
        raise wrong_use(
            f"{len(inputs)} inputs need one -o with a placeholder, such as "
            "-o '{name}_flipped.ply'; with --layers they become the layers of one set"
        )
    return list(_one_by_one(inputs, patterns))


def _one_by_one(inputs: Sequence[Input], patterns: Sequence[str]) -> Iterator[Job]:
    index = 0
    for path, refusal in inputs:
        # A file keeps its number, whatever is wrong with those before it.
        index += not isinstance(refusal, NoMatchError)
        outputs = () if refusal else tuple(name_for(pattern, path, index) for pattern in patterns)
        yield Job((path,), outputs, refusal)


def _own_name(pattern: str) -> Path:
    if has_placeholder(pattern):
        raise wrong_use(f"-o {pattern}: there is no input to take a name from")
    return name_for(pattern, Path(), 1)

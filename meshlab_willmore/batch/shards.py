"""Shares of a batch for independent runs: SLURM arrays, Kubernetes indexed jobs, several machines.

An input's share depends on its name alone. So runs that start at different times, and see other
files that have come meanwhile, never do the same input, and leave none out.
"""

from __future__ import annotations

import hashlib
import os
import re
from collections.abc import Mapping
from pathlib import PurePath
from typing import NamedTuple

from ..messages import WrongUse

AUTO = "auto"
_PATTERN = re.compile(r"(\d+)/(\d+)")
# The number of the share in the name of a report; a brace itself is written twice.
_PLACEHOLDER = re.compile(r"(?<!\{)\{shard\}(?!\})")
_SLURM = "SLURM_ARRAY_TASK_"
_KUBERNETES = ("JOB_COMPLETION_INDEX", "JOB_COMPLETIONS")


class Shard(NamedTuple):
    """One share, from 1, and how many there are."""

    number: int
    of: int

    def has(self, name: str) -> bool:
        """Whether an input belongs to this share."""
        # Checksums differ in few bits for names such as 1.ply and 2.ply, and leave shares empty.
        digest = hashlib.sha256(os.fsencode(name)).digest()
        return int.from_bytes(digest, "big") % self.of == self.number - 1

    def in_name(self, name: str) -> str:
        """The name with this share's number in place of ``{shard}``."""
        return _PLACEHOLDER.sub(str(self.number), name)

    def check_table(self, name: str) -> None:
        """Raise `WrongUse` if all shares would write their tables to the same file."""
        if self.in_name(name) == name:
            path = PurePath(name)
            example = path.with_name(f"{path.stem}-{{shard}}{path.suffix}")
            raise WrongUse(
                f"{name} would be the table of each share, and the last one would replace the "
                f"others; write the share's number into the name, such as '{example}'"
            )


def shard_of(text: str, environment: Mapping[str, str] | None = None) -> Shard:
    """The share for ``i/n``, or for "auto" the one that SLURM's or Kubernetes' variables name.

    Raises
    ------
    WrongUse
        It is neither, or variables are missing or are no numbers.
    """
    if text == AUTO:
        return _from_variables(os.environ if environment is None else environment)
    found = _PATTERN.fullmatch(text)
    shard = Shard(int(found[1]), int(found[2])) if found else Shard(0, 0)
    if not 1 <= shard.number <= shard.of:
        raise WrongUse(f"--shard {text}: it must be I/N with I from 1 to N, such as 3/32, or auto")
    return shard


def _from_variables(environment: Mapping[str, str]) -> Shard:
    def number(name: str, default: str | None = None) -> int:
        value = environment.get(name, default)
        if value is None or not value.isdigit():
            what = "is not set" if value is None else f"is {value!r}, which is no number"
            raise WrongUse(f"--shard auto: the variable {name} {what}; give --shard I/N")
        return int(value)

    if f"{_SLURM}ID" in environment:
        first, step = number(f"{_SLURM}MIN", "0"), number(f"{_SLURM}STEP", "1")
        place = (number(f"{_SLURM}ID") - first) // max(step, 1)
        return Shard(place + 1, number(f"{_SLURM}COUNT"))
    index, count = _KUBERNETES
    if index in environment:
        shard = Shard(number(index) + 1, number(count))
        if shard.number > shard.of:
            raise WrongUse(f"--shard auto: {index} is {shard.number - 1}, but {count} {shard.of}")
        return shard
    raise WrongUse(
        f"--shard auto: there is neither {_SLURM}ID (SLURM) nor {index} (Kubernetes); give "
        "--shard I/N"
    )

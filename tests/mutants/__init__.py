"""Faults, planted one at a time, which tests must find; see `python -m tests.mutants --help`."""

from typing import NamedTuple


class Fault(NamedTuple):
    """`old`, which `file` of the package has once, becomes `new`; one of `tests` must fail."""

    name: str
    file: str
    old: str
    new: str
    tests: str

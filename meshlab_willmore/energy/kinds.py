"""The energies of `meshlab_willmore.energy.table` with their kernels."""

import importlib
from collections.abc import Callable
from typing import NamedTuple

from .table import ENERGIES


class Kind(NamedTuple):
    """A row of `ENERGIES`, and the jitted functions of its module."""

    cost_reduction: Callable
    total: Callable
    is_potential: bool
    length_power: int
    least: float
    is_wide: bool


def _kind(energy):
    kernels = importlib.import_module(f".{energy.module}", __package__)
    _, _, *properties = energy
    return Kind(kernels.cost_reduction, kernels.total, *properties)


KINDS = {name: _kind(energy) for name, energy in ENERGIES.items()}

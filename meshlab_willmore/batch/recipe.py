"""What a batch does to each mesh: the steps of a script, or a function."""

from __future__ import annotations

import inspect
import os
import pickle
from collections.abc import Callable, Iterable
from typing import Any, NamedTuple

import pymeshlab

from ..messages import WrongUse, one_line
from ..mlx.steps import ScriptError, Step
from ..script import examined

Script = str | os.PathLike[str] | Iterable[Step] | Callable[[pymeshlab.MeshSet], Any]


class Recipe(NamedTuple):
    """What is done to each mesh: steps, or a pickled function, and what messages call them."""

    steps: tuple[Step, ...] | bytes
    source: str
    must_be_measured: bool = False
    dry_run: bool = False
    is_pictured: bool = False


def recipe_of(script: Script) -> Recipe:
    """What a script or a function does to each mesh; raises `ScriptError` for a faulty script."""
    if callable(script):
        import cloudpickle

        name = getattr(script, "__qualname__", repr(script))
        try:
            return Recipe(cloudpickle.dumps(script), name)
        except (TypeError, pickle.PicklingError) as error:
            raise WrongUse(
                f"{name} can't be sent to workers: {one_line(error)}; what it uses of that kind "
                "has to be made inside of it"
            ) from error
    is_file = isinstance(script, (str, os.PathLike))
    source = os.fspath(script) if is_file else "filter script"  # type: ignore[arg-type]
    found = examined(script)
    if found.faults:
        raise ScriptError(source, found.faults)
    return Recipe(found.reading.steps, source)


def described(recipe: Recipe) -> tuple[object, ...]:
    """What of a recipe makes results differ."""
    if isinstance(recipe.steps, bytes):
        return (recipe.steps, _code(pickle.loads(recipe.steps)))
    plain = [(s.filter, [(p.name, p.type, p.value) for p in s.params]) for s in recipe.steps]
    return (plain, recipe.must_be_measured)


def _code(function: object) -> str:
    """The source of a function: one of a module is pickled by its name alone."""
    try:
        return inspect.getsource(function)  # type: ignore[arg-type]
    except (OSError, TypeError):
        return ""

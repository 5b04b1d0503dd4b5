"""What the steps of a script did, in lines of a log, and values in one line."""

from __future__ import annotations

import logging
import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ..meshset.catalogue import FilterInfo
    from ..meshset.check import Call
    from ..meshset.play import Played

# The log of the running command; without a handler, nothing is written.
log = logging.getLogger("meshlab_willmore.run")
log.setLevel(logging.INFO)
log.propagate = False


def log_call(call: Call, count: int) -> None:
    """Write which step begins, and its parameters."""
    name = f"{call.known.name} ({call.known.meshlab_name})"
    log.info("step %d of %d: %s", call.number, count, name)
    log.info("  parameters: %s", _given(call.known, call.given) or "all by default")


def log_result(played: Played) -> None:
    """Write how long a step took, and what it returned."""
    log.info("  time: %.3f s", played.seconds)
    if played.returned:
        log.info(
            "  returned: %s", ", ".join(f"{k}={in_line(v)}" for k, v in played.returned.items())
        )


def _given(known: FilterInfo, given: Mapping[str, Any]) -> str:
    return ", ".join(f"{keyword}={_value(known, keyword, v)}" for keyword, v in given.items())


def _value(known: FilterInfo, keyword: str, value: Any) -> str:
    from ..mlx.steps import Percentage

    param = known.param(keyword)
    if param is not None and param.choices and isinstance(value, int):
        return repr(param.choices[value])
    if isinstance(value, Percentage):
        return f"{value.percent:g}%"
    return in_line(value)


def in_line(value: Any) -> str:
    """A value in one line; arrays as lists, a box by its corners."""
    return " ".join(repr(plain(value)).split())


def plain(value: Any) -> Any:
    """The value with arrays as lists, and a box by its corners."""
    if type(value).__name__ == "BoundingBox":
        return [plain(value.min()), plain(value.max())]
    return value.tolist() if hasattr(value, "tolist") else value


def for_json(row: Mapping[str, Any]) -> dict[str, Any]:
    """The row as JSON can hold it, with null for numbers that are not finite."""
    return {key: _json(value) for key, value in row.items()}


def _json(value: Any) -> Any:
    value = plain(value)
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, (list, tuple)):
        return [_json(item) for item in value]
    if isinstance(value, Mapping):
        return {str(key): _json(item) for key, item in value.items()}
    return value if value is None or isinstance(value, (bool, int, str)) else in_line(value)

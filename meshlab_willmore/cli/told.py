"""What steps returned, in a line each."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

from .columns import counted

if TYPE_CHECKING:
    from ..meshset.play import Played

# More than so many letters of a value are for the log.
_LONGEST = 60
_DIGITS = 6
_FLIPPED = ("flips", "willmore_before", "willmore_after")


def steps(played: Iterable[Played]) -> list[str]:
    """An indented line for each step that returned something."""
    return [f"  step {p.number}, {p.name}: {_summary(p.returned)}" for p in played if p.returned]


def flips(returned: Mapping[str, Any]) -> str:
    """What the flip filter did."""
    before, after = returned["willmore_before"], returned["willmore_after"]
    return f"{counted(returned['flips'], 'flip')}, Willmore energy {before:.6g} -> {after:.6g}"


def in_line(value: Any) -> str:
    """A value in one line; arrays as lists, a box by its corners."""
    return " ".join(repr(_plain(value)).split())


def _plain(value: Any) -> Any:
    if type(value).__name__ == "BoundingBox":
        return [_plain(value.min()), _plain(value.max())]
    return value.tolist() if hasattr(value, "tolist") else value


def _summary(returned: Mapping[str, Any]) -> str:
    if all(key in returned for key in _FLIPPED):
        return flips(returned)
    return ", ".join(f"{key} {_short(value)}" for key, value in returned.items())


def _short(value: Any) -> str:
    text = in_line(_rounded(_plain(value)))
    return text if len(text) <= _LONGEST else f"{text[:_LONGEST]}..."


def _rounded(plain: Any) -> Any:
    if isinstance(plain, list):
        return [_rounded(item) for item in plain]
    return float(f"{plain:.{_DIGITS}g}") if isinstance(plain, float) else plain

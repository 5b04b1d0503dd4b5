"""The summary of a batch: counts by outcome, failures with their reasons, slowest, total gain."""

from __future__ import annotations

import heapq
from collections import Counter
from typing import Any

from ..machine import FIX
from ..messages import counted
from .process import ERROR
from .records import BAD_FILE, Result

# So many failures and slowest inputs are listed.
_FAILURES = 20
_SLOWEST = 3
_ENERGY = "willmore_energy"
_HOUR, _MINUTE = 3600, 60


class Summary:
    """Counts and sums over results, added one by one; it does not grow with their number."""

    def __init__(self) -> None:
        self.counts: Counter[str] = Counter()
        self._failures: list[str] = []
        self._slowest: list[tuple[float, str]] = []
        self._seconds = 0.0
        self._energy = [0.0, 0.0]
        self._peak = 0

    @property
    def failed(self) -> int:
        """How many inputs failed."""
        return sum(self.counts.values()) - self.done

    @property
    def done(self) -> int:
        """How many are done."""
        return self.counts["done"]

    def add(self, result: Result) -> None:
        """Count a result."""
        self.counts[result.status] += 1
        self._seconds += result.seconds
        self._peak = max(self._peak, result.memory or 0)
        heapq.heappush(self._slowest, (result.seconds, result.input))
        if len(self._slowest) > _SLOWEST:
            heapq.heappop(self._slowest)
        if not result.is_done:
            if len(self._failures) < _FAILURES:
                self._failures.append(f"  {result.status}: {failure(result)}")
            return
        pair = [_number(result.before), _number(result.after)]
        if None not in pair:
            self._energy = [s + n for s, n in zip(self._energy, pair, strict=True) if n is not None]

    def lines(self) -> list[str]:
        """The summary, for people."""
        counts = ", ".join(f"{count} {status}" for status, count in self.counts.most_common())
        lines = [
            f"{counted(sum(self.counts.values()), 'input')}: {counts or 'nothing to do'}; "
            f"{duration(self._seconds)} of work"
        ]
        lines += self._failures
        hidden = self.failed - len(self._failures)
        lines += [f"  and {hidden} more"] if hidden > 0 else []
        if self._slowest:
            slowest = sorted(self._slowest, reverse=True)
            names = ", ".join(f"{name} ({seconds:.1f} s)" for seconds, name in slowest)
            lines.append(f"slowest: {names}")
        before, after = self._energy
        if before or after:
            gain = before - after
            lines.append(f"Willmore energy {before:.6g} -> {after:.6g}, gain {gain:.6g}")
        if self._peak:
            lines.append(f"most memory of a worker: {self._peak / 2**20:.0f} MiB")
        return lines


def _number(measures: dict[str, Any] | None) -> float | None:
    return None if measures is None else measures.get(_ENERGY)


def failure(result: Result) -> str:
    """One line on a failed input, with its name and the step."""
    text = result.reason
    if FIX in text:
        # A fault of the machine blames no input.
        return f"{text} ({result.input} is left out)"
    if result.step and result.status not in (ERROR, BAD_FILE):
        text = f"{result.step}: {text}"
    # A reason has a blank in place of each line break of a name.
    names = (result.input, " ".join(result.input.split()))
    return text if any(name in text for name in names) else f"{result.input}: {text}"


def duration(seconds: float) -> str:
    """Seconds in hours, minutes and seconds."""
    if seconds < _MINUTE:
        return f"{seconds:.1f} s"
    hours, rest = divmod(round(seconds), _HOUR)
    minutes, left = divmod(rest, _MINUTE)
    return f"{hours} h {minutes:02} min" if hours else f"{minutes} min {left:02} s"

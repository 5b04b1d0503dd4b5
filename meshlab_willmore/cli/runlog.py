"""`-l`: what a run did, step by step, readable up to the moment where it ended."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, TextIO

if TYPE_CHECKING:
    from ..meshset.catalogue import Known
    from ..meshset.check import Call
    from ..meshset.play import Played

STANDARD_OUTPUT = "-"


class Log:
    """Lines that are on the disk as soon as they are said; without a stream, nothing."""

    def __init__(self, stream: TextIO | None) -> None:
        self._stream = stream

    def say(self, line: str) -> None:
        """Write one line."""
        if self._stream is not None:
            self._stream.write(line + "\n")
            self._stream.flush()

    def begin(self, call: Call, count: int) -> None:
        """Write which step comes, and its parameters."""
        name = f"{call.known.name} ({call.known.meshlab_name})"
        self.say(f"step {call.number} of {count}: {name}")
        self.say(f"  parameters: {_given(call.known, call.given) or 'all by default'}")

    def end(self, played: Played) -> None:
        """Write how long a step took, and what it returned."""
        self.say(f"  time: {played.seconds:.3f} s")
        if played.returned:
            returned = ", ".join(f"{k}={_shown(v)}" for k, v in played.returned.items())
            self.say(f"  returned: {returned}")


@contextmanager
def opened(path: str | None) -> Iterator[Log]:
    """The log at `path`, behind what the file holds already, as `meshlabserver` did.

    Parameters
    ----------
    path : str or None
        ``-`` is the standard output, None no log at all.

    Raises
    ------
    OSError
        In one line, if the file can't be written.
    """
    if path is None or path == STANDARD_OUTPUT:
        yield Log(sys.stdout if path else None)
        return
    with ExitStack() as stack:
        try:
            stream = stack.enter_context(Path(path).open("a", encoding="utf-8"))
        except OSError as error:
            raise OSError(f"cannot write the log {path}: {error.strerror}") from error
        yield Log(stream)


def _given(known: Known, given: Mapping[str, Any]) -> str:
    return ", ".join(f"{keyword}={_value(known, keyword, v)}" for keyword, v in given.items())


def _value(known: Known, keyword: str, value: Any) -> str:
    from ..mlx.steps import Percentage

    param = known.param(keyword)
    if param is not None and param.choices and isinstance(value, int):
        return repr(param.choices[value])
    if isinstance(value, Percentage):
        return f"{value.percent:g}%"
    return _shown(value)


def _shown(value: Any) -> str:
    """A value in one line; arrays as lists."""
    plain = value.tolist() if hasattr(value, "tolist") else value
    return " ".join(repr(plain).split())

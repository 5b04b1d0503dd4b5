"""How a command ends: in one line, with an exit code that scripts can trust, also by a signal."""

from __future__ import annotations

import os
import re
import signal
import sys
import warnings
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from types import FrameType
from typing import Any

import click

from .. import machine
from ..messages import WrongUse, notes_taken_by, one_line
from ..mlx.steps import ScriptError
from ..signals import ENDING, handled_by
from .arguments import kept_option, kept_options
from .text import printable

DOCTOR = " ('meshlab-willmore doctor' shows what is missing)"

# How a command line of meshlabserver begins.
_OLD_OPTIONS = ("-i", "-o", "-s", "-l", "-m", "-p", "-w", "-x", "-d")
_SCRIPT = ".mlx"
# What faults of scripts name a function of Python for.
_COMMANDS = {
    "pymeshlab.print_filter_list()": "'meshlab-willmore filters'",
    "pymeshlab.print_plugin_list()": "'meshlab-willmore doctor'",
}

# A hyphen inside of a word, and what takes its place while lines are broken.
_HYPHEN = re.compile(r"(?<=\w)-(?=\w)")
_HELD = "\0"

# A shell reports this plus its number for a process that a signal ended.
SIGNAL_EXIT = 128


class FaultyScript(click.ClickException):
    """A filter script with faults: a line for each, exit code 1."""

    def __init__(self, error: ScriptError) -> None:
        super().__init__(with_commands(str(error)))

    def show(self, file: Any = None) -> None:
        """Print the faults."""
        for line in self.message.splitlines():
            click.echo(f"Error: {line}", file=file, err=file is None)


class _WrongUse(click.ClickException):
    """A command line that can't be right: one line, exit code 2."""

    exit_code = 2


class _Formatter(click.HelpFormatter):
    """Writes help without line breaks inside of names with hyphens: they could not be copied."""

    def write_dl(self, rows: Iterable[tuple[str, str]], *args: Any, **given: Any) -> None:
        """Write a list of options."""
        held = [(name, _HYPHEN.sub(_HELD, text)) for name, text in rows]
        super().write_dl(held, *args, **given)

    def write_text(self, text: str) -> None:
        """Write paragraphs."""
        super().write_text(_HYPHEN.sub(_HELD, text))

    def getvalue(self) -> str:
        """All that was written."""
        return super().getvalue().replace(_HELD, "-")


class _Context(click.Context):
    formatter_class = _Formatter


class OneLineErrors(click.Group):
    """A group whose commands end with one line and an exit code when something fails."""

    context_class = _Context

    def add_command(self, cmd: click.Command, name: str | None = None) -> None:
        """Add a command, whose help is written as that of the group."""
        cmd.context_class = _Context
        super().add_command(cmd, name)

    def main(self, *args: Any, **given: Any) -> Any:
        """Run the command line with all standard streams open."""
        open_closed_streams()
        return super().main(*args, **given)

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Read the options before the command's name."""
        with _usage_errors_in_one_line():
            # A shell that completes words gets no message.
            if not ctx.resilient_parsing:
                _refuse_old_form(args)
            return super().parse_args(ctx, args)

    def invoke(self, ctx: click.Context) -> Any:
        """Run the command; click's own errors stay, others become one line."""
        with (
            stopped_by_signals(ctx),
            _usage_errors_in_one_line(),
            _warnings_as_notes(),
            notes_taken_by(lambda text: click.echo(f"Note: {printable(text)}", err=True)),
        ):
            try:
                return super().invoke(ctx)
            except (
                click.ClickException,
                click.exceptions.Exit,
                click.Abort,
                BrokenPipeError,
                WrongUse,
            ):
                raise
            except Exception as error:
                if is_debug():
                    raise
                raise _as_click_error(error) from error


def _refuse_old_form(args: list[str]) -> None:
    """Raise `WrongUse` where `run` is missing: meshlabserver had no commands."""
    first = args[0] if args else ""
    if first in _OLD_OPTIONS or first.lower().endswith(_SCRIPT):
        raise WrongUse(f"{first} belongs to the command run: meshlab-willmore run {first} ...")


@contextmanager
def _usage_errors_in_one_line() -> Iterator[None]:
    try:
        yield
    except WrongUse as error:
        raise _WrongUse(str(error)) from error
    except click.UsageError as error:
        # Without a command there is help, not an error.
        if type(error).__name__ == "NoArgsIsHelpError":
            raise
        hint = f" (see: {error.ctx.command_path} --help)" if error.ctx else ""
        raise _WrongUse(" ".join(error.format_message().split()) + hint) from error


@contextmanager
def _warnings_as_notes() -> Iterator[None]:
    """Inside, warnings about the machine are printed as notes."""
    with warnings.catch_warnings():
        warnings.simplefilter("always", machine.MachineWarning)
        show = warnings.showwarning

        def note(message: Warning | str, category: type[Warning], *rest: Any) -> None:
            if issubclass(category, machine.MachineWarning):
                click.echo(f"Note: {message}", err=True)
            else:
                show(message, category, *rest)

        warnings.showwarning = note  # type: ignore[assignment]
        yield


def _as_click_error(error: Exception) -> click.ClickException:
    if isinstance(error, ScriptError):
        return FaultyScript(error)
    fault = machine.fault_of(error)
    if fault is None and isinstance(error, ImportError):
        text = machine.without_library(error) or one_line(error)
        return click.ClickException(text + DOCTOR)
    return click.ClickException(one_line(fault or error))


# --- messages ----------------------------------------------------------------------------------


def with_commands(text: str) -> str:
    """Text about a script, with commands in place of the Python functions that it names."""
    for function, command in _COMMANDS.items():
        text = text.replace(function, command)
    return text


debug_option = kept_option("--debug", is_flag=True, help="Show the whole traceback of an error.")


def is_debug() -> bool:
    """Whether errors are shown with their traceback."""
    return "debug" in kept_options()


# --- streams and signals -----------------------------------------------------------------------


def open_closed_streams() -> None:
    """Connect standard streams that are closed to the null device.

    Otherwise the next file that is opened, such as an output, would get the number of a standard
    stream, and what C++ code prints would go into it.
    """
    for descriptor in (0, 1, 2):
        if not _is_open(descriptor):
            # The lowest free number is this one.
            os.open(os.devnull, os.O_RDWR)
    for name in ("stdout", "stderr"):
        if getattr(sys, name) is None:
            setattr(sys, name, Path(os.devnull).open("w", encoding="utf-8"))  # noqa: SIM115


def _is_open(descriptor: int) -> bool:
    try:
        os.fstat(descriptor)
    except OSError:
        return False
    return True


@contextmanager
def stopped_by_signals(ctx: click.Context) -> Iterator[None]:
    """Inside, SIGTERM and SIGHUP act as Ctrl-C, and the exit code is 128 plus their number.

    Filters defer a Ctrl-C to the end of a change, and Numba's compiler would swallow any other
    exception. A second signal ends the process at once.
    """
    caught: list[int] = []

    def stop(number: int, frame: FrameType | None) -> None:
        caught.append(number)
        for watched in ENDING:
            if signal.getsignal(watched) is stop:
                signal.signal(watched, signal.SIG_DFL)
        handle = signal.getsignal(signal.SIGINT)
        if not callable(handle):
            raise KeyboardInterrupt
        handle(signal.SIGINT, frame)

    # What is ignored stays ignored: nohup does that to SIGHUP.
    with handled_by(stop, lambda handler: handler not in (signal.SIG_IGN, None)):
        try:
            yield
        except (KeyboardInterrupt, click.Abort):
            if not caught:
                raise
            # The terminal may be closed.
            with suppress(OSError):
                click.echo(f"Error: terminated by {signal.Signals(caught[0]).name}", err=True)
            ctx.exit(SIGNAL_EXIT + caught[0])

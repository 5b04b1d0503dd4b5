"""How a command ends: in one line and with an exit code that scripts can trust."""

from __future__ import annotations

import re
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import click

from .. import machine
from ..markup import plain
from ..mlx.steps import ScriptError
from . import stopping, streams

DOCTOR = " ('meshlab-willmore doctor' tells what is missing)"

# PyMeshLab says first that it failed, at what, and in which file.
_PRELUDE = re.compile(r"(?:Error d|D)etails:|Unable to (?:open|save) file:[^\n]*\n")
# How a command line of meshlabserver begins.
_OLD_OPTIONS = ("-i", "-o", "-s", "-l", "-m", "-p", "-w", "-x", "-d")
_SCRIPT = ".mlx"


class FaultyScript(click.ClickException):
    """A filter script with faults: a line for each, exit code 1."""

    def __init__(self, error: ScriptError) -> None:
        super().__init__(str(error))

    def show(self, file: Any = None) -> None:
        """Print the faults."""
        for line in self.message.splitlines():
            click.echo(f"Error: {line}", file=file, err=file is None)


class WrongUse(click.ClickException):
    """A command line that can't be right: one line, exit code 2."""

    exit_code = 2


class OneLineErrors(click.Group):
    """A group whose commands end with one line and a telling exit code when something fails."""

    def main(self, *args: Any, **given: Any) -> Any:
        """Begin with all standard streams in their places."""
        streams.completed()
        return super().main(*args, **given)

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Read the options before the command's name."""
        _refuse_old_form(args)
        with _wrong_use_in_one_line():
            return super().parse_args(ctx, args)

    def invoke(self, ctx: click.Context) -> Any:
        """Run the command; what click itself says stays, other errors become one line."""
        with stopping.watched(ctx), _wrong_use_in_one_line(), _notes_in_one_line():
            return self._invoke(ctx)

    def _invoke(self, ctx: click.Context) -> Any:
        try:
            return super().invoke(ctx)
        except (click.ClickException, click.exceptions.Exit, click.Abort, BrokenPipeError):
            raise
        except Exception as error:
            if ctx.meta.get("debug"):
                raise
            if isinstance(error, ScriptError):
                raise FaultyScript(error) from error
            fault = machine.fault_of(error)
            if fault is not None:
                raise click.ClickException(one_line(fault)) from error
            text = one_line(error)
            if isinstance(error, ImportError):
                text = (machine.without_library(error) or text) + DOCTOR
            raise click.ClickException(text) from error


def _refuse_old_form(args: list[str]) -> None:
    """Raise `WrongUse` where `run` is missing, which meshlabserver had no word for."""
    first = args[0] if args else ""
    if first in _OLD_OPTIONS or first.lower().endswith(_SCRIPT):
        raise WrongUse(f"{first} belongs to the command run: meshlab-willmore run {first} ...")


@contextmanager
def _wrong_use_in_one_line() -> Iterator[None]:
    try:
        yield
    except click.UsageError as error:
        # Without a command there is help, not an error.
        if type(error).__name__ == "NoArgsIsHelpError":
            raise
        hint = f" (see: {error.ctx.command_path} --help)" if error.ctx else ""
        raise WrongUse(" ".join(error.format_message().split()) + hint) from error


@contextmanager
def _notes_in_one_line() -> Iterator[None]:
    """Warnings of this package inside are notes."""
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


def one_line(error: BaseException) -> str:
    """What an error says, in one line; its type where it says nothing."""
    return " ".join(str(error).split()) or type(error).__name__


def reason(error: BaseException) -> str:
    """What an error says, in one line, without what PyMeshLab puts before it and markup."""
    text = plain(_PRELUDE.split(str(error))[-1])
    return " ".join(text.split()) or type(error).__name__


def told_of(name: str, error: Exception, say: Callable[[BaseException], str] = one_line) -> str:
    """What went wrong with an input, in one line with its name; the machine's fault as such."""
    fault = machine.fault_of(error)
    if fault is not None:
        return f"{one_line(fault)} ({name} is left out)"
    text = say(error)
    return text if name in text else f"{name}: {text}"


def stops_all(error: Exception) -> bool:
    """Whether other inputs would fail in the same way: something is missing, or set wrong."""
    return isinstance(machine.fault_of(error) or error, ImportError)


def wrong_use(text: str) -> WrongUse:
    """An error of whoever wrote the command line: exit code 2."""
    return WrongUse(text)


def _remember_debug(ctx: click.Context, _option: click.Parameter, value: bool) -> None:
    # meta is shared by a group and its commands: the option works before and after the name.
    ctx.meta["debug"] = ctx.meta.get("debug", False) or value


debug_option = click.option(
    "--debug",
    is_flag=True,
    expose_value=False,
    callback=_remember_debug,
    help="Show the whole traceback of an error.",
)

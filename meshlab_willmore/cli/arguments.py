"""Options of several commands, and the arguments of `run` in the spelling of `meshlabserver`.

Its ``-i``, ``-o`` and ``-m`` take several values. Its ``-l`` was a log; since 2017 it is also the
layer that the ``-o`` just before it saves.
"""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Callable, Collection, Iterator, Sequence
from pathlib import Path
from typing import Any

import click
from click.shell_completion import CompletionItem

from ..mesh_files.formats import MANNERS, PARTS
from ..mesh_files.paths import PROJECT, Output, is_project
from ..messages import WrongUse, reason
from ..options import FILTER, OPTIONS, PRESET, Length, Option
from ..presets import PRESETS
from .scripts import is_script

LAYER_HELP = "an index from 0, c for the current layer, or x for the last one"

# Options of meshlabserver that `run` does not have, and what does their work.
REMOVED = {
    "-x": "--force overwrites existing files",
    "-d": "'meshlab-willmore filters' lists the filters and their parameters",
}

# A choice in a help text.
_NAME = re.compile(r"'[a-z]+( [a-z]+)*'")
_PART = click.Choice([*PARTS, *MANNERS])
_LAYER = re.compile(r"\d+|c|x")

_INPUT, _OUTPUT, _MASK = ("-i", "--input"), ("-o", "--output"), ("-m", "--mask", "-om")
_PROJECT, _WRITTEN = ("-p", "--project"), ("-w", "--write-project")
# A name with its value attached.
_ATTACHED = re.compile(
    r"(?!-om$)(-[iomlpw])(.+)|(--(?:input|output|mask|layer|project|write-project))=(.*)", re.DOTALL
)

_KEPT = "kept options"


def kept_option(*names: str, **attributes: Any) -> Callable[..., Any]:
    """An option whose value, if it is given, is one of `kept_options`, and no argument.

    A group and its commands share these: the option can be before or behind the command's name.
    """

    def keep(ctx: click.Context, option: click.Parameter, value: Any) -> None:
        if value:
            ctx.meta.setdefault(_KEPT, {})[option.name] = value

    return click.option(*names, expose_value=False, callback=keep, **attributes)


def kept_options() -> dict[str, Any]:
    """The values that were given, by the options' names; none outside of a command."""
    ctx = click.get_current_context(silent=True)
    kept: dict[str, Any] = {} if ctx is None else ctx.meta.setdefault(_KEPT, {})
    return kept


force_option = click.option("--force", is_flag=True, help="Overwrite existing files.")
json_option = click.option("--json", "as_json", is_flag=True, help="Print JSON.")


def mask_option(**more: Any) -> Callable[..., Any]:
    """The option ``-m``."""
    return click.option(
        "--mask",
        "-m",
        "parts",
        multiple=True,
        type=_PART,
        metavar="PART...",
        help="Save these parts besides positions and faces, and no others: v, f or w (vertex, "
        "face, wedge) followed by c, f, q, n, t or r (colour, flags, quality, normal, texture, "
        "radius), for example: vc fq wt. mp keeps polygons, sa writes text. Default: the parts "
        "that PyMeshLab saves.",
        **more,
    )


def form_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """The options ``--ascii`` and ``--single``."""
    command = click.option(
        "--single",
        is_flag=True,
        help="Write the numbers of a PLY's vertices in single precision (float, not double).",
    )(command)
    return click.option(
        "--ascii", "as_text", is_flag=True, help="Write PLY and STL as text, not binary."
    )(command)


def flip_options(leave_out: Collection[str] = ()) -> Callable[..., Any]:
    """An option for each parameter of the flip filter, in their order."""

    def decorated(command: Callable[..., Any]) -> Callable[..., Any]:
        for option in reversed(OPTIONS):
            if option.name not in leave_out:
                command = _click_option(option)(command)
        return command

    return decorated


def _click_option(option: Option) -> Callable[..., Any]:
    """An option without a default of its own: the filter knows what is best for the mesh."""
    name = f"--{option.name}"
    if option.type is bool:
        return click.option(f"{name}/--no-{option.name}", default=None, help=_help(option))
    if option.is_choice:
        return click.option(name, type=Choice(option.choices), metavar="NAME", help=_help(option))
    type_ = _Length() if option.type is Length else option.type
    return click.option(name, type=type_, help=_help(option))


class Choice(click.Choice):
    """A choice of names whose blanks may be typed as hyphens, which need no quotes."""

    def __init__(self, choices: Collection[str]) -> None:
        super().__init__([hyphened(choice) for choice in choices])
        self._names = {hyphened(choice): choice for choice in choices}

    def convert(self, value: Any, param: Any, ctx: Any) -> Any:
        """The name itself."""
        found = super().convert(hyphened(value), param, ctx)
        return self._names.get(found, found)

    def shell_complete(self, ctx: Any, param: Any, incomplete: str) -> list[CompletionItem[Any]]:
        """The names that begin so: with blanks if what is typed has one, which is quoted then."""
        found = super().shell_complete(ctx, param, hyphened(incomplete))
        if " " not in incomplete:
            return found
        return [CompletionItem(self._names[item.value]) for item in found]


def hyphened(name: str) -> str:
    """A name as it can be typed without quotes."""
    return name.replace(" ", "-")


class _Length(click.ParamType):
    """A length, or a percentage of the bounding box's diagonal with its sign."""

    name = "LENGTH|PERCENT%"

    def convert(self, value: Any, param: Any, ctx: Any) -> Any:
        from ..mlx.rich import parse_share
        from ..mlx.steps import Percentage

        try:
            share = parse_share(value)
        except ValueError as error:
            self.fail(f"{value!r} {error}", param, ctx)
        # In contrast to PyMeshLab's own, these can be sent to other processes.
        return share if isinstance(share, Percentage) else Length(share)


def _help(option: Option) -> str:
    text = _NAME.sub(lambda found: hyphened(found[0]), option.help)
    if option.default is None:
        return text
    value = option.default
    if option.is_choice:
        value = hyphened(value)
    elif option.type is bool:
        value = option.name if value else f"no-{option.name}"
    elif option.type is float:
        value = f"{value:g}"
    elif option.type is Length:
        value = f"{value:g}%"
    return f"{text}  [default: {value}]"


def check_flip_options(given: dict[str, Any]) -> None:
    """Raise `WrongUse` for the first option that the filter can't take, alone or beside others."""
    from ..meshset.filters import BY_NAME
    from ..meshset.native import ERRORS

    filter_ = BY_NAME[FILTER]
    values = {}
    for parameter in filter_.parameters:
        if parameter.name in given:
            try:
                value = parameter.read(given[parameter.name])
                if parameter.check is not None:
                    parameter.check(value)
                values[parameter.name] = value
            except ERRORS as error:
                raise WrongUse(f"--{parameter.name}: {reason(error)}") from error
            except ValueError as error:
                raise WrongUse(f"--{parameter.name}: {error}") from error
    barred = filter_.barred(values)
    for name in given:
        if name in barred:
            raise WrongUse(f"--{name}: {barred[name]}")


def overruled_defaults(given: dict[str, Any]) -> Iterator[str]:
    """What to say of defaults that are given, but that the preset has other values in place of.

    The filter gets all values, and can't know which were given.
    """
    preset = given.get(PRESET.name, PRESET.default)
    own = {name for one in PRESETS[preset].passes for name in one.defaults}
    for option in OPTIONS:
        if option.name in own and given.get(option.name) == option.default:
            yield (
                f"--{option.name} {option.default:g} is the default, in place of which the preset "
                f"{preset!r} has its own in all passes but the last; for this one in all, give it "
                "a little less or more"
            )


def is_part(word: str) -> bool:
    """Whether a word is a value of ``-m``."""
    return word in PARTS or word in MANNERS


def _is_input(word: str) -> bool:
    return not is_script(word)


class _Words:
    """The arguments up to ``--``, taken one after the other."""

    def __init__(self, args: Sequence[str]) -> None:
        end = list(args).index("--") if "--" in args else len(args)
        self.left = deque(args[:end])
        self.after_end = list(args[end:])

    def __bool__(self) -> bool:
        return bool(self.left)

    def take(self) -> tuple[str, str, list[str]]:
        """The next word, and the option's name and attached value in it."""
        word = self.left.popleft()
        found = _ATTACHED.fullmatch(word)
        return (word, found[1] or found[3], [found[2] or found[4]]) if found else (word, word, [])

    def take_values(self, attached: list[str], belongs: Callable[[str], bool]) -> list[str]:
        """The values of an option; the first one is taken even if it does not belong to it."""
        values = list(attached)
        while self.left and _is_value(self.left[0]) and (not values or belongs(self.left[0])):
            values.append(self.left.popleft())
        return values

    def take_value(self, attached: list[str]) -> list[str]:
        """At most one value."""
        return self.take_values(attached, lambda _: False)


def _is_value(word: str) -> bool:
    return word == "-" or not word.startswith("-")


class SeveralParts(click.Command):
    """A command whose ``-m`` takes several values."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Repeat the option's name before each value, for click."""
        words = _Words(args)
        rest: list[str] = []
        while words:
            word, name, attached = words.take()
            parts = words.take_values(attached, is_part) if name in _MASK else []
            rest += [w for part in parts for w in ("-m", part)] or [word]
        return super().parse_args(ctx, [*rest, *words.after_end])


def take_outputs(args: Sequence[str], ctx: click.Context) -> tuple[list[Output], list[str]]:
    """Take the outputs, with their masks and layers, out of the arguments of `run`.

    A mask or layer is for all names of the ``-o`` before it; a mask before every ``-o`` is for all
    outputs. The other arguments are returned for click, with ``--log`` for an ``-l`` that is a log.
    """
    words = _Words(args)
    for word in words.left:
        if word in REMOVED:
            raise WrongUse(f"{word} of meshlabserver is gone: {REMOVED[word]}")
    done: list[Output] = []
    # Those of the last -o, and whether nothing but their own options has come since.
    last: list[Output] = []
    is_behind = False
    common: tuple[str, ...] = ()
    rest: list[str] = []
    while words:
        word, name, attached = words.take()
        if name in _OUTPUT:
            names = words.take_values(attached, _is_input)
            done, last, is_behind = [*done, *last], [Output(n, common) for n in names], True
            _check_given(name, names, ctx)
        elif name in _WRITTEN:
            names = words.take_value(attached)
            _check_project(name, names, ctx)
            done, last, is_behind = [*done, *last], [Output(n, common) for n in names], True
        elif name in _PROJECT:
            values = words.take_value(attached)
            _check_project(name, values, ctx)
            rest += ["-i", *values, "--layers"]
            is_behind = False
        elif name in _MASK:
            parts = _parts(name, words, attached, ctx)
            common += () if last else parts
            last = [output._replace(parts=(*output.parts, *parts)) for output in last]
        elif name == "--layer" or (name == "-l" and is_behind):
            layer = _layer(name, words.take_value(attached), last)
            last = [output._replace(layer=layer) for output in last]
        elif name == "-l":
            values = words.take_value(attached)
            _check_log("".join(values), bool(last))
            rest += ["--log", *values]
        elif name in _INPUT:
            values = words.take_values(attached, _is_input)
            _check_given(name, values, ctx)
            rest += [w for value in values for w in ("-i", value)]
            is_behind = False
        else:
            rest.append(word)
            is_behind = False
    outputs = [*done, *last]
    _check_layers(outputs)
    return outputs, [*rest, *words.after_end]


def _check_given(name: str, values: Sequence[str], ctx: click.Context) -> None:
    if not values:
        raise click.BadOptionUsage(name, f"Option {name!r} requires an argument.", ctx)


def _check_project(name: str, values: Sequence[str], ctx: click.Context) -> None:
    _check_given(name, values, ctx)
    if not is_project(Path(values[0])):
        raise WrongUse(f"{name} {values[0]}: projects end in {PROJECT}; for a mesh, use -i or -o")


def _parts(name: str, words: _Words, attached: list[str], ctx: click.Context) -> tuple[str, ...]:
    if name == "-om" and not (words and _is_value(words.left[0]) and _is_input(words.left[0])):
        # meshlabserver took an empty mask.
        return ()
    parts = words.take_values(attached, is_part)
    _check_given(name, parts, ctx)
    option = next(param for param in ctx.command.params if param.name == "parts")
    return tuple(_PART.convert(part, option, ctx) for part in parts)


def _layer(name: str, values: Sequence[str], outputs: Sequence[Output]) -> str:
    """The layer for outputs."""
    if name == "--layer":
        if not values:
            raise WrongUse(f"--layer needs the layer to save: {LAYER_HELP}")
        if not outputs:
            raise WrongUse(f"--layer {values[0]} comes before every -o; put it behind one")
        if not _LAYER.fullmatch(values[0]):
            raise WrongUse(f"--layer {values[0]}: it must be {LAYER_HELP}")
    if not values:
        raise WrongUse(f"-l behind -o {outputs[0].name} needs the layer to save: {LAYER_HELP}")
    if outputs[0].layer:
        raise WrongUse(
            f"-o {outputs[0].name} has two layers, {outputs[0].layer} and {values[0]}; name one"
        )
    if not _LAYER.fullmatch(values[0]):
        raise WrongUse(
            f"-l {values[0]} behind -o {outputs[0].name} is no layer ({LAYER_HELP}); for a log, "
            f"write --log {values[0]}"
        )
    return values[0]


def _check_log(value: str, has_outputs: bool) -> None:
    if not _LAYER.fullmatch(value):
        return
    where = "apart from its -o" if has_outputs else "before every -o"
    raise WrongUse(
        f"-l {value} {where} can be a layer or a log; for the layer, put it just behind -o FILE, "
        f"and for a log of that name write --log {value}"
    )


def _check_layers(outputs: Sequence[Output]) -> None:
    """Raise `WrongUse` if only some outputs have a layer."""
    if any(output.layer for output in outputs):
        for output in outputs:
            if output.is_project and output.layer:
                raise WrongUse(f"{output.name} is a project, which has all layers; leave -l out")
            if not (output.layer or output.is_project):
                raise WrongUse(
                    f"-o {output.name} has no layer, but others have; add -l c for the current one"
                )

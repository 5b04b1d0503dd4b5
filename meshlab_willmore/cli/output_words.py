"""``-o`` with several names, and ``-l`` in its two meanings, as `meshlabserver` had them.

There, ``-l`` was a log; since 2017 it is also the layer that the ``-o`` just before it saves: a
place from 0, ``c`` for the current layer, or ``x`` for the last one.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence

from .errors import wrong_use

# Those of `run`: what belongs to the output before it.
_OUTPUT = re.compile(r"(?:--output=|-o)(?P<value>.+)|--output|-o", re.DOTALL)
_MASK = re.compile(r"(?:--mask=|-m).+|--mask|-m", re.DOTALL)
_OLD = re.compile(r"-l(?P<value>.*)", re.DOTALL)
_LAYER = re.compile(r"\d+|c|x")
_NO_MASK = "-om"

LAYER = "--layer"
LOG = "--log"
MEANING = "a place from 0, c for the current layer, or x for the last one"


def plain(
    args: Sequence[str], is_script: Callable[[str], bool], is_part: Callable[[str], bool]
) -> list[str]:
    """The arguments with one name behind each ``-o``, and ``--layer`` or ``--log`` for ``-l``.

    What stands behind several names holds for each of them.

    Raises
    ------
    WrongUse
        For an ``-l`` that can be meant in either way, or in none.
    """
    end = list(args).index("--") if "--" in args else len(args)
    words = _Words(list(args[:end]))
    result: list[str] = []
    has_outputs = False
    while words:
        word = words.take()
        if found := _OUTPUT.fullmatch(word):
            has_outputs = True
            result += _output(words, found["value"], is_script, is_part)
        elif found := _OLD.fullmatch(word):
            values = [found["value"]] if found["value"] else words.take_while(_once(_is_value))
            _check_log("".join(values), has_outputs)
            result += [LOG, *values]
        else:
            result.append(word)
    return [*result, *args[end:]]


def without_empty_masks(args: Sequence[str], is_script: Callable[[str], bool]) -> list[str]:
    """The arguments without an ``-om`` that has nothing behind it: `meshlabserver` took it so."""
    following = [*args[1:], _NO_MASK]
    return [
        word
        for word, after in zip(args, following, strict=True)
        if word != _NO_MASK or (_is_value(after) and not is_script(after))
    ]


class _Words:
    """Arguments, one after the other."""

    def __init__(self, left: list[str]) -> None:
        self._left = left

    def __bool__(self) -> bool:
        return bool(self._left)

    def take(self) -> str:
        return self._left.pop(0)

    def take_while(self, belongs: Callable[[str], bool]) -> list[str]:
        taken: list[str] = []
        while self._left and belongs(self._left[0]):
            taken.append(self.take())
        return taken


def _output(
    words: _Words,
    name: str | None,
    is_script: Callable[[str], bool],
    is_part: Callable[[str], bool],
) -> list[str]:
    """One output or several, each with all that stands behind them."""
    first = [name] if name else words.take_while(_once(_is_value))
    names = [*first, *words.take_while(lambda word: _is_value(word) and not is_script(word))]
    if not names:
        return ["-o"]
    belongings: list[str] = []
    layers: list[str] = []
    while taken := words.take_while(
        _once(lambda word: bool(_MASK.fullmatch(word) or _is_old(word)))
    ):
        (word,) = taken
        if _MASK.fullmatch(word):
            belongings += [word, *words.take_while(is_part)]
            continue
        layers += [word[2:]] if len(word) > 2 else words.take_while(_once(_is_value))
        _check_layers(layers, names)
        belongings += [LAYER, layers[-1]]
    return [word for name in names for word in ("-o", name, *belongings)]


def _once(test: Callable[[str], bool]) -> Callable[[str], bool]:
    """The test, for the first word only."""
    left = iter([True])
    return lambda word: next(left, False) and test(word)


def _is_value(word: str) -> bool:
    return word == "-" or not word.startswith("-")


def _is_old(word: str) -> bool:
    return bool(_OLD.fullmatch(word))


def _check_layers(layers: Sequence[str], names: Sequence[str]) -> None:
    if not layers:
        raise wrong_use(f"-l behind -o {names[0]} wants the layer to save: {MEANING}")
    if len(layers) > 1:
        raise wrong_use(f"-o {names[0]} has two layers, {' and '.join(layers)}; name one")
    if not _LAYER.fullmatch(layers[0]):
        raise wrong_use(
            f"-l {layers[0]} behind -o {names[0]} is no layer ({MEANING}); for a log, type "
            f"{LOG} {layers[0]}"
        )


def _check_log(value: str, has_outputs: bool) -> None:
    if not _LAYER.fullmatch(value):
        return
    where = "apart from its -o" if has_outputs else "before every -o"
    raise wrong_use(
        f"-l {value} {where} is a layer or a log; for the layer, type it just behind -o FILE, and "
        f"for a log of that name {LOG} {value}"
    )


def by_output(order: Iterable[str], given: Sequence[str], outputs: Sequence[str]) -> list[str]:
    """The layer of each output; empty where none has one.

    Parameters
    ----------
    order : iterable of str
        "patterns" for each output and "layer" for each layer, in the order of the command line.
    given, outputs : sequence of str
        The layers and the outputs in that order.

    Raises
    ------
    WrongUse
        If a layer has no output, or only some outputs have a layer.
    """
    rest = iter(given)
    found: list[str] = []
    for name in order:
        if name == "patterns":
            found.append("")
        elif name == "layer":
            layer = next(rest)
            if not found:
                raise wrong_use(f"{LAYER} {layer} stands before every -o; type it behind one")
            if not _LAYER.fullmatch(layer):
                raise wrong_use(f"{LAYER} {layer}: it can be {MEANING}")
            found[-1] = layer
    if any(found) and not all(found):
        bare = outputs[found.index("")]
        raise wrong_use(f"-o {bare} has no layer, but others have; add -l c for the current one")
    return found

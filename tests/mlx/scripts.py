"""Scripts made in code, and strategies for what a script can say."""

from __future__ import annotations

from collections.abc import Iterable

import pytest
from hypothesis import strategies as st

from meshlab_willmore.mlx import rich
from meshlab_willmore.mlx.read import read_bytes
from meshlab_willmore.mlx.steps import Param, Percentage, ScriptError, Step


def script(body: str) -> bytes:
    """A script with `body` between its root tags; the body begins in line 3."""
    return f"<!DOCTYPE FilterScript>\n<FilterScript>\n{body}\n</FilterScript>\n".encode()


def element(**attributes: str) -> str:
    """A ``<Param>`` named p; a `kind` is its type."""
    if "kind" in attributes:
        attributes["type"] = attributes.pop("kind")
    shown = " ".join(f'{key}="{text}"' for key, text in {"name": "p", **attributes}.items())
    return f"<Param {shown}/>"


def one_param(**attributes: str) -> bytes:
    """A script of one filter F with one `element`."""
    return script(f'<filter name="F">{element(**attributes)}</filter>')


def cases(corpus: Iterable[tuple[str, bytes, str]]) -> pytest.MarkDecorator:
    """Parametrise a test by named scripts and the text of the only fault of each."""
    params = [pytest.param(data, text, id=name) for name, data, text in corpus]
    return pytest.mark.parametrize(("data", "text"), params)


def error_of(data: bytes) -> str:
    """The message of the error that reading a script raises."""
    with pytest.raises(ScriptError) as caught:
        read_bytes(data, "s.mlx")
    assert caught.value.source == "s.mlx"
    return str(caught.value)


texts = st.text(
    st.characters(codec="utf-8", exclude_categories=["Cc", "Cs"], exclude_characters="\ufffe\uffff")
    | st.sampled_from("\t\n\r\"'<>&; "),
    max_size=12,
)
names = texts.filter(bool)
floats = st.one_of(
    st.floats(-rich.LARGEST_FLOAT, rich.LARGEST_FLOAT).filter(
        lambda x: x == 0 or abs(x) > rich.SMALLEST_FLOAT
    ),
    st.sampled_from([0.0, -0.0, 0.1, 1e-45, rich.LARGEST_FLOAT, 1e15, 1e16, 123456.789]),
)
bytes_of_colors = st.integers(0, 255)
int32 = st.integers(-(2**31), 2**31 - 1)
ids = st.integers(0, 2**31 - 1)
percentages = st.builds(
    Percentage, floats.filter(lambda x: 0 <= x <= 100) | st.floats(0, 100, width=32)
)


def _repeated(values: st.SearchStrategy, count: int) -> st.SearchStrategy:
    return st.tuples(*[values] * count)


def _numbered(prefix: str, texts: list[str]) -> tuple[tuple[str, str], ...]:
    return tuple((f"{prefix}{i}", text) for i, text in enumerate(texts))


@st.composite
def _enums(draw: st.DrawFn) -> tuple[int, tuple[tuple[str, str], ...]]:
    choices = draw(st.lists(texts, min_size=1, max_size=4))
    details = (("enum_cardinality", str(len(choices))), *_numbered("enum_val", choices))
    return draw(st.integers(0, len(choices) - 1)), details


@st.composite
def _ranged(draw: st.DrawFn, values: st.SearchStrategy) -> tuple[object, tuple]:
    low, high = draw(floats), draw(floats)
    return draw(values), (("min", repr(low)), ("max", repr(high)))


@st.composite
def _opened(draw: st.DrawFn) -> tuple[str, tuple[tuple[str, str], ...]]:
    endings = draw(st.lists(texts, max_size=2))
    details = (("exts_cardinality", str(len(endings))), *_numbered("ext_val", endings))
    return draw(texts), details


def _plain(values: st.SearchStrategy) -> st.SearchStrategy:
    return st.tuples(values, st.just(()))


# For each type, values with the details that MeshLab needs beside them.
VALUES = {
    "RichBool": _plain(st.booleans()),
    "RichInt": _plain(int32),
    "RichFloat": _plain(floats),
    "RichString": _plain(texts),
    "RichEnum": _enums(),
    "RichAbsPerc": _ranged(floats) | _plain(percentages),
    "RichDynamicFloat": _ranged(floats),
    "RichColor": _plain(_repeated(bytes_of_colors, 4)),
    "RichPosition": _plain(_repeated(floats, 3)),
    "RichDirection": _plain(_repeated(floats, 3)),
    "RichPoint3f": _plain(_repeated(floats, 3)),
    "RichMatrix44f": _plain(_repeated(floats, 16)),
    "RichMesh": _plain(ids),
    "RichOpenFile": _opened(),
    "RichSaveFile": st.tuples(texts, st.builds(lambda ext: (("ext", ext),), texts)),
    "RichShotf": _plain(st.none()),
}


@st.composite
def params(draw: st.DrawFn, types: tuple[str, ...] = tuple(VALUES)) -> Param:
    """A parameter of one of the types, as MeshLab could have written it."""
    type = draw(st.sampled_from(types))
    value, needed = draw(VALUES[type])
    described = (("description", draw(texts)), ("tooltip", draw(texts)))
    return Param(draw(names), type, value, draw(st.sampled_from([(), described])) + needed)


def steps(types: tuple[str, ...] = tuple(VALUES)) -> st.SearchStrategy:
    """Lists of steps with parameters of the types."""
    some = st.lists(params(types), max_size=4, unique_by=lambda param: param.name)
    return st.lists(st.builds(Step, names, some.map(tuple)), max_size=4).map(tuple)

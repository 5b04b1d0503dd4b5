"""Stubs of what PyMeshLab binds with pybind11, from the signatures in its docstrings."""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Container, Iterator
from typing import Any, NamedTuple

# Docstrings begin with signatures; those of overloads are numbered.
_SIGNATURE = re.compile(r"^(?:\d+\. )?(\w+\(.*\) -> .*)$")
_EMPTY_ARRAY = re.compile(r"array\(\[\](?:, shape=\([^)]*\))?, dtype=\w+\)")
_ARRAY = re.compile(r"(?:typing\.)?numpy\.ndarray\[(?:numpy\.)?(\w+)\[[^\]]*\]\]")
# Arguments that PyMeshLab gave no name, which can't be given by one.
_UNNAMED = re.compile(r"arg\d+$")
# Special methods whose signatures say what they do; printing a set fails with a TypeError.
_SPECIAL = ("__init__", "__getitem__", "__iter__", "__len__")

# What a signature leaves open.
_RETYPED = {
    ("load_project", "file_name"): "str | Sequence[str]",
    ("apply_filter", "return"): "dict[str, Any]",
    ("filter_parameter_values", "return"): "dict[str, Any]",
}


class Signature(NamedTuple):
    """A signature as Python, and the first sentence of what PyMeshLab writes about it."""

    node: ast.FunctionDef
    summary: str


def signatures(function: Callable[..., Any]) -> list[Signature]:
    """The signatures in a docstring of pybind11's, one for each overload."""
    found, text = [], function.__doc__ or ""
    lines = text.splitlines()
    for number, line in enumerate(lines):
        matched = _SIGNATURE.match(line)
        if matched:
            below = "\n".join(lines[number + 1 :]).strip().partition("\n\n")[0]
            found.append(Signature(_parsed(matched[1]), first_sentence(below)))
    return found


def first_sentence(text: str) -> str:
    """The first sentence of a text, in plain text."""
    plain = re.sub(r":\w+:(?:\w+:)?`([^`]*)`|``([^`]*)``|\*\*", r"\1\2", " ".join(text.split()))
    ended = re.match(r"(.+?\.)(?=\s*[A-Z]|$)", plain)
    return ended[1] if ended else plain


def function_lines(found: list[Signature], indent: str) -> Iterator[str]:
    """The lines of a function in a stub."""
    for signature in found:
        if len(found) > 1:
            yield f"{indent}@overload"
        head = f"{indent}{ast.unparse(signature.node).removesuffix('...').rstrip()}"
        if signature.summary:
            yield head
            yield f'{indent}    """{signature.summary}"""'
        else:
            yield f"{head} ..."


def class_lines(cls: type, left_out: Container[str] = ()) -> Iterator[str]:
    """The lines of a class in a stub: its own methods that pybind11 bound, but for some."""
    if issubclass(cls, Exception):
        yield f"class {cls.__name__}(Exception):"
        yield f'    """{first_sentence(cls.__doc__ or "")}"""'
        return
    yield f"class {cls.__name__}:"
    for name, value in sorted(vars(cls).items()):
        if name not in left_out and (not name.startswith("_") or name in _SPECIAL):
            yield from function_lines(signatures(value), "    ")


# --- signatures ----------------------------------------------------------------------------------


def _parsed(text: str) -> ast.FunctionDef:
    plain = text.replace("pymeshlab.pmeshlab.", "")
    plain = _ARRAY.sub(lambda array: f"NDArray[{_scalar(array[1])}]", plain)
    plain = _EMPTY_ARRAY.sub("...", plain)
    (node,) = ast.parse(f"def {plain}: ...").body
    assert isinstance(node, ast.FunctionDef)
    _retype(node)
    _make_unnamed_positional(node)
    return node


def _scalar(name: str) -> str:
    return "np.bool_" if name == "bool" else f"np.{name}"


def _retype(node: ast.FunctionDef) -> None:
    """Let arguments be whatever NumPy makes an array of, and fill in what is open."""
    for argument in node.args.args:
        if argument.annotation is not None:
            text = _RETYPED.get((node.name, argument.arg), ast.unparse(argument.annotation))
            text = re.sub(r"NDArray\[[\w.]+\]", "ArrayLike", text)
            text = text.replace("list[", "Sequence[")
            argument.annotation = ast.parse(text, mode="eval").body
        if argument.arg == "self":
            argument.annotation = None
    if node.args.kwarg:
        node.args.kwarg.annotation = ast.Name("Any")
    if (node.name, "return") in _RETYPED:
        node.returns = ast.parse(_RETYPED[node.name, "return"], mode="eval").body


def _make_unnamed_positional(node: ast.FunctionDef) -> None:
    unnamed = [i for i, a in enumerate(node.args.args) if _UNNAMED.match(a.arg)]
    if unnamed:
        stop = unnamed[-1] + 1
        node.args.posonlyargs, node.args.args = node.args.args[:stop], node.args.args[stop:]

"""Histograms of a mesh before and after, one over the other, as inline SVG with text."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from html import escape
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .examine import NOISE, Examined, meaningful

Array = NDArray[np.float64]

WIDTH, HEIGHT = 360, 170
LEFT, RIGHT, TOP, BOTTOM = 38, 8, 10, 22
PERCENT = 100.0


class Quantity(NamedTuple):
    """A quantity whose distribution is shown."""

    title: str
    unit: str
    # The values (k,) of a mesh that was examined.
    values: Callable[[Examined], Array]
    # Of the bins; the last one has what is larger, too, and the first one what is smaller.
    edges: Array
    # Where the axis has numbers, and which.
    ticks: Sequence[tuple[float, str]]
    # What is good, in one sentence.
    help: str
    # Whether heights are logarithmic, where few values far out matter.
    is_log: bool = False


def _log_energies(mesh: Examined) -> Array:
    energies = mesh.energy[mesh.energy > NOISE]
    logs: Array = np.log10(energies)
    return logs


def _dihedral(mesh: Examined) -> Array:
    # Each edge once: twins have the same angle.
    angles = np.sort(mesh.dihedral[np.isfinite(mesh.dihedral)])
    return angles[::2]


QUANTITIES = (
    Quantity(
        "Angles of triangles",
        "°",
        lambda mesh: mesh.angles[np.isfinite(mesh.angles)],
        np.linspace(0.0, 180.0, 61),
        [(degrees, f"{degrees}°") for degrees in range(0, 181, 30)],
        "An equilateral triangle has 60° at each corner.",
    ),
    Quantity(
        "Shapes of triangles",
        "",
        lambda mesh: mesh.shapes,
        np.linspace(0.0, 1.0, 51),
        [(share / 5, f"{share / 5:g}") for share in range(6)],
        "1 is equilateral, 0 has no area.",
    ),
    Quantity(
        "Dihedral angles",
        "°",
        _dihedral,
        np.linspace(0.0, 180.0, 61),
        [(degrees, f"{degrees}°") for degrees in range(0, 181, 30)],
        "0° is flat, 180° folded back. Heights are logarithmic.",
        is_log=True,
    ),
    Quantity(
        "Valence of vertices",
        "",
        lambda mesh: mesh.valences[mesh.valences > 0].astype(np.float64),
        np.arange(1.5, 13.0),
        [(float(count), f"{count}" if count < 12 else "12+") for count in range(2, 13, 2)],
        "Edges at a vertex; 6 is regular.",
    ),
    Quantity(
        "Willmore energy W of vertices",
        "",
        _log_energies,
        np.linspace(-8.0, 2.0, 51),
        [
            (float(power), f"10{_raised}")
            for power, _raised in (
                (-8, "⁻⁸"),
                (-6, "⁻⁶"),
                (-4, "⁻⁴"),
                (-2, "⁻²"),
                (0, "⁰"),
                (2, "²"),
            )
        ],
        "0 on spheres and planes; lower is smoother. The scale is logarithmic.",
    ),
)


def figures(before: Examined, after: Examined) -> str:
    """Return a figure for each kind of quantity, as HTML."""
    return "\n".join(_figure(kind, kind.values(before), kind.values(after)) for kind in QUANTITIES)


def _figure(kind: Quantity, before: Array, after: Array) -> str:
    shares = [_shares(kind, values) for values in (before, after)]
    top = max(float(share.max()) for share in shares) or 1.0
    medians = " → ".join(_median(kind, values) for values in (before, after))
    label = f"Histogram. {kind.title}: median {medians} before and after. {kind.help}"
    heights = [_heights(kind, share, top) for share in shares]
    lines = "".join(
        f'<path class="{name}" d="{_outline(kind, height)}"/>'
        for name, height in zip(("before", "after"), heights, strict=True)
    )
    return (
        f"<figure><figcaption><b>{escape(kind.title)}</b>Median {escape(medians)}. "
        f"{escape(kind.help)}</figcaption>"
        f'<svg viewBox="0 0 {WIDTH} {HEIGHT}" role="img" aria-label="{escape(label)}">'
        f"{_axes(kind, top)}{lines}</svg></figure>"
    )


def _median(kind: Quantity, values: Array) -> str:
    if not len(values):
        return "none"
    median = float(np.median(values))
    if kind.values is _log_energies:
        return f"{10**median:.3g}"
    return f"{meaningful(median):.3g}{kind.unit}"


def _shares(kind: Quantity, values: Array) -> Array:
    """The share of each bin of all values, in percent."""
    inside = np.clip(values, kind.edges[0], np.nextafter(kind.edges[-1], -np.inf))
    counts, _ = np.histogram(inside, kind.edges)
    return PERCENT * counts / max(len(values), 1)


# The least share that a logarithmic height shows, as a part of the largest.
_LEAST = 1e-6


def _heights(kind: Quantity, shares: Array, top: float) -> Array:
    if not kind.is_log:
        return shares / top
    return 1.0 - np.log10(np.maximum(shares / top, _LEAST)) / np.log10(_LEAST)


def _x(kind: Quantity, value: float) -> float:
    first, last = kind.edges[0], kind.edges[-1]
    return LEFT + (value - first) / (last - first) * (WIDTH - LEFT - RIGHT)


def _y(height: float) -> float:
    return HEIGHT - BOTTOM - height * (HEIGHT - TOP - BOTTOM)


def _outline(kind: Quantity, heights: Array) -> str:
    ground = f"{_y(0.0):.1f}"
    steps = [f"M{LEFT} {ground}"]
    for start, end, height in zip(kind.edges, kind.edges[1:], heights, strict=False):
        steps.append(f"H{_x(kind, start):.1f}V{_y(height):.1f}H{_x(kind, end):.1f}")
    return "".join([*steps, f"V{ground}Z"])


def _axes(kind: Quantity, top: float) -> str:
    ground = _y(0.0)
    parts = [f'<path class="axis" d="M{LEFT} {ground}H{WIDTH - RIGHT}"/>']
    for value, text in kind.ticks:
        place = f'x="{_x(kind, value):.1f}" y="{HEIGHT - 6}"'
        parts.append(f'<text {place} text-anchor="middle">{text}</text>')
    marks = (
        [(1.0, f"{top:.2g} %"), (0.5, f"{top / 2:.2g} %")]
        if not kind.is_log
        else [(1.0, f"{top:.2g} %"), (0.5, f"{top * _LEAST**0.5:.1g} %")]
    )
    for height, text in marks:
        y = _y(height)
        parts.append(f'<path class="axis" d="M{LEFT} {y:.1f}H{WIDTH - RIGHT}"/>')
        parts.append(f'<text x="{LEFT - 5}" y="{y + 4:.1f}" text-anchor="end">{text}</text>')
    return "".join(parts)

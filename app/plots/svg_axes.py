"""Small plots as SVG: axes with ticks, curves, dots and words, in px of the picture."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from navcore.foundation.text import Text
from schuler_bench.plots import style
from schuler_bench.plots.units import number

_STEPS = (1.0, 2.0, 5.0, 10.0)
_TICKS = 3.0
"""About so many each way."""


@dataclass(frozen=True)
class Box:
    """Where the axes stand, px."""

    left: float
    top: float
    width: float
    height: float


@dataclass(frozen=True)
class Curve:
    """Values over x as a line of a colour, or as dots."""

    x: np.ndarray
    y: np.ndarray
    color: str
    dots: bool = False


def axes(
    box: Box, curves: Sequence[Curve], least: float = 0.02, ends: tuple[float, float] | None = None
) -> str:
    """Draw axes with about three ticks each way, and the curves.

    Parameters
    ----------
    box : Box
        Where.
    curves : sequence of Curve
        At least one with a value.
    least : float
        The axis of the values spans at least this much, in their unit.
    ends : tuple of float, optional
        First and last x that is shown; else 0, or the first one where it is below, and the last.
    """
    first, last = ends or (
        min(0.0, *(float(one.x[0]) for one in curves)),
        max(float(one.x[-1]) for one in curves),
    )
    span = max(last - first, 1e-9)
    every = np.concatenate([one.y for one in curves])
    step = _step(max(float(np.ptp(every)), least) / 2.0)
    low = step * math.floor(float(np.min(every)) / step)
    high = max(step * math.ceil(float(np.max(every)) / step), low + step)

    def at(x: float, y: float) -> tuple[float, float]:
        return (
            box.left + box.width * (x - first) / span,
            box.top + box.height * (high - y) / (high - low),
        )

    parts: list[str] = [
        f'<rect x="{box.left:g}" y="{box.top:g}" width="{box.width:g}" height="{box.height:g}" fill="none" '
        f'stroke="{style.REFERENCE}"/>'
    ]
    for value in np.arange(low, high + 0.5 * step, step).tolist():
        y = at(first, value)[1]
        parts.append(f'<path d="M{box.left:g} {y:.1f}h{box.width:g}" stroke="{style.GRID}"/>')
        parts.append(word(box.left - 5.0, y + 4.0, number(round(value, 9) + 0.0, 3), "end"))
    tick = _step(span / _TICKS)
    for value in np.arange(tick * math.ceil(first / tick - 1e-9), first + 0.9 * span, tick).tolist():
        x, foot = at(value, low)[0], box.top + box.height
        parts.append(f'<path d="M{x:.1f} {foot:g}v4" stroke="{style.REFERENCE}"/>')
        parts.append(word(x, foot + 15.0, number(value + 0.0, 3), "middle"))
    parts += [
        _drawn(one, [at(x, y) for x, y in zip(one.x.tolist(), one.y.tolist(), strict=True)]) for one in curves
    ]
    return Text.joined("", parts)


def _drawn(curve: Curve, points: list[tuple[float, float]]) -> str:
    if curve.dots:
        drawn = "".join(f"M{x:.1f} {y:.1f}h0" for x, y in points)
        return f'<path d="{drawn}" stroke="{curve.color}" stroke-width="3" stroke-linecap="round"/>'
    drawn = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
    return f'<polyline points="{drawn}" fill="none" stroke="{curve.color}" stroke-width="1.4"/>'


def _step(least: float) -> float:
    """Step of 1, 2 or 5 times a power of ten, at least as large."""
    power = 10.0 ** math.floor(math.log10(least))
    return next(power * step for step in _STEPS if power * step >= least * (1.0 - 1e-9))


def picture(width: int, height: int, told: str, parts: Iterable[str]) -> str:
    """Frame of a picture, no wider than its column.

    Parameters
    ----------
    width, height : int
        Px.
    told : str
        What it shows, for those who do not see it.
    parts : iterable of str
        Axes, words and keys.
    """
    return Text(
        '<svg viewBox="0 0 {width} {height}" width="{width}" height="{height}" role="img" '
        'style="max-width:100%" aria-label="{told:html}" font-family="{font}" font-size="12" '
        'fill="{ink}">{parts}</svg>',
        width=width,
        height=height,
        told=told,
        font=style.SVG_FONT,
        ink=style.INK,
        parts=Text.joined("", parts),
    )


def word(x: float, y: float, words: str, anchor: str = "start") -> str:
    """Write words with their start, middle or end at a point."""
    return Text(
        '<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}">{words}</text>',
        x=x,
        y=y,
        anchor=anchor,
        words=words,
    )


def key(x: float, y: float, color: str, words: str, dots: bool = False) -> str:
    """Entry of a legend."""
    line = (
        f'<circle cx="{x + 9.0:.0f}" cy="{y - 4.0:.0f}" r="2.5" fill="{color}"/>'
        if dots
        else f'<path d="M{x:.0f} {y - 4.0:.0f}h18" stroke="{color}" stroke-width="2"/>'
    )
    return Text("{line}{word}", line=line, word=word(x + 23.0, y, words))

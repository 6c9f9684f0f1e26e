"""A recorded log against the track recorded with it: forward speed of both, and what lies between them."""

import math

import numpy as np

from navcore.foundation.text import Text
from navcore.sensors.fit import LogAlongTrack
from navcore.sensors.true_state import horizontal_state, to_ship
from schuler_bench.plots import style
from schuler_bench.plots.units import number

WIDTH, HEIGHT = 312, 244
_LEFT, _RIGHT, _TOP, _PANEL, _BETWEEN = 46, 8, 24, 76, 40
_MOST = 240
"""Points of a curve: means over as many parts of the record."""
_TOLD = Text("forward speed of log and ship, and their difference, over time")
_STEPS = (1.0, 2.0, 5.0, 10.0)


def log_svg(log: LogAlongTrack, delay_s: float) -> str:
    """Draw forward speed of log and ship, m/s, and their difference, over the time in minutes.

    Parameters
    ----------
    log : LogAlongTrack
        With at least two samples.
    delay_s : float
        Of the log; the ship's speed is that of so long before.
    """
    known = log.time_s >= delay_s
    time_s, reading = log.time_s[known], log.reading[known, 1]
    ship = to_ship(*horizontal_state(log.truth, time_s - delay_s))[:, 1]
    minutes, *curves = (_means(values) for values in (time_s / 60.0, ship, reading, reading - ship))
    panels = (
        _panel(_TOP, minutes, [(curves[0], style.TRUTH_COLOR), (curves[1], style.METHOD_COLORS[1])]),
        _panel(_TOP + _PANEL + _BETWEEN, minutes, [(curves[2], style.METHOD_COLORS[1])]),
        _key(_LEFT, 12.0, style.TRUTH_COLOR, Text("ship")),
        _key(_LEFT + 70.0, 12.0, style.METHOD_COLORS[1], Text("log, forward (m/s)")),
        _word(_LEFT, _TOP + _PANEL + _BETWEEN - 8.0, Text("difference (m/s)"), "start"),
        _word(WIDTH - _RIGHT, HEIGHT - 2.0, Text("time (min)"), "end"),
    )
    return Text(
        '<svg viewBox="0 0 {width} {height}" width="{width}" height="{height}" role="img" '
        'style="max-width:100%" aria-label="{told:html}" font-family="{font}" font-size="12" '
        'fill="{ink}">{panels}</svg>',
        width=WIDTH,
        height=HEIGHT,
        told=_TOLD,
        font=style.FONT_FAMILY.replace(chr(34), chr(39)),
        ink=style.INK,
        panels=Text.joined("", panels),
    )


def _means(values: np.ndarray) -> np.ndarray:
    begins = np.unique(np.linspace(0, len(values), _MOST, endpoint=False).astype(int))
    return np.add.reduceat(values, begins) / np.diff(np.append(begins, len(values)))


def _panel(top: float, across: np.ndarray, curves: list[tuple[np.ndarray, str]]) -> str:
    """Axes with three ticks each way, and the curves."""
    every = np.concatenate([values for values, _ in curves])
    step = _step(max(float(np.ptp(every)), 0.02) / 2.0)
    low = step * math.floor(float(np.min(every)) / step)
    high = max(step * math.ceil(float(np.max(every)) / step), low + step)
    span = max(float(across[-1]), 1e-9)
    width = WIDTH - _LEFT - _RIGHT

    def at(x: float, y: float) -> tuple[float, float]:
        return _LEFT + width * x / span, top + _PANEL * (high - y) / (high - low)

    parts: list[str] = [
        f'<rect x="{_LEFT}" y="{top}" width="{width}" height="{_PANEL}" fill="none" '
        f'stroke="{style.REFERENCE}"/>'
    ]
    for value in np.arange(low, high + 0.5 * step, step).tolist():
        y = at(0.0, value)[1]
        parts.append(f'<path d="M{_LEFT} {y:.1f}h{width}" stroke="{style.GRID}"/>')
        parts.append(_word(_LEFT - 5.0, y + 4.0, number(round(value, 6) + 0.0, 3), "end"))
    tick = _step(span / 3.0)
    for value in np.arange(0.0, 0.9 * span, tick).tolist():
        x = at(value, low)[0]
        parts.append(f'<path d="M{x:.1f} {top + _PANEL}v4" stroke="{style.REFERENCE}"/>')
        parts.append(_word(x, top + _PANEL + 15.0, number(value, 3), "middle"))
    for values, color in curves:
        points = (at(x, y) for x, y in zip(across.tolist(), values.tolist(), strict=True))
        drawn = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
        parts.append(f'<polyline points="{drawn}" fill="none" stroke="{color}" stroke-width="1.4"/>')
    return Text.joined("", parts)


def _step(least: float) -> float:
    """Step of 1, 2 or 5 times a power of ten, at least as large."""
    power = 10.0 ** math.floor(math.log10(least))
    return next(power * step for step in _STEPS if power * step >= least * (1.0 - 1e-9))


def _word(x: float, y: float, words: str, anchor: str) -> str:
    return Text(
        '<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}">{words}</text>',
        x=x,
        y=y,
        anchor=anchor,
        words=words,
    )


def _key(x: float, y: float, color: str, words: str) -> str:
    line = f'<path d="M{x:.0f} {y - 4.0:.0f}h18" stroke="{color}" stroke-width="2"/>'
    return Text("{line}{word}", line=line, word=_word(x + 23.0, y, words, "start"))

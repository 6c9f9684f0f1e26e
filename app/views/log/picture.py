"""A recorded log against the track recorded with it: forward speed of both, and what lies between them."""

import numpy as np

from navcore.fitting.along_track import LogAlongTrack
from navcore.foundation.text import Text
from navcore.sensors.true_state import horizontal_state, to_ship
from schuler_bench.plots import style
from schuler_bench.plots.svg_axes import Box, Curve, axes, key, picture, word

WIDTH, HEIGHT = 312, 244
_LEFT, _RIGHT, _TOP, _PANEL, _BETWEEN = 46, 8, 24, 76, 40
_MOST = 240
"""Points of a curve: means over as many parts of the record."""
_TOLD = Text("forward speed of log and ship, and their difference, over time")


def log_svg(log: LogAlongTrack, delay_s: float) -> str:
    """Draw forward speed of log and ship, m/s, and their difference, over the time in minutes.

    Parameters
    ----------
    log : LogAlongTrack
        With at least two samples.
    delay_s : float
        Of the log; the ship's speed is that of so long before.
    """
    known = log.known(delay_s)
    time_s, reading = log.time_s[known], log.reading[known, 1]
    ship = to_ship(*horizontal_state(log.truth, time_s - delay_s))[:, 1]
    minutes, *curves = (_means(values) for values in (time_s / 60.0, ship, reading, reading - ship))
    ours = style.METHOD_COLORS[1]
    width, below = WIDTH - _LEFT - _RIGHT, _TOP + _PANEL + _BETWEEN
    both = Curve(minutes, curves[0], style.TRUTH_COLOR), Curve(minutes, curves[1], ours)
    panels = (
        axes(Box(_LEFT, _TOP, width, _PANEL), both),
        axes(Box(_LEFT, below, width, _PANEL), [Curve(minutes, curves[2], ours)]),
        key(_LEFT, 12.0, style.TRUTH_COLOR, Text("ship")),
        key(_LEFT + 70.0, 12.0, ours, Text("log, forward (m/s)")),
        word(_LEFT, below - 8.0, Text("difference (m/s)")),
        word(WIDTH - _RIGHT, HEIGHT - 2.0, Text("time (min)"), "end"),
    )
    return picture(WIDTH, HEIGHT, _TOLD, panels)


def _means(values: np.ndarray) -> np.ndarray:
    begins = np.unique(np.linspace(0, len(values), _MOST, endpoint=False).astype(int))
    return np.add.reduceat(values, begins) / np.diff(np.append(begins, len(values)))

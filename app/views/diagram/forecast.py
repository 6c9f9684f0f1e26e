"""Forecast of an averaging method's copies, against the errors that came (Zhao 2015, figures 4 to 6)."""

import numpy as np

from navcore.averaging.forecast import GUARD, THRESHOLD_SIGMA, base_motion
from navcore.averaging.plan import Plan
from navcore.averaging.record import sensed_at_rest, standing_signals
from navcore.engine.drivers.averaging import plan_of
from navcore.engine.run import Run
from navcore.foundation.text import Text
from navcore.foundation.units import DEG_PER_HOUR, HOUR, MICRO_G
from schuler_bench.plots import style
from schuler_bench.plots.svg_axes import Box, Curve, axes, key, word
from schuler_bench.plots.units import number
from schuler_bench.views.diagram.blocks import ahead_words
from schuler_bench.views.diagram.membership import picture

WIDTH, HEIGHT = 780, 412
_LEFT, _RIGHT = (54.0, 300.0), (430.0, 336.0)
"""Left edge and width of the columns: the record, and what came of the forecast."""
_ROWS, _ROW = (52.0, 222.0), 110.0
_COLORS = style.METHOD_COLORS[:3]
_STEP_S, _MEAN_S = 10.0, 600.0
"""Step of what came, and the means that are drawn."""
_MOST_POINTS = 300
_SENSORS = ((slice(0, 3), DEG_PER_HOUR, "°/h"), (slice(3, 6), MICRO_G, "µg"))
_TOLD = Text(
    "alignment record without motions of the base; forecast of gyros and accelerometers and what came"
)


def forecast_svg(run: Run, index: int) -> str:
    """Draw record and forecast of an averaging method, as departures from perfect sensors at rest.

    Left: seconds of the record that are used (dots), and those with a motion of the base beneath (grey).
    Right: the forecast as lines, and 10 min means of what the run's sensors feel at rest as dots.
    """
    method, scenario = run.scenario.method[index], run.scenario
    plan = plan_of(scenario, method, run.truth[0])
    ahead_s = max(plan.copies.ahead_s)
    count = int(ahead_s / _MEAN_S) * int(_MEAN_S / _STEP_S)
    came = sensed_at_rest(scenario.imu, plan.standing, count, _STEP_S, scenario.earth, scenario.run.seed)
    came = came.reshape(-1, int(_MEAN_S / _STEP_S), 6).mean(axis=1)
    perfect = standing_signals(plan.standing, scenario.earth)
    middle_s = _MEAN_S * (np.arange(len(came)) + 0.5)
    fit = plan.forecast.at(middle_s)
    parts: list[str] = [
        word(_LEFT[0], 18.0, Text("alignment record, s before the start")),
        word(_RIGHT[0], 18.0, Text("forecast (lines) and what came (dots, 10 min means), h")),
    ]
    parts += [
        key(_LEFT[0] + 42.0 * k, 36.0, color, axis, dots=True)
        for k, (axis, color) in enumerate(zip("xyz", _COLORS, strict=True))
    ]
    for top, (columns, unit, sign) in zip(_ROWS, _SENSORS, strict=True):
        parts.append(_record(plan, perfect, columns, unit, Box(_LEFT[0], top, _LEFT[1], _ROW)))
        curves = [
            Curve(middle_s / HOUR, (values[:, columns] - perfect[columns])[:, k] / unit, color, dots)
            for values, dots in ((came, True), (fit, False))
            for k, color in enumerate(_COLORS)
        ]
        parts.append(axes(Box(_RIGHT[0], top, _RIGHT[1], _ROW), curves, least=1e-6))
        parts.append(word(4.0, top - 10.0, sign))
        off = (fit - came)[:, columns].mean(axis=0) / unit
        told = Text(
            "forecast less what came, mean: {x}, {y}, {z} {unit}",
            x=number(float(off[0]), 2),
            y=number(float(off[1]), 2),
            z=number(float(off[2]), 2),
            unit=sign,
        )
        parts.append(word(_RIGHT[0] + _RIGHT[1], top + _ROW + 34.0, told, "end"))
    parts += [word(4.0, HEIGHT - 22.0, _rule()), word(4.0, HEIGHT - 5.0, _ahead(plan))]
    return picture(WIDTH, HEIGHT, _TOLD, parts)


def _rule() -> str:
    """When a second of the record counts as a motion of the base."""
    return Text(
        "A second is left out where a gyro turns by more than {sigma} σ off its median, and {guard} s "
        "around it.",
        sigma=number(THRESHOLD_SIGMA),
        guard=GUARD,
    )


def _ahead(plan: Plan) -> str:
    """How far each copy runs on the forecast."""
    leads = ", ".join(ahead_words(ahead) for ahead in plan.copies.ahead_s[1:])
    return Text("The copies run ahead on this forecast by {leads}.", leads=leads)


def _record(plan: Plan, perfect: np.ndarray, columns: slice, unit: float, box: Box) -> str:
    """Used seconds of the record and the motions that are left out."""
    seconds = np.arange(len(plan.record)) - len(plan.record) + 0.5
    moving = base_motion(plan.record[:, :3])
    off = (plan.record[:, columns] - perfect[columns]) / unit
    used = np.flatnonzero(~moving)
    shown = used[np.unique(np.linspace(0, len(used) - 1, _MOST_POINTS).astype(int))]
    curves = [Curve(seconds[shown], off[shown, k], color, dots=True) for k, color in enumerate(_COLORS)]
    width = box.width / len(seconds)
    shades = "".join(
        f'<rect x="{box.left + width * i:.1f}" y="{box.top:g}" width="{width + 0.1:.2f}" '
        f'height="{box.height:g}" fill="{style.REFERENCE}" fill-opacity="0.5"/>'
        for i in np.flatnonzero(moving)
    )
    drawn = axes(box, curves, least=1e-6, ends=(seconds[0] - 0.5, 0.0))
    count = int(moving.sum())
    left_out = (
        Text("{count} s of {all} s left out: the base moved", count=count, all=len(seconds))
        if count
        else Text("all {all} s used", all=len(seconds))
    )
    below = word(box.left + box.width, box.top + box.height + 34.0, left_out, "end")
    return Text("{shades}{drawn}{below}", shades=shades, drawn=drawn, below=below)

"""When each method damps: its policy's measure and thresholds, wanted and actual state, xi(t), its margin."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from navcore.engine.in_force import damping_in_force
from navcore.engine.run import MethodRun, Run
from navcore.foundation.notation import unit_sign, with_unit
from navcore.foundation.parameters import extra_of
from navcore.foundation.text import Text
from navcore.law.policy.base import Limit, Measure
from schuler_bench.plots import style
from schuler_bench.plots.units import AUTO, Unit, number, time_unit
from schuler_bench.plots.uplot import LABEL_SIZE, Y_SIZE, Curve, Dash, UplotFigure

MOST_POINTS = 2000
STATE, XI, MARGIN = "state", "xi", "margin"
_WANTED, _DAMPED, _XI, _MEASURE, _MARGIN = range(5)
_LANE = 1.4
"""Height of one method's on and off above the next one's."""
_NUMBERS = {
    _XI: (XI, Text("Damping ratio in force"), "ζ"),
    _MARGIN: (MARGIN, Text("Least damping ratio of the closed-loop poles in force"), Text("least ζ")),
}
"""Column -> key, title and symbol of the plots of a number without unit."""
_WANTED_DASH: Dash = (3, 4)
_LIMIT_DASH: Dash = (10, 4)
_NO_UNIT = Unit("–", 1.0)
_WORDS = Unit("", 1.0)
_WORDED_LANES = 4
_LONGEST = 8
"""Letters of a measure's name that fit on the axis of a low plot; a longer one stands in the legend."""


class Switched(NamedTuple):
    """A method that does not always damp alike, and what its policy measures.

    The limits are its thresholds, in the unit of the measure.
    """

    run: MethodRun
    measure: Measure | None
    limits: tuple[Limit, ...]


_Pair = tuple[Switched, np.ndarray]
"""A method, and its columns."""


def switched_methods(run: Run) -> tuple[Switched, ...]:
    """Methods with a policy that is not constant; empty when nothing switches."""
    return tuple(
        Switched(method, method.method.policy.measure, method.method.policy.limits())
        for method in run.methods
        if not method.method.undamped and method.method.policy.id != "constant"
    )


def switching_plots(run: Run, wanted_time: str = AUTO) -> tuple[UplotFigure, ...]:
    """One plot for each kind of measure, then the states, and the damping ratios asked for and of the loop.

    They share one time axis; there is none while every method is constant.

    Parameters
    ----------
    run : Run
        Result; its output rows are drawn, thinned so that every peak stays.
    wanted_time : str
        Unit of the time axis by name.
    """
    methods = switched_methods(run)
    if not methods:
        return ()
    unit_of_time = time_unit(float(run.t_s[-1]), wanted_time)
    rows = [_on_axis(_series(method.run), len(run.t_s)) for method in methods]
    time_s, thinned = thin(run.t_s, np.hstack(rows))
    values = np.split(thinned, len(methods), axis=1)
    axis = {"time": np.ascontiguousarray(time_s / unit_of_time.si), "time_unit": unit_of_time}
    pairs = list(zip(methods, values, strict=True))
    return (
        *(_measure_plot(place, kind, pairs, axis) for place, kind in enumerate(_kinds(methods))),
        _state_plot(pairs, axis),
        *(
            UplotFigure(
                key=key,
                quantity=key,
                title=title,
                symbol=symbol,
                unit=_NO_UNIT,
                curves=tuple(_curve(pair, column) for pair in pairs),
                **axis,
            )
            for column, (key, title, symbol) in _NUMBERS.items()
        ),
    )


def _curve(pair: _Pair, column: int, si: float = 1.0, above: float = 0.0) -> Curve:
    """One column of a method's values, in a unit of ``si``, drawn higher by ``above``."""
    method, values = pair
    color = style.method_color(method.run.place)
    return Curve(method.run.method.name, color, np.ascontiguousarray(values[:, column] / si + above))


def _series(method: MethodRun) -> np.ndarray:
    """Columns of the law, and the damping ratio of the loop in force."""
    margin = damping_in_force(method.method, method.network, method.t_s, method.law_series)
    return np.column_stack([method.law_series, np.nan_to_num(margin)])


def _kinds(methods: Sequence[Switched]) -> list[Measure]:
    return list(dict.fromkeys(method.measure for method in methods if method.measure is not None))


def _measure_plot(place: int, measure: Measure, pairs: list[_Pair], axis: dict[str, Any]) -> UplotFigure:
    mine = [pair for pair in pairs if pair[0].measure == measure]
    limits = [
        Curve(name, color, np.full(len(axis["time"]), value), _LIMIT_DASH)
        for name, value, color in shared_limits([method for method, _ in mine])
    ]
    return UplotFigure(
        key=f"measure{place}",
        quantity="measure",
        title=measure.label,
        symbol=_symbol(place, measure),
        unit=Unit(unit_sign(measure.unit), measure.si),
        curves=(*(_curve(pair, _MEASURE, measure.si) for pair in mine), *limits),
        **axis,
    )


def _symbol(place: int, measure: Measure) -> str:
    """Name on the axis of a low plot: a long one is a number there, which the legend explains."""
    return measure.label if len(measure.label) <= _LONGEST else chr(ord("①") + place)


def shared_limits(methods: Sequence[Switched]) -> list[tuple[str, float, str]]:
    """Name, value and colour of each threshold: of its method, or ink where several have the same one."""
    owners: dict[tuple[str, float], list[int]] = {}
    for method in methods:
        for limit in method.limits:
            owners.setdefault((_name(method, limit), limit.value), []).append(method.run.place)
    return [
        (name, value, style.method_color(places[0]) if len(places) == 1 else style.INK)
        for (name, value), places in owners.items()
    ]


def _name(method: Switched, limit: Limit) -> str:
    """Letter as in the policy's rule, else the label of the field that sets the limit."""
    if len(limit.name) <= 2:
        return limit.name
    info = type(method.run.method.policy).model_fields[limit.name]
    return extra_of(info).get("label", limit.name)


def _state_plot(pairs: list[_Pair], axis: dict[str, Any]) -> UplotFigure:
    lows = [_LANE * place for place in reversed(range(len(pairs)))]
    lanes = list(zip(pairs, lows, strict=True))
    wanted = [_curve(pair, _WANTED, above=low) for pair, low in lanes]
    if len(lows) == 1:
        ticks = (lows[0], Text("off")), (lows[0] + 1.0, "on")
    else:  # each lane's on, as far as there is room for words
        word = "on" if len(lows) <= _WORDED_LANES else ""
        ticks = tuple((low + 1.0, word) for low in reversed(lows))
    return UplotFigure(
        key=STATE,
        quantity=STATE,
        title=Text("Wanted and actual state"),
        symbol=Text("damped"),
        unit=_WORDS,
        curves=(
            *(_curve(pair, _DAMPED, above=low) for pair, low in lanes),
            *(
                replace(c, name=Text("{name}, wanted", name=c.name), color=style.INK, dash=_WANTED_DASH)
                for c in wanted
            ),
        ),
        floor=-0.15,
        ticks=ticks,
        **axis,
    )


def thin(time_s: np.ndarray, values: np.ndarray, most: int = MOST_POINTS) -> tuple[np.ndarray, np.ndarray]:
    """Take the smallest and the largest value of each bin, in the order in which they came.

    Parameters
    ----------
    time_s : ndarray, shape (n,)
        Times.
    values : ndarray, shape (n, k)
        Columns.
    most : int
        Points to keep; fewer come back as they are.

    Returns
    -------
    ndarray, shape (m,), and ndarray, shape (m, k).
    """
    count = len(time_s)
    if count <= most:
        return time_s, values
    width = -(-2 * count // most)
    bins = -(-count // width)
    whole = np.concatenate([values, np.repeat(values[-1:], bins * width - count, axis=0)])
    binned = whole.reshape(bins, width, -1)
    low, high = np.nanmin(binned, axis=1), np.nanmax(binned, axis=1)
    rising = np.nanargmax(binned, axis=1) >= np.nanargmin(binned, axis=1)
    kept = np.empty((2 * bins, values.shape[1]))
    kept[0::2], kept[1::2] = np.where(rising, low, high), np.where(rising, high, low)
    first = np.arange(bins) * width
    last = np.minimum(first + width, count) - 1
    times = np.empty(2 * bins)
    times[0::2] = time_s[first]
    times[1::2] = np.where(last > first, 0.5 * (time_s[first] + time_s[last]), time_s[last])
    times[-1] = time_s[-1]
    return (times, kept) if times[-1] > times[-2] else (times[:-1], kept[:-1])


def _on_axis(rows: np.ndarray, count: int) -> np.ndarray:
    """Rows of a method that may have ended early, on the run's time axis: the last one stays."""
    missing = count - len(rows)
    return rows if missing <= 0 else np.concatenate([rows, np.repeat(rows[-1:], missing, axis=0)])


def switching_legend(run: Run) -> str:
    """Measures, their thresholds, and what the dashes mean; the strip of results names the methods."""
    items = [
        Text(
            '<span class="sb-entry"><span style="flex:none;width:18px;{bar}"></span>{name:html}</span>',
            bar=bar,
            name=name,
        )
        for name, bar in _legend(run)
    ]
    return Text(
        '<div class="sb-legend" style="padding-left:{y_size}px">{items}</div>',
        y_size=Y_SIZE + LABEL_SIZE,
        items=Text.joined("", items),
    )


def _legend(run: Run) -> list[tuple[str, str]]:
    """Text and style of each entry."""
    methods, items = switched_methods(run), list[tuple[str, str]]()
    for place, kind in enumerate(_kinds(methods)):
        mine = [m for m in methods if m.measure == kind]
        if len(kind.label) > _LONGEST:
            items.append(
                (Text("{symbol} {label}", symbol=_symbol(place, kind), label=kind.label), "display:none")
            )
        for name, value, color in shared_limits(mine):
            items.append(
                (
                    Text("{name} = {with_unit}", name=name, with_unit=with_unit(number(value, 4), kind.unit)),
                    f"border-top:2px dashed {color}",
                )
            )
    items.append((Text("wanted state"), f"border-top:2px dotted {style.INK}"))
    return [*items, (Text("least ζ: of the poles in force"), "display:none")]

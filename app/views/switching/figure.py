"""When each method damps: its policy's measure and thresholds, wanted and actual state, xi(t), its margin."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape

import numpy as np

from app.plots import style
from app.plots.units import AUTO, Unit, number, time_unit
from app.plots.uplot import LABEL_SIZE, Y_SIZE, Dash, UplotFigure
from navcore.engine.in_force import damping_in_force
from navcore.engine.run import MethodRun, Run
from navcore.foundation.notation import unit_sign, with_unit
from navcore.foundation.parameters import extra_of
from navcore.law.policy.base import Limit, Measure

MOST_POINTS = 2000
STATE, XI, MARGIN = "state", "xi", "margin"
_WANTED, _DAMPED, _XI, _MEASURE, _MARGIN = range(5)
_LANE = 1.4
"""Height of one method's on and off above the next one's."""
_WANTED_DASH: Dash = (3, 4)
_LIMIT_DASH: Dash = (10, 4)
_NO_UNIT = Unit("–", 1.0)
_WORDS = Unit("", 1.0)
_WORDED_LANES = 4
_LONGEST = 8
"""Letters of a measure's name that fit on the axis of a low plot; a longer one stands in the legend."""


@dataclass(frozen=True)
class Switched:
    """A method that does not always damp alike.

    Attributes
    ----------
    index : int
        Its place in the scenario.
    run : MethodRun
        The method.
    measure : Measure or None
        What its policy measures.
    limits : tuple of Limit
        Its thresholds, in the unit of the measure.
    """

    index: int
    run: MethodRun
    measure: Measure | None
    limits: tuple[Limit, ...]


def switched_methods(run: Run) -> tuple[Switched, ...]:
    """Methods with a policy that is not constant; empty when nothing switches."""
    return tuple(
        Switched(i, method, method.method.policy.measure, method.method.policy.limits())
        for i, method in enumerate(run.methods)
        if method.method.damping in ("internal", "external") and method.method.policy.id != "constant"
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
    whole = np.hstack([_on_axis(_series(method.run), len(run.t_s)) for method in methods])
    time_s, thinned = thin(run.t_s, whole)
    time = np.ascontiguousarray(time_s / unit_of_time.si)
    width = whole.shape[1] // len(methods)
    pairs = [(m, thinned[:, width * place : width * (place + 1)]) for place, m in enumerate(methods)]
    measures = []
    for place, kind in enumerate(_kinds(methods)):
        mine = [pair for pair in pairs if pair[0].measure == kind]
        measures.append(_measure_plot(place, kind, mine, time, unit_of_time))
    return (
        *measures,
        _state_plot(pairs, time, unit_of_time),
        _xi_plot(pairs, time, unit_of_time),
        _margin_plot(pairs, time, unit_of_time),
    )


def _series(method: MethodRun) -> np.ndarray:
    """Columns of the law, and the damping ratio of the loop in force."""
    margin = damping_in_force(method.method, method.network, method.t_s, method.law_series)
    return np.column_stack([method.law_series, np.nan_to_num(margin)])


def _kinds(methods: Sequence[Switched]) -> list[Measure]:
    return list(dict.fromkeys(method.measure for method in methods if method.measure is not None))


_Pairs = list[tuple[Switched, np.ndarray]]


def _measure_plot(
    place: int, measure: Measure, pairs: _Pairs, time: np.ndarray, unit_of_time: Unit
) -> UplotFigure:
    limits = shared_limits([method for method, _ in pairs])
    return UplotFigure(
        key=f"measure{place}",
        quantity="measure",
        title=measure.label,
        symbol=_symbol(place, measure),
        unit=Unit(unit_sign(measure.unit), measure.si),
        time_unit=unit_of_time,
        names=(*(m.run.method.name for m, _ in pairs), *(name for name, _, _ in limits)),
        colors=(*(style.method_color(m.index) for m, _ in pairs), *(color for _, _, color in limits)),
        dashes=(*((),) * len(pairs), *(_LIMIT_DASH,) * len(limits)),
        data=(
            time,
            *(np.ascontiguousarray(values[:, _MEASURE] / measure.si) for _, values in pairs),
            *(np.full(len(time), value) for _, value, _ in limits),
        ),
    )


def _symbol(place: int, measure: Measure) -> str:
    """Name on the axis of a low plot: a long one is a number there, which the legend explains."""
    return measure.label if len(measure.label) <= _LONGEST else chr(ord("①") + place)


def shared_limits(methods: Sequence[Switched]) -> list[tuple[str, float, str]]:
    """Name, value and colour of each threshold: of its method, or ink where several have the same one."""
    owners: dict[tuple[str, float], list[int]] = {}
    for method in methods:
        for limit in method.limits:
            owners.setdefault((_name(method, limit), limit.value), []).append(method.index)
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


def _state_plot(pairs: _Pairs, time: np.ndarray, unit_of_time: Unit) -> UplotFigure:
    base = [_LANE * place for place in reversed(range(len(pairs)))]
    lanes = list(zip(pairs, base, strict=True))
    return UplotFigure(
        key=STATE,
        quantity=STATE,
        title="Wanted and actual state",
        symbol="damped",
        unit=_WORDS,
        time_unit=unit_of_time,
        names=(*(m.run.method.name for m, _ in pairs), *(f"{m.run.method.name}, wanted" for m, _ in pairs)),
        colors=(*(style.method_color(m.index) for m, _ in pairs), *(style.INK for _ in pairs)),
        dashes=(*((),) * len(pairs), *(_WANTED_DASH,) * len(pairs)),
        data=(
            time,
            *(np.ascontiguousarray(values[:, _DAMPED] + low) for (_, values), low in lanes),
            *(np.ascontiguousarray(values[:, _WANTED] + low) for (_, values), low in lanes),
        ),
        floor=-0.15,
        ticks=_state_ticks(base),
    )


def _state_ticks(base: list[float]) -> tuple[tuple[float, str], ...]:
    """On and off for one method; of several each lane's on, as far as there is room for words."""
    if len(base) == 1:
        return (base[0], "off"), (base[0] + 1.0, "on")
    return tuple((low + 1.0, "on" if len(base) <= _WORDED_LANES else "") for low in reversed(base))


def _xi_plot(pairs: _Pairs, time: np.ndarray, unit_of_time: Unit) -> UplotFigure:
    title = "Damping ratio in force"
    return _column_plot(pairs, time, unit_of_time, _XI, key=XI, title=title, symbol="ζ")


def _margin_plot(pairs: _Pairs, time: np.ndarray, unit_of_time: Unit) -> UplotFigure:
    title = "Least damping ratio of the closed-loop poles in force"
    return _column_plot(pairs, time, unit_of_time, _MARGIN, key=MARGIN, title=title, symbol="least ζ")


def _column_plot(
    pairs: _Pairs, time: np.ndarray, unit_of_time: Unit, column: int, *, key: str, title: str, symbol: str
) -> UplotFigure:
    """Plot one column of each method's values, a number without unit."""
    return UplotFigure(
        key=key,
        quantity=key,
        title=title,
        symbol=symbol,
        unit=_NO_UNIT,
        time_unit=unit_of_time,
        names=tuple(m.run.method.name for m, _ in pairs),
        colors=tuple(style.method_color(m.index) for m, _ in pairs),
        data=(time, *(np.ascontiguousarray(values[:, column]) for _, values in pairs)),
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
    """Names of the methods that switch, their thresholds, and what the dashes mean."""
    items = "".join(
        f'<span style="display:inline-flex;align-items:center;gap:6px;white-space:nowrap">'
        f'<span style="width:18px;{bar}"></span>{escape(name)}</span>'
        for name, bar in _legend(run)
    )
    return (
        f'<div style="display:flex;flex-wrap:wrap;gap:2px 18px;padding:2px 8px 2px {Y_SIZE + LABEL_SIZE}px;'
        f'font-size:{style.FONT_SIZE}px;color:{style.INK}">{items}</div>'
    )


def legend_names(run: Run) -> list[str]:
    """Texts of `switching_legend`, from which its height follows."""
    return [name for name, _ in _legend(run)]


def _legend(run: Run) -> list[tuple[str, str]]:
    """Text and style of each entry."""
    methods = switched_methods(run)
    items = [
        (m.method.name, f"border-top:3px solid {style.method_color(i)}") for i, m in enumerate(run.methods)
    ]
    for place, kind in enumerate(_kinds(methods)):
        mine = [m for m in methods if m.measure == kind]
        if len(kind.label) > _LONGEST:
            items.append((f"{_symbol(place, kind)} {kind.label}", "display:none"))
        for name, value, color in shared_limits(mine):
            items.append(
                (f"{name} = {with_unit(number(value, 4), kind.unit)}", f"border-top:2px dashed {color}")
            )
    items.append(("wanted state", f"border-top:2px dotted {style.INK}"))
    return [*items, ("least ζ: of the poles in force", "display:none")]

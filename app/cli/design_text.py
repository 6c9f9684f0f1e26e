"""Budgets, best settings and fronts as tables for people."""

from collections.abc import Sequence

from navcore.analysis.whole_system import duration
from navcore.design.confirm import Confirmed
from navcore.design.measures import in_display_unit
from navcore.design.pareto import Pareto
from navcore.design.tune import Tuned
from navcore.foundation.answers import columns, number
from navcore.quantities import TUNED
from navcore.study.robust_tune import TunedOver


def unstated(fields: Sequence[str]) -> list[str]:
    """Note on what is assumed of constants that the scenario does not state."""
    return [f"note: 0 is assumed for {', '.join(fields)}"] if fields else []


def tune_text(objective: str, tuned: Tuned) -> list[str]:
    """Lines: the best values and how flat the optimum is, the objective before and after, what holds it."""
    rows = [["parameter", "best", "within 5 %", ""]]
    for field, value in tuned.best.items():
        low, high = tuned.flat.get(field, (value, value))
        end = "at the end of its range" if field in tuned.at_end_of_range else ""
        rows.append([field, number(value, 5), f"{number(low, 3)} to {number(high, 3)}", end])
    lines = [*columns(rows), ""]
    lines += columns(
        [
            [objective, "", ""],
            ["  before", *_in_unit(objective, tuned.before)],
            ["  after", *_in_unit(objective, tuned.objective)],
            ["  floor", *_in_unit(objective, tuned.floor)],
            ["  times the floor", number(tuned.objective / tuned.floor, 4) if tuned.floor else "-", ""],
        ]
    )
    if isinstance(tuned, TunedOver):
        lines += _over(objective, tuned)
    if tuned.confirmed is not None:
        lines += _confirmed(tuned.confirmed)
    if tuned.default_limits:
        lines.append(f"by default: {', '.join(tuned.default_limits)} (--no-default-limits: without)")
    for text in tuned.active:
        cost = tuned.cost.get(text)
        without = " ".join(_in_unit(objective, cost)).rstrip()
        lines.append(f"active: {text}" + ("" if cost is None else f"; without it {without}"))
    return [*lines, *(f"warning: {text}" for text in tuned.warnings), *unstated(tuned.assumed_zero)]


def _over(objective: str, tuned: TunedOver) -> list[str]:
    where = ", ".join(f"{name} = {value}" for name, value in tuned.where.items()) or "the scenario itself"
    rows = [
        [f"over {tuned.points} points", "", "", ""],
        ["  worst", *_in_unit(objective, tuned.worst), where],
        ["  in the scenario itself", *_in_unit(objective, tuned.here), ""],
        ["  best there", *_in_unit(objective, tuned.best_here), ""],
    ]
    return ["", *columns(rows)]


def _confirmed(confirmed: Confirmed) -> list[str]:
    rows = [[f"run, {confirmed.seeds} seeds", "before", "after", "difference", "95 % interval", ""]]
    for name, change in confirmed.changes.items():
        values = [change.before, change.after, change.difference, change.low, change.high]
        cells = [_in_unit(name, value)[0] if name in TUNED else number(value) for value in values]
        unit = _in_unit(name, 0.0)[1] if name in TUNED else ""
        rows.append([f"  {name}", *cells[:3], f"{cells[3]} to {cells[4]}", unit])
    return ["", *columns(rows), ""]


def pareto_text(fronts: Pareto) -> list[str]:
    """Lines: for each network the ends of its front and the settings there, the present design, the floor."""
    first, second = fronts.objectives
    rows = [
        ["", first, second, ""],
        ["", *(in_display_unit(name, None)[1] for name in fronts.objectives), ""],
    ]
    for name, points in fronts.fronts.items():
        chosen = [points[0], points[len(points) // 2], points[-1]] if len(points) > 2 else list(points)
        for k, point in enumerate(chosen):
            setting = ", ".join(
                f"{field} = {value:.4g}" for field, value in point.network.items() if isinstance(value, float)
            )
            if point.growth_per_s > 0.0:
                every = duration(1.0 / point.growth_per_s)
                setting = f"{setting or 'no parameter'}; its whole system grows by e in {every}"
            rows.append([name if k == 0 else "", *_values(fronts, point.values), setting])
    if fronts.present is not None:
        rows.append(["as it is", *_values(fronts, fronts.present), ""])
    rows.append(["floor", *_values(fronts, fronts.floor), ""])
    lines = columns([row[:3] for row in rows])
    return [f"{line}  {row[3]}".rstrip() for line, row in zip(lines, rows, strict=True)]


def _values(fronts: Pareto, values: tuple[float | None, float | None]) -> list[str]:
    return [_in_unit(name, value)[0] for name, value in zip(fronts.objectives, values, strict=True)]


def _in_unit(name: str, value: float | None) -> list[str]:
    """A value of a measure and its unit."""
    in_unit, unit = in_display_unit(name, value)
    return [number(in_unit), unit]

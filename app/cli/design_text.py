"""Budgets, best settings and fronts as tables for people."""

from collections.abc import Sequence

from navcore.analysis.whole_system import duration
from navcore.design.measures import in_display_unit
from navcore.design.pareto import Pareto
from navcore.foundation.answers import columns, number


def unstated(fields: Sequence[str]) -> list[str]:
    """Note on what is assumed of constants that the scenario does not state."""
    return [f"note: 0 is assumed for {', '.join(fields)}"] if fields else []


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

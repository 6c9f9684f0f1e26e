"""The proposal of a search as HTML: each field now and proposed, and what holds the optimum where it is."""

from __future__ import annotations

from html import escape
from typing import TYPE_CHECKING

from app.plots.units import number
from navcore.foundation.units import ARCMIN, ARCSEC, MINUTE

if TYPE_CHECKING:
    from app.jobs.designer import TuningTask
    from navcore.design.tune import Tuned

OBJECTIVES = {
    "tilt_rms": ("tilt, RMS in the steady state", "arcsec", ARCSEC),
    "velocity_rms": ("velocity, RMS in the steady state", "m/s", 1.0),
    "position_rms": ("position, RMS over the run", "m", 1.0),
    "heading_rms": ("heading, RMS over the run", "arcmin", ARCMIN),
    "settling_s": ("settling time", "min", MINUTE),
}
"""What a method can be tuned for: label, unit, and the unit's size in SI."""


def proposal_html(task: TuningTask, found: Tuned) -> str:
    """Table of the present and the proposed setting, the objective, and sentences about the optimum."""
    label, unit, size = OBJECTIVES[task.objective]
    rows = []
    data = task.scenario.canonical()
    for field, value in found.best.items():
        low, high = found.flat.get(field, (value, value))
        now = _value(data, field)
        rows.append(
            (
                field.split(".", 2)[-1],
                "default" if now is None else number(now, 4),
                number(value, 4),
                f"{number(low, 3)} to {number(high, 3)}",
            )
        )
    objective = [
        f"{label}, {unit}",
        "none" if found.before is None else number(found.before / size, 4),
        number(found.objective / size, 4),
        "" if found.floor is None else f"floor {number(found.floor / size, 4)}",
    ]
    head = ("", "now", "proposed", "within 5 % of the best")
    cells = "".join(_row(row) for row in (*rows, objective))
    table = f"<table><thead>{_row(head, 'th')}</thead><tbody>{cells}</tbody></table>"
    sentences = "".join(f"<p>{escape(text)}</p>" for text in sentences_about(task, found))
    return f'<div class="sb-table sb-proposal" style="padding:4px 10px">{table}{sentences}</div>'


def sentences_about(task: TuningTask, found: Tuned) -> list[str]:
    """What the user should know about the optimum, one sentence each."""
    _, unit, size = OBJECTIVES[task.objective]
    told = []
    if found.stopped:
        told.append("The search was stopped: this is the best setting it had seen.")
    if found.floor:
        told.append(f"The proposed setting is {number(found.objective / found.floor, 3)} times the floor.")
    for field in found.at_end_of_range:
        told.append(f"{field} stands at the end of its range: the true optimum may lie outside.")
    for text in found.active:
        without = found.cost.get(text)
        more = "" if without is None else f" Without it the objective is {number(without / size, 4)} {unit}."
        told.append(f"The requirement {text} holds the optimum back.{more}")
    return told


def _value(data: object, field: str) -> float | None:
    for part in field.split("."):
        if isinstance(data, list):
            data = data[int(part)]
        elif isinstance(data, dict):
            data = data.get(part)
    return float(data) if isinstance(data, int | float) else None


def _row(cells: tuple[str, ...] | list[str], tag: str = "td") -> str:
    return "<tr>" + "".join(f"<{tag}>{escape(cell)}</{tag}>" for cell in cells) + "</tr>"

"""The table of the pins and the present run: what each measures, and whether it meets the requirements."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape

from app.plots import style
from app.plots.units import rounded, settling
from app.session.laid import edited
from app.session.pins import Pin
from app.session.requirements import MEASURES, Requirements, verdicts
from app.session.window import Window
from navcore.engine.run import MethodRun, Run
from navcore.foundation.units import MINUTE

COLUMNS: dict[str, str] = {
    "pinned": "run",
    "method": "method",
    "settling": "settles to 2 %",
    "velocity": "velocity RMS (m/s)",
    "tilt": "largest tilt (arcsec)",
    "position": "largest position error (m)",
    "verdict": "requirements",
}
"""Columns by which the table can be sorted, and their headings."""
PRESENT = "present run"
_TEXTS = ("pinned", "method")


@dataclass(frozen=True)
class Line:
    """One line: a pin, or the present run, by the method that is or was edited.

    Attributes
    ----------
    pin : Pin or None
        None for the present run.
    color : str
        Of its curve, ``#RRGGBB``.
    method : str
        Name of the method.
    numbers : dict of str to float
        What is measured, by the keys of `COLUMNS`; none while the run is being computed.
    asked : int
        Requirements there are.
    """

    pin: Pin | None
    color: str
    method: str
    numbers: dict[str, float]
    asked: int = 0

    def key(self, column: str) -> tuple[bool, float, str]:
        """By what it is sorted: what is not known comes last."""
        if column == "pinned":
            return False, float(0 if self.pin is None else self.pin.id), ""
        if column == "method":
            return False, 0.0, self.method
        value = self.numbers.get(column, math.nan)
        return math.isnan(value), 0.0 if math.isnan(value) else value, ""


def lines_of(
    window: Window, selected: int, pins: Sequence[Pin], requirements: Requirements
) -> tuple[Line, ...]:
    """Measure the present run and the pins, each by its edited method, over the same window.

    Parameters
    ----------
    window : Window
        Part of the run that counts.
    selected : int
        Place of the method that is edited now.
    pins : sequence of Pin
        Pinned runs.
    requirements : Requirements
        By which all of them are judged.
    """
    place = min(selected, len(window.run.methods) - 1)
    lines = [_line(None, style.method_color(place), window.run, place, requirements)]
    for pin in pins:
        place = edited(pin)
        if pin.run is None:
            lines.append(Line(pin, pin.hex, pin.scenario.method[place].name, {}))
        else:
            lines.append(_line(pin, pin.hex, window.of(pin.run), place, requirements))
    return tuple(lines)


def _line(pin: Pin | None, color: str, run: Run, place: int, requirements: Requirements) -> Line:
    method = run.methods[place]
    numbers = _numbers(method)
    asked = 0
    if requirements.any:
        limits = [found for found in verdicts(run, requirements) if found.limit is not None]
        asked = len(limits)
        numbers["verdict"] = float(sum(not found.passed[place] for found in limits))
    return Line(pin, color, method.method.name, numbers, asked)


def _numbers(method: MethodRun) -> dict[str, float]:
    return {
        "settling": MEASURES["settling_min"](method),
        "velocity": MEASURES["velocity_rms_mps"](method),
        "tilt": MEASURES["tilt_max_arcsec"](method),
        "position": method.errors["position_m"]["max_abs"],
    }


def pins_html(lines: Sequence[Line], by: str, baseline: int | None, *, buttons: bool = True) -> str:
    """Return the table, sorted; its headings sort it otherwise.

    Parameters
    ----------
    lines : sequence of Line
        The present run and the pins.
    by : str
        Key of `COLUMNS`, with a minus sign for the other way round.
    baseline : int or None
        Id of the pin with which numbers are compared.
    buttons : bool
        False for a file: its headings sort nothing.
    """
    column, falling = by.removeprefix("-"), by.startswith("-")
    ordered = sorted(lines, key=lambda line: line.key(column), reverse=falling)
    best = {
        name: min(found)
        for name in COLUMNS
        if len(found := [v for line in lines if math.isfinite(v := line.numbers.get(name, math.nan))]) > 1
        and min(found) < max(found)
    }
    head = "".join(_head(name, title, column, falling, buttons) for name, title in COLUMNS.items())
    body = "".join(_row(line, best, baseline) for line in ordered)
    return (
        f'<div class="sb-pins sb-table" style="margin:4px 10px 8px;overflow-x:auto"><table style="'
        f"border-collapse:collapse;width:100%;font-size:{style.FONT_SIZE}px;color:{style.INK};"
        f'font-variant-numeric:tabular-nums"><thead><tr>{head}<th style="{_CELL}">note</th></tr></thead>'
        f"<tbody>{body}</tbody></table></div>"
    )


def _head(name: str, title: str, column: str, falling: bool, buttons: bool) -> str:
    if not buttons:
        return f'<th scope="col" style="{_CELL if name in _TEXTS else _NUMBER}">{title}</th>'
    mark, state = "", ""
    if name == column:
        mark = " ▾" if falling else " ▴"
        state = f' aria-sort="{"descending" if falling else "ascending"}"'
    button = f'<button class="sb-sort" data-command="sort-pins {name}" title="Sort by this column">'
    side = _CELL if name in _TEXTS else _NUMBER.replace("white-space:nowrap", "line-height:1.15")
    return f'<th scope="col" style="{side}"{state}>{button}{title}{mark}</button></th>'


def _row(line: Line, best: dict[str, float], baseline: int | None) -> str:
    pin = line.pin
    dash = "solid" if pin is None else "dashed"
    bar = (
        f'<span style="display:inline-block;width:18px;border-top:3px {dash} {line.color};margin-right:6px;'
        'vertical-align:middle"></span>'
    )
    name, marks, note = PRESENT, "", ""
    if pin is not None:
        name, note = pin.name, pin.note
        marks = (", baseline" if pin.id == baseline else "") + ("" if pin.shown else ", hidden")
    cells = [f'<td style="{_CELL};white-space:nowrap">{bar}<b>{escape(name)}</b>{marks}</td>']
    cells.append(f'<td style="{_CELL}">{escape(line.method)}</td>')
    if not line.numbers:
        cells.append(f'<td style="{_CELL}" colspan="{len(COLUMNS) - 2}">being computed</td>')
    else:
        cells += [_cell(line, name, best) for name in list(COLUMNS)[2:]]
    cells.append(f'<td style="{_CELL}">{escape(note)}</td>')
    return f'<tr style="border-top:1px solid {style.GRID}">{"".join(cells)}</tr>'


def _cell(line: Line, name: str, best: dict[str, float]) -> str:
    if name == "verdict":
        return f'<td style="{_NUMBER}">{_verdict(line)}</td>'
    value = line.numbers[name]
    text = settling(value * MINUTE) if name == "settling" else rounded(value)
    mark = f' class="sb-best" title="{style.BEST}"' if best.get(name) == value else ""
    return f'<td style="{_NUMBER}"><span{mark}>{text}</span></td>'


def _verdict(line: Line) -> str:
    if not line.asked:
        return f'<span style="color:{style.MUTED}">nothing asked</span>'
    missed = round(line.numbers["verdict"])
    color, text = style.PASSED, "✓ meets all"
    if missed:
        color, text = style.DANGER, f"✗ misses {missed} of {line.asked}"
    return f'<span style="color:{color};font-weight:600">{text}</span>'


_CELL = "padding:3px 8px 3px 2px;vertical-align:top;text-align:left"
_NUMBER = "padding:3px 8px 3px 2px;vertical-align:top;text-align:right;white-space:nowrap"

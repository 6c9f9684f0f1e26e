"""The metrics of all methods as a table: the numbers of `Run.errors` and `Run.loop`, only put into units."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from html import escape
from typing import TYPE_CHECKING

from app.plots import style
from app.plots.budgets import times_the_floor
from app.plots.earth_mode import earth_mode_text
from app.plots.pinned import Pinned, deltas
from app.plots.units import (
    ARCMINUTES,
    ARCSECONDS,
    AUTO,
    METRES,
    METRES_PER_SECOND,
    NAMED,
    NAUTICAL_MILES,
    Unit,
    number,
    rounded,
    settling,
)
from app.session.display import Display
from navcore.engine.run import LawInForce, MethodRun, Run

if TYPE_CHECKING:
    from navcore.engine.verification import Difference, Verification

STATISTICS = ("rms", "max_abs", "final")
_HEADINGS = ("rms", "max", "final")
_OF_THE_DIFFERENCE = ("Δ rms", "Δ max", "Δ final")

# Fixed units: numbers of two runs can be compared at a glance.
_QUANTITIES: tuple[tuple[str, str, Unit], ...] = (
    ("tilt φE", "phi_e_rad", ARCSECONDS),
    ("tilt φN", "phi_n_rad", ARCSECONDS),
    ("heading φU", "phi_u_rad", ARCMINUTES),
    ("velocity δVE", "dve_mps", METRES_PER_SECOND),
    ("velocity δVN", "dvn_mps", METRES_PER_SECOND),
    ("latitude", "dlat_m", METRES),
    ("longitude", "dlon_m", METRES),
    ("position", "position_m", METRES),
    ("position", "position_m", NAUTICAL_MILES),
)


_ANGLES, _SPEEDS = (ARCSECONDS, ARCMINUTES), (METRES_PER_SECOND,)


@dataclass(frozen=True)
class Row:
    """One line of the table.

    Attributes
    ----------
    label : str
        What is shown.
    unit : str
        Its unit; may be empty.
    cells : tuple of tuple of str
        For every method either one text or one for each of `STATISTICS`.
    deltas : tuple of str
        For every method what has changed against the baseline; empty without one.
    best : tuple of tuple of bool
        For every method, which of its cells are the best of all methods; empty where there is no best.
    """

    label: str
    unit: str
    cells: tuple[tuple[str, ...], ...]
    deltas: tuple[str, ...] = ()
    best: tuple[tuple[bool, ...], ...] = ()


def metrics_rows(run: Run, display: Display | None = None, baseline: Pinned | None = None) -> tuple[Row, ...]:
    """Lines of the table: the loop's figures, then the errors of each quantity.

    Parameters
    ----------
    run : Run
        Result.
    display : Display, optional
        Units, and which number is compared.
    baseline : Pinned, optional
        What it is compared with.
    """
    shown = display or Display()
    loops = _loop_rows(run)
    errors = [_error_row(run, *quantity) for quantity in _in_units(shown)]
    if baseline is not None and baseline.run is not None:
        loops = [replace(row, deltas=("",) * len(run.methods)) for row in loops]
        errors = [
            replace(row, deltas=_delta_texts(run, baseline.run, name, shown.delta, unit))
            for row, (_, name, unit) in zip(errors, _in_units(shown), strict=True)
        ]
    return (*loops, *errors)


def _in_units(display: Display) -> list[tuple[str, str, Unit]]:
    """The quantities in the units that are wanted; lengths then have one line each."""
    found: list[tuple[str, str, Unit]] = []
    for label, name, unit in _QUANTITIES:
        family = _ANGLES if unit in _ANGLES else _SPEEDS if unit in _SPEEDS else ()
        wanted = display.angle if family == _ANGLES else display.speed if family else display.length
        entry = (label, name, unit if wanted == AUTO else NAMED[wanted])
        if entry not in found:
            found.append(entry)
    return found


def _delta_texts(run: Run, baseline: Run, name: str, statistic: str, unit: Unit) -> tuple[str, ...]:
    return tuple(
        "not in it" if delta is None else delta.text(unit) for delta in deltas(run, baseline, name, statistic)
    )


def difference_rows(verification: Verification) -> tuple[Row, ...]:
    """Lines with the largest difference between full strapdown and linear model, and its part of the peak."""
    return tuple(
        Row(label, unit.name, tuple((_difference(d.get(name), unit),) for d in verification.differences))
        for label, name, unit in _QUANTITIES[:-1]
    )


def _difference(found: Difference | None, unit: Unit) -> str:
    if found is None:
        return "not known"
    part = "" if found.of_peak is None else f" ({number(100.0 * found.of_peak, 2)} %)"
    return f"{number(found.peak / unit.si, 3)}{part}"


def verdict(verification: Verification) -> str:
    """Say in one line how far the linear model is from the full strapdown."""
    worst = [
        (found.of_peak, label, method.method.name)
        for method, differences in zip(verification.linear.methods, verification.differences, strict=True)
        for label, name, _ in _QUANTITIES[:-1]
        if (found := differences.get(name)) is not None and found.of_peak is not None
    ]
    if not worst:
        return "The two models could not be compared."
    part, label, name = max(worst)
    return f"Largest difference: {number(100.0 * part, 2)} % of the peak ({label}, {name})."


def _loop_rows(run: Run) -> list[Row]:
    settles = tuple((_settling(method),) for method in run.methods)
    times = [m.loop.settling_s if m.loop.stable else None for m in run.methods]
    best = _best([[math.inf if time is None else time] for time in times])
    rows = [
        Row("damping ratio", "", tuple((rounded(m.loop.damping_ratio),) for m in run.methods)),
        Row("settles to 2 %", "", settles, best=best),
        # How far it is from 1 is what counts: three digits would hide it.
        Row("H(0)", "", tuple((number(m.loop.h0),) for m in run.methods)),
    ]
    if run.status != "ok":
        rows.insert(0, Row("run", "", tuple((m.status,) for m in run.methods)))
    return rows


def _best(sizes: Sequence[Sequence[float]]) -> tuple[tuple[bool, ...], ...]:
    """Mark the smallest size of each column; none where all are alike."""
    marks = []
    for column in zip(*sizes, strict=True):
        found = [size for size in column if math.isfinite(size)]
        least = min(found, default=math.nan)
        marks.append(tuple(size == least and min(column) < max(column) for size in column))
    return tuple(zip(*marks, strict=True))


def system_html(run: Run) -> str:
    """Table with a line a method: whole system, law in force, and the steady errors over the floor."""
    heads = (
        "",
        "24 h mode",
        "time damped",
        "damping ratio in force",
        "tilt, velocity: times the floor",
    )
    lines = "".join(
        f'<tr style="{_LINE};color:{style.method_color(i)}"><td style="padding:1px 8px 1px 2px">'
        f"{escape(method.method.name)}</td>"
        + "".join(
            f'<td style="padding:1px 8px">{escape(text)}</td>'
            for text in (
                earth_mode_text(method.whole.earth_growth),
                f"{number(100.0 * method.law_in_force.damped_share, 3)} %",
                _coefficient(method.law_in_force),
                floor,
            )
        )
        + "</tr>"
        for i, (method, floor) in enumerate(zip(run.methods, times_the_floor(run.scenario), strict=True))
    )
    head = "".join(f'<th style="{_MUTED};text-align:left;padding:1px 8px">{text}</th>' for text in heads)
    return (
        f'<details class="sb-system" style="{_SMALL}">'
        f'<summary style="cursor:pointer">Whole system, law in force, floor'
        f'</summary><div style="overflow-x:auto"><table style="{_TABLE}"><thead><tr>{head}</tr></thead>'
        f"<tbody>{lines}</tbody></table></div></details>"
    )


def _coefficient(law: LawInForce) -> str:
    """One value, or the range over the run."""
    if law.xi_min is None or law.xi_max is None:
        return "none"
    low, high = number(law.xi_min, 3), number(law.xi_max, 3)
    return low if low == high else f"{low} to {high}"


def _settling(method: MethodRun) -> str:
    if not method.loop.stable:
        return "unstable"
    return settling(method.loop.settling_s)


def _error_row(run: Run, label: str, name: str, unit: Unit) -> Row:
    cells = tuple(
        tuple(rounded(method.errors[name][statistic] / unit.si) for statistic in STATISTICS)
        for method in run.methods
    )
    sizes = [[abs(method.errors[name][statistic]) for statistic in STATISTICS] for method in run.methods]
    return Row(label, unit.name, cells, best=_best(sizes))


def metrics_html(
    run: Run,
    methods: Sequence[int] | None = None,
    verification: Verification | None = None,
    *,
    old: bool = False,
    display: Display | None = None,
    baseline: Pinned | None = None,
) -> str:
    """Return the metrics of a run as an HTML table, with the methods' colours and aligned figures.

    Parameters
    ----------
    run : Run
        Result.
    methods : sequence of int, optional
        Places of the methods to show, where all of them side by side are too wide; all when None.
    verification : Verification, optional
        Of the same methods: its differences are added below.
    old : bool
        It is of an earlier scenario: shown, and said, as such.
    display : Display, optional
        Units, and which number is compared.
    baseline : Pinned, optional
        Adds a column of differences to each method.
    """
    shown = range(len(run.methods)) if methods is None else methods
    compares = baseline is not None and baseline.run is not None
    columns = 4 if compares else 3
    head = "".join(
        f'<th colspan="{columns}" style="{_HEAD};border-bottom:3px solid {style.method_color(i)}">'
        f"{escape(run.methods[i].method.name)}</th>"
        for i in shown
    )
    headings: list[str] = list(_HEADINGS)
    if compares:
        headings.append(_OF_THE_DIFFERENCE[STATISTICS.index((display or Display()).delta)])
    below = "".join(f'<th style="{_NUMBER};{_MUTED}">{name}</th>' for name in headings) * len(shown)
    rows = metrics_rows(run, display, baseline)
    decimals = _decimals(rows)
    body = "".join(_html_row(_part(row, shown), decimals=decimals) for row in rows)
    if compares and baseline is not None:
        body += (
            f'<tr style="{_LINE}"><td colspan="{2 + columns * len(shown)}" style="padding:6px 2px;{_MUTED}">'
            f'Δ: this run minus <b style="color:{baseline.hex}">{escape(baseline.name)}</b>, the method of '
            "the same name; in the unit of the line, and as a part of the baseline's number</td></tr>"
        )
    if verification is not None:
        compared = "".join(_html_row(_part(row, shown), columns) for row in difference_rows(verification))
        faint = "opacity:.5" if old else ""
        title = "Full strapdown minus linear model: largest difference (part of the strapdown's peak)"
        title += "; of an earlier scenario" if old else ""
        body += (
            f'<tr class="sb-difference" style="{_LINE};{faint}"><td colspan="{2 + columns * len(shown)}" '
            f'style="padding:8px 2px 2px;font-weight:600">{title}</td></tr>'
        )
        body += compared.replace("<tr ", '<tr class="sb-old" ') if old else compared
    return (
        f'<div style="overflow-x:auto"><table style="{_TABLE}"><thead><tr><td></td><td></td>{head}</tr>'
        f'<tr><td></td><th style="{_MUTED};text-align:left">unit</th>{below}</tr></thead>'
        f"<tbody>{body}</tbody></table></div>"
    )


def _part(row: Row, methods: Sequence[int]) -> Row:
    deltas = tuple(row.deltas[i] for i in methods) if row.deltas else ()
    best = tuple(row.best[i] for i in methods) if row.best else ()
    return replace(row, cells=tuple(row.cells[i] for i in methods), deltas=deltas, best=best)


def _decimals(rows: Sequence[Row]) -> int:
    """Most decimals of the numbers that stand below each other."""
    numbers = (text for row in rows for cell in row.cells if len(cell) > 1 for text in cell)
    return max((len(text.partition(".")[2]) for text in numbers if "e" not in text), default=0)


def method_px(rows: Sequence[Row], letter_px: float, padding_px: float) -> float:
    """Width that a method's columns need, its differences left out.

    Parameters
    ----------
    rows : sequence of Row
        The table.
    letter_px, padding_px : float
        Width of a digit, and left and right of a number together.
    """
    places = _decimals(rows)
    widths = [0] * len(STATISTICS)
    for row in rows:
        for cell in row.cells:
            if len(cell) == len(widths):
                whole = (len(text.partition(".")[0]) + 1 + places for text in cell)
                widths = [max(pair) for pair in zip(widths, whole, strict=True)]
    return sum(letter_px * max(width, len("final")) + padding_px for width in widths)


_TABLE = (
    f"border-collapse:collapse;font-size:{style.FONT_SIZE}px;color:{style.INK};width:100%;"
    "font-variant-numeric:tabular-nums;line-height:1.1"
)
_SMALL = f"margin:0 10px;font-size:12.5px;color:{style.INK}"
_HEAD = "text-align:center;padding:2px 8px;font-weight:600"
_NUMBER = "text-align:right;padding:1px 8px;white-space:nowrap"
_MUTED = f"color:{style.MUTED};font-weight:400"
_DELTA = f"background:{style.SEA}"
_LINE = f"border-top:1px solid {style.GRID}"


def _html_row(row: Row, columns: int = 3, decimals: int = 0) -> str:
    cells = ""
    for place, cell in enumerate(row.cells):
        best = row.best[place] if row.best else (False,) * len(cell)
        if len(cell) == 1:
            span = columns + bool(row.deltas)
            text = _marked(escape(cell[0]), best[0])
            cells += f'<td colspan="{span}" style="text-align:center;padding:1px 8px">{text}</td>'
            continue
        for value, mark in zip(cell, best, strict=True):
            cells += f'<td style="{_NUMBER}">{_marked(escape(value), mark)}{_filled(value, decimals)}</td>'
        if row.deltas:
            cells += f'<td class="sb-delta" style="{_NUMBER};{_DELTA}">{escape(row.deltas[place])}</td>'
    return (
        f'<tr style="{_LINE}"><td style="padding:1px 8px 1px 2px;white-space:nowrap">{escape(row.label)}</td>'
        f'<td style="{_MUTED};padding:1px 8px 1px 0">{escape(row.unit)}</td>{cells}</tr>'
    )


def _marked(text: str, best: bool) -> str:
    return f'<span class="sb-best" title="{style.BEST}">{text}</span>' if best else text


def _filled(text: str, decimals: int) -> str:
    """Unseen figures behind a number, so that the points of a column stand below each other."""
    _, point, fraction = text.partition(".")
    rest = ("" if point or decimals == 0 else ".") + "0" * (decimals - len(fraction))
    return (
        f'<span style="visibility:hidden" aria-hidden="true">{rest}</span>'
        if rest and "e" not in text
        else ""
    )

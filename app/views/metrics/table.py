"""The metrics of all methods as a table: the numbers of `Run.errors` and `Run.loop`, only put into units."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from navcore.engine.measures import measure
from navcore.engine.run import LawInForce, Run
from navcore.foundation.text import Text, quoted
from navcore.quantities import ERRORS, QUANTITIES, STATISTICS, RecordedError
from schuler_bench.plots import style
from schuler_bench.plots.budgets import times_the_floor
from schuler_bench.plots.effective import earth_mode_text
from schuler_bench.plots.known import known_marks
from schuler_bench.plots.pinned import Pinned, difference_text
from schuler_bench.plots.table import cell, row, table
from schuler_bench.plots.units import (
    AUTO,
    NAMED,
    Unit,
    number,
    rounded,
    settling,
)
from schuler_bench.session.display import Display

if TYPE_CHECKING:
    from navcore.engine.verification import Difference, Verification


_OF_THE_DIFFERENCE = {"rms": Text("Δ rms"), "max_abs": Text("Δ max"), "final": Text("Δ final")}
# The units are fixed: numbers of two runs can be compared at a glance.
_UNITS = (*((error, NAMED[error.kind.unit]) for error in ERRORS), (ERRORS[-1], NAMED["nmi"]))


def _worst(value: float) -> str:
    """Write the worst tilt, rad."""
    unit = NAMED[QUANTITIES["worst_tilt"].shown]
    return f"{number(value / unit.si, 3)} {unit.name}" if math.isfinite(value) else Text("no bound")


_LOOP = {"damping_ratio": rounded, "settling_s": settling, "h0": number, "worst_tilt": _worst}
_BEST = ("settling_s",)
"""Of which the smallest is marked; not of the worst tilt, for a method without log has none."""


_OF_KIND = {
    "tilt": "tilt_rms_arcsec",
    "velocity": "velocity_rms_mps",
    "heading": "heading_rms_arcmin",
    "position": "position_rms_m",
}
"""Quantity whose tests say how an error of a kind is known."""


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
    hint : str
        What it is, shown beside the pointer; may be empty.
    known : str
        HTML of the marks that say how its numbers are known.
    """

    label: str
    unit: str
    cells: tuple[tuple[str, ...], ...]
    deltas: tuple[str, ...] = ()
    best: tuple[tuple[bool, ...], ...] = ()
    hint: str = ""
    known: str = ""


def metrics_rows(
    run: Run,
    display: Display | None = None,
    baseline: Pinned | None = None,
    edited: tuple[int, str] | None = None,
) -> tuple[Row, ...]:
    """Lines of the table: the loop's figures, then the errors of each quantity.

    Parameters
    ----------
    run : Run
        Result.
    display : Display, optional
        Units, and which number is compared.
    baseline : Pinned, optional
        What it is compared with.
    edited : (int, str), optional
        Place of the method that is edited now, and name of the one that was edited in the baseline: they are
        compared where the baseline has no method of the present name.
    """
    display = display or Display()
    before = None if baseline is None else baseline.run
    # lengths in one unit have one line each
    quantities = dict.fromkeys(
        (error, unit if (chosen := getattr(display, error.kind.dimension)) == AUTO else NAMED[chosen])
        for error, unit in _UNITS
    )
    rows = _loop_rows(run)
    if before is not None:
        rows = [replace(row, deltas=("",) * len(run.methods)) for row in rows]
    for error, unit in quantities:
        row = _error_row(run, error, unit)
        if before is not None:
            row = replace(row, deltas=_delta_texts(run, before, error.name, display.delta, unit, edited))
        rows.append(row)
    return tuple(rows)


def _delta_texts(
    run: Run, baseline: Run, name: str, statistic: str, unit: Unit, edited: tuple[int, str] | None
) -> tuple[str, ...]:
    """For every method what has changed against the baseline's method of the same name."""
    old = {method.method.name: method.errors[name][statistic] for method in baseline.methods}
    pairs = zip(run.methods, _compared(run, baseline, edited), strict=True)
    return tuple(
        Text("not in it")
        if other is None
        else difference_text(method.errors[name][statistic], old[other], unit)
        for method, other in pairs
    )


def _compared(run: Run, baseline: Run, edited: tuple[int, str] | None) -> list[str | None]:
    """For every method the name of the baseline's method with which it is compared; None without one."""
    known = {method.method.name for method in baseline.methods}
    names = [method.method.name for method in run.methods]
    place, before = edited or (-1, "")
    return [
        name if name in known else before if i == place and before in known - set(names) else None
        for i, name in enumerate(names)
    ]


def difference_rows(verification: Verification) -> tuple[Row, ...]:
    """Lines with the largest difference between full strapdown and linear model, and its part of the peak."""
    return tuple(
        Row(
            error.label,
            unit.name,
            tuple((_difference(d.get(error.name), unit),) for d in verification.differences),
        )
        for error, unit in _UNITS[:-1]
    )


def _difference(difference: Difference | None, unit: Unit) -> str:
    if difference is None:
        return Text("not known")
    part = "" if difference.of_peak is None else f" ({number(100.0 * difference.of_peak, 2)} %)"
    return f"{number(difference.peak / unit.si, 3)}{part}"


def verdict(verification: Verification) -> str:
    """Say in one line how far the linear model is from the full strapdown."""
    worst = [
        (difference.of_peak, error.label, method.method.name)
        for method, differences in zip(verification.linear.methods, verification.differences, strict=True)
        for error in ERRORS
        if (difference := differences.get(error.name)) is not None and difference.of_peak is not None
    ]
    if not worst:
        return Text("The two models could not be compared.")
    part, label, name = max(worst)
    return Text(
        "Largest difference: {part} % of the peak ({label}, {name}).",
        part=number(100.0 * part, 2),
        label=label,
        name=name,
    )


def _loop_rows(run: Run) -> list[Row]:
    rows = [Row("run", "", tuple((m.status,) for m in run.methods))] if run.status != "ok" else []
    # How far H(0) is from 1 is what counts: three digits would hide it.
    for key, text in _LOOP.items():
        values = [measure(method, key) for method in run.methods]
        texts = [text(value) for value in values]
        if key == "settling_s":
            texts = [
                t if m.loop.stable else Text("unstable") for m, t in zip(run.methods, texts, strict=True)
            ]
        quantity = QUANTITIES[key]
        best = _best([[value] for value in values]) if key in _BEST else ()
        cells = tuple((text,) for text in texts)
        marks = known_marks(key, run)
        rows.append(Row(quantity.label, "", cells, best=best, hint=quantity.help, known=marks))
    return rows


def _best(sizes: Sequence[Sequence[float]]) -> tuple[tuple[bool, ...], ...]:
    """Mark the smallest size of each column; none where all are alike."""
    marks = []
    for column in zip(*sizes, strict=True):
        least = min((size for size in column if math.isfinite(size)), default=math.nan)
        marks.append(tuple(size == least and min(column) < max(column) for size in column))
    return tuple(zip(*marks, strict=True))


def system_html(run: Run, *, folded: bool = True) -> str:
    """Table with a line a method: whole system, law in force, and the steady errors over the floor."""
    heads = (
        "",
        Text("24 h mode"),
        Text("time damped"),
        Text("damping ratio in force"),
        Text("tilt, velocity: times the floor"),
    )
    floors, lines = times_the_floor(run.scenario), []
    for method, floor in zip(run.methods, floors, strict=True):
        law = method.law_in_force
        texts = (
            method.method.name,
            earth_mode_text(method.whole.earth_growth),
            f"{number(100.0 * law.damped_share, 3)} %",
            _coefficient(law),
            floor,
        )
        color = style.method_color(method.place)
        lines.append(row((cell(quoted(text)) for text in texts), style=f"color:{color}"))
    head = row(cell(text, "sb-m", tag="th") for text in heads)
    return Text(
        '<details{state} class="sb-system"><summary>Whole system, law in force, floor</summary>'
        "{table}</details>",
        state="" if folded else " open",
        table=table([head], lines),
    )


def _coefficient(law: LawInForce) -> str:
    """One value, or the range over the run."""
    if law.xi_min is None or law.xi_max is None:
        return "none"
    low, high = number(law.xi_min, 3), number(law.xi_max, 3)
    return low if low == high else Text("{low} to {high}", low=low, high=high)


def _error_row(run: Run, error: RecordedError, unit: Unit) -> Row:
    values = [[method.errors[error.name][statistic] for statistic in STATISTICS] for method in run.methods]
    cells = tuple(tuple(rounded(value / unit.si) for value in row) for row in values)
    # an error passes through 0: the last value says nothing of a method
    sizes = [
        [math.nan if s == "final" else abs(v) for s, v in zip(STATISTICS, row, strict=True)] for row in values
    ]
    marks = known_marks(_OF_KIND[error.kind.name], run)
    return Row(error.label, unit.name, cells, best=_best(sizes), hint=error.title, known=marks)


def metrics_html(
    run: Run,
    methods: Sequence[int] | None = None,
    verification: Verification | None = None,
    *,
    old: bool = False,
    display: Display | None = None,
    baseline: Pinned | None = None,
    edited: tuple[int, str] | None = None,
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
    edited : (int, str), optional
        See `metrics_rows`.
    """
    places = range(len(run.methods)) if methods is None else methods
    compares = baseline is not None and baseline.run is not None
    headings = list(STATISTICS.values())
    if compares:
        headings.append(_OF_THE_DIFFERENCE[(display or Display()).delta])
    columns = len(headings)
    width = 2 + columns * len(places)
    below = [cell(name, "sb-n sb-m", tag="th") for name in headings] * len(places)
    head = [
        row([cell(), cell(), *(_method_head(run, i, columns) for i in places)]),
        row([cell(), cell(Text("unit"), "sb-m", tag="th"), *below]),
    ]
    rows = metrics_rows(run, display, baseline, edited)
    decimals = _decimals(rows)
    body = [_html_row(_part(each, places), columns, decimals) for each in rows]
    if baseline is not None and baseline.run is not None:
        foot = Text(
            'Δ: this run minus <b style="color:{hex}">{name:html}</b>, the method of the same name; '
            "in the unit of the line, and as a part of the baseline's number",
            hex=baseline.hex,
            name=baseline.name,
        )
        others = zip(run.methods, _compared(run, baseline.run, edited), strict=True)
        renamed = [(m.method.name, other) for m, other in others if other not in (None, m.method.name)]
        for now, before in renamed:
            foot += Text("; {now:html} is compared with {before:html}", now=now, before=before)
        body.append(row([cell(foot, "sb-foot", colspan=width)]))
    if verification is not None:
        title = Text("Full strapdown minus linear model: largest difference (part of the strapdown's peak)")
        title += Text("; of an earlier scenario") if old else ""
        look = "sb-old" if old else ""
        body.append(row([cell(title, "sb-title", colspan=width)], f"sb-difference {look}".rstrip()))
        body += [_html_row(_part(each, places), columns, look=look) for each in difference_rows(verification)]
    return table(head, body)


def _method_head(run: Run, index: int, columns: int) -> str:
    method = run.methods[index]
    name = Text("<span>{name:html}</span>", name=method.method.name)
    return cell(name, "sb-h", tag="th", colspan=columns, style=f"color:{style.method_color(method.place)}")


def _part(whole: Row, methods: Sequence[int]) -> Row:
    """The cells of some methods."""
    parts = {
        name: tuple(values[i] for i in methods)
        for name in ("cells", "deltas", "best")
        if (values := getattr(whole, name))
    }
    return replace(whole, **parts)


def _decimals(rows: Sequence[Row]) -> int:
    """Most decimals of the numbers that stand below each other."""
    numbers = (text for line in rows for texts in line.cells if len(texts) > 1 for text in texts)
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
    widths = [len("final")] * len(STATISTICS)
    for texts in (texts for line in rows for texts in line.cells if len(texts) > 1):
        whole = (len(text.partition(".")[0]) + 1 + places for text in texts)
        widths = [max(pair) for pair in zip(widths, whole, strict=True)]
    return sum(letter_px * width + padding_px for width in widths)


def _html_row(line: Row, columns: int, decimals: int = 0, look: str = "") -> str:
    cells = [cell(quoted(line.label) + line.known), cell(quoted(line.unit), "sb-m")]
    for place, texts in enumerate(line.cells):
        best = line.best[place] if line.best else (False,) * len(texts)
        marked = [
            cell(quoted(text), "sb-best", tag="span", title=style.BEST) if mark else quoted(text)
            for text, mark in zip(texts, best, strict=True)
        ]
        if len(texts) == 1:
            cells.append(cell(marked[0], "sb-c", colspan=columns))
            continue
        filled = [_filled(text, decimals) for text in texts]
        cells += [cell(Text.joined("", parts), "sb-n") for parts in zip(marked, filled, strict=True)]
        if line.deltas:
            cells.append(cell(quoted(line.deltas[place]), "sb-n sb-delta"))
    return row(cells, look, title=line.hint)


def _filled(text: str, decimals: int) -> str:
    """Unseen figures behind a number, so that the points of a column stand below each other."""
    _, point, fraction = text.partition(".")
    rest = ("" if point or decimals == 0 else ".") + "0" * (decimals - len(fraction))
    return cell(rest, "sb-fill", tag="span", aria_hidden="true") if rest and "e" not in text else ""

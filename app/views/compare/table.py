"""The table of the pins and the present run: what each measures, and whether it meets the requirements."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from navcore.engine.measures import measure
from navcore.engine.run import Run
from navcore.foundation.text import Text, quoted
from navcore.quantities import QUANTITIES
from navcore.scenario.requirement import Requirement
from schuler_bench.plots import style
from schuler_bench.plots.table import cell, row, table
from schuler_bench.plots.units import rounded
from schuler_bench.session.pins import Pin
from schuler_bench.session.requirements import asked
from schuler_bench.session.shown import Window, edited
from schuler_bench.views.design.limits import design_text
from schuler_bench.views.requirements.table import overall

MEASURED = {
    "settling": QUANTITIES["settling_s"],
    "velocity": QUANTITIES["velocity_rms_mps"],
    "tilt": QUANTITIES["tilt_max_arcsec"],
    "position": QUANTITIES["position_max_m"],
}
"""Columns with a quantity."""
COLUMNS: dict[str, str] = {
    "pinned": "run",
    "method": "method",
    **{
        name: Text("{label} ({shown})", label=quantity.label, shown=quantity.shown)
        for name, quantity in MEASURED.items()
    },
    "verdict": Text("requirements"),
}
"""Columns by which the table can be sorted, and their headings."""
PRESENT = Text("present run")
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
    missed : tuple of str
        Labels of those that it misses.
    setting : str
        Parameters of the method's network.
    unknown : int
        Requirements that only seeds decide.
    """

    pin: Pin | None
    color: str
    method: str
    numbers: dict[str, float]
    asked: int = 0
    missed: tuple[str, ...] = ()
    setting: str = ""
    unknown: int = 0

    def key(self, column: str) -> tuple[bool, float, str]:
        """By what it is sorted: what is not known comes last."""
        if column == "method":
            return False, 0.0, self.method
        value = self.numbers.get(column, math.nan)
        if column == "pinned":
            value = 0.0 if self.pin is None else float(self.pin.id)
        return math.isnan(value), 0.0 if math.isnan(value) else value, ""


def lines_of(window: Window, run: Run, selected: int, pins: Sequence[Pin]) -> tuple[Line, ...]:
    """Measure the present run and the pins, each by its edited method, over the same window.

    The requirements of the present run judge all of them, each from its own time on.

    Parameters
    ----------
    window : Window
        Part of the run that counts.
    run : Run
        All of it.
    selected : int
        Place of the method that is edited now.
    pins : sequence of Pin
        Pinned runs.
    """
    place = min(selected, len(window.run.methods) - 1)
    lines = [_own_line(window, run, place)]
    for pin in pins:
        place = edited(pin)
        if pin.run is None:
            lines.append(Line(pin, pin.hex, pin.scenario.method[place].name, {}))
        else:
            lines.append(_line(pin, pin.hex, window.of(pin.run), pin.run, place, run.scenario.requirement))
    return tuple(lines)


def lines_without_pins(window: Window, run: Run) -> tuple[Line, ...]:
    """Measure every method of the present run: what could be pinned."""
    return tuple(_own_line(window, run, place) for place in range(len(window.run.methods)))


def _own_line(window: Window, run: Run, place: int) -> Line:
    color = style.method_color(run.methods[place].place)
    return _line(None, color, window.run, run, place, run.scenario.requirement)


def _line(
    pin: Pin | None, color: str, part: Run, whole: Run, place: int, requirements: Sequence[Requirement]
) -> Line:
    method = part.methods[place]
    numbers = {name: measure(method, one.key) / one.size for name, one in MEASURED.items()}
    limits = asked(whole, requirements)
    missed = tuple(verdict.quantity.label for verdict in limits if verdict.words[place] == "missed")
    unknown = sum(verdict.words[place] == "open" for verdict in limits)
    if limits:
        numbers["verdict"] = float(len(missed))
    setting = design_text(method.method)
    return Line(pin, color, method.method.name, numbers, len(limits), missed, setting, unknown)


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
        False for a file: its headings sort nothing, and it shows what the page tells beneath the pointer.
    """
    column, falling = by.removeprefix("-"), by.startswith("-")
    ordered = sorted(lines, key=lambda line: line.key(column), reverse=falling)
    best: dict[str, float] = {}
    for name in COLUMNS:
        values = [line.numbers.get(name, math.nan) for line in lines]
        finite = [value for value in values if math.isfinite(value)]
        if len(finite) > 1 and min(finite) < max(finite):
            best[name] = min(finite)
    marks = {column: " ▾" if falling else " ▴"} if buttons else {}
    head = [_head(name, title, marks.get(name, ""), buttons) for name, title in COLUMNS.items()]
    head.append(cell(Text("note"), tag="th"))
    rows = (_row(line, best, baseline, buttons) for line in ordered)
    look = {"tag": "div", "style": f"--sb-cells:{len(head)}"}
    return cell(table([row(head)], rows), "sb-pins sb-table", **look)


def _head(name: str, title: str, mark: str, buttons: bool) -> str:
    state = {" ▾": "descending", " ▴": "ascending"}.get(mark)
    if buttons:
        button = Text(
            '<button class="sb-sort" data-command="sort-pins {name}" title="Sort by this column">', name=name
        )
        title = Text("{button}{title}{mark}</button>", button=button, title=title, mark=mark)
    return cell(title, "" if name in _TEXTS else "sb-n", tag="th", scope="col", aria_sort=state)


def _row(line: Line, best: dict[str, float], baseline: int | None, buttons: bool) -> str:
    pin = line.pin
    dash = "solid" if pin is None else "dashed"
    name = Text(
        '<span class="sb-bar" style="border-top:3px {dash} {color}"></span>', dash=dash, color=line.color
    )
    if pin is None:
        name += Text("<b>{present}</b>", present=PRESENT)
    else:
        marks = [Text("baseline")] * (pin.id == baseline) + [Text("hidden")] * (not pin.shown)
        name += Text.joined(", ", [Text("<b>{name:html}</b>", name=pin.name), *marks])
    numbers = (
        [_cell(line, column, best) for column in list(COLUMNS)[2:]]
        if line.numbers
        else [cell(Text("being computed"), colspan=len(COLUMNS) - 2)]
    )
    note = cell("" if pin is None else quoted(pin.note))
    below = "" if buttons else cell(quoted(line.setting), "sb-muted", tag="div")
    method = cell(quoted(line.method) + below, title=line.setting if buttons else "")
    return row([cell(name, "sb-name"), method, *numbers, note])


def _cell(line: Line, name: str, best: dict[str, float]) -> str:
    if name == "verdict":
        return cell(overall(len(line.missed), line.asked, line.missed, line.unknown), "sb-n")
    value = line.numbers[name]
    text = "never" if name == "settling" and math.isinf(value) else rounded(value)
    mark = {"look": "sb-best", "title": style.BEST} if best.get(name) == value else {}
    return cell(cell(text, tag="span", **mark), "sb-n")

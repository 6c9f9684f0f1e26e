"""Present setting and proposal in runs on the same seeds, and beside the limits, as HTML."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

from navcore.design.measures import Setting, measure
from navcore.design.ship import Ship
from navcore.foundation.text import Text, quoted
from navcore.quantities import QUANTITIES, Quantity, value_unit
from schuler_bench.plots.limits import SIGNS, short_label
from schuler_bench.plots.table import cell, row, table
from schuler_bench.plots.units import number

if TYPE_CHECKING:
    from navcore.design.confirm import Change
    from navcore.design.tuned import Tuned
    from navcore.questions.tune import TuneQuestion

_OF_THE_LOOP = ("settling_s", "growth_per_s")
_SMALLER, _LARGER, _ALIKE = (
    Text("smaller"),
    Text("larger"),
    Text("no difference beyond chance"),
)


def confirmation_html(task: TuneQuestion, tuned: Tuned) -> str:
    """Table with a row a quantity: before, after, the paired difference, and the limit."""
    seeds = None if tuned.confirmed is None else tuned.confirmed.seeds
    title = (
        Text("Not confirmed by runs")
        if seeds is None
        else Text("Mean of {seeds} runs, both settings on the same seeds", seeds=seeds)
    )
    heads = (title, Text("before"), Text("after"), Text("difference (95 % interval)"), "", Text("limit"))
    head = row(cell(quoted(text), "sb-n" if k else "", tag="th") for k, text in enumerate(heads))
    return table([head], [*_runs(task, tuned), *_loops(task, tuned)], "sb-confirmed")


def _runs(task: TuneQuestion, tuned: Tuned) -> Iterator[str]:
    if tuned.confirmed is None:
        return
    limits = {one.quantity: one for one in task.scenario.requirement}
    for key, change in tuned.confirmed.changes.items():
        quantity = QUANTITIES[key]
        size = quantity.size / (value_unit(key) if key in limits else 1.0)
        limit = limits.get(key)
        texts = [
            *(_shown(value, size) for value in (change.before, change.after)),
            _difference(change, size),
        ]
        asked = met = None
        if limit is not None:
            asked = Text("{sign} {limit}", sign=SIGNS[limit.sense], limit=number(limit.limit / size, 4))
            met = None if change.after is None else limit.met(change.after)
        yield _row(
            quantity, quantity.names.get("ensemble") or short_label(key), texts, _side(change), asked, met
        )


def _loops(task: TuneQuestion, tuned: Tuned) -> Iterator[str]:
    """Settling and growth of both settings, beside their limits."""
    ship, limits = Ship(task.scenario), {one.name: one for one in tuned.limits}
    settings = [Setting(ship, each.method[task.method]) for each in (task.scenario, tuned.scenario)]
    for key in dict.fromkeys((*_OF_THE_LOOP, *(name for name in limits if QUANTITIES[name].kind is None))):
        quantity, one = QUANTITIES[key], limits.get(key)
        before, after = (measure(setting, key) for setting in settings)
        asked = met = None
        if one is not None:
            asked = Text("{sign} {limit}", sign=SIGNS[one.sense], limit=number(one.limit / quantity.size, 4))
            met = not one.excess(settings[1])
        texts = [*(_shown(value, quantity.size) for value in (before, after)), ""]
        yield _row(quantity, quantity.label, texts, "", asked, met)


def _shown(value: float | None, size: float) -> str:
    if value is None:
        return Text("diverges")
    return Text("never") if math.isinf(value) else number(value / size, 4)


def _difference(change: Change, size: float) -> str:
    if change.difference is None or change.low is None or change.high is None:
        return ""
    middle, low, high = (number(value / size, 3) for value in (change.difference, change.low, change.high))
    return Text("{middle} ({low} to {high})", middle=middle, low=low, high=high)


def _side(change: Change) -> str:
    if change.low is None or change.high is None:
        return ""
    return _SMALLER if change.high < 0.0 else _LARGER if change.low > 0.0 else _ALIKE


def _row(
    quantity: Quantity, label: str, texts: list[str], side: str, limit: str | None, met: bool | None
) -> str:
    unit = Text(" ({shown})", shown=quantity.shown) if quantity.shown else ""
    name = Text("{label}{unit}", label=label, unit=unit)
    look = "sb-met" if side == _SMALLER else "sb-missed" if side == _LARGER else "sb-muted"
    word = "" if met is None else Text("✓ met") if met else Text("✗ missed")
    badge = cell(quoted(word), "sb-met" if met else "sb-missed", tag="span") if word else ""
    asked = Text("{limit:html} {badge}", limit=limit, badge=badge) if limit else ""
    return row(
        [
            cell(quoted(name)),
            *(cell(quoted(text), "sb-n") for text in texts),
            cell(cell(quoted(side), look, tag="span") if side else ""),
            cell(asked, "sb-n"),
        ],
        title=quantity.help,
    )

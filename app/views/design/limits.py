"""Which methods meet the limits, and with what probability: one row a method, as HTML."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any

from navcore.design.judged import Designs
from navcore.design.measures import Setting
from navcore.design.shares import Limit
from navcore.design.ship import Ship
from navcore.design.stated import assumed_zero
from navcore.engine.measures import measure
from navcore.engine.run import Run
from navcore.foundation.answers import assumptions
from navcore.foundation.notation import symbol
from navcore.foundation.text import Text, quoted
from navcore.quantities import QUANTITIES, value_unit
from navcore.scenario.method import Method
from schuler_bench.editing.limits import shown_limit
from schuler_bench.jobs.odds import Odds
from schuler_bench.plots.effective import growth_text
from schuler_bench.plots.limits import SIGNS, requirement_words, short_label
from schuler_bench.plots.table import cell, row, table
from schuler_bench.plots.units import number
from schuler_bench.plots.varied import factors_text
from schuler_bench.session.requirements import asked
from schuler_bench.views.requirements.shares import judgements, share_text
from schuler_bench.views.tune.fronts import setting_text

if TYPE_CHECKING:
    from navcore.study.robust import Robust

TAKE_DESIGN = "take-design"
"""Command that puts a design into the method that is edited: ``take-design 3``, its place."""
NO_LIMITS = Text(
    "This scenario has no limits yet: the bars show where the error comes from. Give what the ship needs, "
    "such as the largest tilt; a table then says which methods meet it, and with what probability."
)
_TAKE, _TAKE_HINT = Text("Take"), Text("Put it into the method that is edited; undo takes it back.")
_TUNED = Text("Every network, tuned for these limits, and a Kalman filter")
_STOPPED = Text("The search was stopped: what was found so far")
_UNDER_WAY = Text("runs are under way")
_HEADS = (
    Text("method"),
    Text("setting"),
    Text("meets all limits (95 % interval)"),
    Text("limit that fails most often"),
    Text("this run"),
)


@dataclass(frozen=True)
class Line:
    """One row.

    Attributes
    ----------
    method : Method
        With its setting.
    odds : Odds or None
        How often its seeds meet the limits; None while that is not known.
    run : str
        What it makes of the limits in the run that is shown; empty for a method that is not in it.
    place : int or None
        Of a design that can be taken.
    growth : float or None
        Of the whole system, 1/s.
    beside : str
        Shares elsewhere than where ``odds`` are counted.
    """

    method: Method
    odds: Odds | None
    run: str = ""
    place: int | None = None
    growth: float | None = None
    beside: str = ""


def designs_html(
    run: Run, odds: Callable[[Method], Odds | None], found: Designs | Robust | None, note: str = ""
) -> str:
    """Table of the scenario's methods and of the designs that were found, best first.

    Parameters
    ----------
    run : Run
        Of the scenario, which has limits.
    odds : callable
        Shares of its methods.
    found : Designs, Robust or None
        Of the same scenario.
    note : str
        HTML above the table.
    """
    own = [
        Line(method.method, odds(method.method), said, growth=method.growth_per_s)
        for method, said in zip(run.methods, _verdicts(run, odds), strict=True)
    ]
    head = row(cell(quoted(text), tag="th") for text in _HEADS)
    body = [_title(Text("Methods of this scenario")), *map(_line, own)]
    if isinstance(found, Designs):
        designs = [
            Line(share.method, Odds(share, found.seeds), "", place, growth_of(run.scenario, share.method))
            for place, share in enumerate(found.methods)
        ]
        body += [_title(_STOPPED if found.stopped else _TUNED), *map(_line, designs)]
    elif found is not None:
        body += [_title(_robust_title(found)), *map(_line, _robust_lines(run, found))]
    words = Text.joined(", ", map(requirement_words, run.scenario.requirement))
    assumed = found.assumptions() if found is not None else assumptions(assumed_zero(run.scenario))
    said = Text.joined(" ", (Text("Limits: {asked}.", asked=words), *assumed, *_worst_case(run)))
    told = Text('<p class="sb-asked-limits">{asked:html}</p>', asked=said)
    return note + told + table([head], body, "sb-designs")


def _worst_case(run: Run) -> Iterator[str]:
    """Give a sentence on the worst that a log can do to each method; none where no method reads it."""
    row = QUANTITIES["worst_tilt"]
    values = {method.method.name: measure(method, row.key) for method in run.methods}
    if worst := {name: value for name, value in values.items() if value > 0.0}:
        named = (
            Text("{name} {value}", name=name, value=number(value / row.size, 3))
            if math.isfinite(value)
            else Text("{name} without bound", name=name)
            for name, value in worst.items()
        )
        yield Text(
            "The worst that a log within 1 m/s can do to the tilt of one channel, ″: {named}.",
            named=Text.joined(", ", named),
        )


def limits_wanted() -> str:
    """Where to give limits, for a scenario without any."""
    link = Text('<button class="sb-sort" data-command="tab Requirements">Requirements</button>')
    return Text('<p class="sb-none">{words:html} {link}</p>', words=NO_LIMITS, link=link)


def _robust_title(found: Robust) -> str:
    """Explanation of the rows, and the cost of the most robust one in the scenario itself."""
    return Text(
        "Every network, tuned for the worst of {points} points of the study, and there; the first is worst "
        "with {where}. Cost: {price} % of the seeds of this scenario",
        points=found.points,
        where=factors_text(found.methods[0].where),
        price=number(100.0 * found.price, 3),
    )


def _robust_lines(run: Run, found: Robust) -> Iterator[Line]:
    for place, one in enumerate(found.methods):
        here, everywhere = (number(100.0 * met, 3) for met in (one.nominal.met, one.met))
        beside = Text("this scenario {here} %, all points {everywhere} %", here=here, everywhere=everywhere)
        odds, growth = Odds(one.worst, found.seeds), growth_of(run.scenario, one.method)
        yield Line(one.method, odds, "", place, growth, beside)


def _title(text: str) -> str:
    return row([cell(quoted(text), "sb-title", colspan=len(_HEADS))])


def _verdicts(run: Run, odds: Callable[[Method], Odds | None]) -> list[str]:
    """Verdict on the limits of each method: the answer to a slider, before any seed is run."""
    judged = asked(run, run.scenario.requirement, [judgements(odds(one.method)) for one in run.methods])
    return [
        verdict_badge([(one.words[k], one.quantity.key) for one in judged]) for k in range(len(run.methods))
    ]


def verdict_badge(words: Sequence[tuple[str, str]]) -> str:
    """Badge of a method by the verdicts on its limits, each with the key of its quantity."""
    missed, unknown = (
        Text.joined(", ", [short_label(key) for found, key in words if found == word])
        for word in ("missed", "open")
    )
    if missed:
        return cell(quoted(Text("✗ misses {missed}", missed=missed)), "sb-missed", tag="span")
    if unknown:
        return cell(quoted(Text("? open: {names}", names=unknown)), "sb-open", tag="span")
    return cell(quoted(Text("✓ meets all")), "sb-met", tag="span")


def _line(line: Line) -> str:
    method, odds = line.method, line.odds
    if odds is None:
        share, worst = cell(quoted(_UNDER_WAY), "sb-muted", tag="span"), ""
    else:
        one = odds.share
        share = cell(
            quoted(share_text(one.met, one.low, one.high)),
            "sb-odds sb-met" if one.met >= 0.5 else "sb-odds sb-missed",
            tag="span",
            title=Text("{seeds} seeds, each with its own noise and constants", seeds=odds.seeds),
        )
        worst = _worst(one.limits, one.diverged)
        share += cell(quoted(line.beside), "sb-muted", tag="div") if line.beside else ""
    button = ""
    if line.place is not None:
        button = Text(
            '<button class="sb-take" data-command="{command} {place}" title="{hint:html}">'
            "{take:html}</button>",
            command=TAKE_DESIGN,
            place=line.place,
            hint=_TAKE_HINT,
            take=_TAKE,
        )
    grows = growth_text(line.growth)
    mark = cell(Text("↗ {grows}", grows=grows), "sb-muted", tag="div") if grows else ""
    cells = (
        cell(quoted(method.label()), "sb-all"),
        cell(quoted(design_text(method)) + mark),
        cell(share),
        cell(quoted(worst), "sb-w"),
        cell(line.run or button, "sb-w"),
    )
    return row(cells, data_design=method.label(), data_met="" if odds is None else f"{odds.share.met:g}")


def growth_of(scenario: Any, method: Any) -> float:
    """Growth of the whole system with a method as the law is sampled, 1/s; computed once."""
    # both are frozen, and so hashable, which their types do not say
    return _growth(scenario.model_copy(update={"method": ()}), method)


@lru_cache(maxsize=64)
def _growth(scenario: Any, method: Any) -> float:
    return Setting(Ship(scenario), method).growth_per_s


def design_text(method: Method) -> str:
    """Setting of a method in a few words."""
    if method.undamped or not method.kind.uses_network:
        return symbol(method.damping)
    return setting_text(method.network.model_dump(exclude_none=True))


def _worst(limits: Sequence[Limit], diverged: int) -> str:
    worst = min(limits, key=lambda limit: limit.met)
    if worst.met >= 1.0:
        return Text("none")
    one = worst.requirement
    row_ = QUANTITIES[one.quantity]
    unit = value_unit(one.quantity) / row_.size
    middle = Text("no value") if worst.median is None else number(worst.median * unit, 3)
    words = Text(
        "{label}: median {median}, limit {sign}\u00a0{limit}\u00a0{unit}",
        label=short_label(one.quantity),
        median=middle,
        sign=SIGNS[one.sense],
        limit=number(shown_limit(one), 4),
        unit=row_.limit_shown,
    )
    return Text("{words}; {lost} seeds diverge", words=words, lost=diverged) if diverged else words

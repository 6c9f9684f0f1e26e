"""The proposal of a search as HTML: each field now and proposed, what runs say of both, and the limits."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from navcore.design.vary import present, read_varied
from navcore.foundation.notation import symbol
from navcore.foundation.text import Text, quoted
from navcore.quantities import QUANTITIES
from schuler_bench.jobs.refusals import spoken
from schuler_bench.plots.table import cell, row, table
from schuler_bench.plots.units import number
from schuler_bench.plots.varied import factors_text
from schuler_bench.views.tune.confirmation import confirmation_html

if TYPE_CHECKING:
    from navcore.design.tuned import Tuned
    from navcore.questions.tune import TuneQuestion

_HERE = Text("in this scenario itself")


def proposal_html(task: TuneQuestion, tuned: Tuned, *, accepted: bool = False) -> str:
    """Tables of the present and the proposed setting, of their runs, and sentences about the optimum."""
    quantity = QUANTITIES[task.objective]
    label, size = quantity.names.get(tuned.judged, quantity.label), quantity.size
    rows = []
    now = present(task.scenario, read_varied(task.scenario, task.vary, task.beyond_sliders)).tolist()
    for (field, value), before in zip(tuned.best.items(), now, strict=True):
        low, high = tuned.flat.get(field, (value, value))
        rows.append(
            (
                symbol(field.rsplit(".", 1)[-1]),
                Text("default") if math.isnan(before) else number(before, 4),
                number(value, 4),
                Text("{low} to {high}", low=number(low, 3), high=number(high, 3)),
            )
        )
    objective = [
        Text("{label} ({shown})", label=label, shown=quantity.shown),
        "none" if tuned.before is None else number(tuned.before / size, 4),
        number(tuned.objective / size, 4),
        "" if tuned.floor is None else Text("floor {floor}", floor=number(tuned.floor / size, 4)),
    ]
    method = task.scenario.method[task.method].name
    title = Text("Accepted for {method}", method=method) if accepted else None
    head = (
        title or Text("Proposal for {method}", method=method),
        Text("before") if accepted else Text("now"),
        Text("after") if accepted else Text("proposed"),
        Text("range within 5 % of the best"),
    )
    settings = table([_row(head, "th")], [_row(cells) for cells in (*rows, objective)])
    sentences = Text.joined(
        "", (Text("<li>{text:html}</li>", text=text) for text in sentences_about(task, tuned))
    )
    listed = Text("<ul>{sentences}</ul>", sentences=sentences) if sentences else ""
    return Text(
        '<div class="sb-table sb-proposal">{settings}{runs}{listed}</div>',
        settings=settings,
        runs=confirmation_html(task, tuned),
        listed=listed,
    )


def sentences_about(task: TuneQuestion, tuned: Tuned) -> list[str]:
    """Write sentences about the optimum."""
    unit, size = QUANTITIES[task.objective].shown, QUANTITIES[task.objective].size
    sentences = []
    if tuned.stopped:
        sentences.append(Text("The search was stopped: this is the best setting it had seen."))
    if tuned.floor:
        times = number(tuned.objective / tuned.floor, 3)
        sentences.append(Text("The proposed setting is {times} times the floor.", times=times))
    sentences += _over(task, tuned)
    for field in tuned.at_end_of_range:
        name = symbol(field.rsplit(".", 1)[-1])
        sentences.append(
            Text("{name} stands at the end of its range: the true optimum may lie outside.", name=name)
        )
    for text in tuned.active:
        without = tuned.cost.get(text)
        more = (
            ""
            if without is None
            else Text(
                " Without it the objective is {without} {unit}.", without=number(without / size, 4), unit=unit
            )
        )
        sentences.append(
            Text(
                "The requirement {requirement_words} holds the optimum back.{more}",
                requirement_words=spoken(text),
                more=more,
            )
        )
    if tuned.default_limits:
        kept = Text.joined(", ", map(spoken, tuned.default_limits))
        sentences.append(Text("Kept by default: {kept}.", kept=kept))
    sentences += tuned.assumptions()
    return [*sentences, *(spoken(text) for text in tuned.warnings if text not in _doubts(task, tuned))]


def _over(task: TuneQuestion, tuned: Tuned) -> Iterator[str]:
    """Say what the setting gives over the points of a study, and what that costs in the scenario itself."""
    from navcore.study.robust_tune import TunedOver

    if not isinstance(tuned, TunedOver):
        return
    quantity = QUANTITIES[task.objective]
    where = Text("with {factors}", factors=factors_text(tuned.where)) if tuned.where else _HERE
    yield Text(
        "Over {points} points of the study the objective is at most {worst} {unit}, {where}; the runs are of "
        "the point that was worst before.",
        points=tuned.points,
        worst=number(tuned.worst / quantity.size, 4),
        unit=quantity.shown,
        where=where,
    )
    yield Text(
        "In this scenario it is {here} {unit}; the setting that is best here has {best}.",
        here=number(tuned.here / quantity.size, 4),
        unit=quantity.shown,
        best=number(tuned.best_here / quantity.size, 4),
    )


def doubts(task: TuneQuestion, tuned: Tuned) -> list[str]:
    """Say what speaks against the proposal in its runs."""
    if tuned.confirmed is None:
        return [Text("No run has confirmed this setting.")]
    quantity = QUANTITIES[task.objective]
    name = quantity.names.get("ensemble", quantity.label)  # of the runs, whatever was searched by
    return [Text(*text.forms, **(text.values | {"name": name})) for text in _doubts(task, tuned)]


def _doubts(task: TuneQuestion, tuned: Tuned) -> list[Text]:
    verdict = "" if tuned.confirmed is None else tuned.confirmed.verdict(task.objective)
    return [verdict] if isinstance(verdict, Text) else []


def _row(cells: Sequence[str], tag: str = "td") -> str:
    return row(cell(quoted(text), "sb-n" if k else "", tag=tag) for k, text in enumerate(cells))

"""The table of verdicts: what each requirement asks, what each method measures, and whether it is met."""

import math
from collections.abc import Mapping, Sequence

from navcore.engine.run import Run
from navcore.engine.verdicts import WORDS
from navcore.foundation.text import Text, quoted
from navcore.scenario.requirement import Requirement
from navcore.scenario.stochastic import drawn_as_zero
from schuler_bench.editing.limits import (
    BOXES,
    DETAILS,
    FROM,
    box_text,
    detail_label,
    from_text,
    label_of,
    shown_limit,
)
from schuler_bench.jobs.odds import Odds
from schuler_bench.plots import style
from schuler_bench.plots.known import known_mark
from schuler_bench.plots.limits import SIGNS
from schuler_bench.plots.pinned import Pinned, pinned_methods, together
from schuler_bench.plots.table import cell, row, table
from schuler_bench.plots.units import number, rounded
from schuler_bench.session.requirements import Verdict, verdicts
from schuler_bench.views.requirements.shares import judgements, odds_html

_DIGITS = 4


def requirements_html(
    run: Run,
    pins: Sequence[Pinned] = (),
    methods: Sequence[int] | None = None,
    odds: Sequence[Odds | None] = (),
    boxes: Mapping[str, int] | None = None,
) -> str:
    """Return a row a requirement and a column a method: measured value, and whether it meets the limit.

    Parameters
    ----------
    run : Run
        Result.
    pins : sequence of Pinned
        Runs that are judged beside it.
    methods : sequence of int, optional
        Places of the columns to show, the run's methods first; all when None.
    odds : sequence of Odds or None
        Of each method of the run: how often its seeds meet the limits.
    boxes : mapping, optional
        The limits stand in boxes, each row at its place: how often the text of each box has been refused.
    """
    judged = together(run, pins)
    shown = range(len(judged.methods)) if methods is None else methods
    judged_all = verdicts(judged, run.scenario.requirement, [judgements(one) for one in odds])
    lines = [Text("solid {method_color}", method_color=style.method_color(one.place)) for one in run.methods]
    lines += [Text("dashed {color}", color=pinned.color) for pinned in pinned_methods(pins)]
    heads = (
        cell(quoted(judged.methods[i].method.name), "sb-h", tag="th", style=f"border-bottom:3px {lines[i]}")
        for i in shown
    )
    head = row([cell(Text("requirement"), tag="th"), cell(Text("limit"), "sb-n", tag="th"), *heads])
    asked = any(verdict.limit is not None for verdict in judged_all)
    foot = row(
        [
            cell(Text("all together"), "sb-all"),
            cell(),
            *(cell(_overall(judged_all, i) + odds_html(_of(odds, i)), "sb-n") for i in shown),
        ],
    )
    places, more, look = list(range(len(judged_all))), [], ""
    if boxes is not None:
        places.sort(key=lambda place: BOXES.index(judged_all[place].quantity.key))
        limited = any(one.from_h for one in run.scenario.requirement)
        begins = [cell(FROM), cell(_box("from", FROM, from_text(run.scenario), boxes), "sb-n")]
        button = cell(Text("add a limit"), "sb-do", tag="button", aria_expanded="false")
        more = [row(begins, "" if limited else "sb-unasked"), row([cell(button)], "sb-unfold")]
        look = "" if asked else "sb-nothing"
    rows = (
        _row(
            judged_all[place],
            shown,
            [odds_html(_of(odds, i), place) for i in shown],
            asked=asked,
            boxes=boxes,
            judged=judged,
        )
        for place in places
    )
    return table([head], [*rows, *more, foot], look) + (zero_html(run) if asked else "")


def zero_html(run: Run) -> str:
    """Say which constants the run takes as 0 though the scenario gives their spread; empty where none is."""
    fields = ", ".join(drawn_as_zero(run.scenario))
    if not fields:
        return ""
    said = Text(
        "Drawn as 0 in this run, though a standard deviation is given: {fields}. The shares are of seeds "
        "that draw them.",
        fields=fields,
    )
    return cell(said, "sb-muted sb-zero", tag="p")


def _box(key: str, label: str, text: str, refused: Mapping[str, int]) -> str:
    """Box of a limit; its HTML changes when a text is refused, so that the page shows this one again."""
    return Text(
        '<input class="sb-limit" inputmode="decimal" data-limit="{key}" data-refused="{times}" '
        'value="{text}" aria-label="{label:html}">',
        key=key,
        times=refused.get(key, 0),
        text=text,
        label=label,
    )


def _of(odds: Sequence[Odds | None], index: int) -> Odds | None:
    return odds[index] if index < len(odds) else None


def _row(
    verdict: Verdict,
    shown: Sequence[int],
    beside: Sequence[str],
    *,
    asked: bool,
    boxes: Mapping[str, int] | None,
    judged: Run,
) -> str:
    fidelity = judged.scenario.run.fidelity
    quantity, one = verdict.quantity, verdict.requirement
    unit = (
        Text(' <span class="sb-muted">({shown:html})</span>', shown=quantity.shown) if quantity.shown else ""
    )
    limit = Text("no limit") if one is None else _limit(one)
    if boxes is not None:
        text = "" if one is None else box_text(one)
        box = _box(quantity.key, label_of(quantity.key), text, boxes)
        details = "" if one is None else _details(one, boxes)
        limit = Text("{sign} {box}{details}", sign=SIGNS[quantity.sense], box=box, details=details)
    cells = (
        cell(
            Text(
                "{measured}{known}{mark}{odds}",
                measured=_measured(verdict, value),
                known=known_mark(quantity.key, method.method, fidelity),
                mark=_mark(word) if asked else "",
                odds=odds if one is not None else "",
            ),
            "sb-n",
            data_measure=quantity.key,
            data_value=_number(value),
            data_passed="" if word == "" else WORDS[word],
        )
        for value, word, odds, method in (
            (verdict.measured[i], verdict.words[i], said, judged.methods[i])
            for i, said in zip(shown, beside, strict=True)
        )
    )
    name = Text("{label:html}{unit}", label=quantity.label, unit=unit)
    if one is not None and one.from_h and quantity.kind is not None:
        name = Text("{name}, from {hours:g} h", name=name, hours=one.from_h)
    named = cell(name)
    look = "sb-unasked" if boxes is not None and verdict.limit is None else ""
    return row([named, cell(limit, "sb-n"), *cells], look, title=quantity.help)


def _number(value: float) -> str:
    """Value as the page's scripts read it."""
    return f"{value:.9g}" if math.isfinite(value) else "Infinity"


def _measured(verdict: Verdict, value: float) -> str:
    if not math.isinf(value):
        return rounded(value)
    return Text("never") if verdict.quantity.kind is None else Text("no value")


def _limit(one: Requirement) -> str:
    """Limit in a table without boxes, with its share, hour and clause below it."""
    asked = Text("{sign} {limit}", sign=SIGNS[one.sense], limit=number(shown_limit(one), _DIGITS))
    if isinstance(one.at_most, str):
        asked = Text("{sign} {limit:html}", sign=SIGNS[one.sense], limit=one.at_most)
    for detail in DETAILS.values():
        if text := detail.text(one):
            words = Text("{label}: {text}", label=detail.label, text=text)
            asked += cell(quoted(words), "sb-muted", tag="div")
    return asked


def _details(one: Requirement, refused: Mapping[str, int]) -> str:
    """Boxes of a limit for its share, hour and clause."""
    boxes = (
        Text(
            '<label class="sb-detail">{label:html} {box}</label>',
            label=detail.label,
            box=_box(f"{one.quantity}.{field}", detail_label(one.quantity, field), detail.text(one), refused),
        )
        for field, detail in DETAILS.items()
        if detail.allowed(one.quantity)
    )
    return Text.joined("", boxes)


def _mark(word: str) -> str:
    """Word beside the value, of one width, so that the values stand below each other."""
    return cell(_BADGES[word]() if word else "", "sb-word", tag="span")


def _overall(judged: tuple[Verdict, ...], index: int) -> str:
    words = [verdict.words[index] for verdict in judged if verdict.requirement is not None]
    return overall(words.count("missed"), len(words), unknown=words.count("open"))


def overall(missed: int, asked: int, which: Sequence[str] = (), unknown: int = 0) -> str:
    """Badge that says how many of the limits a method misses, and ``which``, where nothing else says it."""
    if not asked:
        return cell(Text("nothing asked"), "sb-muted", tag="span")
    if missed and which:
        names = Text.joined(", ", which)
        text = Text("✗ misses {missed} of {asked}: {names:html}", missed=missed, asked=asked, names=names)
        return _badge(text, False)
    if missed:
        return _badge(Text("✗ misses {missed} of {asked}", missed=missed, asked=asked), False)
    if unknown:
        return cell(Text("? {unknown} of {asked} open", unknown=unknown, asked=asked), "sb-open", tag="span")
    return _badge(Text("✓ meets all {asked}", asked=asked) if asked > 1 else Text("✓ meets it"), True)


def _badge(text: str, passed: bool) -> str:
    return cell(text, "sb-met" if passed else "sb-missed", tag="span")


_BADGES = {
    "met": lambda: _badge(Text("✓ met"), True),
    "missed": lambda: _badge(Text("✗ missed"), False),
    "open": lambda: cell(Text("? open"), "sb-open", tag="span"),
}

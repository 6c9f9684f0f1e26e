"""Tables of a study: shares and quantiles of every method, and the worst runs, which a click opens."""

from __future__ import annotations

from collections.abc import Sequence, Set
from typing import Any

from navcore.foundation.text import Text, quoted
from navcore.quantities import QUANTITIES
from schuler_bench.plots.table import cell, row, table
from schuler_bench.plots.units import number
from schuler_bench.plots.varied import value_text, varied_label
from schuler_bench.shell import notices
from schuler_bench.views.study.figure import MET, label_of

OPEN_RUN = "open-study-run"
"""Command of a worst run's button, with its number and the method."""
_OPEN, _HINT = Text("Open"), Text("Opens the scenario of this very run; undo goes back.")
_STATUS = {
    "ok": Text("ended"),
    "diverged": Text("diverged"),
    "refused": Text("refused"),
    "stopped": Text("stopped"),
}


def shares_html(document: dict[str, Any], metric: str) -> str:
    """Table with a row a method: runs, share that meets the limits, quantiles of a metric, wins."""
    methods = document["methods"]
    limited = any(MET in one for one in methods)
    measured = metric != MET
    wins = measured and any("best" in one["metrics"][metric] for one in methods)
    heads = [Text("method"), Text("runs"), Text("diverged")]
    heads += [Text("meets all limits"), Text("95 % interval")] if limited else []
    heads += [label_of(metric), Text("5 % to 95 %")] if measured else []
    heads += [Text("alone the best")] if wins else []
    body = []
    for one in methods:
        cells = [cell(quoted(one["name"]), "sb-all")]
        cells += [cell(str(one["runs"]), "sb-n"), cell(str(one["diverged"]), "sb-n")]
        if limited:
            cells += [cell(_percent(one[MET]["share"]), "sb-n"), cell(_interval(one[MET]), "sb-n")]
        if measured:
            found = one["metrics"][metric]
            cells.append(cell(_number(found["median"]), "sb-n"))
            ends = Text("{low} to {high}", low=_number(found["q05"]), high=_number(found["q95"]))
            cells.append(cell(ends, "sb-n"))
        if wins:
            best = one["metrics"][metric]["best"]
            told = Text("{share} ({interval})", share=_percent(best["share"]), interval=_interval(best))
            cells.append(cell(told, "sb-n"))
        body.append(row(cells))
    return table([_head(heads, {0})], body)


def worst_html(document: dict[str, Any], metric: str, method: str, *, buttons: bool) -> str:
    """Table of the runs with the largest values of a metric; empty where there are none."""
    one = next(one for one in document["methods"] if one["name"] == method)
    found = one.get("worst", {}).get(metric, [])
    if not found:
        return ""
    factors = [*found[0]["factors"]]
    heads = [Text("run"), *map(varied_label, factors), label_of(metric), Text("status")]
    heads += [Text("open")] if buttons else []
    body = []
    for run in found:
        take = Text(
            '<button class="sb-take" data-command="{command} {number}" title="{hint:html}">'
            "{words:html}</button>",
            command=OPEN_RUN,
            number=run["run"],
            hint=_HINT,
            words=_OPEN,
        )
        values = map(value_text, run["factors"].values())
        cells = [cell(str(run["run"]), "sb-n"), *(cell(quoted(value), "sb-n") for value in values)]
        cells += [
            cell(_number(run["value"]), "sb-n"),
            cell(quoted(_STATUS[run["status"]])),
        ]
        body.append(row([*cells, cell(take, "sb-w")] if buttons else cells))
    title = notices.heading(Text("Worst runs of {method}", method=method))
    words = {heads.index(head) for head in heads[len(factors) + 2 :]}
    return Text("{title}{table}", title=title, table=table([_head(heads, words)], body, "sb-worst"))


def study_html(document: dict[str, Any], metric: str, method: str, *, buttons: bool = True) -> str:
    """Both tables; ``buttons``: with what opens a run."""
    worst = worst_html(document, metric, method, buttons=buttons)
    return Text.joined("", (shares_html(document, metric), worst))


def _head(heads: Sequence[str], of_words: Set[int]) -> str:
    """Row of headings; those of columns of numbers stand at the right as these do."""
    return row(
        cell(quoted(head), "" if place in of_words else "sb-n", tag="th") for place, head in enumerate(heads)
    )


def metrics_of(document: dict[str, Any]) -> tuple[str, ...]:
    """Quantities to choose from: metrics of runs, and the share of runs that meets the limits."""
    methods = document["methods"]
    keys = tuple(key for key in methods[0]["metrics"] if QUANTITIES[key].kind) if methods else ()
    return (*keys, MET) if methods and MET in methods[0] else keys


def _number(value: float | None) -> str:
    return Text("none") if value is None else number(value, 3)


def _percent(share: float) -> str:
    return f"{number(100.0 * share, 3)}\u00a0%"


def _interval(share: dict[str, float]) -> str:
    low, high = (number(100.0 * share[end], 3) for end in ("low", "high"))
    return Text("{low} to {high} %", low=low, high=high)

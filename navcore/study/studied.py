"""What a study gives: its summary, as a document and as tables, and the rows of its runs."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from navcore.foundation.answers import Answer, Column, Table, number
from navcore.foundation.text import Text


@dataclass(frozen=True)
class Studied(Answer):
    """Result of a study.

    Attributes
    ----------
    summary : dict
        As ``summary.json``; its ``status`` says whether it is complete.
    runs : bytes
        ``runs.parquet``; empty where it lies in a folder.
    place : str
        The folder, where there is one.
    """

    summary: dict[str, Any]
    runs: bytes = b""
    place: str = ""

    @property
    def complete(self) -> bool:
        """Whether no run is missing."""
        return self.summary["status"] == "complete"

    @property
    def so_far(self) -> str:
        """How many runs were complete, and how to go on."""
        done = Text("{runs} of {of} runs are complete", runs=self.summary["runs"], of=self.summary["of"])
        if not self.place:
            return done
        return Text("{done}; --out {place} --resume goes on", done=done, place=self.place)

    def document(self) -> dict[str, Any]:
        """Return ``summary.json``."""
        return self.summary

    def rows(self) -> Iterator[Table | str]:
        """Give shares and medians of each method, the first metric by cell and by factor."""
        document = self.summary
        title = document["title"] or Text("study")
        yield Text("{title}: {runs} of {of} runs", title=title, runs=document["runs"], of=document["of"])
        yield _methods(document["methods"])
        names = [method["name"] for method in document["methods"]]
        cells = document.get("cells", [])
        keys = [*document["methods"][0]["metrics"]][:1] if document["methods"] else []
        for key in keys if cells else []:
            title = Text(
                "{key}, median; in brackets the % of runs in which the method alone has the smallest", key=key
            )
            heads = [", ".join(cells[0]["factors"]), *names]
            rows = tuple((_place(cell), *_cell(cell, key, names)) for cell in cells)
            yield Table(tuple(map(Column, heads)), rows, title)
        yield from _depending(document["methods"])


def _methods(methods: list[dict[str, Any]]) -> Table:
    limited = any("met" in method for method in methods)
    metrics = [*methods[0]["metrics"]] if methods else []
    heads = ["method", *(["met %", "95 % interval"] if limited else []), *metrics, "diverged", "refused"]
    rows: list[tuple[str | float | None, ...]] = []
    for method in methods:
        met = [_percent(method["met"]["share"]), _interval(method["met"])] if limited else []
        medians = [method["metrics"][key]["median"] for key in metrics]
        rows.append((method["name"], *met, *medians, str(method["diverged"]), str(method["refused"])))
    return Table(tuple(map(Column, heads)), tuple(rows))


def _place(cell: dict[str, Any]) -> str:
    return ", ".join(value if isinstance(value, str) else f"{value:g}" for value in cell["factors"].values())


def _cell(cell: dict[str, Any], key: str, names: list[str]) -> list[str]:
    """Median and share of wins with its interval of each method."""
    found = {method["name"]: method["metrics"][key] for method in cell["methods"]}
    texts = []
    for name in names:
        one = found.get(name)
        best = (
            f" ({_percent(one['best']['share'])}: {_interval(one['best'])})" if one and "best" in one else ""
        )
        texts.append(number(one["median"]) + best if one else "-")
    return texts


def _percent(share: float) -> str:
    return number(100.0 * share, 3)


def _interval(share: dict[str, float]) -> str:
    return f"{_percent(share['low'])} to {_percent(share['high'])}"


def _depending(methods: list[dict[str, Any]]) -> Iterator[Table]:
    """Give the quantity that moves the first metric most, and its Sobol indices, for each method."""
    for method in methods:
        for key, found in [*method.get("tornado", {}).items()][:1]:
            title = Text("{name}, {key}: least and largest median by factor", name=method["name"], key=key)
            ends = ("least", "at_least", "largest", "at_largest")
            rows = tuple((one["factor"], *(_value(one[end]) for end in ends)) for one in found)
            yield Table(tuple(map(Column, ("factor", "least", "at", "largest", "at"))), rows, title)
        for key, found in [*method.get("sobol", {}).items()][:1]:
            name = method["name"]
            title = Text("{name}, {key}: Sobol indices with their 95 % intervals", name=name, key=key)
            rows = tuple((one["factor"], _index(one["first"]), _index(one["total"])) for one in found)
            yield Table(tuple(map(Column, ("factor", "first order", "total"))), rows, title)


def _index(one: dict[str, float]) -> str:
    return f"{one['value']:.2f} ({one['low']:.2f} to {one['high']:.2f})"


def _value(value: Any) -> str:
    return value if isinstance(value, str) else number(value, 4)

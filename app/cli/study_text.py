"""The summary of a study as tables for people."""

from typing import Any

from navcore.foundation.answers import columns, number


def study_text(document: dict[str, Any]) -> list[str]:
    """Lines: share that meets the limits and median of each metric; the first metric by cell, by factor."""
    runs = f"{document['runs']} of {document['of']} runs"
    lines = [f"{document['title'] or 'study'}: {runs}", "", *columns(_methods(document["methods"]))]
    names = [method["name"] for method in document["methods"]]
    cells = document.get("cells", [])
    keys = [*document["methods"][0]["metrics"]][:1] if document["methods"] else []
    for key in keys if cells else []:
        lines += ["", f"{key}, median; in brackets the % of runs in which the method alone has the smallest"]
        head = [", ".join(cells[0]["factors"]), *names]
        lines += columns([head, *([_place(cell), *_cell(cell, key, names)] for cell in cells)])
    return lines + _depending(document["methods"])


def _methods(methods: list[dict[str, Any]]) -> list[list[str]]:
    limited = any("met" in method for method in methods)
    metrics = [*methods[0]["metrics"]] if methods else []
    rows = [["method", *(["met %", "95 % interval"] if limited else []), *metrics, "diverged", "refused"]]
    for method in methods:
        met = [_percent(method["met"]["share"]), _interval(method["met"])] if limited else []
        medians = [number(method["metrics"][key]["median"]) for key in metrics]
        rows.append([method["name"], *met, *medians, str(method["diverged"]), str(method["refused"])])
    return rows


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


def _depending(methods: list[dict[str, Any]]) -> list[str]:
    """Quantity that moves the first metric most, and its Sobol indices, for each method."""
    lines: list[str] = []
    for method in methods:
        for key, found in [*method.get("tornado", {}).items()][:1]:
            lines += ["", f"{method['name']}, {key}: least and largest median by factor"]
            rows = [["factor", "least", "at", "largest", "at"]]
            for one in found:
                ends = [_value(one[end]) for end in ("least", "at_least", "largest", "at_largest")]
                rows.append([one["factor"], *ends])
            lines += columns(rows)
        for key, found in [*method.get("sobol", {}).items()][:1]:
            lines += ["", f"{method['name']}, {key}: Sobol indices with their 95 % intervals"]
            orders = [[f"{one[name]['value']:.2f} ({one[name]['low']:.2f} to {one[name]['high']:.2f})"
                       for name in ("first", "total")] for one in found]  # fmt: skip
            named = [[one["factor"], *order] for one, order in zip(found, orders, strict=True)]
            lines += columns([["factor", "first order", "total"], *named])
    return lines


def _value(value: Any) -> str:
    return value if isinstance(value, str) else number(value, 4)

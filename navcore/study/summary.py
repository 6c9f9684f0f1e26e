"""Summary of a study: shares with their intervals, quantiles, and which method is best where."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Literal

import numpy as np

from navcore.engine.measures import versions
from navcore.engine.verdicts import wilson
from navcore.quantities import QUANTITIES
from navcore.scenario.fields import SCHEMA
from navcore.study.model import series_column
from navcore.study.plan import Plan
from navcore.study.sensitivity import Sensitivity

QUANTILES, _NAMES = (0.05, 0.5, 0.95), ("q05", "median", "q95")
MOST_CELLS = 500
"""Combinations of the grid that are summed up one by one; all are in the rows."""
WORST = 5
"""Runs of each method that are named for a metric, the worst first."""


def summary(plan: Plan, runs: Path, status: Literal["complete", "stopped"], done: int) -> dict[str, Any]:
    """Sum up the rows of a study.

    Parameters
    ----------
    plan : Plan
        The study.
    runs : Path
        Its ``runs.parquet``. One metric is read at a time: 8 bytes a row.
    status, done : str, int
        How it ended, and how many runs it has.

    Returns
    -------
    dict
        Document that JSON can hold (interface.md).
    """
    rows = _Rows(runs)
    groups = [np.arange(len(rows.method))]
    combinations = list(plan.combinations()) if plan.cell_count <= MOST_CELLS else [{}]
    if len(combinations) > 1:
        cells = plan.cells(rows.run)
        order = np.argsort(cells, kind="stable")
        groups += np.split(order, np.searchsorted(cells[order], range(1, len(combinations))))
    found = [_counts(plan, rows, group) for group in groups]
    drawn = {factor.column: rows.column(factor.column) for factor in plan.random}
    sensitivity = Sensitivity(plan, rows.run, drawn)
    for key in plan.study.output.metrics:
        values = rows.column(key)
        _depending(rows, key, values, sensitivity, found[0])
        _worst(plan, rows, key, values, found[0])
        for group, methods in zip(groups, found, strict=True):
            _measured(rows, key, values, group, methods)
    _over_time(plan, rows, found[0])
    document: dict[str, Any] = {
        "schema": SCHEMA,
        "title": plan.study.title,
        "status": status,
        "runs": done,
        "of": plan.runs,
        "versions": versions(),
        "methods": [*found[0].values()],
    }
    if plan.study.output.series:
        document["epochs_h"] = [*plan.study.output.epochs_h]
    if len(groups) > 1:
        document["cells"] = [
            {"factors": factors, "methods": [*methods.values()]}
            for factors, methods in zip(combinations, found[1:], strict=True)
        ]
    return document


class _Rows:
    """Columns of the results; that of a metric is read when it is asked for, and not kept."""

    def __init__(self, path: Path) -> None:
        import pyarrow.parquet as pq

        self._file = pq.ParquetFile(path)
        names = self._read("method").dictionary_encode().combine_chunks()
        self.names: list[str] = names.dictionary.to_pylist() if len(names) else []
        self.method = names.indices.to_numpy() if len(names) else np.zeros(0, np.int64)
        self.run = self._read("run").to_numpy()
        self.status = self._read("status").to_numpy()
        self.met = self._read("met").to_numpy()

    def column(self, name: str) -> np.ndarray:
        """Values; NaN where there are none."""
        return self._read(name).to_numpy().astype(float)

    def _read(self, name: str) -> Any:
        return self._file.read([name]).column(0)


def _counts(plan: Plan, rows: _Rows, group: np.ndarray) -> dict[int, dict[str, Any]]:
    """Number of a method -> its runs, and the share of them that meets all limits."""
    found = {}
    for k, name in enumerate(rows.names):
        own = group[rows.method[group] == k]
        if own.size:
            status = rows.status[own]
            ended = {word: int((status == word).sum()) for word in ("diverged", "refused")}
            found[k] = {"name": name, "runs": int(own.size), **ended}
            if plan.scenario.requirement:
                found[k]["met"] = _share(int(rows.met[own].sum()), int(own.size))
            found[k]["metrics"] = {}
    return found


def _measured(
    rows: _Rows, key: str, values: np.ndarray, group: np.ndarray, methods: dict[int, dict[str, Any]]
) -> None:
    """Add a metric to the methods of a group: quantiles, and the share of runs in which it alone is best."""
    method, run = rows.method[group], rows.run[group]
    chosen = np.nan_to_num(values[group], nan=np.inf)
    for k, document in methods.items():
        own = chosen[method == k]
        document["metrics"][key] = _quantiles(own)
        document["metrics"][key]["without"] = int(np.isinf(own).sum())
    if QUANTITIES[key].kind is None or len(methods) < 2:
        return
    starts = np.flatnonzero(np.diff(run, prepend=-1))
    rows_a_run = np.diff(np.append(starts, len(run)))
    least = chosen == np.repeat(np.minimum.reduceat(chosen, starts), rows_a_run)
    alone = np.repeat(np.add.reduceat(least.astype(int), starts), rows_a_run) == 1
    winners = method[least & alone]
    for k, document in methods.items():
        document["metrics"][key]["best"] = _share(int((winners == k).sum()), len(starts))


def _depending(
    rows: _Rows, key: str, values: np.ndarray, sensitivity: Sensitivity, methods: dict[int, dict[str, Any]]
) -> None:
    """Add to each method what moves a metric most, and its Sobol indices where the sample gives them."""
    chosen = np.nan_to_num(values, nan=np.inf)
    for k, document in methods.items():
        own = rows.method == k
        for name, found in {"tornado": sensitivity.tornado, "sobol": sensitivity.sobol}.items():
            if one := found(chosen, own):
                document.setdefault(name, {})[key] = one


def _worst(plan: Plan, rows: _Rows, key: str, values: np.ndarray, methods: dict[int, dict[str, Any]]) -> None:
    """Add to each method its runs with the largest values of a metric, those without a value first."""
    if QUANTITIES[key].kind is None:
        return
    chosen = np.nan_to_num(values, nan=np.inf)
    for k, document in methods.items():
        own = np.flatnonzero(rows.method == k)
        if own.size > WORST:
            own = own[np.argpartition(chosen[own], own.size - WORST)[-WORST:]]
        own = own[np.lexsort((rows.run[own], -chosen[own]))]
        document.setdefault("worst", {})[key] = [
            _named(plan, rows, int(one), float(chosen[one])) for one in own
        ]


def _named(plan: Plan, rows: _Rows, place: int, value: float) -> dict[str, Any]:
    """One run: its number, factors, status and value."""
    number = int(rows.run[place])
    setting, _ = plan.at(number)
    told = {"run": number, "factors": plan.values(setting), "status": str(rows.status[place])}
    return told | {"value": float(value) if np.isfinite(value) else None}


def _over_time(plan: Plan, rows: _Rows, methods: dict[int, dict[str, Any]]) -> None:
    """Add to each method the quantiles of the errors that are kept, at the epochs."""
    for name in plan.study.output.series:
        columns = [rows.column(series_column(name, hours)) for hours in plan.study.output.epochs_h]
        for k, document in methods.items():
            own = rows.method == k
            found = [_quantiles(np.nan_to_num(column[own], nan=np.inf)) for column in columns]
            document.setdefault("series", {})[name] = {
                quantile: [one[quantile] for one in found] for quantile in _NAMES
            }


def _quantiles(values: np.ndarray) -> dict[str, Any]:
    """Quantiles of the finite values; None where there are none."""
    there = values[np.isfinite(values)]
    found = np.quantile(there, QUANTILES).tolist() if there.size else [None] * len(QUANTILES)
    return dict(zip(_NAMES, found, strict=True))


def _share(count: int, runs: int) -> dict[str, float]:
    low, high = wilson(count, runs)
    return {"share": count / runs, "low": low, "high": high}

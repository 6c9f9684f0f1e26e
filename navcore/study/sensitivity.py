"""Which factor a metric depends on: the tornado, and Sobol indices where the sample allows them."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np

from navcore.study.plan import Plan

_PARTS = 5
"""Groups of a factor that is drawn, by its size."""
_MOST_VALUES = 100
"""Values of a grid factor whose medians are compared."""
_LEVEL, _RESAMPLES, _SEED = 0.95, 200, 1


class Sensitivity:
    """Groups of a study's rows by each factor.

    Parameters
    ----------
    plan : Plan
        The study.
    run : ndarray, shape (n,)
        Number of the run of each row.
    drawn : mapping
        Column -> values of the factors that are drawn, shape (n,).
    """

    def __init__(self, plan: Plan, run: np.ndarray, drawn: dict[str, np.ndarray]) -> None:
        self._plan, places = plan, plan.places(run.astype(np.int64))
        self._draw = np.broadcast_to(places[0], run.shape)
        self._groups: dict[str, tuple[np.ndarray, list[Any]]] = {}
        for k, (factor, names) in enumerate(zip(plan.grid, plan.shown, strict=True), 1):
            if 1 < len(names) <= _MOST_VALUES:
                self._groups[factor.column] = places[k], names
        for column, values in drawn.items():
            if len(values) >= 4 * _PARTS:
                edges = np.quantile(values, np.linspace(0.0, 1.0, _PARTS + 1)[1:-1])
                part = np.searchsorted(edges, values, side="right")
                middles = [float(np.median(values[part == k])) for k in range(_PARTS) if (part == k).any()]
                self._groups[column] = part, middles if len(middles) == _PARTS else []

    def tornado(self, values: np.ndarray, own: np.ndarray) -> list[dict[str, Any]]:
        """Say how far the median of a metric moves with each factor, the largest move first.

        Parameters
        ----------
        values : ndarray, shape (n,)
            Of the metric; infinite where there is none.
        own : ndarray of bool, shape (n,)
            Rows of the method.
        """
        found = []
        for column, (part, names) in self._groups.items():
            groups = [values[own & (part == k)] for k in range(len(names))]
            medians = [np.median(group) if group.size else np.inf for group in groups]
            if not (medians and np.isfinite(medians).all()):
                continue
            least, largest = int(np.argmin(medians)), int(np.argmax(medians))
            found.append(
                {
                    "factor": column,
                    "least": float(medians[least]),
                    "at_least": names[least],
                    "largest": float(medians[largest]),
                    "at_largest": names[largest],
                }
            )
        return sorted(found, key=lambda one: one["least"] - one["largest"])

    def sobol(self, values: np.ndarray, own: np.ndarray) -> list[dict[str, Any]]:
        """Sobol indices of a metric with their 95 % intervals, in the order of the factors.

        Of several seeds and grid values the mean counts. Empty with another sample than ``saltelli``, where
        a run has no value or is missing, and where nothing differs.
        """
        plan = self._plan
        count, dimensions = plan.study.sample.points, len(plan.random)
        if plan.study.sample.method != "saltelli":
            return []
        runs = np.bincount(self._draw[own], minlength=plan.study.draws)
        if not runs.all() or not np.isfinite(values[own]).all():
            return []
        means = np.bincount(self._draw[own], values[own], plan.study.draws) / runs
        rows = means.reshape(count, dimensions + 2).T[:, None, :]
        if np.ptp(rows) <= 1e-12 * np.abs(rows).max():
            return []
        from scipy.stats import bootstrap

        rows = rows - rows[:2].mean()
        found = _indices(rows)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of a factor that does nothing all samples are alike
            ends = bootstrap(
                [np.arange(count)],
                lambda which: _indices(rows[:, :, which]),
                method="BCa",
                n_resamples=_RESAMPLES,
                confidence_level=_LEVEL,
                rng=_SEED,
            ).confidence_interval
        document = []
        for k, factor in enumerate(plan.random):
            one: dict[str, Any] = {"factor": factor.column}
            for order, name in enumerate(("first", "total")):
                value = float(found[order, k])
                low, high = (float(e[order, k]) if np.isfinite(e[order, k]) else value for e in ends)
                one[name] = {"value": value, "low": low, "high": high}
            document.append(one)
        return document


def _indices(rows: np.ndarray) -> np.ndarray:
    """First and total Sobol indices, shape (2, d), of values at A, B and the mixed points (2 + d, 1, n).

    Saltelli et al., Computer Physics Communications 181, 2010, table 2 (b) and (f).
    """
    f_a, f_b, mixed = rows[0, 0], rows[1, 0], rows[2:, 0]
    variance = np.var([f_a, f_b])
    first = np.mean(f_b * (mixed - f_a), axis=1) / variance
    total = 0.5 * np.mean((f_a - mixed) ** 2, axis=1) / variance
    return np.array([first, total])

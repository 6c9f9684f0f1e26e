"""Envelope of the error curves over many seeds: where 90 % of all noises let them run."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from navcore.engine.run import Run

LOWEST, HIGHEST = 5.0, 95.0
"""Per cent of the runs that lie below the lower and the upper edge."""


@dataclass(frozen=True, eq=False)
class Envelope:
    """Edges of a band for every method.

    Attributes
    ----------
    t_s : ndarray, shape (m,)
        Times, s.
    low, high : tuple of ndarray, each shape (m, 8)
        For every method the edges of the quantities of `navcore.mechanization.recorder.NAMES`, SI.
    count : int
        Number of seeds.
    """

    t_s: np.ndarray
    low: tuple[np.ndarray, ...]
    high: tuple[np.ndarray, ...]
    count: int

    @property
    def label(self) -> str:
        """What the band is, in words."""
        return f"band: {LOWEST:g} to {HIGHEST:g} % of {self.count} seeds"


def envelope(runs: Sequence[Run]) -> Envelope:
    """Envelope of runs that differ in their seed only.

    A plot's bins keep their smallest and largest value; the lower edge is the 5 % quantile over the runs of
    a bin's smallest value, the upper edge the 95 % quantile of its largest one.

    Parameters
    ----------
    runs : sequence of Run
        At least one; they are cut to the shortest.
    """
    low, high, times = [], [], []
    for index in range(len(runs[0].methods)):
        series = [run.methods[index].plot for run in runs]
        pairs = 2 if len(series[0].t_s) > 2 and series[0].t_s[0] > 0.0 else 1
        bins = min(len(each.t_s) for each in series) // pairs
        stacked = np.stack([each.values[: bins * pairs].reshape(bins, pairs, -1) for each in series])
        low.append(np.percentile(stacked.min(axis=2), LOWEST, axis=0))
        high.append(np.percentile(stacked.max(axis=2), HIGHEST, axis=0))
        times.append(series[0].t_s[: bins * pairs].reshape(bins, pairs).mean(axis=1))
    count = min((len(each) for each in times), default=0)
    shortest = times[0][:count] if times else np.empty(0)
    return Envelope(
        shortest, tuple(each[:count] for each in low), tuple(each[:count] for each in high), len(runs)
    )

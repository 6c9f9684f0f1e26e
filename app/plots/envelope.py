"""Bands behind the error curves: over many seeds, or one standard deviation by covariance."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from navcore.engine.run import Run
from navcore.foundation.text import Text
from navcore.quantities import COMPONENTS
from schuler_bench.plots.lengths import curves_of, with_lengths

if TYPE_CHECKING:
    from navcore.design.bands import Bands
    from navcore.scenario.model import Scenario

BandKind = Literal["none", "covariance", "seeds"]
"""Bands that can be shown."""

LOWEST, HIGHEST = 5.0, 95.0
"""Per cent of the runs that lie below the lower and the upper edge."""
OLD = Text(" (of an earlier setting)")


@dataclass(frozen=True, eq=False)
class Envelope:
    """Edges of a band for every method.

    Attributes
    ----------
    t_s : ndarray, shape (m,)
        Times, s.
    low, high : tuple of ndarray, each shape (m, 10), or None
        For every method the edges of its curves (`schuler_bench.plots.lengths.curves_of`), SI; None for a
        method without a band.
    words : str
        What the band is.
    details : tuple of str
        What it covers and what it does not.
    old : bool
        It is of an earlier scenario.
    with_recorded : bool
        The first of the methods is the INS as it was recorded.
    """

    t_s: np.ndarray
    low: tuple[np.ndarray | None, ...]
    high: tuple[np.ndarray | None, ...]
    words: str
    details: tuple[str, ...] = ()
    old: bool = False
    with_recorded: bool = False

    @property
    def label(self) -> str:
        """Name of the band, and whether it is older than the curves."""
        return Text("band: {words}{old}", words=self.words, old=OLD if self.old else "")


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
    for methods in zip(*(run.methods for run in runs), strict=True):
        series = [method.plot for method in methods]
        pairs = 2 if len(series[0].t_s) > 2 and series[0].t_s[0] > 0.0 else 1
        bins = min(len(each.t_s) for each in series) // pairs
        stacked = np.stack([curves_of(one)[: bins * pairs].reshape(bins, pairs, -1) for one in methods])
        low.append(np.percentile(stacked.min(axis=2), LOWEST, axis=0))
        high.append(np.percentile(stacked.max(axis=2), HIGHEST, axis=0))
        times.append(series[0].t_s[: bins * pairs].reshape(bins, pairs).mean(axis=1))
    count = min(map(len, times))
    words = Text(
        "{lowest:g} to {highest:g} % of {runs} seeds", lowest=LOWEST, highest=HIGHEST, runs=len(runs)
    )
    lower, upper = (tuple(each[:count] for each in edges) for edges in (low, high))
    return Envelope(
        times[0][:count], lower, upper, words, (Text("Each seed is another draw of all random errors."),)
    )


_COVERS = Text(
    "One standard deviation of the errors, by covariance along the motion: random errors of IMU and log, and "
    "biases and initial errors with their standard deviations."
)
_BY_INS = Text("Standard deviations that the INS recorded of its output.")
_MOST_NAMED = 2


def covariance_envelope(scenario: Scenario, bands: Bands) -> Envelope:
    """Bands of one standard deviation on both sides of zero; of a length from zero up.

    Parameters
    ----------
    scenario : Scenario
        What the bands are of.
    bands : Bands
        Of `navcore.design.bands.covariance_bands`.
    """
    low: list[np.ndarray | None] = []
    high: list[np.ndarray | None] = []
    missing, details = [], [_COVERS]
    for method, band in zip(scenario.method, bands.methods, strict=True):
        if band.sigma is None:
            missing.append(method.name)
            details.append(Text("{name}: no band, {reason}.", name=method.name, reason=band.reason))
            low.append(None)
            high.append(None)
            continue
        if band.kind == "filter":
            details.append(
                Text("{name}: the covariance that the Kalman filter computes for itself.", name=method.name)
            )
        distance = np.hypot(band.sigma[:, 5], band.sigma[:, 6])
        edge = with_lengths(np.column_stack([band.sigma, distance]))
        high.append(edge)
        low.append(np.where(np.arange(edge.shape[1]) < len(COMPONENTS), -edge, 0.0))
    names = (
        Text.joined(", ", missing)
        if len(missing) <= _MOST_NAMED
        else Text("{missing} methods", missing=len(missing))
    )
    words = Text("±1σ by covariance")
    if missing:
        words += Text("; no covariance: {names}", names=names)
    return Envelope(bands.t_s, tuple(low), tuple(high), words, tuple(details))


def own_band(run: Run) -> Envelope | None:
    """Band of the standard deviations that a recorded INS gives its own output; None where it gives none."""
    recorded = None if run.against is None else run.against.recorded
    if recorded is None or recorded.sigma is None:
        return None
    distance = np.hypot(recorded.sigma[:, 5], recorded.sigma[:, 6])
    edge = with_lengths(np.column_stack([recorded.sigma, distance]))
    low = np.where(np.arange(edge.shape[1]) < len(COMPONENTS), -edge, 0.0)
    others = (None,) * (len(run.lines) - 1)
    words = Text("±1σ by the INS itself")
    return Envelope(recorded.t_s, (low, *others), (edge, *others), words, (_BY_INS,), with_recorded=True)

"""Standard deviations of a budget: one source or all, in the steady state or along a run."""

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from navcore.quantities import budgeted


@dataclass(frozen=True)
class Figures:
    """Standard deviations; None where there is none.

    Attributes
    ----------
    tilt_rad, velocity_mps : float or None
        Of one level channel: the root mean square of the two along a run.
    heading_rad, position_m : float or None
        Along a run only; position is the distance.
    """

    tilt_rad: float | None = None
    velocity_mps: float | None = None
    heading_rad: float | None = None
    position_m: float | None = None

    def as_dict(self, along_run: bool) -> dict[str, float | None]:
        """Return the figures that this kind of budget has."""
        return {kind.figure: _finite(getattr(self, kind.figure)) for kind in budgeted(not along_run)}


@dataclass(frozen=True)
class Entry:
    """One source, or all together.

    Attributes
    ----------
    rms : Figures
        In the steady state, or root mean square over the run.
    final : Figures or None
        At the end of the run; None in the steady state.
    growth : Figures or None
        Without a steady state: standard deviation after one hour of growth with the square root of time.
    """

    rms: Figures
    final: Figures | None = None
    growth: Figures | None = None

    def as_dict(self) -> dict[str, Any]:
        """Return the document of interface.md."""
        document: dict[str, Any] = self.rms.as_dict(self.final is not None)
        if self.final is not None:
            document["final"] = self.final.as_dict(True)
        if self.growth is not None:
            document["growth_in_1h"] = self.growth.as_dict(False)
        return document


def total_of(entries: Iterable[Entry]) -> Figures:
    """Independent sources of a steady state together; None for a figure that one of them lacks."""
    figures = [entry.rms for entry in entries]
    columns = [[getattr(one, kind.figure) for one in figures] for kind in budgeted(steady=True)]
    sums = (None if None in values else math.sqrt(sum(x * x for x in values)) for values in columns)
    return Figures(*sums)


@dataclass(frozen=True, eq=False)
class Series:
    """Mean squares along the run, for bands under the error curves.

    Attributes
    ----------
    t_s : ndarray, shape (m,)
    sources : dict of ndarray, shape (m, 7)
        For `navcore.quantities.COMPONENTS`, in their units squared; empty where the method has none.
    total : ndarray, shape (m, 7)
    given : ndarray, shape (m, 7), or None
        Mean square of what follows from the sources that are given as numbers, together and with their signs;
        None where fewer than two act.
    """

    t_s: np.ndarray
    sources: Mapping[str, np.ndarray]
    total: np.ndarray
    given: np.ndarray | None = None


def entry_of(t_s: np.ndarray, variance: np.ndarray) -> Entry:
    """Root mean square over a run, and at its end, of variances of shape (m, 7)."""
    return Entry(mean_figures(t_s, variance), _figures(variance[-1]))


def mean_figures(t_s: np.ndarray, variance: np.ndarray) -> Figures:
    """Root mean squares over a run of variances for `navcore.quantities.COMPONENTS`, shape (m, 7)."""
    span = t_s[-1] - t_s[0]
    with np.errstate(over="ignore", invalid="ignore"):  # of an unstable loop
        mean = np.trapezoid(variance, t_s, axis=0) / span if span > 0.0 else variance[-1]
    return _figures(mean)


def _figures(variance: np.ndarray) -> Figures:
    phi_e, phi_n, phi_u, dv_e, dv_n, lat, lon = np.maximum(variance, 0.0).tolist()
    return Figures(
        math.sqrt(0.5 * (phi_e + phi_n)),
        math.sqrt(0.5 * (dv_e + dv_n)),
        math.sqrt(phi_u),
        math.sqrt(lat + lon),
    )


def _finite(value: float | None) -> float | None:
    return None if value is None or not math.isfinite(value) else float(value)

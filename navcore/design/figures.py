"""Standard deviations of a budget: one source or all, in the steady state or along a run."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np


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
        document = {"tilt_rad": self.tilt_rad, "velocity_mps": self.velocity_mps}
        if along_run:
            document |= {"heading_rad": self.heading_rad, "position_m": self.position_m}
        return {name: _finite(value) for name, value in document.items()}


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


@dataclass(frozen=True, eq=False)
class Series:
    """Variances along the run, for bands under the error curves.

    Attributes
    ----------
    t_s : ndarray, shape (m,)
    sources : dict of ndarray, shape (m, 7)
        For `navcore.design.along.QUANTITIES`, in their units squared; empty where the method has none.
    total : ndarray, shape (m, 7)
    """

    t_s: np.ndarray
    sources: Mapping[str, np.ndarray]
    total: np.ndarray


def entry_of(t_s: np.ndarray, variance: np.ndarray) -> Entry:
    """Root mean square over a run, and at its end, of variances of shape (m, 7)."""
    return Entry(mean_figures(t_s, variance), _figures(variance[-1]))


def mean_figures(t_s: np.ndarray, variance: np.ndarray) -> Figures:
    """Root mean squares over a run of variances for `navcore.design.along.QUANTITIES`, shape (m, 7)."""
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

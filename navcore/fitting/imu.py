"""Noise of a standing IMU: white noise and Gauss-Markov drift by likelihood, beside its Allan deviation.

The Allan deviation shows what the record holds at each averaging time, with the chi-square intervals of
white noise (NIST SP 1065: overlapping estimate, equation 11; degrees of freedom, table 5; interval, 45).
White noise and drift come from the likelihood of `navcore.fitting.drift`, each axis by itself. A drift that
does not level off within the record is a rate walk as well: both have then the same likelihood.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from navcore.fitting.drift import Estimate, Posterior, blocks_of, posterior
from navcore.foundation.answers import Answer, Column, Table
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.foundation.units import DEG_PER_HOUR, DEG_PER_SQRT_HOUR, HOUR, MICRO_G
from navcore.sensors.recorded_imu import ImuRecord

SHORTEST_S = 120.0
_BLOCKS = 4000
_LONGEST_TAU = 0.5
_AT_END = 0.8
"""Share of the longest correlation time beyond which the drift does not level off within the record."""
_ALLAN_SAMPLES = 100_000
_FEWEST_PAIRS = 9
"""Averages within the record at the longest averaging time."""
_PARTS = 20
_UNEVEN = 2.0
"""A stretch with so many times the median noise of all stretches is a disturbance."""
AXES = "x", "y", "z"


@dataclass(frozen=True)
class AxisFit:
    """Noise of one axis, SI.

    Attributes
    ----------
    white : Estimate
        Square root of the spectral density: standard deviation of the integral after 1 s.
    instability, tau_s : Estimate
        Standard deviation and correlation time of a Gauss-Markov drift.
    walk : Estimate
        Rate walk: growth of the drift in the square root of a second; 0 where it levels off in the record.
    """

    white: Estimate
    instability: Estimate
    tau_s: Estimate
    walk: Estimate


@dataclass(frozen=True, eq=False)
class Allan:
    """Overlapping Allan deviation of one axis.

    Attributes
    ----------
    tau_s, deviation, low, high : ndarray, shape (m,)
        Averaging times, the deviation (SI), and the ends of its 95 % interval.
    """

    tau_s: np.ndarray
    deviation: np.ndarray
    low: np.ndarray
    high: np.ndarray


@dataclass(frozen=True, eq=False)
class FittedImu(Answer):
    """Noise of a standing IMU.

    Attributes
    ----------
    source : str
        Name of the file.
    rate_hz, span_s : float
        Of the record.
    gyro, accel : tuple of AxisFit
        Right, forward, up as the file's axes are called x, y, z.
    allan_gyro, allan_accel : tuple of Allan
        Of the same axes.
    disturbed_s : tuple of (float, float)
        Stretches in which the IMU was moved or shaken.
    """

    source: str
    rate_hz: float
    span_s: float
    gyro: tuple[AxisFit, ...]
    accel: tuple[AxisFit, ...]
    allan_gyro: tuple[Allan, ...]
    allan_accel: tuple[Allan, ...]
    disturbed_s: tuple[tuple[float, float], ...] = ()

    def document(self) -> dict[str, Any]:
        """Return the document of interface.md."""
        fitted = {
            name: [getattr(axis, what).document(unit) for axis in getattr(self, sensor)]
            for name, sensor, what, unit in _FIELDS
        }
        allan = {
            name: [
                {key: list(getattr(axis, key) / unit) for key in ("deviation", "low", "high")}
                for axis in getattr(self, f"allan_{sensor}")
            ]
            for name, sensor, unit in (("gyro_dph", "gyro", DEG_PER_HOUR), ("accel_ug", "accel", MICRO_G))
        }
        return {
            "imu": fitted,
            "allan": {"tau_s": list(self.allan_gyro[0].tau_s), **allan},
            "rate_hz": self.rate_hz,
            "span_s": self.span_s,
            "disturbed_s": [list(one) for one in self.disturbed_s],
            "source": self.source,
        }

    def rows(self) -> Iterator[Table | str]:
        """Give a table a sensor, and what stands in the way of a standing record."""
        yield Text(
            "{source}: {span_s:.0f} s at {rate_hz:.6g} Hz; 95 % intervals",
            source=self.source,
            span_s=self.span_s,
            rate_hz=self.rate_hz,
        )
        heads = (Column(""), Column("x", left=True), Column("y", left=True), Column("z", left=True))
        cells = []
        for name, sensor, what, unit in _FIELDS:
            values = (getattr(axis, what).scaled(1.0 / unit) for axis in getattr(self, sensor))
            cells.append((name, *(_cell(value) for value in values)))
        yield Table(heads, tuple(cells))
        for begin, end in self.disturbed_s:
            yield Text(
                "disturbed from {begin:.0f} to {end:.0f} s: cut the record to the time at rest",
                begin=begin,
                end=end,
            )

    def blocks(self) -> dict[str, Any]:
        """Return the block ``imu`` of a scenario: of each sensor the root mean square of its axes."""
        found = {}
        for name, sensor, what, unit in _FIELDS:
            if what == "walk":
                continue
            values = np.array([getattr(axis, what).value / unit for axis in getattr(self, sensor)])
            mean = np.median(values) if what == "tau_s" else np.sqrt(np.mean(values**2))
            found[name] = float(f"{mean:.4g}")
        return {"imu": found}


_FIELDS = (
    ("gyro_arw_dpsh", "gyro", "white", DEG_PER_SQRT_HOUR),
    ("gyro_instability_dph", "gyro", "instability", DEG_PER_HOUR),
    ("gyro_tau_s", "gyro", "tau_s", 1.0),
    ("gyro_rate_walk_dphph", "gyro", "walk", DEG_PER_HOUR / HOUR**0.5),
    ("accel_vrw_ugpshz", "accel", "white", MICRO_G),
    ("accel_instability_ug", "accel", "instability", MICRO_G),
    ("accel_tau_s", "accel", "tau_s", 1.0),
    ("accel_walk_ugpsh", "accel", "walk", MICRO_G / HOUR**0.5),
)
"""Name, sensor, what of an axis, and size of the unit."""


def fit_imu(record: ImuRecord) -> FittedImu:
    """Fit the noise of an IMU that rests.

    Parameters
    ----------
    record : ImuRecord
        Of a vehicle at rest.

    Raises
    ------
    InputError
        The record is shorter than two minutes.
    """
    if record.duration_s < SHORTEST_S:
        allowed = Text(
            "lasts {span:.0f} s; a fit of its noise needs {least:.0f} s at rest",
            span=record.duration_s,
            least=SHORTEST_S,
        )
        raise InputError(Fault(record.source, "", None, allowed))
    rates = record.increments * record.rate_hz
    fits = [_axis(rates[:, i], record.rate_hz) for i in range(6)]
    curves = [allan_deviation(rates[:, i], record.rate_hz) for i in range(6)]
    return FittedImu(
        source=record.source,
        rate_hz=record.rate_hz,
        span_s=record.duration_s,
        gyro=tuple(fits[:3]),
        accel=tuple(fits[3:]),
        allan_gyro=tuple(curves[:3]),
        allan_accel=tuple(curves[3:]),
        disturbed_s=_disturbed(rates, record.rate_hz),
    )


def _axis(rates: np.ndarray, rate_hz: float) -> AxisFit:
    time_s = np.arange(rates.size) / rate_hz
    span_s = rates.size / rate_hz
    length_s = max(1.0 / rate_hz, round(rates.size / _BLOCKS) / rate_hz)
    size = float(np.std(rates)) or 1.0
    values = ((rates - rates.mean()) / size)[:, None]
    blocks = blocks_of(time_s, values, np.ones((rates.size, 1, 1)), np.array([100.0]), length_s)
    longest_s = _LONGEST_TAU * span_s
    found = posterior(blocks, (4.0 * length_s, longest_s))
    return AxisFit(
        white=found.white.scaled(size / rate_hz**0.5),
        instability=found.drift.scaled(size),
        tau_s=found.tau_s,
        walk=_walk(found, longest_s).scaled(size),
    )


def _walk(found: Posterior, longest_s: float) -> Estimate:
    """Rate walk of a drift that does not level off within the record."""
    if found.drift.value == 0.0 or found.tau_s.high < _AT_END * longest_s:
        return Estimate(0.0, 0.0, found.growth.high)
    return found.growth


def allan_deviation(rates: np.ndarray, rate_hz: float) -> Allan:
    """Overlapping Allan deviation at averaging times that double.

    Parameters
    ----------
    rates : ndarray, shape (n,)
        Readings, SI.
    rate_hz : float
        Readings a second.
    """
    from scipy.stats import chi2

    several = max(1, rates.size // _ALLAN_SAMPLES)
    means = rates[: rates.size // several * several].reshape(-1, several).mean(axis=1)
    step_s = several / rate_hz
    most = means.size // (_FEWEST_PAIRS + 1)
    factors = 2 ** np.arange(int(np.log2(max(most, 1))) + 1)
    phase = step_s * np.concatenate([[0.0], np.cumsum(means - means.mean())])
    pairs = [phase[2 * m :] - 2.0 * phase[m:-m] + phase[: -2 * m] for m in factors]
    tau_s = step_s * factors
    deviation = np.array([np.sqrt(0.5 * np.mean(pair**2)) for pair in pairs]) / tau_s
    n, m = float(phase.size), factors.astype(float)
    freedom = (1.5 * (n - 1.0) / m - 2.0 * (n - 2.0) / n) * 4.0 * m**2 / (4.0 * m**2 + 5.0)
    low, high = (deviation * np.sqrt(freedom / chi2.ppf(share, freedom)) for share in (0.975, 0.025))
    return Allan(tau_s, deviation, low, high)


def _disturbed(rates: np.ndarray, rate_hz: float) -> tuple[tuple[float, float], ...]:
    """Stretches whose noise over a second is far above that of the others, s."""
    several = max(1, round(rate_hz))
    means = rates[: len(rates) // several * several].reshape(-1, several, 6).mean(axis=1)
    parts = np.array_split(np.abs(np.diff(means, axis=0)), _PARTS)
    noise = np.array([part.mean(axis=0) for part in parts])
    bad = np.any(noise > _UNEVEN * np.median(noise, axis=0), axis=1)
    edges = np.cumsum([0, *map(len, parts)]) * (several / rate_hz)
    found: list[tuple[float, float]] = []
    for place in np.flatnonzero(bad):
        begin, end = float(edges[place]), float(edges[place + 1])
        if found and found[-1][1] == begin:
            found[-1] = found[-1][0], end
        else:
            found.append((begin, end))
    return tuple(found)


def _cell(value: Estimate) -> str:
    return f"{value.value:.4g} [{value.low:.4g}, {value.high:.4g}]"

"""Error of a recorded log against a recorded track, by maximum likelihood.

The error is taken along the ship's axes. What is fitted: the clock of the log, its bias and scale, the
current and the tidal stream (of a speed through the water), the white noise of a sample and a first-order
Gauss-Markov drift. The track has noise of its own. It is part of the difference of both, and it would draw
the scale down (regression on a noisy regressor): the scale is told by the smoothed speed of the track, and
the noise of the log by what its changes share with those of the difference.
"""

from dataclasses import dataclass

import numpy as np

from navcore.fitting.along_track import LogAlongTrack
from navcore.fitting.drift import (
    NINETY_FIVE,
    Blocks,
    Estimate,
    Posterior,
    around,
    blocks_of,
    coefficients_at,
    posterior,
)
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.foundation.units import HOUR
from navcore.io.agreement import M2_S
from navcore.io.clocks import lag_between
from navcore.io.series import rate_of
from navcore.sensors.true_state import horizontal_state, to_ship

FEWEST_SAMPLES = 50
K1_S = 23.9345 * HOUR
"""Period of the luni-solar diurnal tide."""
_BLOCKS_A_TAU = 10.0
_FEWEST_BLOCKS, _MOST_BLOCKS = 200, 20_000
_SMOOTHED_S = 150.0
"""Time over which the speed of the track is smoothed where it tells the scale."""
_CHANGE_S = 20.0
"""Time over which its rate of change, which tells the clock, is smoothed: the track has noise."""
_LEAST_TURN = 0.1
"""Standard deviation of the heading's sine and cosine from which a current can be told from a bias."""
_LEAST_TIDE = 0.4
"""Share of a tide's period that a record must cover."""
_LONG_TIDE = 1.1
_LEAST_CHANGE_MPS = 0.2
"""Change of the speed (rms) from which there is a scale and a clock to be told."""
_SPEEDS = 1.5
_SCALE, _CLOCK_S = 0.2, 30.0
"""What is known of coefficients beforehand, as standard deviations."""
_CLOCK_ROUNDS = 4
_LONGEST_TAU = 0.5


@dataclass(frozen=True)
class Tide:
    """A tidal stream, E and N.

    Attributes
    ----------
    period_s : float
        Its period.
    sine, cosine : tuple of Estimate
        Amplitudes of sin and cos of 2 pi t / period, east and north, m/s; t from the start of the record.
    """

    period_s: float
    sine: tuple[Estimate, Estimate]
    cosine: tuple[Estimate, Estimate]


@dataclass(frozen=True)
class LogErrorFit:
    """Model of a log's error along its axes, each value with its 95 % interval.

    Attributes
    ----------
    bias : tuple of Estimate
        Starboard, forward, m/s.
    noise : Estimate
        Standard deviation of the white noise of one sample, per axis, m/s.
    drift, drift_tau_s : Estimate
        Standard deviation (m/s, per axis) and correlation time (s) of the drift. It is sought up to half of
        the span; what is slower cannot be told from a bias.
    scale : Estimate or None
        Scale error; None where the ship changes its speed too little to tell one.
    delay_s : Estimate or None
        Time by which the log is late, s, negative for an early one; None where the ship moves too evenly.
    current : tuple of Estimate or None
        East, north, m/s; None over ground, and where the ship keeps its heading: the bias includes it.
    tides : tuple of Tide
        Tidal streams, of a record that is long enough.
    rate_hz, span_s : float
        Rate without gaps, and length of the record.
    one_axis : bool
        The log measures the speed forward alone.
    """

    bias: tuple[Estimate, Estimate]
    noise: Estimate
    drift: Estimate
    drift_tau_s: Estimate
    scale: Estimate | None
    delay_s: Estimate | None
    current: tuple[Estimate, Estimate] | None
    tides: tuple[Tide, ...]
    rate_hz: float
    span_s: float
    one_axis: bool = False

    @property
    def late_s(self) -> float:
        """Time by which the log is late, s; 0 where it cannot be told."""
        return 0.0 if self.delay_s is None else self.delay_s.value


def fit_log(log: LogAlongTrack, *, through_water: bool) -> LogErrorFit:
    """Fit clock, bias, scale, current, tide, noise and drift of a log.

    Parameters
    ----------
    log : LogAlongTrack
        The log beside the track.
    through_water : bool
        Whether it measures the speed through the water, so that current and tide are part of its error.

    Raises
    ------
    InputError
        Fewer than 50 samples.
    """
    if log.time_s.size < FEWEST_SAMPLES:
        raise _too_short(log.time_s.size)
    moving = not log.truth.constant
    velocity, heading = horizontal_state(log.truth, log.time_s)
    one_axis = not np.any(log.reading[:, 0])
    told = _Told(
        axes=(1,) if one_axis else (0, 1),
        moving=moving and bool(np.std(to_ship(velocity, heading), axis=0).max() > _LEAST_CHANGE_MPS),
        water=through_water and moving and _turns(heading),
        tides=_tides(float(np.ptp(log.time_s))) if through_water and moving and _turns(heading) else (),
    )
    late_s = _rough_clock(log) if told.moving else 0.0
    rows = _rows(log, told, late_s)
    length_s, taus_s = _lengths(rows)
    blocks = rows.blocks(length_s)
    found = posterior(blocks, taus_s)
    if told.moving:
        for _ in range(_CLOCK_ROUNDS):
            mean, deviation = coefficients_at(blocks, *found.at)
            step = float(mean[rows.clock])
            late_s += step
            rows = _rows(log, told, late_s, float(mean[rows.scale]))
            blocks = rows.blocks(length_s)
            if abs(step) < 0.1 * deviation[rows.clock]:
                break
        found = posterior(blocks, taus_s, found.at)
    return _fit(log, told, rows, found, late_s)


@dataclass(frozen=True)
class _Told:
    """What a record can tell: measured axes, speeds that change, a current, tides by their periods."""

    axes: tuple[int, ...]
    moving: bool
    water: bool
    tides: tuple[float, ...]


@dataclass(frozen=True, eq=False)
class _Rows:
    """Samples of the regression, and where its coefficients stand; -1 for one that is not fitted."""

    time_s: np.ndarray
    error: np.ndarray
    design: np.ndarray
    prior: np.ndarray
    bias: int
    scale: int
    clock: int
    water: int

    def blocks(self, length_s: float) -> Blocks:
        """Means over blocks."""
        return blocks_of(self.time_s, self.error, self.design, self.prior, length_s)


def _rows(log: LogAlongTrack, told: _Told, late_s: float, scale: float = 0.0) -> _Rows:
    """Error of the log and its regressors.

    The scale acts on the smoothed speed. What that leaves out of the speed is taken off the error by the
    scale that was found before.
    """
    time_s, error = log.error(late_s)
    axes = list(told.axes)
    columns = [np.tile(unit, (time_s.size, 1)) for unit in np.eye(len(axes))]
    prior = [_SPEEDS] * len(axes)
    at_scale = at_clock = at_water = -1
    if told.moving:
        speed, smooth, change = _speeds(log, time_s, late_s)
        error = error - scale * (speed - smooth)
        at_scale, at_clock = len(columns), len(columns) + 1
        columns += [smooth[:, axes], -change[:, axes]]
        prior += [_SCALE, _CLOCK_S]
    if told.water:
        at_water = len(columns)
        _, heading = horizontal_state(log.truth, time_s - late_s)
        waves = [np.ones(time_s.size)]
        for period in told.tides:
            phase = 2.0 * np.pi * (time_s - late_s) / period
            waves += [np.sin(phase), np.cos(phase)]
        along = [to_ship(np.tile(unit, (time_s.size, 1)), heading)[:, axes] for unit in np.eye(2)]
        columns += [-wave[:, None] * axis for wave in waves for axis in along]
        prior += [_SPEEDS] * (2 * len(waves))
    design = np.stack(columns, axis=2)
    return _Rows(time_s, error[:, axes], design, np.array(prior), 0, at_scale, at_clock, at_water)


def _speeds(
    log: LogAlongTrack, time_s: np.ndarray, late_s: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Speed along the ship's axes, smoothed, and its rate of change, each (n, 2)."""
    from scipy.ndimage import uniform_filter1d

    step_s = log.truth.step_s
    grid = np.arange(len(log.truth.values)) * step_s
    whole = to_ship(*horizontal_state(log.truth, grid))

    def smoothed(values: np.ndarray, over_s: float) -> np.ndarray:
        return uniform_filter1d(values, 2 * int(0.5 * over_s / step_s) + 1, axis=0, mode="nearest")

    smooth = smoothed(whole, _SMOOTHED_S)
    change = smoothed(np.gradient(whole, step_s, axis=0), _CHANGE_S)
    at = time_s - late_s
    speed, *others = (
        np.column_stack([np.interp(at, grid, column) for column in values.T])
        for values in (whole, smooth, change)
    )
    return speed, others[0], others[1]


def _rough_clock(log: LogAlongTrack) -> float:
    """Lag of the speed forward by its fast changes, s; 0 where they show none."""
    grid = np.arange(len(log.truth.values)) * log.truth.step_s
    velocity, heading = horizontal_state(log.truth, grid)
    regressors = np.column_stack([to_ship(velocity, heading)[:, 1], np.sin(heading), np.cos(heading)])
    lag = lag_between(log.time_s, log.reading[:, 1], grid, regressors)
    return lag.late_s if lag is not None and lag.related else 0.0


def _lengths(rows: _Rows) -> tuple[float, tuple[float, float]]:
    """Length of a block, and the range of the drift's correlation time, s.

    The blocks are short beside the correlation time of what least squares leave.
    """
    interval_s, span_s = 1.0 / rate_of(rows.time_s), float(np.ptp(rows.time_s))
    shortest, longest = max(span_s / _MOST_BLOCKS, interval_s), max(span_s / _FEWEST_BLOCKS, interval_s)
    length_s = longest
    while length_s > shortest:
        tau_s = _left_tau(rows.blocks(length_s))
        if tau_s > 0.5 * _BLOCKS_A_TAU * length_s:
            length_s = min(length_s, tau_s / _BLOCKS_A_TAU)
            break
        length_s *= 0.5
    length_s = max(length_s, shortest)
    return length_s, (2.0 * length_s, max(_LONGEST_TAU * span_s, 8.0 * length_s))


def _left_tau(blocks: Blocks) -> float:
    """Correlation time of what ordinary least squares leave, s, by the ratio of its first covariances."""
    kept = blocks.count > 0
    design = blocks.design[kept].reshape(-1, blocks.design.shape[2])
    values = blocks.values[kept]
    size = np.linalg.norm(design, axis=0) + 1e-30
    found, *_ = np.linalg.lstsq(design / size, values.ravel(), rcond=None)
    left = values - (design / size @ found).reshape(values.shape)
    lags = np.array([np.mean(left[:-k] * left[k:]) for k in range(1, min(40, len(left) - 1))])
    if lags.size < 2 or lags[0] <= 0.0:
        return 0.0
    below = np.flatnonzero(lags < lags[0] / np.e)
    return float(below[0] if below.size else lags.size) * blocks.length_s


def _fit(log: LogAlongTrack, told: _Told, rows: _Rows, found: Posterior, late_s: float) -> LogErrorFit:
    def estimate(place: int) -> Estimate:
        return around(float(found.coefficients[place]), float(found.deviations[place]))

    def pair(place: int) -> tuple[Estimate, Estimate]:
        return estimate(place), estimate(place + 1)

    bias = [Estimate(0.0, -np.inf, np.inf)] * 2
    for place, axis in enumerate(told.axes):
        bias[axis] = estimate(place)
    clock = None
    if told.moving:
        left = estimate(rows.clock)
        clock = Estimate(*(late_s + value for value in left))
        clock = clock if found.deviations[rows.clock] < 0.5 * _CLOCK_S else None
    scale = estimate(rows.scale) if told.moving else None
    if scale is not None and found.deviations[rows.scale] > 0.5 * _SCALE:
        scale = None
    tides = tuple(
        Tide(period, pair(rows.water + 2 + 4 * i), pair(rows.water + 4 + 4 * i))
        for i, period in enumerate(told.tides)
    )
    rate_hz = rate_of(log.time_s)
    return LogErrorFit(
        bias=(bias[0], bias[1]),
        noise=_noise(log, told, late_s, found, rate_hz),
        drift=found.drift,
        drift_tau_s=found.tau_s,
        scale=scale,
        delay_s=clock,
        current=pair(rows.water) if told.water else None,
        tides=tides,
        rate_hz=rate_hz,
        span_s=float(np.ptp(log.time_s)),
        one_axis=len(told.axes) == 1,
    )


def _noise(log: LogAlongTrack, told: _Told, late_s: float, found: Posterior, rate_hz: float) -> Estimate:
    """White noise of a sample of the log: what its changes share with those of the error.

    The noise of the track is in the error, but not in the reading. The drift's part is taken off, though not
    at the upper end: a drift that is smoother than a Gauss-Markov one has none. The rest of the interval is
    by the spread of the products over pieces of the record.
    """
    axes = list(told.axes)
    error = log.error(late_s)[1][:, axes]
    reading = log.reading[log.known(late_s)][:, axes]
    products = 0.5 * np.mean(np.diff(reading, axis=0) * np.diff(error, axis=0), axis=1)
    of_drift = found.drift.value**2 * -np.expm1(-1.0 / (rate_hz * found.tau_s.value))
    pieces = np.array([piece.mean() for piece in np.array_split(products, min(50, products.size // 4))])
    variance = float(products.mean()) - of_drift
    spread = float(pieces.std(ddof=1) / np.sqrt(pieces.size))
    ends = variance - NINETY_FIVE * spread, variance + NINETY_FIVE * spread + of_drift
    return Estimate(*(float(np.sqrt(max(value, 0.0))) for value in (variance, *ends)))


def _turns(heading: np.ndarray) -> bool:
    return bool(np.std(np.sin(heading)) + np.std(np.cos(heading)) > _LEAST_TURN)


def _tides(span_s: float) -> tuple[float, ...]:
    long = span_s > _LONG_TIDE * K1_S
    return ((M2_S,) if span_s > _LEAST_TIDE * M2_S else ()) + ((K1_S,) if long else ())


def _too_short(samples: int) -> InputError:
    return InputError(
        Fault(
            "",
            "reference.file",
            None,
            Text(
                "{samples} samples of the log; a fit needs {fewest_samples}",
                samples=samples,
                fewest_samples=FEWEST_SAMPLES,
            ),
        )
    )

"""Error of a recorded log against a recorded track, and the simulated log that behaves like it.

The error is taken along the ship's axes. Its model is that of `navcore.sensors.reference`: a delay, a
constant bias, white noise and a first-order Gauss-Markov drift. Bias is the mean; noise and drift come from
the autocovariance C(k) = drift^2 exp(-k T / tau), whose value at lag 0 exceeds the curve by noise^2 (Gelb,
Applied Optimal Estimation, 1974, ch. 2.2). Both axes are fitted together.
"""

from dataclasses import dataclass

import numpy as np

from navcore.foundation.earth import WGS84
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.io.series import rate_of
from navcore.motion.track import TrackMotion
from navcore.motion.truth import Site, Truth
from navcore.sensors.log_files import log_recording, log_series
from navcore.sensors.recorded import recorded_window
from navcore.sensors.reference import Reference
from navcore.sensors.true_state import horizontal_state, to_ship

FEWEST_SAMPLES = 50
LONGEST_LAG_SHARE = 0.1
"""Lags up to this share of the record are fitted: the autocovariance of longer ones is mostly chance."""
_GRID_STEP_S = 0.5
_TAU_STEPS = 400


@dataclass(frozen=True)
class LogErrorFit:
    """Model of a log's error along its axes.

    Attributes
    ----------
    bias : ndarray, shape (2,)
        Starboard, forward, m/s.
    bias_std : ndarray, shape (2,)
        Uncertainty of the bias for the fitted drift and the span, m/s.
    noise : float
        Standard deviation of the white noise of one sample, per axis, m/s.
    drift, drift_tau_s : float
        Standard deviation (m/s, per axis) and correlation time (s) of the drift. It is sought up to a tenth
        of the span; what is slower cannot be told from a bias.
    delay_s : float
        Delay that was taken out before the fit, s.
    rate_hz, span_s : float
        Rate, as a count over the time without gaps, and length of the record.
    """

    bias: np.ndarray
    bias_std: np.ndarray
    noise: float
    drift: float
    drift_tau_s: float
    delay_s: float
    rate_hz: float
    span_s: float

    def reference(self) -> Reference:
        """Simulated log with this error, rounded to what the fit can tell (mm/s, 0.1 s)."""
        return Reference(
            kind="log",
            frame="body",
            bias_mps=(round(float(self.bias[0]), 3), round(float(self.bias[1]), 3)),
            noise_mps=round(self.noise, 3),
            drift_mps=round(self.drift, 3),
            drift_tau_s=round(self.drift_tau_s, 1),
            delay_s=round(self.delay_s, 1),
            rate_hz=round(self.rate_hz, 3),
        )


@dataclass(frozen=True)
class LogAlongTrack:
    """A recorded log and the true motion it belongs to.

    Attributes
    ----------
    time_s : ndarray, shape (m,)
        Epochs of the log after t = 0, those called valid by the log only.
    reading : ndarray, shape (m, 2)
        Starboard, forward speed, m/s.
    truth : Truth
        Motion over the time that log and track share.
    """

    time_s: np.ndarray
    reading: np.ndarray
    truth: Truth

    def error(self, delay_s: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
        """Times (n,), and reading minus true velocity along the ship's axes ``delay_s`` earlier (n, 2)."""
        known = self.time_s >= delay_s
        velocity, heading = horizontal_state(self.truth, self.time_s[known] - delay_s)
        return self.time_s[known], self.reading[known] - to_ship(velocity, heading)


def log_along_track(reference: Reference, track: TrackMotion) -> LogAlongTrack:
    """Put a recorded log beside the track recorded with it.

    Parameters
    ----------
    reference : Reference
        With ``kind = "file"``; its ``speed`` says which speed of the log is meant.
    track : TrackMotion
        Positions and heading of the same time.

    Raises
    ------
    InputError
        A file is missing or wrong, they share no time, or the log does not measure along the ship's axes.
    """
    series, along_axes = log_series(reference, log_recording(reference))
    window = recorded_window(track, reference)
    if not along_axes or window is None:
        allowed = Text("needs speeds along the ship's axes (VBW, VHW or speed columns)")
        raise InputError(Fault("", "reference.file", reference.file, allowed))
    count = int(window.span_s / _GRID_STEP_S) + 1
    truth = track.truth(count, _GRID_STEP_S, Site(0.0, 0.0, 0.0), WGS84, start_utc=window.start_s)
    elapsed = series.time_s - window.start_s
    within = series.valid & (elapsed >= 0.0) & (elapsed <= (count - 1) * _GRID_STEP_S)
    return LogAlongTrack(elapsed[within], series.values[within], truth)


def fit_delay(log: LogAlongTrack, longest_s: float = 60.0, step_s: float = 0.1) -> float:
    """Delay of the log that leaves the smallest variance of its error, s.

    Only a record with turns or changes of speed can show one. The same samples are compared for all delays.
    """
    delays = np.arange(0.0, longest_s + 0.5 * step_s, step_s)
    samples = int(np.count_nonzero(log.time_s >= longest_s))
    if samples < FEWEST_SAMPLES:
        raise _too_short(samples)
    variance = [np.var(log.error(delay)[1][-samples:], axis=0).sum() for delay in delays]
    return float(delays[int(np.argmin(variance))])


def fit_log_error(time_s: np.ndarray, error: np.ndarray, delay_s: float = 0.0) -> LogErrorFit:
    """Fit bias, white noise and Gauss-Markov drift.

    Parameters
    ----------
    time_s : ndarray, shape (n,)
        Epochs, s, about evenly spaced.
    error : ndarray, shape (n, 2)
        Error along two axes, m/s.
    delay_s : float
        Delay already taken out of the error; only noted.

    Raises
    ------
    InputError
        Fewer than 50 samples.
    """
    if time_s.size < FEWEST_SAMPLES:
        raise _too_short(time_s.size)
    rate_hz = rate_of(time_s)
    interval = 1.0 / rate_hz
    span = float(time_s[-1] - time_s[0])
    bias = error.mean(axis=0)
    lags = np.arange(max(int(LONGEST_LAG_SHARE * time_s.size), 10) + 1)
    covariance = _autocovariance(error - bias, lags.size).mean(axis=1)
    if covariance[0] == 0.0:
        return LogErrorFit(bias, np.zeros(2), 0.0, 0.0, span, delay_s, rate_hz, span)
    drift_variance, tau = _fit_decay(covariance, lags * interval)
    noise_variance = covariance[0] - drift_variance
    # The mean of a Gauss-Markov process over a span much longer than tau: variance 2 tau / span of its own.
    share = (noise_variance / time_s.size + drift_variance * 2.0 * tau / span) / covariance[0]
    return LogErrorFit(
        bias=bias,
        bias_std=error.std(axis=0) * np.sqrt(share),
        noise=float(np.sqrt(noise_variance)),
        drift=float(np.sqrt(drift_variance)),
        drift_tau_s=tau,
        delay_s=delay_s,
        rate_hz=rate_hz,
        span_s=span,
    )


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


def _autocovariance(centred: np.ndarray, lags: int) -> np.ndarray:
    """Mean products at lags 0, 1, ..., each over the pairs there are; shape (lags, 2)."""
    count = centred.shape[0]
    spectrum = np.fft.rfft(centred, 2 * count, axis=0)
    sums = np.fft.irfft(np.abs(spectrum) ** 2, 2 * count, axis=0)[:lags]
    return sums / (count - np.arange(lags))[:, None]


def _fit_decay(covariance: np.ndarray, lag_s: np.ndarray) -> tuple[float, float]:
    """Least-squares variance (0 to the whole) and time constant of variance exp(-lag / tau) beyond lag 0."""
    taus = np.geomspace(lag_s[1], lag_s[-1], _TAU_STEPS)
    curves = np.exp(-lag_s[1:] / taus[:, None])
    variances = np.clip(curves @ covariance[1:] / np.sum(curves**2, axis=1), 0.0, covariance[0])
    misfit = np.sum((covariance[1:] - variances[:, None] * curves) ** 2, axis=1)
    best = int(np.argmin(misfit))
    return float(variances[best]), float(taus[best])

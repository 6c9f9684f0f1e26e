"""The simulated log: truth with current, tide, scale error, bias, drift, noise, events, delay, resolution."""

from __future__ import annotations

import numpy as np

from navcore.foundation.units import DEG, HOUR, PPM
from navcore.motion.base import Truth
from navcore.sensors.base import ReferenceErrors
from navcore.sensors.noise import gauss_markov, unit_noise
from navcore.sensors.reference import Reference, event_velocity, in_service
from navcore.sensors.true_state import horizontal_state, to_navigation, to_ship

SHORTEST_HOLD_S = 5.0
"""A sample stands for three intervals of the log, and at least this long."""
_FINEST_LSB = 1e-9


def hold_time(interval_s: float) -> float:
    """Age beyond which a sample counts as missing, s: three intervals, at least 5 s."""
    return max(3.0 * interval_s, SHORTEST_HOLD_S)


def simulated_errors(
    reference: Reference, truth: Truth, duration_s: float, seed: int, step_s: float
) -> ReferenceErrors:
    """Errors of a simulated log at its epochs 0, 1/rate, ... <= duration.

    A log faster than the mechanization is read once a step, as the mean of that step's samples of V_r - V_c:
    noise is divided by the square root of their number. Rounding averages out when the noise is at least half
    the resolution (it then counts as white noise of lsb / sqrt 12 a sample) and not at all when it is less.

    Parameters
    ----------
    reference : Reference
        With ``kind = "log"``.
    truth : Truth
        True motion over the run.
    duration_s, step_s : float
        Length of the run and step of the mechanization, s.
    seed : int
        Seed of the run; its streams ``log.noise`` and ``log.drift`` are used.

    Returns
    -------
    ReferenceErrors
    """
    samples = max(1.0, reference.rate_hz * step_s)
    interval = samples / reference.rate_hz
    time_s = np.arange(int(duration_s / interval + 1e-9) + 1) * interval
    own, lsb = _own_errors(reference, time_s.size, seed, interval, samples)
    if reference.delay_s == 0.0 and lsb == 0.0:
        error = _linear_errors(reference, truth, time_s, own)
    else:
        error = _delayed_rounded_errors(reference, truth, time_s, own, lsb)
    if reference.event:
        error = error + event_velocity(reference.event, time_s)
    return ReferenceErrors(
        time_s=time_s,
        # A copy: one that may not be written to would make numba compile the kernels a second time.
        error=np.array(np.broadcast_to(error, (time_s.size, 2)), order="C"),
        valid=in_service(reference.outage, time_s),
        body_frame=reference.frame == "body",
        hold_s=hold_time(interval),
    )


def _linear_errors(reference: Reference, truth: Truth, time_s: np.ndarray, own: np.ndarray) -> np.ndarray:
    """Errors of a log without delay and rounding: the velocity itself cancels, and is often not needed."""
    scale = reference.scale_ppm * PPM
    error = -(1.0 + scale) * _water(reference, time_s)
    if scale == 0.0 and reference.frame == "enu":
        return error + own
    velocity, heading = horizontal_state(truth, time_s)
    return error + scale * velocity + (to_navigation(own, heading) if reference.frame == "body" else own)


def _delayed_rounded_errors(
    reference: Reference, truth: Truth, time_s: np.ndarray, own: np.ndarray, lsb: float
) -> np.ndarray:
    """Errors of readings of an earlier velocity, rounded; a body log turns them by the present heading."""
    measured_at = np.maximum(time_s - reference.delay_s, 0.0)
    velocity, heading = horizontal_state(truth, time_s)
    then_velocity, then_heading = horizontal_state(truth, measured_at)
    seen = (1.0 + reference.scale_ppm * PPM) * (then_velocity - _water(reference, measured_at))
    if reference.frame == "body":
        return to_navigation(_rounded(to_ship(seen, then_heading) + own, lsb), heading) - velocity
    return _rounded(seen + own, lsb) - velocity


def _water(reference: Reference, time_s: np.ndarray) -> np.ndarray:
    """Velocity of the water over the ground, E and N, m/s; shape (m, 2) or (1, 2)."""
    current = np.array([reference.current_mps])
    if not any(reference.tide_mps):
        return current
    angle = 2.0 * np.pi * time_s / (reference.tide_period_h * HOUR) + reference.tide_phase_deg * DEG
    return current + np.sin(angle)[:, None] * np.array(reference.tide_mps)


def _own_errors(
    reference: Reference, count: int, seed: int, interval_s: float, samples: float
) -> tuple[np.ndarray, float]:
    """Bias, drift and noise in the log's axes, shape (m, 2) or (1, 2), and the rounding that is left."""
    own = np.array([reference.bias_mps], dtype=float)
    noise, lsb = reference.noise_mps, reference.lsb_mps
    if samples > 1.0 and noise >= 0.5 * lsb:
        noise, lsb = np.hypot(noise, lsb / np.sqrt(12.0)), 0.0
    if noise > 0.0:
        own = own + noise / np.sqrt(samples) * unit_noise(seed, "log.noise", count, 2)
    if reference.drift_mps > 0.0:
        unit = unit_noise(seed, "log.drift", count, 2)
        own = own + reference.drift_mps * gauss_markov(
            unit, float(np.exp(-interval_s / reference.drift_tau_s))
        )
    return own, lsb


def _rounded(reading: np.ndarray, lsb: float) -> np.ndarray:
    return reading if lsb < _FINEST_LSB else np.round(reading / lsb) * lsb

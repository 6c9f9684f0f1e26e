"""The simulated log: the truth with all errors of its reading, its own errors, the water and events."""

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from navcore.motion.truth import Truth
from navcore.sensors.base import ReferenceErrors
from navcore.sensors.log_errors.base import LogPart
from navcore.sensors.noise import gauss_markov, unit_noise
from navcore.sensors.reference import Reference, in_service
from navcore.sensors.true_state import (
    heading_rate,
    horizontal_acceleration,
    horizontal_state,
    to_navigation,
    to_ship,
)

SHORTEST_HOLD_S = 5.0
"""A sample stands for three intervals of the log, and at least this long."""
_FINEST_LSB = 1e-9


def hold_time(interval_s: float) -> float:
    """Age beyond which a sample counts as missing, s: three intervals, at least 5 s."""
    return max(3.0 * interval_s, SHORTEST_HOLD_S)


def log_works(reference: Reference, truth: Truth, time_s: np.ndarray) -> np.ndarray:
    """Whether a simulated log gives anything at each time (m,): no outage, and fast enough through the water.

    Returns
    -------
    ndarray of bool, shape (m,)
    """
    works = in_service(reference.outage, time_s)
    if reference.min_speed_mps > 0.0:
        water = _Log(reference.all_parts(), False).water(time_s)
        through = horizontal_state(truth, time_s)[0] - water
        works &= np.hypot(through[:, 0], through[:, 1]) >= reference.min_speed_mps
    return works


def moored(reference: Reference, truth: Truth, time_s: np.ndarray) -> np.ndarray:
    """Whether the ship knows at each time (m,) that it lies still; ndarray of bool, shape (m,) or (1,)."""
    velocity = horizontal_state(truth, time_s)[0]
    return np.hypot(velocity[:, 0], velocity[:, 1]) < reference.zero_below_mps


def simulated_errors(
    reference: Reference,
    truth: Truth,
    duration_s: float,
    seed: int,
    step_s: float,
    parts: Iterable[LogPart] | None = None,
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
        Seed of the run; its streams ``log.noise`` (``log.white`` when smoothed) and ``log.drift`` are used.
    parts : iterable of LogPart, optional
        The errors; those of ``reference`` when left out.

    Returns
    -------
    ReferenceErrors
    """
    samples = max(1.0, reference.rate_hz * step_s)
    interval = samples / reference.rate_hz
    time_s = np.arange(int(duration_s / interval + 1e-9) + 1) * interval
    all_parts = reference.all_parts() if parts is None else parts
    log = _Log(tuple(part for part in all_parts if part.active), reference.frame == "body")
    own, lsb = log.own(time_s.size, interval, seed, samples)
    delay_s = sum(part.delay_s for part in log.parts)
    smoothing_s = sum(part.smoothing_s for part in log.parts)
    if delay_s == smoothing_s == lsb == 0.0:
        error = log.linear_errors(truth, time_s, own)
    else:
        error = log.delayed_rounded_errors(truth, time_s, own, delay_s, smoothing_s, lsb)
    error = sum((part.after(time_s) for part in log.parts if part.after), error)
    valid = log_works(reference, truth, time_s)
    still = np.zeros(0, dtype=bool)
    if reference.zero_below_mps > 0.0:
        still = np.array(np.broadcast_to(moored(reference, truth, time_s), time_s.size))
        error = np.where(still[:, None], -horizontal_state(truth, time_s)[0], error)
        valid |= still
    return ReferenceErrors(
        time_s=time_s,
        # A copy: one that may not be written to would make numba compile the kernels a second time.
        error=np.array(np.broadcast_to(error, (time_s.size, 2)), order="C"),
        valid=valid,
        body_frame=log.body_frame,
        hold_s=hold_time(interval),
        moored=still,
    )


@dataclass(frozen=True, eq=False)
class _Log:
    """The active parts of a log and its axes."""

    parts: tuple[LogPart, ...]
    body_frame: bool

    @property
    def scale(self) -> float:
        """Relative error of the measured velocity."""
        return sum(part.scale for part in self.parts)

    def by_motion(self, truth: Truth, time_s: np.ndarray) -> np.ndarray | float:
        """Errors by acceleration and in turns, E and N, m/s; shape (m, 2) or (1, 2), or 0."""
        seconds = sum(part.acceleration_s for part in self.parts)
        error = seconds * horizontal_acceleration(truth, time_s) if seconds else 0.0
        if seconds := sum(part.turn_s for part in self.parts):
            through = horizontal_state(truth, time_s)[0] - self.water(time_s)
            across = through[:, ::-1] * [1.0, -1.0]  # to starboard
            error = error + seconds * heading_rate(truth, time_s)[:, None] * across
        return error

    def water(self, time_s: np.ndarray) -> np.ndarray:
        """Velocity of the water over the ground, E and N, m/s; shape (m, 2) or (1, 2)."""
        return sum((part.water(time_s) for part in self.parts if part.water), np.zeros((1, 2)))

    def own(self, count: int, interval_s: float, seed: int, samples: float) -> tuple[np.ndarray, float]:
        """Errors in the log's axes, shape (m, 2) or (1, 2), and the rounding that is left."""
        noise = math.hypot(*(part.white for part in self.parts))
        lsb = sum(part.lsb for part in self.parts)
        if samples > 1.0 and noise >= 0.5 * lsb:
            noise, lsb = math.hypot(noise, lsb / math.sqrt(12.0)), 0.0
        own = sum((part.constant for part in self.parts), np.zeros((1, 2)))
        for part in self.parts:
            sigma, tau_s = part.markov
            if sigma > 0.0:
                unit = unit_noise(seed, part.source.replace("_", "."), count, 2)
                own = own + sigma * gauss_markov(unit, math.exp(-interval_s / tau_s))
        if noise > 0.0:
            unit = unit_noise(seed, "log.noise", count, 2)
            own = own + np.multiply(unit, noise / math.sqrt(samples), dtype=float)
        return own, lsb

    def linear_errors(self, truth: Truth, time_s: np.ndarray, own: np.ndarray) -> np.ndarray:
        """Errors without delay and rounding: the velocity itself cancels, and is often not needed."""
        error = self.by_motion(truth, time_s) - (1.0 + self.scale) * self.water(time_s)
        if self.scale == 0.0 and not self.body_frame:
            return error + own
        velocity, heading = horizontal_state(truth, time_s)
        return error + self.scale * velocity + (to_navigation(own, heading) if self.body_frame else own)

    def delayed_rounded_errors(
        self,
        truth: Truth,
        time_s: np.ndarray,
        own: np.ndarray,
        delay_s: float,
        smoothing_s: float,
        lsb: float,
    ) -> np.ndarray:
        """Errors of readings of an earlier velocity, smoothed and rounded, in the log's axes.

        A body log is turned by the present heading.
        """
        measured_at = np.maximum(time_s - delay_s, 0.0)
        velocity, heading = horizontal_state(truth, time_s)
        then_velocity, then_heading = horizontal_state(truth, measured_at)
        seen = (1.0 + self.scale) * (then_velocity - self.water(measured_at))
        seen = seen + self.by_motion(truth, measured_at)
        if self.body_frame:
            along_axes = _smoothed(to_ship(seen, then_heading), time_s, smoothing_s)
            return to_navigation(_rounded(along_axes + own, lsb), heading) - velocity
        return _rounded(_smoothed(seen, time_s, smoothing_s) + own, lsb) - velocity


def _smoothed(reading: np.ndarray, time_s: np.ndarray, tau_s: float) -> np.ndarray:
    """First-order filter, at rest on the first reading; exact for readings that are linear between epochs."""
    if tau_s == 0.0 or len(reading) < 2:
        return reading
    from scipy.signal import lfilter

    ratio = float(time_s[1] - time_s[0]) / tau_s
    decay = math.exp(-ratio)
    new = 1.0 + math.expm1(-ratio) / ratio
    earlier = 1.0 - decay - new
    return lfilter([new, earlier], [1.0, -decay], reading, axis=0, zi=(1.0 - new) * reading[:1])[0]


def _rounded(reading: np.ndarray, lsb: float) -> np.ndarray:
    return reading if lsb < _FINEST_LSB else np.round(reading / lsb) * lsb

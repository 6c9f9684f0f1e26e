"""The simulated log: the truth with all errors of its reading, its own errors, the water and events."""

import hashlib
import math
import weakref
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

import numpy as np

from navcore.foundation.compiled import kernel
from navcore.foundation.stage_cache import kept
from navcore.motion.truth import Truth
from navcore.sensors.base import ReferenceErrors
from navcore.sensors.log_errors.base import LogPart
from navcore.sensors.noise import gauss_markov, unit_noise
from navcore.sensors.reference import Reference, in_service
from navcore.sensors.rounding import DITHERED, mean_rounding
from navcore.sensors.true_state import (
    heading_rate,
    horizontal_acceleration,
    horizontal_state,
    to_ship,
    turned,
)

SHORTEST_HOLD_S = 5.0
"""A sample stands for three intervals of the log, and at least this long."""
_FINEST_LSB = 1e-9
_PATHS = 8
"""Paths of the drift along which the rounding of a log that drifts is followed."""


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
        through = _true_state(truth, time_s)[0] - water
        works &= np.hypot(through[:, 0], through[:, 1]) >= reference.min_speed_mps
    return works


def moored(reference: Reference, truth: Truth, time_s: np.ndarray) -> np.ndarray:
    """Whether the ship knows at each time (m,) that it lies still; ndarray of bool, shape (m,) or (1,)."""
    velocity = _true_state(truth, time_s)[0]
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
    given = None if parts is None else [parts]
    return simulated_side_by_side([reference], truth, duration_s, [seed], step_s, 1, given).alone()


def simulated_side_by_side(
    references: Sequence[Reference],
    truth: Truth,
    duration_s: float,
    seeds: Sequence[int],
    step_s: float,
    width: int,
    parts: Sequence[Iterable[LogPart]] | None = None,
) -> ReferenceErrors:
    """Errors of several simulated logs on one motion, as `simulated_errors`, with the logs as the last axis.

    Parameters
    ----------
    references, seeds, parts : sequence
        One a log. They differ in their constant errors and their seeds alone.
    truth, duration_s, step_s
        As of `simulated_errors`.
    width : int
        Size of the last axis. Places without a log repeat the first.

    Returns
    -------
    ReferenceErrors
        With errors of shape (m, 2, width).
    """
    reference = references[0]
    samples, interval, time_s = _epochs(reference, duration_s, step_s)
    each = [one.all_parts() for one in references] if parts is None else parts
    logs = [_active(reference, one) for one in each]
    log = logs[0]
    noise, lsb = log.noise(samples)
    # One layout and one type of number for every scenario: another is another kernel.
    own = np.ascontiguousarray(
        [
            np.broadcast_to(one.own(time_s.size, interval, seed, noise), (time_s.size, 2))
            for one, seed in zip(logs, seeds, strict=True)
        ]
    )
    key = "log readings", weakref.ref(truth), reference, duration_s, step_s
    make = partial(log.readings, truth, time_s, lsb)
    readings = kept(key, make) if parts is None else make()
    error = np.empty((time_s.size, 2, width))
    _read(readings.along_axes, own, float(lsb), readings.turn, readings.rest, error)
    for part in log.parts:
        if part.after:
            error += part.after(time_s)[:, :, None]
    valid = log_works(reference, truth, time_s)
    still = np.zeros(0, dtype=bool)
    if reference.zero_below_mps > 0.0:
        still = np.array(np.broadcast_to(moored(reference, truth, time_s), time_s.size))
        error = np.where(still[:, None, None], -_true_state(truth, time_s)[0][:, :, None], error)
        valid |= still
    return ReferenceErrors(
        time_s=time_s,
        error=error,
        valid=valid,
        body_frame=log.body_frame,
        hold_s=hold_time(interval),
        moored=still,
    )


@kernel
def _read(along_axes, own, lsb, turn, rest, error):
    """Errors (m, 2, width) of readings of logs whose ``own`` errors (logs, m, 2) are given.

    The others are those of `_Readings`: shapes (m, 2) or (1, 2), ``turn`` also (0, 2).
    """
    along_stride = 1 if along_axes.shape[0] > 1 else 0
    rest_stride = 1 if rest.shape[0] > 1 else 0
    turn_stride = 1 if turn.shape[0] > 1 else 0
    for i in range(error.shape[0]):
        a, r, c = i * along_stride, i * rest_stride, i * turn_stride
        for place in range(error.shape[2]):
            log = place if place < own.shape[0] else 0
            x, y = along_axes[a, 0] + own[log, i, 0], along_axes[a, 1] + own[log, i, 1]
            if lsb >= _FINEST_LSB:
                x, y = np.rint(x / lsb) * lsb, np.rint(y / lsb) * lsb
            if turn.shape[0] > 0:
                sine, cosine = turn[c, 0], turn[c, 1]
                x, y = x * cosine + y * sine, y * cosine - x * sine
            error[i, 0, place], error[i, 1, place] = x + rest[r, 0], y + rest[r, 1]


def mean_rounding_of(
    reference: Reference, truth: Truth, duration_s: float, step_s: float
) -> tuple[np.ndarray, list[np.ndarray]]:
    """Mean over the noise of the error that rounding adds to a simulated log's readings.

    Parameters
    ----------
    reference, truth, duration_s, step_s
        As of `simulated_errors`. Its other errors count as far as they are known numbers.

    Returns
    -------
    time_s : ndarray, shape (m,)
        Epochs of the log, s.
    errors : list of ndarray, shape (m, 2)
        E and N, m/s: none where noise averages rounding out. Of a log that drifts, one for each of several
        paths of its drift, over the square root of their number: their squares add up to a mean square.
    """
    samples, interval, time_s = _epochs(reference, duration_s, step_s)
    log = _active(reference, reference.all_parts())
    if samples > 1.0 and reference.dither >= DITHERED * log.lsb:
        return time_s, []
    sigma, errors = reference.dither / math.sqrt(samples), []
    readings = log.readings(truth, time_s, log.lsb)
    paths = _PATHS if any(part.markov[0] > 0.0 for part in log.parts) else 1
    for seed in range(paths):
        own = log.own(time_s.size, interval, seed, 0.0)
        error = mean_rounding(readings.along_axes + own, log.lsb, sigma) / math.sqrt(paths)
        error = turned(error, *readings.turn.T) if log.body_frame else error
        errors.append(np.broadcast_to(error, (time_s.size, 2)))
    return time_s, errors


def _epochs(reference: Reference, duration_s: float, step_s: float) -> tuple[float, float, np.ndarray]:
    """Samples of the log in one reading, the interval of the readings, s, and their times (m,), s."""
    samples = max(1.0, reference.rate_hz * step_s)
    interval = samples / reference.rate_hz
    return samples, interval, np.arange(int(duration_s / interval + 1e-9) + 1) * interval


def _active(reference: Reference, parts: Iterable[LogPart]) -> "_Log":
    return _Log(tuple(part for part in parts if part.active), reference.frame == "body")


@dataclass(frozen=True, eq=False)
class _Log:
    """The active parts of a log and its axes."""

    parts: tuple[LogPart, ...]
    body_frame: bool

    @property
    def scale(self) -> float:
        """Relative error of the measured velocity."""
        return sum(part.scale for part in self.parts)

    @property
    def delay_s(self) -> float:
        """Age of what is read, s."""
        return sum(part.delay_s for part in self.parts)

    @property
    def smoothing_s(self) -> float:
        """Time constant of the smoothing, s."""
        return sum(part.smoothing_s for part in self.parts)

    @property
    def lsb(self) -> float:
        """Resolution of the readings, m/s."""
        return sum(part.lsb for part in self.parts)

    def by_motion(self, truth: Truth, time_s: np.ndarray) -> np.ndarray | float:
        """Errors by acceleration and in turns, E and N, m/s; shape (m, 2) or (1, 2), or 0."""
        seconds = sum(part.acceleration_s for part in self.parts)
        error = seconds * horizontal_acceleration(truth, time_s) if seconds else 0.0
        if seconds := sum(part.turn_s for part in self.parts):
            through = _true_state(truth, time_s)[0] - self.water(time_s)
            across = through[:, ::-1] * [1.0, -1.0]  # to starboard
            error = error + seconds * heading_rate(truth, time_s)[:, None] * across
        return error

    def water(self, time_s: np.ndarray) -> np.ndarray:
        """Velocity of the water over the ground, E and N, m/s; shape (m, 2) or (1, 2)."""
        return sum((part.water(time_s) for part in self.parts if part.water), np.zeros((1, 2)))

    def noise(self, samples: float) -> tuple[float, float]:
        """Standard deviation of the noise of a reading of several samples, and the rounding that is left."""
        noise, lsb = math.hypot(*(part.white for part in self.parts)), self.lsb
        if samples > 1.0 and noise >= DITHERED * lsb:
            noise, lsb = math.hypot(noise, lsb / math.sqrt(12.0)), 0.0
        return noise / math.sqrt(samples), lsb

    def own(self, count: int, interval_s: float, seed: int, noise: float) -> np.ndarray:
        """Errors in the log's axes, shape (m, 2) or (1, 2), with noise of a standard deviation."""
        own = sum((part.constant for part in self.parts), np.zeros((1, 2)))
        for part in self.parts:
            sigma, tau_s = part.markov
            if sigma > 0.0:
                unit = unit_noise(seed, part.source.replace("_", "."), count, 2)
                own = own + sigma * gauss_markov(unit, math.exp(-interval_s / tau_s))
        if noise > 0.0:
            unit = unit_noise(seed, "log.noise", count, 2)
            white = np.multiply(unit, noise, dtype=float)
            own = np.add(white, own, out=white)
        return own

    def readings(self, truth: Truth, time_s: np.ndarray, lsb: float) -> "_Readings":
        """Readings to which any seed adds the log's own errors.

        Without delay, smoothing and rounding the velocity itself cancels, and is often not needed.
        """
        turn = np.empty((0, 2))
        if self.body_frame:
            heading = _true_state(truth, time_s)[1]
            turn = np.column_stack([np.sin(heading), np.cos(heading)])
        if self.delay_s == self.smoothing_s == lsb == 0.0:
            rest = self.by_motion(truth, time_s) - (1.0 + self.scale) * self.water(time_s)
            if self.scale != 0.0:
                rest = rest + self.scale * _true_state(truth, time_s)[0]
            return _Readings(np.zeros((1, 2)), turn, np.ascontiguousarray(rest))
        measured_at = np.maximum(time_s - self.delay_s, 0.0)
        then_velocity, then_heading = _true_state(truth, measured_at)
        seen = (1.0 + self.scale) * (then_velocity - self.water(measured_at))
        seen = seen + self.by_motion(truth, measured_at)
        along_axes = to_ship(seen, then_heading) if self.body_frame else seen
        along_axes = np.ascontiguousarray(_smoothed(along_axes, time_s, self.smoothing_s))
        return _Readings(along_axes, turn, np.ascontiguousarray(-_true_state(truth, time_s)[0]))


class _Readings(NamedTuple):
    """Parts of the errors of a reading: turned by ``turn``, with the log's own errors, plus the rest.

    ``along_axes``: the reading in the log's axes, m/s, as far as it does not cancel. ``turn``: sine and
    cosine of the present heading, one row a time, none of a log in E and N. ``rest``: E and N, m/s.
    """

    along_axes: np.ndarray
    turn: np.ndarray
    rest: np.ndarray


def _true_state(truth: Truth, time_s: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Take `horizontal_state` from the cache if it is there: the log of another seed needs the same."""
    if truth.constant:
        return horizontal_state(truth, time_s)
    times = hashlib.blake2b(np.ascontiguousarray(time_s).data, digest_size=16).digest()
    return kept(("true state", weakref.ref(truth), times), lambda: horizontal_state(truth, time_s))


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

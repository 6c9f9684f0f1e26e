"""The floor along a scenario's motion: the Kalman filter's own covariance (theory.md 16).

One call of the filter (update with the log, then a step of the undamped error model) is a Riccati map
P -> C + A (I + P J)^-1 P A^T. Such maps compose into one of the same form, so that an interval of many calls
is found by doubling, like the matrices of the damped methods. Biases are states without drive.

What the filter is not told of here (scale factors, current, tide, events) only adds to every method's error:
what is found remains a bound from below.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from navcore.analysis.transfers import RADIUS
from navcore.design.course import Course, log_axes
from navcore.design.maps import ERRORS, calls_joined, error_step
from navcore.mechanization.trajectory import named
from navcore.quantities import COMPONENTS
from navcore.scenario.model import Scenario
from navcore.scenario.start import aligned_errors, independent_errors
from navcore.scenario.stochastic import StochasticModel

_LEAST_NOISE = 1e-5
"""Standard deviation of a sample that counts as free of noise, m/s: the equation needs some."""
_STATES = np.array([4, 5, 6, 0, 1, 2, 3])


@dataclass(frozen=True, eq=False)
class RiccatiMap:
    """P -> C + A (I + P J)^-1 P A^T, stacked.

    Attributes
    ----------
    A, C, J : ndarray, shape (g, n, n)
    """

    A: np.ndarray
    C: np.ndarray
    J: np.ndarray

    def then(self, later: RiccatiMap) -> RiccatiMap:
        """Return this map followed by another."""
        both = np.linalg.solve(
            np.eye(self.A.shape[-1]) + self.C @ later.J, np.concatenate([self.A, self.C], axis=-1)
        )
        n = self.A.shape[-1]
        passed, left = both[..., :n], both[..., n:]
        C = later.C + later.A @ left @ later.A.mT
        J = self.J + self.A.mT @ later.J @ passed
        return RiccatiMap(later.A @ passed, 0.5 * (C + C.mT), 0.5 * (J + J.mT))

    def apply(self, k: int, P: np.ndarray) -> np.ndarray:
        """Pass a covariance through the map of kind k."""
        through = np.linalg.solve(np.eye(len(P)) + P @ self.J[k], P)
        P = self.C[k] + self.A[k] @ through @ self.A[k].T
        return 0.5 * (P + P.T)


def filter_variance(scenario: Scenario, course: Course, model: StochasticModel) -> np.ndarray:
    """Variance of the filter's error before it reads the log at each edge of the course.

    Parameters
    ----------
    scenario : Scenario
        With a log.
    course : Course
        Of `navcore.design.course.course`.
    model : StochasticModel
        What the filter knows.

    Returns
    -------
    ndarray, shape (k + 1, 7)
        For `navcore.quantities.COMPONENTS`, squared.
    """
    sensors = _Sensors(scenario, course, model)
    pairs, places = _pairs(course)
    kinds, turns = course.kind[pairs], course.turn[pairs].reshape(-1, 3, 3)
    half, length = course.half[kinds], course.length[kinds]
    served, moored = course.served[kinds], course.moored[kinds]
    n = sensors.size
    whole = RiccatiMap(*np.zeros((3, len(pairs), n, n)))
    alike = np.column_stack([length, served, moored])
    for calls, works, still in np.unique(alike, axis=0).tolist():
        of = np.flatnonzero((alike == (calls, works, still)).all(axis=1))
        interval = _interval(sensors, half[of], turns[of], calls, bool(works), bool(still))
        whole.A[of], whole.C[of], whole.J[of] = interval.A, interval.C, interval.J
    P = sensors.start
    out = np.empty((len(course.edges), len(COMPONENTS)))
    unit = sensors.units[_STATES]
    out[0] = P[_STATES, _STATES] * unit**2
    for i, place in enumerate(places.tolist()):
        P = whole.apply(place, P)
        out[i + 1] = P[_STATES, _STATES] * unit**2
    out[:, 5:] *= course.metres**2
    return out


def _pairs(course: Course) -> tuple[np.ndarray, np.ndarray]:
    """First interval of each pair of kind and attitude, and the pair of each interval."""
    key = np.column_stack([course.kind, np.rint(course.turn / 1e-3)]).astype(np.int64)
    _, first, which = np.unique(key, axis=0, return_index=True, return_inverse=True)
    return first, which.reshape(-1)


class _Sensors:
    """States of the filter beside the seven errors, in normalised units: velocities of about 1 m/s."""

    def __init__(self, scenario: Scenario, course: Course, model: StochasticModel) -> None:
        omega_s = scenario.omega_s
        self.scenario, self.model, self.course = scenario, model, course
        tilt = 1.0 / (omega_s * RADIUS)
        units = [1.0, 1.0, tilt, tilt, tilt, tilt, tilt]
        start = list(independent_errors(scenario, model.initial))
        self.drifts = []
        self.biases = []
        for name, drift, bias, unit in (
            ("gyro", model.gyro_drift, model.gyro_bias, 1.0 / RADIUS),
            ("accel", model.accel_drift, model.accel_bias, omega_s),
            ("log", model.log_drift, model.log_bias, 1.0),
        ):
            if drift.sigma:
                self.drifts.append((name, len(units), len(bias), drift))
                units += [unit] * len(bias)
                start += [drift.sigma] * len(bias)
            if bias.any():
                self.biases.append((name, len(units), len(bias)))
                units += [unit] * len(bias)
                start += bias.tolist()
        self.units = np.array(units)
        # columns of independent deviations: what an alignment makes of a bias is correlated with it
        spread = np.diag(start)
        turn = course.turn[0].reshape(3, 3)
        for name, at, width in self.biases:
            for axis in range(width if name != "log" else 0):
                bias = turn[:, axis] * start[at + axis]
                sides = (bias, np.zeros(3)) if name == "gyro" else (np.zeros(3), bias)
                spread[:ERRORS, at + axis] = aligned_errors(scenario, *sides)
        spread /= self.units[:, None]
        self.start = spread @ spread.T

    @property
    def size(self) -> int:
        """Number of states."""
        return len(self.units)


def _interval(
    sensors: _Sensors, half: np.ndarray, turns: np.ndarray, calls: int, works: bool, still: bool
) -> RiccatiMap:
    fresh = _one_call(sensors, half, turns, works, still)
    return calls_joined(fresh, lambda: _one_call(sensors, half, turns, False), calls, sensors.course.hold)


def _one_call(
    sensors: _Sensors, half: np.ndarray, turns: np.ndarray, works: bool, still: bool = False
) -> RiccatiMap:
    """Update with the log, or the zero of a ship that lies still, where there is a sample.

    Then comes a step of the undamped model.
    """
    model, scenario, h = sensors.model, sensors.scenario, sensors.course.step_s
    g, n = len(half), sensors.size
    transition, integral = error_step(half, h)
    into = {"gyro": -integral[:, :, 4:7], "accel": integral[:, :, 0:2]}
    if scenario.run.fidelity == "channel":
        into["gyro"][:, :, 2] = 0.0
    seen = np.zeros((g, 2, n))
    seen[:, 0, 0] = seen[:, 1, 1] = 1.0
    body = scenario.reference.frame == "body"
    axes = log_axes(body, turns)
    if body and not still:
        seen[:, 0, 6], seen[:, 1, 6] = -named(half)["v_n"], named(half)["v_e"]
    A, Q = np.zeros((2, g, n, n))
    A[:, :ERRORS, :ERRORS] = transition
    A[:, range(ERRORS, n), range(ERRORS, n)] = 1.0
    for name, at, width, *drift in (*sensors.biases, *sensors.drifts):
        own = slice(at, at + width)
        if name == "log":
            seen[:, :, own] -= 0.0 if still else axes
        else:
            A[:, :ERRORS, own] = into[name] @ (turns if name == "gyro" else turns[:, :2])
        if drift:
            left = math.exp(-h / drift[0].tau_s)
            A[:, range(at, at + width), range(at, at + width)] = left
            Q[:, range(at, at + width), range(at, at + width)] = drift[0].sigma ** 2 * (1.0 - left * left)
    for name, density in (
        ("gyro", model.figures.gyro_white**2 / h),
        ("accel", model.figures.accel_white**2 / h),
    ):
        Q[:, :ERRORS, :ERRORS] += density * into[name] @ into[name].mT
    noise = max(model.figures.log_noise**2 / max(1.0, model.figures.log_rate_hz * h), _LEAST_NOISE**2)
    if still:
        noise = scenario.reference.zero_below_mps**2
    s = sensors.units
    A, Q, seen = A / s[:, None] * s, Q / s[:, None] / s, seen * s
    J = seen.mT @ seen / noise if works else np.zeros((g, n, n))
    return RiccatiMap(A, Q, J)

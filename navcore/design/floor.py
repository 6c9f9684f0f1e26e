"""The least error that any causal linear damping can reach in the steady state (theory.md 16)."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from navcore.foundation.earth import SEMI_MAJOR_AXIS
from navcore.foundation.text import Text
from navcore.networks.lqg import ACCEL, DV, GYRO, LOG, PHI, Plant, filter_covariance, plant, riccati
from navcore.scenario.stochastic import StochasticModel

_ROUNDING = 1e-12
_ENTRIES = {
    "gyro_white": PHI,
    "gyro_drift": GYRO,
    "accel_white": DV,
    "accel_drift": ACCEL,
    "log_drift": LOG,
}
"""State that each random source drives; the log's noise enters by the gain of the filter."""


FLOOR_OF_ZERO = Text("with so few random errors a filter could remove all of it: the floor is 0")


@dataclass(frozen=True)
class Floor:
    """Standard deviations of one level channel.

    Attributes
    ----------
    tilt_rad, velocity_mps : float or None
        None where there is no floor.
    reason : str
        Why there is none; empty when there is one.
    sources : dict of (float, float)
        Tilt (rad) and velocity (m/s) that each random source leaves of it.
    """

    tilt_rad: float | None
    velocity_mps: float | None
    reason: str = ""
    sources: Mapping[str, tuple[float, float]] = field(default_factory=dict)


def steady_floor(model: StochasticModel, omega_s: float) -> Floor:
    """Error of the Kalman filter on the same model, measuring V_c - V_r, in the steady state.

    Parameters
    ----------
    model : StochasticModel
        The sensors.
    omega_s : float
        Schuler frequency, rad/s.
    """
    if model.silent:
        return Floor(
            None, None, Text("imu and reference have no random error: there is no floor to compare with")
        )
    if not model.log:
        return Floor(None, None, Text('reference.kind = "none": without a log nothing bounds the error'))
    if not model.figures.inertial:
        return Floor(0.0, 0.0)
    whole = plant(model.figures, omega_s)
    system = whole.excited()
    try:
        error = _steady_filter(system, white=model.figures.log_noise > 0.0)
        sources = _sources(system, whole.kept, error, omega_s)
    except np.linalg.LinAlgError:
        return Floor(None, None, Text("the Kalman filter of these sensors comes to no steady state"))
    return Floor(_tilt(error.P, omega_s), math.sqrt(max(error.P[DV, DV], 0.0)), sources=sources)


@dataclass(frozen=True, eq=False)
class _Filter:
    """Error of the Kalman filter in the steady state: r' = closed r + enter w + noise v, x = back r.

    Attributes
    ----------
    closed, enter, back : ndarray
        States that are not known exactly, drives of the plant, states of the plant.
    noise : ndarray, shape (n, 1)
        Entry of the log's white noise v; zero where it has none.
    P : ndarray, shape (n, n)
        Covariance of x.
    """

    closed: np.ndarray
    enter: np.ndarray
    noise: np.ndarray
    back: np.ndarray
    P: np.ndarray


def _steady_filter(system: Plant, white: bool) -> _Filter:
    """Filter of a plant; of a log without white noise what it measures is known exactly, and taken out.

    Its derivative is then the measurement, with the drives that enter it as noise, and so on until a drive
    is met (Friedland 1989; Maybeck 1979, 5.10).

    Parameters
    ----------
    system : Plant
        Without drifts that nothing drives.
    white : bool
        Whether the log has white noise.

    Raises
    ------
    numpy.linalg.LinAlgError
        The Riccati equation has no solution.
    """
    from scipy.linalg import null_space

    A, C, W = system.A, system.C, system.W
    enter = back = np.eye(len(A))
    if white:
        P = filter_covariance(system)
        gain = P @ C.T / system.V
        return _Filter(A - gain @ C, enter, -gain, back, P)
    least = _ROUNDING**2 * float(np.max(W))
    while len(A):
        size = np.linalg.norm(C)
        if size < _ROUNDING:
            raise np.linalg.LinAlgError(Text("the log does not see every state"))
        C = C / size
        rest = null_space(C)
        into = C @ enter
        seen, noise = C @ A @ rest, float((into @ W @ into.T)[0, 0])
        A, enter, back = rest.T @ A @ rest, rest.T @ enter, back @ rest
        if noise > least and len(A):
            shared = enter @ W @ into.T / noise
            left = enter @ W @ enter.T - noise * shared @ shared.T
            P = riccati((A - shared @ seen).T, seen.T, left, noise)
            gain = P @ seen.T / noise + shared
            none = np.zeros((len(A), 1))
            return _Filter(A - gain @ seen, enter - gain @ into, none, back, back @ P @ back.T)
        C = seen
    return _Filter(A, enter, np.zeros((0, 1)), back, back @ A @ back.T)


def _tilt(P: np.ndarray, omega_s: float) -> float:
    return math.sqrt(max(P[PHI, PHI], 0.0)) / (omega_s * SEMI_MAJOR_AXIS)


def _sources(
    system: Plant, kept: list[int], error: _Filter, omega_s: float
) -> dict[str, tuple[float, float]]:
    """Split the covariance of the filter's error: each noise by itself."""
    from scipy.linalg import solve_continuous_lyapunov

    if len(error.closed) and np.max(np.real(np.linalg.eigvals(error.closed))) > -_ROUNDING:
        raise np.linalg.LinAlgError(Text("the filter goes on learning for ever"))
    noises = {"log_white": system.V * error.noise @ error.noise.T}
    for name, state in _ENTRIES.items():
        if state in kept:
            column = error.enter[:, [kept.index(state)]]
            noises[name] = system.W[kept.index(state), kept.index(state)] * column @ column.T
    parts = {}
    for name, noise in noises.items():
        share = noise
        if len(noise) and noise.any():
            share = solve_continuous_lyapunov(error.closed, -noise)
        P = error.back @ share @ error.back.T
        parts[name] = (_tilt(P, omega_s), math.sqrt(max(P[DV, DV], 0.0)))
    return parts

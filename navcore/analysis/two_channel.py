"""The optimum of both level channels together, beside the network that is optimal for one (theory.md 17).

The network `optimal` is designed on one level channel and acts on each of them. Here the same cost and the
same sensors stand on the model of both channels with the Earth's rotation, heading and latitude
(`navcore.analysis.whole_matrix`). Its Kalman filter is the floor of any damping, its LQG law the best one
that knows how the channels are coupled. All is in the steady state, at rest.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from navcore.analysis.whole_matrix import (
    DV_E,
    DV_N,
    PHI_E,
    PHI_N,
    PHI_U,
    STATES,
    free_matrix,
    inputs_of_law,
    system_matrix,
)
from navcore.foundation.earth import SEMI_MAJOR_AXIS, SPHERE
from navcore.networks import lqg
from navcore.networks.base import LinearNetwork
from navcore.networks.lqg import ControlProblem, SensorFigures, plant, riccati

_GYRO, _ACCEL, _LOG = 6, 9, 11
"""First states of the drifts of three gyros, two accelerometers, and both axes of the log."""
_ALL = 13


class Deviations(NamedTuple):
    """Standard deviations in the steady state, rad and m/s."""

    tilt_e_rad: float
    tilt_n_rad: float
    heading_rad: float
    velocity_e_mps: float
    velocity_n_mps: float


@dataclass(frozen=True)
class TwoChannel:
    """What a network that is optimal for one channel leaves, beside the optimum of both.

    Attributes
    ----------
    floor : Deviations
        Of the Kalman filter of both channels: no damping leaves less.
    both_channels : Deviations
        Of the LQG law of both channels, for the cost of the network.
    one_channel : Deviations or None
        Of the network on each channel; None where the whole system has no steady state with it.
    """

    floor: Deviations
    both_channels: Deviations
    one_channel: Deviations | None


@dataclass(frozen=True, eq=False)
class BothPlant:
    """Free system of both channels with its drifts: x' = A x + B u + w, z = V_c - V_r = C x + v.

    Time is omega_s t; all states are in m/s: velocity errors, and angles times g/omega_s.

    Attributes
    ----------
    A, W : ndarray, shape (n, n)
        W is the density of w.
    B : ndarray, shape (n, 4)
        Of c_E, c_N into the transport rate and a_E, a_N into the velocity.
    C : ndarray, shape (2, n)
    V : float
        Density of v, (m/s)^2.
    unit_mps : float
        g/omega_s.
    """

    A: np.ndarray
    B: np.ndarray
    C: np.ndarray
    W: np.ndarray
    V: float
    unit_mps: float


@dataclass(frozen=True, eq=False)
class BothLaw:
    """x' = A x + B (V_r - V_c), (c_E, c_N, a_E, a_N) = K x in omega_s t; a in omega_s m/s."""

    A: np.ndarray
    B: np.ndarray
    K: np.ndarray


def both_plant(figures: SensorFigures, omega_s: float, lat: float) -> BothPlant:
    """Model of both level channels on the sphere, without drifts that nothing drives.

    Parameters
    ----------
    figures : SensorFigures
        Of each gyro, accelerometer and axis of the log.
    omega_s : float
        rad/s.
    lat : float
        rad.
    """
    one, unit = plant(figures, omega_s), SPHERE.gravity(lat, 0.0) / omega_s
    A, W, C = np.zeros((_ALL, _ALL)), np.zeros((_ALL, _ALL)), np.zeros((2, _ALL))
    A[:STATES, :STATES] = free_matrix(lat, omega_s)
    turned = (unit / (omega_s * SEMI_MAJOR_AXIS)) ** 2  # one channel takes g/omega_s = omega_s R
    for k, axis in enumerate((PHI_E, PHI_N, PHI_U)):
        A[axis, _GYRO + k], W[axis, axis] = -1.0, turned * one.W[lqg.PHI, lqg.PHI]
    for k, axis in enumerate((DV_E, DV_N)):
        A[axis, _ACCEL + k], W[axis, axis] = 1.0, one.W[lqg.DV, lqg.DV]
        C[k, axis], C[k, _LOG + k] = 1.0, -1.0
    drifts = [lqg.GYRO] * 3 + [lqg.ACCEL] * 2 + [lqg.LOG] * 2
    for state, of in enumerate(drifts, _GYRO):
        A[state, state] = one.A[of, of]
        W[state, state] = one.W[of, of] * (turned if of == lqg.GYRO else 1.0)
    B = np.zeros((_ALL, 4))
    B[:STATES] = inputs_of_law(lat, omega_s)
    kept = [k for k in range(_ALL) if k < STATES or W[k, k] > 0.0]
    return BothPlant(A[np.ix_(kept, kept)], B[kept], C[:, kept], W[np.ix_(kept, kept)], one.V, unit)


def both_law(problem: ControlProblem, system: BothPlant) -> tuple[BothLaw, np.ndarray]:
    """LQG law of both channels, and the covariance of its Kalman filter.

    It minimises phi^2 + q dV^2 + rho (u_c^2 + u_a^2), summed over both axes; u_a is only there with feedback.

    Raises
    ------
    numpy.linalg.LinAlgError
        A Riccati equation has no solution.
    """
    A, C = system.A, system.C
    P = riccati(A.T, C.T, system.W, system.V)
    gain = P @ C.T / system.V
    B = system.B if problem.feedback else system.B[:, :2]
    weight = np.zeros_like(A)
    weight[PHI_E, PHI_E] = weight[PHI_N, PHI_N] = 1.0
    weight[DV_E, DV_E] = weight[DV_N, DV_N] = problem.q
    K = np.zeros((4, len(A)))
    K[: B.shape[1]] = -B.T @ riccati(A, B, weight, problem.rho) / problem.rho
    return BothLaw(A + system.B @ K - gain @ C, -gain, K), P


def two_channel(network: LinearNetwork, problem: ControlProblem, lat: float) -> TwoChannel | None:
    """Compare a network that solves a control problem of one channel with the optimum of both.

    Parameters
    ----------
    network : LinearNetwork
        As it acts on each channel.
    problem : ControlProblem
        Which it solves.
    lat : float
        rad.

    Returns
    -------
    TwoChannel or None
        None where the problem of both channels has no solution.
    """
    from scipy.linalg import solve_continuous_lyapunov

    system = both_plant(problem.figures, network.omega_s, lat)
    try:
        law, P = both_law(problem, system)
    except np.linalg.LinAlgError:
        return None
    driven = solve_continuous_lyapunov(system.A + system.B @ law.K, -law.B @ law.B.T * system.V)
    one = _one_channel(network, system, lat)
    return TwoChannel(
        _deviations(P, system.unit_mps),
        _deviations(P + driven, system.unit_mps),
        None if one is None else _deviations(one, system.unit_mps),
    )


def _one_channel(network: LinearNetwork, system: BothPlant, lat: float) -> np.ndarray | None:
    """Covariance of the plant with a network on each channel; None where a mode does not decay."""
    from scipy.linalg import solve_continuous_lyapunov

    closed = system_matrix(network, lat)
    free = np.zeros_like(closed)
    free[:STATES, :STATES] = free_matrix(lat, network.omega_s)
    # at rest the law sees V_c - V_r, so that an error of the log enters as dV does, with the other sign
    seen = (closed - free)[:, [DV_E, DV_N]]
    n, drifts = len(closed), slice(STATES, len(system.A))
    size = n + len(system.A) - STATES
    A, W = np.zeros((size, size)), np.zeros((size, size))
    A[:n, :n], A[n:, n:] = closed, system.A[drifts, drifts]
    A[:STATES, n:] = system.A[:STATES, drifts]
    A[:n, n:] += seen @ system.C[:, drifts]
    W[:STATES, :STATES], W[n:, n:] = system.W[:STATES, :STATES], system.W[drifts, drifts]
    W[:n, :n] += system.V * seen @ seen.T
    if np.linalg.eigvals(A).real.max() >= 0.0:
        return None
    return solve_continuous_lyapunov(A, -W)


def _deviations(P: np.ndarray, unit_mps: float) -> Deviations:
    size = [math.sqrt(max(P[k, k], 0.0)) for k in range(STATES)]
    phi_e, phi_n, phi_u = (size[k] / unit_mps for k in (PHI_E, PHI_N, PHI_U))
    return Deviations(phi_e, phi_n, phi_u, size[DV_E], size[DV_N])

"""One level channel as a control problem: its stochastic model, the Kalman filter and the LQG law on it.

Everything is in normalised units, or double precision is lost (theory.md 15): time tau = omega_s t, velocity
in m/s, tilt times sqrt(g R) in m/s, so that the free loop is dV' = phi, phi' = -dV.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from navcore.foundation.text import Text

DV, PHI, GYRO, ACCEL, LOG = range(5)
_LEAST_NOISE = 1e-7
"""Density of a log without white noise, relative to that of its drift: the equation needs some noise."""
_QUIET_LOG = 1e-8
"""Density of a log without any error for which a network is designed, (m/s)^2/Hz."""

_RESIDUAL = 1e-11
"""Of a Riccati equation, relative to its terms, up to which the fast solution is good."""


@dataclass(frozen=True)
class SensorFigures:
    """Random errors of gyros, accelerometers and log, SI.

    Attributes
    ----------
    gyro_white, accel_white : float
        Roots of the power spectral densities, (rad/s)/sqrt(Hz) and (m/s^2)/sqrt(Hz).
    gyro_drift, accel_drift, log_drift : float
        Standard deviations of first-order Gauss-Markov processes, rad/s, m/s^2, m/s.
    gyro_tau_s, accel_tau_s, log_tau_s : float
        Their correlation times, s.
    log_noise : float
        Standard deviation of one sample, m/s.
    log_rate_hz : float
        Samples a second, each held until the next.
    """

    gyro_white: float
    gyro_drift: float
    gyro_tau_s: float
    accel_white: float
    accel_drift: float
    accel_tau_s: float
    log_noise: float
    log_rate_hz: float
    log_drift: float
    log_tau_s: float

    @property
    def log_density(self) -> float:
        """Power spectral density of the log's noise, sigma^2 / f."""
        return self.log_noise**2 / self.log_rate_hz

    @property
    def inertial(self) -> bool:
        """Whether gyros or accelerometers have any random error."""
        return any((self.gyro_white, self.gyro_drift, self.accel_white, self.accel_drift))

    @property
    def log(self) -> bool:
        """Whether the log has any random error."""
        return any((self.log_noise, self.log_drift))


class ControlProblem(NamedTuple):
    """What an LQG law is designed for.

    Attributes
    ----------
    figures : SensorFigures
    rho, q : float
        Weights of the correction and of the velocity error in phi^2 + q dV^2 + rho (u_c^2 + u_a^2).
    feedback : bool
        Whether the velocity itself is corrected too.
    """

    figures: SensorFigures
    rho: float
    q: float
    feedback: bool


@dataclass(frozen=True, eq=False)
class Plant:
    """Free channel with its drifts: x' = A x + w, z = C x + v.

    States dV, phi sqrt(gR), gyro drift, accelerometer drift, log drift; z = V_c - V_r.

    Attributes
    ----------
    A : ndarray, shape (5, 5)
    C : ndarray, shape (1, 5)
    W : ndarray, shape (5, 5)
        Density of w in tau.
    V : float
        Density of v in tau, (m/s)^2.
    """

    A: np.ndarray
    C: np.ndarray
    W: np.ndarray
    V: float

    @property
    def kept(self) -> list[int]:
        """States of the plant that is left of it without drifts that nothing drives."""
        return [DV, PHI, *(i for i in (GYRO, ACCEL, LOG) if self.W[i, i] > 0.0)]

    def excited(self) -> Plant:
        """Return the same plant without drifts that nothing drives."""
        keep = self.kept
        return Plant(self.A[np.ix_(keep, keep)], self.C[:, keep], self.W[np.ix_(keep, keep)], self.V)


def plant(figures: SensorFigures, omega_s: float) -> Plant:
    """Make the model of one level channel (theory.md 14).

    Parameters
    ----------
    figures : SensorFigures
        Random errors.
    omega_s : float
        Schuler frequency, rad/s.
    """
    # Only now: it brings the compiler, and a network is often looked at without a run.
    from navcore.foundation.earth import SEMI_MAJOR_AXIS

    A = np.zeros((5, 5))
    A[DV, PHI], A[PHI, DV], A[PHI, GYRO], A[DV, ACCEL] = 1.0, -1.0, -1.0, 1.0
    W = np.zeros((5, 5))
    W[DV, DV] = figures.accel_white**2 / omega_s
    W[PHI, PHI] = (SEMI_MAJOR_AXIS * figures.gyro_white) ** 2 * omega_s
    for i, sigma, tau, unit in (
        (GYRO, figures.gyro_drift, figures.gyro_tau_s, SEMI_MAJOR_AXIS),
        (ACCEL, figures.accel_drift, figures.accel_tau_s, 1.0 / omega_s),
        (LOG, figures.log_drift, figures.log_tau_s, 1.0),
    ):
        rate = 1.0 / (tau * omega_s)
        A[i, i], W[i, i] = -rate, 2.0 * (unit * sigma) ** 2 * rate
    least = _LEAST_NOISE * 2.0 * figures.log_drift**2 * figures.log_tau_s or _QUIET_LOG
    return Plant(A, np.array([[1.0, 0.0, 0.0, 0.0, -1.0]]), W, (figures.log_density or least) * omega_s)


def filter_covariance(system: Plant) -> np.ndarray:
    """Covariance of the Kalman filter's error in the steady state.

    Raises
    ------
    numpy.linalg.LinAlgError
        The Riccati equation has no solution.
    """
    return riccati(system.A.T, system.C.T, system.W, system.V)


def riccati(A: np.ndarray, B: np.ndarray, Q: np.ndarray, r: float) -> np.ndarray:
    """Stabilising solution of A^T X + X A - X B B^T X / r + Q = 0.

    By the ordered Schur form of the Hamiltonian matrix, some ten times as fast for these sizes as scipy's
    general solver, which is asked where the residual says so.

    Parameters
    ----------
    A, Q : ndarray, shape (n, n)
    B : ndarray, shape (n, m)
    r : float
        Weight of every input.

    Raises
    ------
    numpy.linalg.LinAlgError
        There is none.
    """
    from scipy.linalg import schur, solve_continuous_are

    n = len(A)
    weight = B @ B.T / r
    form: Any = schur(np.block([[A, -weight], [-Q, -A.T]]), output="real", sort="lhp")
    _, vectors, stable = form
    if stable == n:
        upper, lower = vectors[:n, :n], vectors[n:, :n]
        X = np.linalg.solve(upper.T, lower.T).T
        X = 0.5 * (X + X.T)
        size = np.linalg.norm(A.T @ X) + np.linalg.norm(Q) + np.linalg.norm(X @ weight @ X)
        if np.linalg.norm(A.T @ X + X @ A - X @ weight @ X + Q) < _RESIDUAL * size:
            return X
    try:
        return solve_continuous_are(A, B, Q, r * np.eye(B.shape[1]))
    except ValueError as error:  # scipy's own word for a pencil that cannot be reordered
        raise np.linalg.LinAlgError(str(error)) from None


@dataclass(frozen=True, eq=False)
class Compensator:
    """x' = A x + B u, c = C x, a = E x with u = V_r - V_c, in tau; a in omega_s m/s.

    Attributes
    ----------
    A : ndarray, shape (n, n)
    B, C, E : ndarray, shape (n,)
    """

    A: np.ndarray
    B: np.ndarray
    C: np.ndarray
    E: np.ndarray

    def reduced(self, order: int) -> Compensator:
        """Return the balanced truncation to an order; itself where it has no more states.

        Parameters
        ----------
        order : int
            States to keep.

        Raises
        ------
        numpy.linalg.LinAlgError
            A mode does not decay, or not by more than the rounding: no balanced form exists.
        """
        if len(self.B) <= order:
            return self
        if np.linalg.eigvals(self.A).real.max() >= -np.finfo(float).eps * np.abs(self.A).max():
            raise np.linalg.LinAlgError(Text("the compensator has a mode that does not decay"))
        outputs = np.stack([self.C, self.E])
        reach = _root(_gramian(self.A, np.outer(self.B, self.B)))
        watch = _root(_gramian(self.A.T, outputs.T @ outputs))
        left, sizes, right = np.linalg.svd(watch.T @ reach)
        # A state that nothing reaches or watches has no size but rounding.
        order = min(order, int(np.count_nonzero(sizes > np.finfo(float).eps * sizes[0])))
        scale = 1.0 / np.sqrt(sizes[:order])
        into, out = reach @ right[:order].T * scale, (left[:, :order] * scale).T @ watch.T
        return Compensator(out @ self.A @ into, out @ self.B, self.C @ into, self.E @ into)


def _gramian(A: np.ndarray, Q: np.ndarray) -> np.ndarray:
    """Solution of A X + X A^T + Q = 0; a `LinAlgError` where rounding leaves none.

    The steps of `scipy.linalg.solve_continuous_lyapunov`, which only warns of that, and a warning cannot be
    caught for one thread.
    """
    from scipy.linalg import get_lapack_funcs, schur

    form: Any = schur(A, output="real")
    triangular, vectors = form
    turned = vectors.T.dot((-Q).dot(vectors))
    (solve,) = get_lapack_funcs(("trsyl",), (triangular, turned))
    solution, scale, failed = solve(triangular, triangular, turned, tranb="T")
    if failed:
        raise np.linalg.LinAlgError(Text("the compensator has a mode that does not decay"))
    return vectors.dot(scale * solution).dot(vectors.T)


def _root(gramian: np.ndarray) -> np.ndarray:
    """Matrix S with S S^T = gramian; what rounding made negative is left out."""
    values, vectors = np.linalg.eigh(0.5 * (gramian + gramian.T))
    return vectors * np.sqrt(np.maximum(values, 0.0))


def compensator(system: Plant, rho: float, q: float, feedback: bool) -> Compensator:
    """LQG law: Kalman filter and the feedback that minimises phi^2 + q dV^2 + rho (u_c^2 + u_a^2).

    Parameters
    ----------
    system : Plant
        The channel.
    rho : float
        Weight of the correction; small: fast.
    q : float
        Weight of the velocity error beside that of the tilt.
    feedback : bool
        Whether the velocity itself is corrected too (u_a), as by K1 of `compass`.

    Raises
    ------
    numpy.linalg.LinAlgError
        A Riccati equation has no solution.
    """
    n = len(system.A)
    gain = filter_covariance(system) @ system.C.T / system.V
    entry = np.zeros((n, 2 if feedback else 1))
    entry[PHI, 0] = -1.0
    if feedback:
        entry[DV, 1] = 1.0
    weight = np.zeros((n, n))
    weight[PHI, PHI], weight[DV, DV] = 1.0, q
    cost = riccati(system.A, entry, weight, rho)
    back = entry.T @ cost / rho
    # the filter reads z = V_c - V_r = -u, and the correction is minus the gain times the estimate
    A = system.A - entry @ back - gain @ system.C
    return Compensator(A, gain[:, 0], back[0], back[1] if feedback else np.zeros(n))

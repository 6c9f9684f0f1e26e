"""Networks in discrete time: bilinear, prewarped at omega_s, in delta form (theory.md 3.5, Liu 17-19).

The direct form that Liu prints is never run: at Schuler scale its coefficients do not fit into a double.
"""

import math
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.networks.base import LinearNetwork
from navcore.networks.state_space import state_spaces

_SINGULAR = 1e-6


@dataclass(frozen=True, eq=False)
class DiscreteNetwork:
    """One step: y = C x + D u from x before the update, then x += dA x + B u.

    Attributes
    ----------
    dA : ndarray, shape (n, n)
        Transition matrix minus the identity, never added to it before use.
    B, C : ndarray, shape (n,)
    D : float
    step_s : float
        Step, s.
    E : ndarray, shape (n,), or None
        Output row of the velocity feedback a = E x + F u, 1/s; None for a network that has none.
    F : float
        1/s.
    """

    dA: np.ndarray
    B: np.ndarray
    C: np.ndarray
    D: float
    step_s: float
    E: np.ndarray | None = None
    F: float = 0.0

    @property
    def order(self) -> int:
        """Number of states."""
        return len(self.B)

    def response(self, omega: np.ndarray | float) -> np.ndarray:
        """Complex frequency response H_d(e^(j omega T)), shape of ``omega`` (rad/s)."""
        omega = np.asarray(omega, dtype=float)
        if self.order == 0:
            return np.full(omega.shape, complex(self.D))
        # z - 1 directly: near DC the difference of two numbers close to 1 would lose everything
        delta = np.expm1(1j * omega.reshape(-1) * self.step_s)
        systems = delta[:, None, None] * np.eye(self.order) - self.dA
        states = np.linalg.solve(systems, np.broadcast_to(self.B[:, None], (len(delta), self.order, 1)))[
            ..., 0
        ]
        return (states @ self.C + self.D).reshape(omega.shape)

    def steady_state(self, u: float) -> np.ndarray:
        """State at which a constant input u leaves the network at rest, shape (n,).

        Raises
        ------
        InputError
            The network has a pole at zero.
        """
        if self.order == 0 or u == 0.0:
            return np.zeros(self.order)
        try:
            return np.linalg.solve(self.dA, -self.B * u)
        except np.linalg.LinAlgError:
            reason = Text("a pole at zero leaves no steady state for a constant velocity")
            raise InputError(Fault("", "poles", None, reason)) from None


@lru_cache(maxsize=256)
def discretise(network: LinearNetwork, step_s: float) -> DiscreteNetwork:
    """Discretise a network.

    Bilinear in normalised time tau = omega_s t with a = tan(omega_s T/2), so that the discrete response at
    omega is the continuous one at omega_s tan(omega T/2)/tan(omega_s T/2), exact at omega_s.

    Parameters
    ----------
    network : LinearNetwork
        H(s).
    step_s : float
        Step T, s; below half a Schuler period.

    Raises
    ------
    InputError
        The step is not positive or too long, or a pole of the network has no discrete counterpart.
    """
    half_angle = 0.5 * network.omega_s * step_s
    if not 0.0 < half_angle < 0.5 * math.pi:
        limit = math.pi / network.omega_s
        raise InputError(Fault("", "step_s", step_s, Text("must be > 0 and < {limit:g} (s)", limit=limit)))
    poles = network.poles / network.omega_s
    feedback = network.feedback_p
    continuous, *others = state_spaces([p for p in (network.num_p, feedback) if p is not None], poles)
    a = math.tan(half_angle)
    if np.any(np.abs(1.0 - a * poles) < _SINGULAR):
        reason = Text(
            "an unstable pole at {omega_s:g} rad/s cannot run at this step", omega_s=network.omega_s / a
        )
        raise InputError(Fault("", "poles", None, reason))
    inverse = np.linalg.inv(np.eye(network.order) - a * continuous.A)
    discrete = DiscreteNetwork(
        dA=2.0 * a * continuous.A @ inverse,
        B=2.0 * a * inverse @ continuous.B,
        C=continuous.C @ inverse,
        D=continuous.D + a * float(continuous.C @ inverse @ continuous.B),
        step_s=step_s,
    )
    for second in others:
        E = network.omega_s * second.C @ inverse
        F = network.omega_s * (second.D + a * float(second.C @ inverse @ second.B))
        discrete = replace(discrete, E=E, F=F)
    return discrete

"""Discrete forms of a network and Sun's damping coefficient for `tests.law_twin`, as in a textbook."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.interpolate import PchipInterpolator

from navcore.networks.base import LinearNetwork, NetworkParameters


@dataclass
class Form:
    """Discrete state space of Q in one channel, and the continuous one where the law re-tunes it."""

    A: np.ndarray
    B: np.ndarray
    C: np.ndarray
    D: float
    continuous: tuple[np.ndarray, np.ndarray, np.ndarray] | None = None
    second: tuple[np.ndarray, float] | None = None  # row and direct term of the velocity feedback, 1/s

    @property
    def steady(self) -> np.ndarray:
        """States at rest under a constant input of 1."""
        return np.linalg.solve(np.eye(len(self.B)) - self.A, self.B) if len(self.B) else self.B


def bilinear(A: np.ndarray, B: np.ndarray, C: np.ndarray, D: float, a: float) -> Form:
    """Tustin's form of (A, B, C, D) in normalised time; ``a`` = tan(omega_s T / 2)."""
    eye = np.eye(len(B))
    inverse = np.linalg.inv(eye - a * A)
    return Form(
        (eye + a * A) @ inverse, 2.0 * a * inverse @ B, C @ inverse, D + a * float(C @ inverse @ B), (A, B, C)
    )


def companion(network: LinearNetwork, a: float) -> Form:
    """Q = 1 - H in controller form: the strictly proper part of (D - N)/D over 1 - H(infinity)."""
    n = network.order
    num = np.concatenate([np.zeros(n + 1 - len(network.num_p)), network.num_p])
    rest = network.den_p - num
    direct = float(rest[0])
    A = np.eye(n, k=1)
    if n:
        A[-1] = -network.den_p[:0:-1]
    B = np.eye(n)[-1] if n else np.zeros(0)
    form = bilinear(A, B, (rest - direct * network.den_p)[:0:-1], direct, a)
    if network.feedback_p is not None:
        row = np.concatenate([np.zeros(n - len(network.feedback_p)), network.feedback_p])[::-1]
        pushed = bilinear(A, B, network.omega_s * row, 0.0, a)
        form.second = (pushed.C, pushed.D)
    return form


def damping_ratio(network: LinearNetwork) -> float:
    """Smallest -Re/|p| of the roots of p^2 D + N + p G, with G = 0 for a network with one output."""
    n = network.order
    loop = np.concatenate([network.den_p, [0.0, 0.0]])
    loop[n + 3 - len(network.num_p) :] += network.num_p
    if network.feedback_p is not None:
        loop[n + 2 - len(network.feedback_p) : n + 2] += network.feedback_p
    poles = np.roots(loop)
    return float(np.min(-poles.real / np.abs(poles)))


def controller(parameters: NetworkParameters, omega_s: float, a: float) -> Form:
    """Q = 1 - H with the low-passed input and its scaled derivatives as states."""
    network = parameters.transfer(omega_s)
    n = network.order
    A = np.diag(np.ones(n - 1), 1)
    A[-1] = -network.den_p[:0:-1]
    last = network.den_p[-1]
    scale = last ** (np.arange(n) / n) / last  # z^(i) = scale_i X_(i+1)
    return bilinear(
        A * scale[None, :] / scale[:, None], np.eye(n)[-1] / scale,
        (network.den_p - network.num_p)[:0:-1] * scale, 0.0, a,
    )  # fmt: skip


def adaptive(policy: Any, knots: float) -> float:
    """Coefficient of the policy `adaptive` for a difference: the printed curve, or the table's."""
    if policy.law in ("quadratic", "as_printed"):
        xi = 0.3076 * knots**2 + (1.1452 if policy.law == "as_printed" else -1.1452) * knots + 0.8101
    else:
        x, y = np.array(sorted(policy.table)).T
        xi = float(PchipInterpolator(x, y)(np.clip(knots, x[0], x[-1])))
    return min(max(xi, 0.04), 0.99)

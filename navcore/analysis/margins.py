"""Margins of the open loop omega_s^2 H(s)/s^2 from the roots of its crossings: a millisecond, for sliders."""

import math
from dataclasses import dataclass

import numpy as np

from navcore.analysis.loop import analyse
from navcore.networks.base import LinearNetwork

_REAL = 1e-7
"""Imaginary part, relative, up to which a root counts as real."""


@dataclass(frozen=True)
class Margins:
    """Margins of the open loop omega_s^2 H(s)/s^2.

    Attributes
    ----------
    gain_up, gain_down : float or None
        Factor to which the loop gain may rise or fall before the loop gets unstable; None: no limit.
    phase_rad : float or None
        Smallest phase margin, rad.
    crossover_rad_s : float or None
        Frequency of that margin, rad/s.
    delay_s : float or None
        Delay that makes the loop unstable, s.
    """

    gain_up: float | None
    gain_down: float | None
    phase_rad: float | None
    crossover_rad_s: float | None
    delay_s: float | None


def margins(network: LinearNetwork) -> Margins | None:
    """Margins of the loop omega_s^2 H/s^2; None where they mean nothing (undamped or unstable loop).

    Of a network with two outputs the loop is (H + p G)/p^2, broken at V_c.
    """
    loop = analyse(network)
    if not loop.stable or loop.settling_s is None:
        return None
    gains = np.array([x * x / h for x, h in _phase_crossings(network) if h > 0.0])
    up, down = gains[gains > 1.0], gains[gains < 1.0]
    crossings = np.array(_gain_crossings(network))
    if len(crossings) == 0:
        return Margins(_smallest(up), _largest(down), None, None, None)
    # -L = H omega_s^2/omega^2 has the phase of H
    phases = np.angle(network.loop_response(crossings * network.omega_s))
    least = int(np.argmin(np.abs(phases)))
    # a delay turns the phase clockwise: only the way from each crossing down to -180 deg counts
    lag = np.mod(phases, 2.0 * math.pi)
    return Margins(
        gain_up=_smallest(up),
        gain_down=_largest(down),
        phase_rad=float(phases[least]),
        crossover_rad_s=float(crossings[least]) * network.omega_s,
        delay_s=float(np.min(lag / crossings)) / network.omega_s,
    )


def _gain_crossings(network: LinearNetwork) -> list[float]:
    """Frequencies over omega_s at which |L| = 1: |N|^2 = x^4 |D|^2, p = j x."""
    n, d = network.loop_num_p, network.den_p
    size = np.polysub(np.polymul(n, _mirrored(n)), np.append(np.polymul(d, _mirrored(d)), np.zeros(4)))
    return _on_axis(size)


def _phase_crossings(network: LinearNetwork) -> list[tuple[float, float]]:
    """Frequencies over omega_s at which H is real, and H there."""
    n, d = network.loop_num_p, network.den_p
    turned = np.polymul(n, _mirrored(d))
    odd = np.polysub(turned, _mirrored(turned))
    crossings = _on_axis(odd[:-1])  # one factor p is omega = 0
    return [(x, float(np.real(network.loop_response(x * network.omega_s)))) for x in crossings]


def _mirrored(polynomial: np.ndarray) -> np.ndarray:
    """Coefficients of P(-p)."""
    signs = (-1.0) ** np.arange(len(polynomial) - 1, -1, -1)
    return polynomial * signs


def _on_axis(even: np.ndarray) -> list[float]:
    """Positive x with even(j x) = 0, for a polynomial in p^2."""
    roots = np.roots(np.trim_zeros(even[::-1][::2][::-1], "f"))
    real = np.real(roots[np.abs(np.imag(roots)) <= _REAL * np.abs(roots)])
    return sorted(float(x) for x in np.sqrt(-real[real < 0.0]))


def _smallest(values: np.ndarray) -> float | None:
    return float(np.min(values)) if len(values) else None


def _largest(values: np.ndarray) -> float | None:
    return float(np.max(values)) if len(values) else None

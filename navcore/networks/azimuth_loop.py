"""Loops of the azimuth channel, and the gains of a gyrocompass (theory.md 6.1)."""

from typing import NamedTuple

import numpy as np

from navcore.networks.base import LinearNetwork


class AzimuthGains(NamedTuple):
    """Gains of the loop that turns the platform by the north velocity difference.

    Attributes
    ----------
    k1, k2, k3, k4 : float
        K_U1 (1/s), K_U2, K_U3 (rad/(m s)), K_U4 (1/s).
    """

    k1: float
    k2: float
    k3: float
    k4: float


def azimuth_gains(sigma: float, xi: float, omega_s: float, gravity: float) -> AzimuthGains:
    """Gains for (s^2 + 2 sigma s + sigma^2/xi^2)^2; sigma and omega_s in rad/s, gravity in m/s^2."""
    stiffness = sigma**2 / xi**2
    return AzimuthGains(2.0 * sigma, 2.0 * stiffness / omega_s**2 - 1.0, stiffness**2 / gravity, 2.0 * sigma)


def azimuth_polynomial(gains: AzimuthGains, omega_s: float, gravity: float) -> np.ndarray:
    """Characteristic polynomial of the loop of the heading, in p = s/omega_s, descending, shape (5,).

    s (s + K_U4) (s^2 + K_U1 s + omega_s^2 (1 + K_U2)) + g K_U3, omega_s in rad/s, gravity in m/s^2.
    """
    level = [1.0, gains.k1 / omega_s, 1.0 + gains.k2]
    loop = np.polymul([1.0, gains.k4 / omega_s, 0.0], level)
    loop[-1] += gravity * gains.k3 / omega_s**4
    return loop


AzimuthChannel = LinearNetwork | AzimuthGains
"""Loop of the azimuth channel: Y(s) of whole damping, or a gyrocompass."""

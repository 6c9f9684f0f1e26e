"""Loops of the azimuth channel, and the gains of a gyrocompass (theory.md 6.1)."""

from typing import NamedTuple

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


AzimuthChannel = LinearNetwork | AzimuthGains
"""Loop of the azimuth channel: Y(s) of whole damping, or a gyrocompass."""

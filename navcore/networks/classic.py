"""The two textbook networks with fixed coefficients."""

from typing import ClassVar, Literal

import numpy as np

from navcore.foundation.text import Text
from navcore.foundation.units import EARTH_RATE
from navcore.networks.base import LinearNetwork, NetworkParameters, linear_network

_OMEGA_S = 1.2400e-3
"""Schuler frequency for which the coefficients were chosen, rad/s."""


def _from_roots(
    id: str, omega_s: float, unit: float, zeros: list[float], poles: list[float]
) -> LinearNetwork:
    zeros_p, poles_p = np.array(zeros) / unit, np.array(poles) / unit
    return linear_network(id, omega_s, np.poly(zeros_p), np.poly(poles_p), zeros_p=zeros_p, poles_p=poles_p)


class Classic2Network(NetworkParameters):
    """H = (s+8.5e-4)(s+9.412e-2) / ((s+8.0e-3)(s+1.0e-2))."""

    title: ClassVar[str] = Text("Classic, second order")
    source: ClassVar[str] = "Liu 2, Sun 5, Zha 2"
    no_handle: ClassVar[str] = Text("its coefficients are fixed")
    id: Literal["classic2"] = "classic2"

    def transfer(self, omega_s: float) -> LinearNetwork:
        """Return H(s); its coefficients do not follow omega_s (rad/s)."""
        return _from_roots("classic2", omega_s, omega_s, [-8.5e-4, -9.412e-2], [-8.0e-3, -1.0e-2])

    def at_earth_rate(self) -> LinearNetwork:
        """Return Y(s) of the azimuth channel: its roots lie to Omega as those of H(s) to 1.24e-3 rad/s."""
        return _from_roots("classic2", EARTH_RATE, _OMEGA_S, [-8.5e-4, -9.412e-2], [-8.0e-3, -1.0e-2])


class Classic3Network(NetworkParameters):
    """H = (s+8.8e-4)(s+1.97e-2)^2 / ((s+4.41e-3)(s+8.8e-3)^2)."""

    title: ClassVar[str] = Text("Classic, third order")
    source: ClassVar[str] = "Liu 3, Sun 4"
    no_handle: ClassVar[str] = Text("its coefficients are fixed")
    id: Literal["classic3"] = "classic3"

    def transfer(self, omega_s: float) -> LinearNetwork:
        """Return H(s); its coefficients do not follow omega_s (rad/s)."""
        return _from_roots(
            "classic3", omega_s, omega_s, [-8.8e-4, -1.97e-2, -1.97e-2], [-4.41e-3, -8.8e-3, -8.8e-3]
        )

    def at_earth_rate(self) -> LinearNetwork:
        """Return Y(s) of the azimuth channel: its roots lie to Omega as those of H(s) to 1.24e-3 rad/s."""
        return _from_roots(
            "classic3", EARTH_RATE, _OMEGA_S, [-8.8e-4, -1.97e-2, -1.97e-2], [-4.41e-3, -8.8e-3, -8.8e-3]
        )

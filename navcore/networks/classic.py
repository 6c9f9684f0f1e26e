"""The two textbook networks with fixed coefficients."""

from typing import ClassVar, Literal

import numpy as np

from navcore.foundation.text import Text
from navcore.foundation.units import EARTH_RATE
from navcore.networks.base import LinearNetwork, NetworkParameters, linear_network

_OMEGA_S = 1.2400e-3
"""Schuler frequency for which the coefficients were chosen, rad/s."""


class _ClassicNetwork(NetworkParameters):
    """A network with fixed roots, rad/s."""

    no_handle: ClassVar[str] = Text("its coefficients are fixed")
    zeros: ClassVar[tuple[float, ...]]
    poles: ClassVar[tuple[float, ...]]

    def transfer(self, omega_s: float) -> LinearNetwork:
        """Return H(s); its coefficients do not follow omega_s (rad/s)."""
        return self._network(omega_s, omega_s)

    def at_earth_rate(self) -> LinearNetwork:
        """Return Y(s) of the azimuth channel: its roots lie to Omega as those of H(s) to 1.24e-3 rad/s."""
        return self._network(EARTH_RATE, _OMEGA_S)

    def _network(self, omega_s: float, unit: float) -> LinearNetwork:
        zeros, poles = np.array(self.zeros) / unit, np.array(self.poles) / unit
        return linear_network(self.id, omega_s, np.poly(zeros), np.poly(poles), zeros_p=zeros, poles_p=poles)


class Classic2Network(_ClassicNetwork):
    """H = (s+8.5e-4)(s+9.412e-2) / ((s+8.0e-3)(s+1.0e-2))."""

    title: ClassVar[str] = Text("Classic, second order")
    source: ClassVar[str] = "Liu 2, Sun 5, Zha 2"
    zeros: ClassVar[tuple[float, ...]] = (-8.5e-4, -9.412e-2)
    poles: ClassVar[tuple[float, ...]] = (-8.0e-3, -1.0e-2)
    id: Literal["classic2"] = "classic2"


class Classic3Network(_ClassicNetwork):
    """H = (s+8.8e-4)(s+1.97e-2)^2 / ((s+4.41e-3)(s+8.8e-3)^2)."""

    title: ClassVar[str] = Text("Classic, third order")
    source: ClassVar[str] = "Liu 3, Sun 4"
    zeros: ClassVar[tuple[float, ...]] = (-8.8e-4, -1.97e-2, -1.97e-2)
    poles: ClassVar[tuple[float, ...]] = (-4.41e-3, -8.8e-3, -8.8e-3)
    id: Literal["classic3"] = "classic3"

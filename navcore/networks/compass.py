"""The compass-alignment loop as a damping network: sigma, xi or K1, K2, K3 (Deng 1, 2; Zha 10-15)."""

import math
from typing import Any, ClassVar, Literal

import numpy as np
from pydantic import model_validator

from navcore.foundation.parameters import bounds_of, choice, given, quantity
from navcore.foundation.text import Text
from navcore.networks.base import LinearNetwork, NetworkParameters, linear_network, refuse
from navcore.networks.pair import MainPair, Placement, dampings, placement
from navcore.networks.roots import pair

GAINS_TOLERANCE = 1e-3
"""Mismatch, relative to the largest term, up to which gains count as those of some (sigma, xi).

Papers print 3 to 6 digits (0.0264, 202.520, 0.904534) for their own omega_s, from which the site's differs by
up to 0.15 %; Zha's inconsistent sets miss by 29 % and 45 %.
"""

_DESIGN, _GAINS = ("sigma", "xi"), ("k1", "k2", "k3")


class CompassNetwork(NetworkParameters):
    """H = ((1+K2)s + K3)/(s + K1), third-order loop with poles -sigma, -sigma +- j sigma sqrt(1-xi^2)/xi.

    Give sigma and xi, or all of k1, k2, k3; not both.
    """

    title: ClassVar[str] = Text("Compass")
    source: ClassVar[str] = "Deng 1, 2; Zha 10"
    alternatives: ClassVar[tuple[tuple[str, ...], ...]] = (_DESIGN, _GAINS)
    placeable: ClassVar[str] = "compass"
    no_handle: ClassVar[str] = Text(
        "its gains give three real poles; a click into the pole map places a pair"
    )
    id: Literal["compass"] = "compass"
    sigma: float | None = quantity(
        0.0088,
        unit="1/s",
        ge=1e-5,
        le=1.0,
        slider=(5e-4, 0.2),
        log=True,
        label=Text("decay rate σ"),
        help=Text(
            "Decay rate of all three closed-loop poles (Deng 2, Zha 12): larger is faster, and lets more of "
            "the log's noise through."
        ),
    )
    xi: float | None = quantity(
        0.7,
        ge=0.01,
        le=10.0,
        slider=(0.05, 1.5),
        label=Text("damping ratio ζ"),
        help=Text("Damping ratio of the closed-loop pair; Deng and Zha write ξ (Deng 2, Zha 14)."),
    )
    k1: float | None = quantity(
        None,
        unit="1/s",
        ge=-10.0,
        le=10.0,
        slider=(1e-3, 0.5),
        log=True,
        label="K₁",
        help=Text("Velocity feedback; 3σ (Deng 2)."),
    )
    k2: float | None = quantity(
        None,
        ge=-1e10,
        le=1e10,
        slider=(1.0, 5e4),
        log=True,
        label="K₂",
        help=Text("Extra proportional gain of the platform rate; σ² (2 + 1/ζ²)/ωₛ² - 1 (Deng 2)."),
    )
    k3: float | None = quantity(
        None,
        unit="1/s",
        ge=-1e10,
        le=1e10,
        slider=(1e-3, 1e3),
        log=True,
        label="K₃",
        help=Text("Integral gain of the platform rate; σ³/(ωₛ² ζ²) (Deng 2)."),
    )
    realisation: Literal["feedback", "network", "as_printed"] = choice(
        "feedback",
        label=Text("realisation"),
        help=Text(
            "External damping only: velocity feedback (theory.md 3.1), the network form, or Deng 4 as "
            "printed, which lacks the transport rate of the reference."
        ),
    )

    @model_validator(mode="before")
    @classmethod
    def _one_way_only(cls, data: Any) -> Any:
        gains, design = given(data, _GAINS), given(data, _DESIGN)
        if gains and design:
            allowed = Text(
                "must not be given together with {design}: the gains follow from sigma and xi",
                design=", ".join(design),
            )
            raise refuse(gains[0], data[gains[0]], allowed)
        if gains and len(gains) < 3:
            missing = ", ".join(name for name in _GAINS if name not in gains)
            raise refuse(
                gains[0], data[gains[0]], Text("needs {missing} too: give all of k1, k2, k3", missing=missing)
            )
        if gains:
            return {**data, "sigma": None, "xi": None}
        if isinstance(data, dict):
            return {key: value for key, value in data.items() if value is not None}
        return data

    def gains(self, omega_s: float) -> tuple[float, float, float]:
        """Return K1 (1/s), K2, K3 (1/s) for a Schuler frequency in rad/s (Deng 2)."""
        if self.k1 is not None and self.k2 is not None and self.k3 is not None:
            return self.k1, self.k2, self.k3
        assert self.sigma is not None and self.xi is not None
        return gains_from_sigma_xi(self.sigma, self.xi, omega_s)

    @property
    def external_form(self) -> str:
        """The realisation that was chosen."""
        return self.realisation

    def feedback_gains(self, omega_s: float) -> tuple[float, float, float]:
        """Return the gains."""
        return self.gains(omega_s)

    def transfer(self, omega_s: float) -> LinearNetwork:
        """Return H(s) = ((1+K2)s + K3)/(s + K1) for a Schuler frequency in rad/s."""
        k1, k2, k3 = self.gains(omega_s)
        if 1.0 + k2 == 0.0 and k3 == 0.0:
            raise refuse("k2", k2, Text("must not be -1 while k3 = 0: H would be zero"))
        closed_loop, warnings = None, ()
        if self.sigma is not None and self.xi is not None:
            s = self.sigma / omega_s
            closed_loop = [complex(-s), *pair(self.xi, s / self.xi)]
        elif sigma_xi_from_gains(k1, k2, k3, omega_s) is None:
            warnings = (Text("no (σ, ζ) gives these K"),)
        return linear_network(
            "compass",
            omega_s,
            [1.0 + k2, k3 / omega_s],
            [1.0, k1 / omega_s],
            closed_loop_p=closed_loop,
            warnings=warnings,
            realisation=self.realisation,
        )

    def with_pair(self, damping_ratio: float, frequency: float, omega_s: float) -> Placement:
        """Return the compass loop with this pair: xi and sigma = xi |p|."""
        data = {"realisation": self.realisation, "sigma": damping_ratio * frequency, "xi": damping_ratio}
        return placement(type(self), data, damping_ratio, frequency, "")

    def main_pair(self, omega_s: float) -> MainPair | None:
        """Return the pair of sigma and xi; of other gains the pair of the loop, None without one."""
        if self.sigma is not None and self.xi is not None:
            damping_ratio, frequency = self.xi, self.sigma / self.xi
        else:
            k1, k2, k3 = self.gains(omega_s)
            roots = np.roots([1.0, k1 / omega_s, 1.0 + k2, k3 / omega_s])
            pole = next((root for root in roots if root.imag > 0.0), None)
            if pole is None:
                return None
            damping_ratio, frequency = float(-pole.real / abs(pole)), float(abs(pole)) * omega_s
        rates = bounds_of(type(self).model_fields["sigma"])
        return MainPair(damping_ratio, frequency, dampings(type(self), "xi"), ((0.0, math.inf),), rates)

    def following(self, network: LinearNetwork) -> dict[str, Any]:
        """Return the gains, and sigma and xi if these gains have any."""
        k1, k2, k3 = self.gains(network.omega_s)
        design_values = sigma_xi_from_gains(k1, k2, k3, network.omega_s)
        design = {} if design_values is None else dict(zip(_DESIGN, design_values, strict=True))
        return dict(zip(_GAINS, (k1, k2, k3), strict=True)) | design


def gains_from_sigma_xi(sigma: float, xi: float, omega_s: float) -> tuple[float, float, float]:
    """Gains of the compass loop (Deng 2).

    Parameters
    ----------
    sigma : float
        Decay rate, 1/s.
    xi : float
        Damping ratio of the pair.
    omega_s : float
        Schuler frequency, rad/s.

    Returns
    -------
    K1 (1/s), K2, K3 (1/s).
    """
    ratio = (sigma / omega_s) ** 2
    return 3.0 * sigma, ratio * (2.0 + 1.0 / xi**2) - 1.0, ratio * sigma / xi**2


def sigma_xi_from_gains(k1: float, k2: float, k3: float, omega_s: float) -> tuple[float, float] | None:
    """Return the (sigma, xi) that give these gains, None if there are none (theory.md 3.1).

    They exist iff sigma = K1/3 > 0, 1/xi^2 = K3 omega_s^2/sigma^3 > 0 and
    K3 omega_s^2 = sigma [(1+K2) omega_s^2 - 2 sigma^2], here to `GAINS_TOLERANCE` of the largest term.

    Parameters
    ----------
    k1, k2, k3 : float
        1/s, 1, 1/s.
    omega_s : float
        rad/s.
    """
    sigma = k1 / 3.0
    if sigma <= 0.0 or k3 <= 0.0:
        return None
    squared = (sigma / omega_s) ** 2
    left, proportional, cubic = k3, sigma * (1.0 + k2), 2.0 * sigma * squared
    if abs(left - proportional + cubic) > GAINS_TOLERANCE * max(abs(left), abs(proportional), cubic):
        return None
    return sigma, math.sqrt(sigma * squared / k3)

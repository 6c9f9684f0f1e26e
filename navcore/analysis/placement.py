"""From a wanted closed-loop pole pair (damping ratio, frequency) to the parameters that give it."""

from __future__ import annotations

import math

from navcore.analysis.loop import H0_TOLERANCE
from navcore.foundation.errors import Fault, InputError
from navcore.networks.base import NetworkParameters
from navcore.networks.catalogue import NETWORKS
from navcore.networks.pair import Placement

LEAST_DAMPING, LARGEST_DAMPING = 0.01, 1.0
__all__ = ["LARGEST_DAMPING", "LEAST_DAMPING", "Placement", "place", "placeable"]


def place(
    parameters: NetworkParameters,
    damping_ratio: float,
    frequency: float,
    omega_s: float,
    *,
    earth_mode_decays: bool = False,
) -> Placement:
    """Set a network's parameters so that its main closed-loop pair lies where it is wanted.

    Parameters
    ----------
    parameters : NetworkParameters
        The network; what the pair does not set stays.
    damping_ratio : float
        Wanted, 0.01..1 (a pair; above 1 there is none).
    frequency : float
        Wanted natural frequency |p|, rad/s.
    omega_s : float
        Schuler frequency, rad/s.
    earth_mode_decays : bool
        Ask for H(0) = 1 and H'(0) <= 0 as well, so that the 24 h mode does not grow (theory.md 10).

    Raises
    ------
    InputError
        The network has no parameter for it, the wanted value lies outside what the parameter allows, or the
        network with that pair would let the 24 h mode grow although it must not.
    """
    if not LEAST_DAMPING <= damping_ratio <= LARGEST_DAMPING:
        allowed = f"must be >= {LEAST_DAMPING} and <= {LARGEST_DAMPING:g}"
        raise InputError(Fault("", "damping ratio", damping_ratio, allowed))
    if not (math.isfinite(frequency) and frequency > 0.0):
        raise InputError(Fault("", "frequency", frequency, "must be > 0 (rad/s)"))
    placed = parameters.with_pair(damping_ratio, frequency, omega_s)
    if placed is None:
        allowed = f"cannot be placed by a pole: use {placeable()}"
        raise InputError(Fault("", "network", parameters.id, allowed))
    if earth_mode_decays:
        _require_decay(placed, omega_s)
    return placed


def _require_decay(placed: Placement, omega_s: float) -> None:
    """Refuse a pair with which the 24 h mode grows."""
    network = placed.parameters.transfer(omega_s)
    if abs(network.h0 - 1.0) <= H0_TOLERANCE and network.h_slope <= 0.0:
        return
    found = f"H(0) = {network.h0:.4g}, H'(0) = {network.h_slope:+.4g} s"
    allowed = f"lets the 24 h mode grow ({found}): use complementary, or unity2 below omega_s"
    raise InputError(Fault("", "network", placed.parameters.id, allowed))


def placeable() -> str:
    """Names of the networks that a pole pair can place, ``"compass, ... or unity2"``."""
    *names, last = (model.placeable for model in NETWORKS.values() if model.placeable)
    return f"{', '.join(names)} or {last}"

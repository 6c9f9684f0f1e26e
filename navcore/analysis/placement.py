"""From a wanted closed-loop pole pair (damping ratio, frequency) to the parameters that give it."""

import math

from navcore.analysis.loop import H0_TOLERANCE
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.networks.base import NetworkParameters
from navcore.networks.catalogue import NETWORKS
from navcore.networks.pair import LARGEST_DAMPING, LEAST_DAMPING, Placement

__all__ = ["LARGEST_DAMPING", "LEAST_DAMPING", "Placement", "place", "placeable"]


def place(
    parameters: NetworkParameters,
    damping_ratio: float,
    frequency: float,
    omega_s: float,
    *,
    h_slope_limit_s: float | None = None,
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
    h_slope_limit_s : float, optional
        Ask for H(0) = 1 and H'(0) no larger than this as well, s; with 0 the 24 h mode does not grow
        (theory.md 10).

    Raises
    ------
    InputError
        The network has no parameter for it, the wanted value lies outside what the parameter allows, or H(0)
        or H'(0) of the network with that pair is not what is asked for.
    """
    if not LEAST_DAMPING <= damping_ratio <= LARGEST_DAMPING:
        allowed = Text(
            "must be >= {least_damping} and <= {largest_damping:g}",
            least_damping=LEAST_DAMPING,
            largest_damping=LARGEST_DAMPING,
        )
        raise InputError(Fault("", Text("damping ratio"), damping_ratio, allowed))
    if not (math.isfinite(frequency) and frequency > 0.0):
        raise InputError(Fault("", "frequency", frequency, Text("must be > 0 (rad/s)")))
    placed = parameters.with_pair(damping_ratio, frequency, omega_s)
    if placed is None:
        allowed = Text("cannot be placed by a pole: use {placeable}", placeable=placeable())
        raise InputError(Fault("", "network", parameters.id, allowed))
    if h_slope_limit_s is not None:
        _require_slope(placed, h_slope_limit_s, omega_s)
    return placed


def _require_slope(placed: Placement, limit_s: float, omega_s: float) -> None:
    """Refuse a pair whose network does not have H(0) = 1 and a slope H'(0) within the limit."""
    network = placed.parameters.transfer(omega_s)
    instead = Text("use complementary, or unity2 with a pair below ωₛ")
    if not abs(network.h0 - 1.0) <= H0_TOLERANCE:
        allowed = Text(
            "must be 1 when H'(0) is limited, and is not with this pair: {instead}", instead=instead
        )
        raise InputError(Fault("", "H(0)", float(f"{network.h0:.4g}"), allowed))
    if not network.h_slope <= limit_s:
        allowed = Text("must be <= {limit_s:.4g} (s)", limit_s=limit_s)
        if limit_s <= 0.0 < network.h_slope:
            allowed += Text(": with this pair the 24 h mode grows")
        raise InputError(
            Fault(
                "",
                "H'(0)",
                float(f"{network.h_slope:.4g}"),
                Text("{allowed}; {instead}", allowed=allowed, instead=instead),
            )
        )


def placeable() -> str:
    """Names of the networks that a pole pair can place, ``"compass, ... or unity2"``."""
    *names, last = (model.placeable for model in NETWORKS.values() if model.placeable)
    return Text("{names} or {last}", names=", ".join(names), last=last)

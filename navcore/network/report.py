"""What ``schuler network`` prints: one network on the sphere and its closed loop (contract.md)."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

from navcore.earth import SPHERE
from navcore.loop import analyse
from navcore.network.base import NetworkParameters


def network_report(parameters: NetworkParameters) -> dict[str, Any]:
    """Return the ``network --json`` document; complex numbers as [re, im], no value that JSON cannot hold.

    Raises
    ------
    InputError
        The parameters make no network.
    """
    network = parameters.transfer(SPHERE.schuler_frequency(0.0))
    loop = analyse(network)
    return {
        "id": network.id,
        "num": [float(c) for c in network.num],
        "den": [float(c) for c in network.den],
        "zeros": _pairs(network.zeros),
        "poles": _pairs(network.poles),
        "gain": network.gain,
        "h0": _finite(network.h0),
        "closed_loop_poles": _pairs(loop.poles),
        "stable": loop.stable,
        "damping_ratio": _finite(loop.damping_ratio),
        "natural_frequency_rad_s": _finite(loop.natural_frequency),
        "settling_s": loop.settling_s,
        "warnings": list(dict.fromkeys([*network.warnings, *loop.warnings])),
    }


def _pairs(values: Iterable[complex]) -> list[list[float]]:
    return [[float(v.real) + 0.0, float(v.imag) + 0.0] for v in values]


def _finite(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None

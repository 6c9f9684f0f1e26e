"""Networks of eight states: a product of two with a stable loop, and one that is a network of four states."""

from typing import Any

import numpy as np

from navcore.foundation.earth import WGS84
from navcore.networks import parse_network

OMEGA_S = WGS84.schuler_frequency(np.radians(45.0))
FOUR: dict[str, Any] = {"id": "complementary", "zeta": 0.5}


def _pairs(roots: np.ndarray) -> list[Any]:
    return [root.real if root.imag == 0.0 else [root.real, root.imag] for root in roots]


def product(omega_s: float = OMEGA_S) -> dict[str, Any]:
    """Two complementary networks in a row: H(0) = 1, eight zeros and eight poles, a stable loop."""
    parts = [parse_network(FOUR | {"zeta": zeta}).transfer(omega_s) for zeta in (0.5, 0.3)]
    roots = {name: np.concatenate([getattr(one, name) for one in parts]) for name in ("zeros", "poles")}
    return {"id": "custom", **{name: _pairs(one) for name, one in roots.items()}, "gain": 1.0}


def cancelling(omega_s: float = OMEGA_S) -> dict[str, Any]:
    """`FOUR` with four fast poles, each on a zero: eight states, and the answers of the four."""
    four = parse_network(FOUR).transfer(omega_s)
    more = omega_s * np.array([-3.0, -4.0, -3.5 + 1.0j, -3.5 - 1.0j])
    roots = {name: np.concatenate([getattr(four, name), more]) for name in ("zeros", "poles")}
    return {"id": "custom", **{name: _pairs(one) for name, one in roots.items()}, "gain": four.gain}


def polynomials(block: dict[str, Any], omega_s: float = OMEGA_S) -> tuple[list[float], list[float]]:
    """Numerator and denominator of a network in descending powers of s, rad/s."""
    network = parse_network(block).transfer(omega_s)
    return network.num.tolist(), network.den.tolist()

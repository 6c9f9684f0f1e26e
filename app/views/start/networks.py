"""The networks with a thumbnail of |H| and their trade in words, from the registry alone."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from app.plots import style
from app.plots.units import rounded, settling
from navcore.analysis import analyse, time_response
from navcore.foundation.errors import InputError
from navcore.foundation.text import Text
from navcore.foundation.units import ARCSEC
from navcore.networks import NETWORKS
from navcore.networks.base import LinearNetwork

_WIDTH, _HEIGHT = 150, 62
_LOW_DB, _HIGH_DB = -12.0, 18.0
_FIRST, _LAST = -2.0, 2.0
"""Powers of ten of the frequency over omega_s at the ends."""
_STEP_H = 12.0


@dataclass(frozen=True)
class NetworkCard:
    """One network with its default parameters.

    Attributes
    ----------
    id, title : str
        In the registry, and in words.
    svg : str
        |H| over the frequency.
    trade : str
        What it gives, and what it costs.
    """

    id: str
    title: str
    svg: str
    trade: str


@lru_cache(maxsize=4)
def network_cards(omega_s: float) -> tuple[NetworkCard, ...]:
    """Cards of all registered networks, in their order, for a Schuler frequency in rad/s."""
    return tuple(_card(id, omega_s) for id in NETWORKS)


def _card(id: str, omega_s: float) -> NetworkCard:
    kind = NETWORKS[id]
    title = str(getattr(kind, "title", "") or id)
    try:
        network = kind.model_validate({"id": id}).transfer(omega_s)
    except (InputError, ValueError, NotImplementedError) as error:
        return NetworkCard(id, title, "", Text("Needs parameters of its own: {error}.", error=error))
    power = np.linspace(_FIRST, _LAST, 120)
    gain_db = 20.0 * np.log10(np.abs(network.response(omega_s * 10.0**power)))
    return NetworkCard(id, title, _svg(power, gain_db), _trade(network, gain_db))


def _trade(network: LinearNetwork, gain_db: np.ndarray) -> str:
    loop = analyse(network)
    times = np.linspace(0.0, _STEP_H * 3600.0, 800)
    tilt = float(np.max(np.abs(time_response(network, "dv_r", "phi", times)))) / ARCSEC
    if loop.settling_s is None:
        return "Does not damp: an oscillation goes on for ever. The log has no influence on the tilt."
    peak = float(np.max(gain_db))
    gain = (
        Text("|H| rises to {peak} dB", peak=rounded(peak, 2)) if peak > 0.1 else "|H| stays at or below 0 dB"
    )
    return Text(
        "Settles to 2 % in {settling}, least damping ratio {damping}. {gain}; a step "
        "of the log's error by 1 m/s tilts it by up to {tilt} arcsec.",
        settling=settling(loop.settling_s),
        damping=rounded(loop.damping_ratio, 2),
        gain=gain,
        tilt=rounded(tilt, 2),
    )


def _svg(power: np.ndarray, gain_db: np.ndarray) -> str:
    x = _WIDTH * (power - _FIRST) / (_LAST - _FIRST)
    y = _HEIGHT * (_HIGH_DB - np.clip(gain_db, _LOW_DB, _HIGH_DB)) / (_HIGH_DB - _LOW_DB)
    points = " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(x, y, strict=True))
    zero, schuler = _HEIGHT * _HIGH_DB / (_HIGH_DB - _LOW_DB), _WIDTH * (0.0 - _FIRST) / (_LAST - _FIRST)
    return (
        f'<svg viewBox="0 0 {_WIDTH} {_HEIGHT}" role="img"><title>|H| from {_LOW_DB:g} to {_HIGH_DB:g} dB over '
        f'the frequency; the dashed line is the Schuler frequency</title><path d="M0 {zero:.1f}H{_WIDTH}" '
        f'stroke="{style.GRID}"/><path d="M{schuler:.1f} 0V{_HEIGHT}" stroke="{style.REFERENCE}" '
        f'stroke-dasharray="3 3"/><polyline points="{points}" fill="none" '
        f'stroke="{style.METHOD_COLORS[0]}" stroke-width="1.8"/></svg>'
    )

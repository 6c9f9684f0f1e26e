"""Small pictures: presets by their own runs, networks by |H| from the registry, with their trade in words.

``python -m schuler_bench.views.start.cards`` makes those of the presets anew.
"""

import re
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import numpy as np

from navcore.analysis import analyse
from navcore.analysis.frequencies import curve_frequencies
from navcore.analysis.judged import JudgedLoop, loop_value
from navcore.engine.run import Run
from navcore.foundation.assets import asset_path
from navcore.foundation.errors import InputError
from navcore.foundation.offered import when_changed
from navcore.foundation.text import Text
from navcore.foundation.units import ARCSEC
from navcore.mechanization.recorder import DV_E, DV_N
from navcore.networks import NETWORKS
from navcore.networks.base import LinearNetwork
from navcore.scenario.file import load, presets, scenario_hash
from schuler_bench.plots import style
from schuler_bench.plots.units import duration, rounded, settling
from schuler_bench.session.display import Display

_WIDE, _HIGH = 150, 62
_LOW_DB, _HIGH_DB = -12.0, 18.0
_FIRST, _LAST = -2.0, 2.0
"""Powers of ten of the frequency over omega_s at the ends."""


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


when_changed(network_cards.cache_clear)


def _card(id: str, omega_s: float) -> NetworkCard:
    kind = NETWORKS[id]
    title = str(getattr(kind, "title", "") or id)
    try:
        network = kind.model_validate({"id": id}).transfer(omega_s)
    except (InputError, ValueError, NotImplementedError) as error:
        return NetworkCard(id, title, "", Text("Needs parameters of its own: {error}.", error=error))
    even = omega_s * np.logspace(_FIRST, _LAST, 120)
    omega = curve_frequencies(even, (network.zeros, network.poles))
    gain_db = 20.0 * np.log10(np.abs(network.response(omega)))
    return NetworkCard(id, title, _svg(np.log10(omega / omega_s), gain_db), _trade(network, gain_db))


def _trade(network: LinearNetwork, gain_db: np.ndarray) -> str:
    loop = analyse(network)
    tilt = loop_value("log_tilt", JudgedLoop(network, loop, True)) / ARCSEC
    if loop.settling_s is None:
        return Text("Does not damp: an oscillation goes on for ever. The log has no influence on the tilt.")
    peak = float(np.max(gain_db))
    gain = (
        Text("|H| rises to {peak} dB", peak=rounded(peak, 2))
        if peak > 0.1
        else Text("|H| stays at or below 0 dB")
    )
    return Text(
        "The tilt settles to 2 % in {settling}, least damping ratio {damping}. {gain}; a step "
        "of the log's error by 1 m/s tilts it by up to {tilt} arcsec.",
        settling=settling(loop.settling_s),
        damping=rounded(loop.damping_ratio, 2),
        gain=gain,
        tilt=rounded(tilt, 2),
    )


def _svg(power: np.ndarray, gain_db: np.ndarray) -> str:
    x = _WIDE * (power - _FIRST) / (_LAST - _FIRST)
    y = _HIGH * (_HIGH_DB - np.clip(gain_db, _LOW_DB, _HIGH_DB)) / (_HIGH_DB - _LOW_DB)
    points = " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(x, y, strict=True))
    zero, schuler = (
        _HIGH * _HIGH_DB / (_HIGH_DB - _LOW_DB),
        _WIDE * (0.0 - _FIRST) / (_LAST - _FIRST),
    )
    return Text(
        '<svg viewBox="0 0 {wide} {high}" role="img"><title>|H| from {low_db:g} to {high_db:g} '
        'dB over the frequency; the dashed line is the Schuler frequency</title><path d="M0 '
        '{zero:.1f}H{wide}" stroke="{grid}"/><path d="M{schuler:.1f} 0V{high}" '
        'stroke="{reference}" stroke-dasharray="3 3"/><polyline points="{points}" fill="none" '
        'stroke="{method_colors}" stroke-width="1.8"/></svg>',
        wide=_WIDE,
        high=_HIGH,
        low_db=_LOW_DB,
        high_db=_HIGH_DB,
        zero=zero,
        grid=style.GRID,
        schuler=schuler,
        reference=style.REFERENCE,
        points=points,
        method_colors=style.METHOD_COLORS[0],
    )


WIDTH, HEIGHT = 240, 84
_TITLE = re.compile("<title ([^<>/]*+)/>")
_BINS = 80
_EDGE = 3.0


def card_path(name: str) -> Path:
    """File of a preset's picture."""
    return asset_path("cards") / f"{name}.svg"


def mark(name: str) -> str:
    """Mark of a picture's preset: the beginning of its hash."""
    return scenario_hash(load(name))[:16]


def card_svg(run: Run, of: str) -> str:
    """Draw the velocity error of all methods: the one of east and north that is larger.

    Parameters
    ----------
    run : Run
        Of the preset.
    of : str
        `mark` of the preset.
    """
    good = [m.plot.values for m in run.methods if m.status == "ok"]
    peaks = {
        column: max((float(np.nanmax(np.abs(values[:, column]))) for values in good), default=0.0)
        for column in (DV_E, DV_N)
    }
    column = max(peaks, key=lambda each: peaks[each])
    peak, span = peaks[column] or 1.0, float(run.t_s[-1]) or 1.0
    symbol = "δVE" if column == DV_E else "δVN"
    lines = "".join(
        f'<polyline points="{_points(m.plot.t_s / span, m.plot.values[:, column] / peak)}" '
        f'stroke="{style.method_color(m.place)}"/>'
        for m in Display().placed(run).methods
    )
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" role="img" data-of="{of}">'
        f'<title data-symbol="{symbol}" data-count="{len(run.methods)}" data-peak="{rounded(peak)}" '
        f'data-span="{duration(span)}"/><path d="M0 {HEIGHT / 2:g}H{WIDTH}" stroke="{style.GRID}"/>'
        f'<g fill="none" stroke-width="1.4" stroke-linejoin="round">{lines}</g></svg>\n'
    )


def card(name: str) -> str:
    """HTML of a preset's picture with its title; empty where there is none."""
    path = card_path(name)
    if not path.exists():
        return ""
    before, values, after = _TITLE.split(path.read_text(encoding="utf-8"))
    words = Text(
        "Velocity error {symbol} of {count} methods, up to {peak} m/s in {span}",
        **dict(re.findall(r'data-(\w+)="([^"]*)"', values)),
    )
    return Text("{before}<title>{words:html}</title>{after}", before=before, words=words, after=after)


def _points(at: np.ndarray, values: np.ndarray) -> str:
    """Both extremes of each bin, so that noise keeps its width."""
    points: list[str] = []
    heights = HEIGHT / 2 - values * (HEIGHT / 2 - _EDGE)
    for part in np.array_split(np.arange(len(at)), min(_BINS, max(len(at) // 2, 1))):
        drawn = part[np.isfinite(values[part]) & (np.abs(values[part]) <= 1.001)]
        if len(drawn):
            ends = sorted({int(drawn[np.argmin(values[drawn])]), int(drawn[np.argmax(values[drawn])])})
            points += [f"{WIDTH * at[k]:.0f},{heights[k]:.1f}" for k in ends]
    return " ".join(points)


def main() -> None:
    """Write all pictures anew."""
    from navcore.engine.simulation import simulate

    asset_path("cards").mkdir(exist_ok=True)
    for name in presets():
        card_path(name).write_text(card_svg(simulate(load(name)), mark(name)), encoding="utf-8")


if __name__ == "__main__":
    main()

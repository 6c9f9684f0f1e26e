"""Small pictures of the presets, made from their own runs by ``python -m app.views.start.cards``."""

from __future__ import annotations

from html import escape
from pathlib import Path

import numpy as np

from app.plots import style
from app.plots.units import duration, rounded
from navcore.engine.run import Run
from navcore.foundation.assets import asset_path
from navcore.foundation.text import Text
from navcore.mechanization.recorder import DV_E, DV_N
from navcore.scenario.file import load, presets, scenario_hash

WIDTH, HEIGHT = 240, 84
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
        f'stroke="{style.method_color(i)}"/>'
        for i, m in enumerate(run.methods)
    )
    words = Text(
        "Velocity error {symbol} of {count} methods, up to {peak} m/s in {span}",
        symbol=symbol,
        count=len(run.methods),
        peak=rounded(peak),
        span=duration(span),
    )
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" role="img" data-of="{of}">'
        f'<title>{escape(words)}</title><path d="M0 {HEIGHT / 2:g}H{WIDTH}" stroke="{style.GRID}"/>'
        f'<g fill="none" stroke-width="1.4" stroke-linejoin="round">{lines}</g></svg>\n'
    )


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

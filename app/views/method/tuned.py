"""The table that Sun's double loop found, beside the paper's: damping over velocity difference."""

from __future__ import annotations

from html import escape
from typing import TYPE_CHECKING

from app.plots import style
from app.plots.table import cell, row, table
from app.plots.units import number, round_up
from navcore.law.policy.adaptive import SUN_TABLE

if TYPE_CHECKING:
    from navcore.design.sun import Tuning

WIDTH, HEIGHT = 312, 190
_LEFT, _RIGHT, _TOP, _BOTTOM = 40, 10, 24, 36
_MARKS = (1.0, 1.2, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0)


def table_svg(tuning: Tuning, color: str) -> str:
    """Our coefficients as dots and a line, Sun's Table 1 dashed."""
    rows = [tuple(row) for row in tuning.rows()]
    across = round_up(max(*(kn for kn, _ in rows), SUN_TABLE[-1][0]), _MARKS)
    high = round_up(max(*(xi for _, xi in rows), *(xi for _, xi in SUN_TABLE)), _MARKS)
    width, height = WIDTH - _LEFT - _RIGHT, HEIGHT - _TOP - _BOTTOM

    def at(kn: float, xi: float) -> tuple[float, float]:
        return _LEFT + width * kn / across, _TOP + height * (1.0 - xi / high)

    def line(points: list[tuple[float, ...]], stroke: str, dash: str = "none") -> str:
        drawn = " ".join(f"{x:.1f},{y:.1f}" for x, y in (at(kn, xi) for kn, xi in points))
        return (
            f'<polyline points="{drawn}" fill="none" stroke="{stroke}" stroke-width="2" '
            f'stroke-dasharray="{dash}"/>'
        )

    dots = "".join(
        f'<circle class="sb-found" cx="{x:.1f}" cy="{y:.1f}" r="3" fill="{color}"/>'
        for x, y in (at(kn, xi) for kn, xi in rows)
    )
    sun = [tuple(row) for row in SUN_TABLE]
    return (
        f'<svg viewBox="0 0 {WIDTH} {HEIGHT}" width="{WIDTH}" height="{HEIGHT}" role="img" '
        f'style="max-width:100%" aria-label="damping ratio over velocity difference, found and Sun\'s" '
        f'font-family="{style.FONT_FAMILY.replace(chr(34), chr(39))}" font-size="12.5" fill="{style.INK}">'
        f"{_axes(across, high, at)}"
        f"{line(sun, style.MUTED, dash='6 4')}{line(rows, color)}{dots}"
        f'<line x1="{_LEFT + 60}" y1="10" x2="{_LEFT + 82}" y2="10" stroke="{color}" stroke-width="2"/>'
        f'<text x="{_LEFT + 87}" y="14">found</text>'
        f'<line x1="{_LEFT + 140}" y1="10" x2="{_LEFT + 162}" y2="10" stroke="{style.MUTED}" '
        f'stroke-width="1.6" stroke-dasharray="6 4"/><text x="{_LEFT + 167}" y="14">Sun, Table 1</text></svg>'
    )


def _axes(across: float, high: float, at) -> str:
    (x0, y0), (x1, y1) = at(0.0, 0.0), at(across, high)
    parts = [f'<path d="M{x0} {y1} V{y0} H{x1}" fill="none" stroke="{style.REFERENCE}"/>']
    for part in (0.0, 0.5, 1.0):
        x, y = at(part * across, part * high)
        parts.append(
            f'<text x="{x:.1f}" y="{y0 + 15:.1f}" text-anchor="middle">{number(part * across, 3)}</text>'
            f'<text x="{x0 - 5:.1f}" y="{y + 4:.1f}" text-anchor="end">{number(part * high, 3)}</text>'
        )
        if part:
            parts.append(f'<path d="M{x0} {y:.1f} H{x1}" stroke="{style.GRID}"/>')
    parts.append(
        f'<text x="{0.5 * (x0 + x1):.1f}" y="{HEIGHT - 4}" text-anchor="middle">'
        f'velocity difference (kn)</text><text x="4" y="14">ζ (–)</text>'
    )
    return "".join(parts)


def table_html(tuning: Tuning, color: str) -> str:
    """The plot, the rows, and what the user should know about them."""
    head = row(cell(title, "sb-n", tag="th") for title in ("difference (kn)", "ζ found", "Sun"))
    body = [
        row(cell(text, "sb-n") for text in (number(kn, 3), number(xi, 3), number(his, 2)))
        for kn, xi, his in tuning.beside_sun()
    ]
    warnings = "".join(f"<li>{escape(text)}</li>" for text in tuning.warnings)
    return (
        f'<div class="sb-tuned">{table_svg(tuning, color)}'
        f"<details><summary>table</summary>{table([head], body)}</details>"
        f"{f'<ul>{warnings}</ul>' if warnings else ''}</div>"
    )

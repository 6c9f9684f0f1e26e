"""The table that Sun's double loop found, beside the paper's: damping over velocity difference."""

from __future__ import annotations

from typing import TYPE_CHECKING

from navcore.foundation.text import Text
from navcore.law.policy.adaptive import SUN_TABLE
from schuler_bench.plots import style
from schuler_bench.plots.svg_axes import picture, word
from schuler_bench.plots.table import cell, row, table
from schuler_bench.plots.units import number, round_up

if TYPE_CHECKING:
    from navcore.design.sun import Tuning

WIDTH, HEIGHT = 312, 190
_LEFT, _RIGHT, _TOP, _BOTTOM = 40, 10, 24, 36
_TOLD = Text("damping ratio over velocity difference, found and Sun's")
_MARKS = (1.0, 1.2, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0)


def table_svg(tuning: Tuning, color: str) -> str:
    """Our coefficients as dots and a line, Sun's Table 1 dashed."""
    rows = [tuple(row) for row in tuning.pairs()]
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
    parts = (
        _axes(across, high, at),
        line(sun, style.MUTED, dash="6 4") + line(rows, color) + dots,
        f'<line x1="{_LEFT + 60}" y1="10" x2="{_LEFT + 82}" y2="10" stroke="{color}" stroke-width="2"/>',
        word(_LEFT + 87, 14, Text("found")),
        f'<line x1="{_LEFT + 140}" y1="10" x2="{_LEFT + 162}" y2="10" stroke="{style.MUTED}" '
        'stroke-width="1.6" stroke-dasharray="6 4"/>',
        word(_LEFT + 167, 14, Text("Sun, Table 1")),
    )
    return picture(WIDTH, HEIGHT, _TOLD, parts)


def _axes(across: float, high: float, at) -> str:
    (x0, y0), (x1, y1) = at(0.0, 0.0), at(across, high)
    parts = [f'<path d="M{x0} {y1} V{y0} H{x1}" fill="none" stroke="{style.REFERENCE}"/>']
    for part in (0.0, 0.5, 1.0):
        x, y = at(part * across, part * high)
        parts.append(word(x, y0 + 15, number(part * across, 3), "middle"))
        parts.append(word(x0 - 5, y + 4, number(part * high, 3), "end"))
        if part:
            parts.append(f'<path d="M{x0} {y:.1f} H{x1}" stroke="{style.GRID}"/>')
    parts.append(word(0.5 * (x0 + x1), HEIGHT - 4, Text("velocity difference (kn)"), "middle"))
    parts.append(word(4, 14, "ζ (–)"))
    return Text.joined("", parts)


def table_html(tuning: Tuning, color: str) -> str:
    """The plot, the rows, and what the user should know about them."""
    head = row(cell(title, "sb-n", tag="th") for title in (Text("difference (kn)"), "ζ found", "Sun"))
    body = [
        row(cell(text, "sb-n") for text in (number(kn, 3), number(xi, 3), number(his, 2)))
        for kn, xi, his in tuning.beside_sun()
    ]
    warnings = Text.joined("", (Text("<li>{text:html}</li>", text=text) for text in tuning.warnings))
    listed = Text("<ul>{warnings}</ul>", warnings=warnings) if warnings else ""
    return Text(
        '<div class="sb-tuned">{table_svg}<details><summary>table</summary>{table}</details>{listed}</div>',
        table_svg=table_svg(tuning, color),
        table=table([head], body),
        listed=listed,
    )

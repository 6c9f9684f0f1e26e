"""The table that Sun's double loop found, beside the paper's: damping over velocity difference."""

from __future__ import annotations

from typing import TYPE_CHECKING

from app.plots import style
from app.plots.table import cell, row, table
from app.plots.units import number, round_up
from navcore.foundation.text import Text
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
        return Text(
            '<polyline points="{drawn}" fill="none" stroke="{stroke}" stroke-width="2" '
            'stroke-dasharray="{dash}"/>',
            drawn=drawn,
            stroke=stroke,
            dash=dash,
        )

    dots = Text.joined(
        "",
        (
            Text(
                '<circle class="sb-found" cx="{x:.1f}" cy="{y:.1f}" r="3" fill="{color}"/>',
                x=x,
                y=y,
                color=color,
            )
            for x, y in (at(kn, xi) for kn, xi in rows)
        ),
    )
    sun = [tuple(row) for row in SUN_TABLE]
    return Text(
        '<svg viewBox="0 0 {width} {height}" width="{width}" height="{height}" role="img" '
        'style="max-width:100%" aria-label="damping ratio over velocity difference, found and '
        'Sun\'s" font-family="{replace}" font-size="12.5" fill="{ink}">'
        '{axes}{line}{line2}{dots}<line x1="{left}" y1="10" x2="{left2}" y2="10" '
        'stroke="{color}" stroke-width="2"/><text x="{left3}" y="14">found</text><line '
        'x1="{left4}" y1="10" x2="{left5}" y2="10" stroke="{muted}" stroke-width="1.6" '
        'stroke-dasharray="6 4"/><text x="{left6}" y="14">Sun, Table 1</text></svg>',
        width=WIDTH,
        height=HEIGHT,
        replace=style.FONT_FAMILY.replace(chr(34), chr(39)),
        ink=style.INK,
        axes=_axes(across, high, at),
        line=line(sun, style.MUTED, dash="6 4"),
        line2=line(rows, color),
        dots=dots,
        left=_LEFT + 60,
        left2=_LEFT + 82,
        color=color,
        left3=_LEFT + 87,
        left4=_LEFT + 140,
        left5=_LEFT + 162,
        muted=style.MUTED,
        left6=_LEFT + 167,
    )


def _axes(across: float, high: float, at) -> str:
    (x0, y0), (x1, y1) = at(0.0, 0.0), at(across, high)
    parts = [
        Text(
            '<path d="M{x0} {y1} V{y0} H{x1}" fill="none" stroke="{reference}"/>',
            x0=x0,
            y1=y1,
            y0=y0,
            x1=x1,
            reference=style.REFERENCE,
        )
    ]
    for part in (0.0, 0.5, 1.0):
        x, y = at(part * across, part * high)
        parts.append(
            Text(
                '<text x="{x:.1f}" y="{y0:.1f}" text-anchor="middle">{part}</text><text x="{x0:.1f}" '
                'y="{y:.1f}" text-anchor="end">{part2}</text>',
                x=x,
                y0=y0 + 15,
                part=number(part * across, 3),
                x0=x0 - 5,
                y=y + 4,
                part2=number(part * high, 3),
            )
        )
        if part:
            parts.append(
                Text('<path d="M{x0} {y:.1f} H{x1}" stroke="{grid}"/>', x0=x0, y=y, x1=x1, grid=style.GRID)
            )
    parts.append(
        Text(
            '<text x="{x0:.1f}" y="{height}" text-anchor="middle">velocity difference (kn)</text>'
            '<text x="4" y="14">ζ (–)</text>',
            x0=0.5 * (x0 + x1),
            height=HEIGHT - 4,
        )
    )
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

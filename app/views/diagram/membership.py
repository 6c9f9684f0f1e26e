"""Liu's membership functions of the variation s, and what the policy does with them (Liu 2021, figure 8)."""

import numpy as np

from navcore.foundation.text import Text
from navcore.law.policy.variation import Variation
from schuler_bench.plots import style
from schuler_bench.plots.svg_axes import Box, Curve, axes, key, word
from schuler_bench.plots.units import number

WIDTH, HEIGHT = 780, 178
_BOX = Box(46, 34, 700, 92)
_BELOW = 18.0
"""Height of the strip with what is decided."""
_TOLD = Text("membership functions small, medium and large of the variation, and what is decided")
_COLORS = style.METHOD_COLORS[:3]
_NAMES = (Text("small"), Text("medium"), Text("large"))


def memberships(policy: Variation, s: np.ndarray) -> np.ndarray:
    """Values of small, medium and large for variations s (m/s), shape (3, n)."""
    a, b, c = policy.a, policy.b, policy.c
    small = np.interp(s, [a, b], [1.0, 0.0])
    large = np.interp(s, [b, c], [0.0, 1.0])
    return np.stack([small, np.interp(s, [a, b, c], [0.0, 1.0, 0.0]), large])


def membership_svg(policy: Variation) -> str:
    """Draw the three functions over s, and below them where the wish is damped, unchanged and undamped."""
    last = 1.5 * policy.c
    s = np.array([0.0, policy.a, policy.b, policy.c, last])
    curves = [Curve(s, values, color) for values, color in zip(memberships(policy, s), _COLORS, strict=True)]
    decided = (
        (0.0, policy.a, Text("damp"), _COLORS[0]),
        (policy.a, policy.c, Text("as it is"), style.REFERENCE),
        (policy.c, last, Text("do not damp"), _COLORS[2]),
    )
    parts = [axes(_BOX, curves, least=1.0, ends=(0.0, last))]
    parts += [
        key(_BOX.left + 90.0 * k, 16.0, color, name)
        for k, (name, color) in enumerate(zip(_NAMES, _COLORS, strict=True))
    ]
    for sign, value in (("a", policy.a), ("b", policy.b), ("c", policy.c)):
        x = _at(value, last)
        parts.append(
            f'<path d="M{x:.1f} {_BOX.top}v{_BOX.height}" stroke="{style.MUTED}" stroke-dasharray="3 3"/>'
        )
        parts.append(word(x, _BOX.top - 5.0, f"{sign} = {number(value, 3)}", "middle"))
    top = _BOX.top + _BOX.height + 26.0
    for begin, end, name, color in decided:
        x0, x1 = _at(begin, last), _at(end, last)
        parts.append(
            f'<rect x="{x0:.1f}" y="{top}" width="{x1 - x0:.1f}" height="{_BELOW}" fill="{color}" '
            f'fill-opacity="0.25" stroke="{color}"/>'
        )
        parts.append(word(0.5 * (x0 + x1), top + 13.0, name, "middle"))
    right, foot = _BOX.left + _BOX.width, _BOX.top + _BOX.height
    parts.append(word(right, foot + 15.0, Text("variation s (m/s)"), "end"))
    return picture(WIDTH, HEIGHT, _TOLD, parts)


def _at(value: float, last: float) -> float:
    return _BOX.left + _BOX.width * value / last


def picture(width: int, height: int, told: str, parts: list[str]) -> str:
    """Put parts into an SVG of a size in px; ``told`` says in words what it shows."""
    return Text(
        '<svg class="sb-beneath" viewBox="0 0 {width} {height}" role="img" '
        'xmlns="http://www.w3.org/2000/svg" font-family="{font}" font-size="12" fill="{ink}" '
        'aria-label="{told:html}">{parts}</svg>',
        width=width,
        height=height,
        font=style.SVG_FONT,
        ink=style.INK,
        told=told,
        parts=Text.joined("", parts),
    )

"""What colours of the light page become on the dark one, and how they contrast.

The dark page is the light one with its lightness turned round (``invert``) and its hues turned back
(``hue-rotate``): the blue method is blue in both, in plots, tables, controls and the 3D view. What a colour
becomes is computed here with the browser's own matrices (CSS Filter Effects 1).
"""

import math
from typing import Literal

from schuler_bench.plots.style import rgb
from schuler_bench.views.appearance.view import _INVERT

Theme = Literal["light", "dark"]
HUE_DEG = 180.0
LEAST_TEXT, LEAST_CURVE = 4.5, 3.0
"""Contrast that WCAG 2.2 asks for: of text (1.4.3, AA) and of graphical objects (1.4.11)."""

Color = tuple[float, float, float]


def shown(color: str, theme: Theme) -> Color:
    """What the eye gets of a colour ``#RRGGBB``: red, green, blue, 0..1."""
    light = tuple(part / 255.0 for part in rgb(color))
    if theme == "light":
        return light[0], light[1], light[2]
    inverted = [part * (1.0 - 2.0 * _INVERT) + _INVERT for part in light]
    turned = [sum(a * b for a, b in zip(row, inverted, strict=True)) for row in _hue_matrix()]
    red, green, blue = (min(max(part, 0.0), 1.0) for part in turned)
    return red, green, blue


def contrast(one: Color, other: Color) -> float:
    """Contrast ratio of two colours, 1 to 21 (WCAG 2.2).

    Examples
    --------
    >>> contrast((0.0, 0.0, 0.0), (1.0, 1.0, 1.0))
    21.0
    """
    lighter, darker = sorted((_luminance(one), _luminance(other)), reverse=True)
    return (lighter + 0.05) / (darker + 0.05)


def _luminance(color: Color) -> float:
    red, green, blue = (
        part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in color
    )
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue


def _hue_matrix() -> tuple[Color, Color, Color]:
    """Matrix of ``hue-rotate`` (CSS Filter Effects 1, 8.5)."""
    c, s = math.cos(math.radians(HUE_DEG)), math.sin(math.radians(HUE_DEG))
    return (
        (0.213 + 0.787 * c - 0.213 * s, 0.715 - 0.715 * c - 0.715 * s, 0.072 - 0.072 * c + 0.928 * s),
        (0.213 - 0.213 * c + 0.143 * s, 0.715 + 0.285 * c + 0.140 * s, 0.072 - 0.072 * c - 0.283 * s),
        (0.213 - 0.213 * c - 0.787 * s, 0.715 - 0.715 * c + 0.715 * s, 0.072 + 0.928 * c + 0.072 * s),
    )

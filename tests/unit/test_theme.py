"""Both themes read well: text against its ground 4.5 to 1, curves 3 to 1 (WCAG 2.2), hues kept."""

import colorsys
import re
from pathlib import Path

import pytest

import schuler_bench
from schuler_bench.plots import style
from schuler_bench.plots.style import METHOD_COLORS
from schuler_bench.session.pins import COLORS
from schuler_bench.shell import notices
from tests import dark_page as theme

WHITE = "#FFFFFF"
BOTH = pytest.mark.parametrize("shown", ["light", "dark"])
LESSONS = Path(schuler_bench.__file__).parent / "views" / "learn" / "learn.css"


def rules() -> list[tuple[str, str, str]]:
    """Selector, text and ground of every rule of ours that names a colour of text."""
    found = []
    for selector, body in re.findall(r"([^{}]+)\{([^{}]*)\}", LESSONS.read_text()):
        ink = re.search(r"(?<![-\w])color: (#[0-9a-f]{3,6})\b", body)
        ground = re.search(r"background: (#[0-9a-f]{3,6})\b", body)
        if ink:
            found.append((selector.strip(), full(ink.group(1)), full(ground.group(1)) if ground else WHITE))
    return found


def full(color: str) -> str:
    return color if len(color) == 7 else "#" + "".join(2 * digit for digit in color[1:])


TEXTS = [
    *((f"banner of a flipped pin, {name}", WHITE, color) for name, color in COLORS.items()),
    *(
        (f"text {ink} on {ground}", ink, ground)
        for ink in (style.INK, style.MUTED, style.DANGER, style.TRUTH_COLOR)
        for ground in (WHITE, style.SEA)
    ),
    *((f"note, {tone}", *colors) for tone, colors in notices._TONES.items()),
    *rules(),
]


@BOTH
@pytest.mark.parametrize(
    ("ink", "ground", "least"),
    [pytest.param(*colors, theme.LEAST_TEXT, id=name) for name, *colors in TEXTS]
    + [pytest.param(color, WHITE, theme.LEAST_CURVE, id=f"curve {color}") for color in METHOD_COLORS],
)
def test_it_stands_out_from_its_ground(ink: str, ground: str, least: float, shown: theme.Theme) -> None:
    assert theme.contrast(theme.shown(ink, shown), theme.shown(ground, shown)) >= least


@pytest.mark.parametrize("color", METHOD_COLORS)
def test_a_method_keeps_its_hue_in_the_dark(color: str) -> None:
    hue, _, saturation = colorsys.rgb_to_hls(*theme.shown(color, "light"))
    dark, _, _ = colorsys.rgb_to_hls(*theme.shown(color, "dark"))
    if saturation < 0.05:
        return
    # hue-rotate keeps luminance rather than the HLS hue: within 30 degrees a colour has the same name.
    assert min(abs(hue - dark), 1 - abs(hue - dark)) * 360 < 30


def test_light_and_dark_are_far_apart() -> None:
    assert theme.contrast(theme.shown(WHITE, "dark"), theme.shown(WHITE, "light")) > 15
    assert theme.contrast(theme.shown("#000000", "dark"), theme.shown(WHITE, "dark")) > 14

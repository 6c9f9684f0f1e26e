"""Where things stand on the page, from the size of the browser's window."""

import re
from dataclasses import dataclass, replace

SMALLEST = (640, 400)
LARGEST = (7680, 4320)
SMALLEST_ALONE = (240, 160)
"""Of a view that fills the window: it may stand in a small frame of another page."""
WIDE_FROM_PX = 1600
"""From this width on the plots stand in two panels above each other; below, in one column of tabs."""

# Measured in the page (tests/browser/test_page_layout.py holds them against it).
_COLUMN_PADDING_PX = 12
"""Between the edges of a column and its plots, both sides together."""
_CHROME_PX = {True: 53, False: 58}
"""Handles and tabs above a panel's content: of one of two panels, of a single one."""
_MARGIN_PX = 18
"""Above and below a panel's content."""
_LOOK_PX = 21
"""The line at the top of a tab that says what to look for."""
_PRESENTED_PX = 560.0
"""Height for which a page in presentation size is laid out: it is enlarged to the window's."""
_TOUCH_PX = 30
"""More height of tabs and of the tools above a plot, where a finger must hit them (static/touch.css)."""
_TABS_PX = 28
"""A second row of tabs in its column."""
_LEAST_SCALE, _MOST_SCALE = 1.25, 4.0
CHOOSER_PX = 36
"""A chooser above a plot."""
TOOLS = '<div class="sb-tools"></div>'
"""HTML that lets the controls of a tab stand in one row (static/page.css)."""
Window = tuple[int, int, bool, bool]
"""Width and height, CSS pixels; whether one view fills it; whether a finger is the pointer."""


@dataclass(frozen=True)
class Layout:
    """Sizes in CSS pixels, before the page is enlarged.

    Attributes
    ----------
    scale : float
        By which type, lines and all sizes are enlarged; 1 but in presentation size.
    touch : bool
        A finger is the pointer.
    alone : bool
        One view fills the window.
    wide : bool
        Two panels above each other; else one.
    left_px, right_px : int
        Widths of the columns.
    plot_px : int
        Width of a plot.
    room_px : int
        Height for a panel's content.
    view_px : (int, int)
        Width and height of the 3D view between the columns.
    """

    wide: bool
    left_px: int
    right_px: int
    plot_px: int
    room_px: int
    view_px: tuple[int, int]
    scale: float = 1.0
    touch: bool = False
    alone: bool = False

    def aspect(self, taken_px: int = 0) -> float:
        """Height / width of a plot that fills the panel, ``taken_px`` being used by something else."""
        return max(self.room_px - taken_px, 160) / self.plot_px


def layout_for(
    width: int, height: int, alone: bool = False, touch: bool = False, *, presentation: bool = False
) -> Layout:
    """Arrange the page for a window of this size (CSS pixels); ``alone``: one view fills it, in normal size.

    In presentation size a text is as high in every window, as a part of the window's height.

    Examples
    --------
    >>> layout_for(1920, 1080).wide, layout_for(1366, 768).wide
    (True, False)
    >>> layout_for(1280, 720, presentation=True).scale, layout_for(1920, 1080, presentation=True).scale
    (1.29, 1.93)
    """
    if alone:
        size = width, height
        room = max(height - _MARGIN_PX, 120)
        return Layout(False, 320, width, width - _COLUMN_PADDING_PX, room, size, alone=True)
    if presentation:
        return _presented(width, height)
    if touch:
        mouse = layout_for(width, height)
        return replace(mouse, room_px=max(mouse.room_px - _TOUCH_PX, 200), touch=True)
    wide = width >= WIDE_FROM_PX
    left = 360 if width >= 1500 else 340 if width >= 1300 else 320
    right = width // 2 if wide else max(360, min(round(0.5 * width), width - left - 260))
    room = (height // 2 if wide else height) - _CHROME_PX[wide] - _MARGIN_PX - _LOOK_PX
    view = max(width - left - right, 120), height
    return Layout(wide, left, right, right - _COLUMN_PADDING_PX, max(room, 200), view)


def _presented(width: int, height: int) -> Layout:
    """One column of plots, and a narrow one for the few controls."""
    scale = round(min(max(height / _PRESENTED_PX, _LEAST_SCALE), _MOST_SCALE), 2)
    across, down = int(width / scale), int(height / scale)
    left, right = min(300, round(0.3 * across)), round(0.48 * across)
    room = down - _CHROME_PX[False] - _TABS_PX - _MARGIN_PX
    view = max(across - left - right, 120), down
    return Layout(False, left, right, right - _COLUMN_PADDING_PX, max(room, 200), view, scale)


def read_state(text: str) -> tuple[Window | None, tuple[str, ...]]:
    """Window size, whether one view fills it, whether a finger is the pointer, and front tabs.

    Returns (None, ()) for anything else than what the page reports.

    Examples
    --------
    >>> read_state("1920x1080|Frequency|Errors")
    ((1920, 1080, False, False), ('Frequency', 'Errors'))
    >>> read_state("480x320 alone|Method|Poles")
    ((480, 320, True, False), ('Method', 'Poles'))
    >>> read_state("1180x820 touch|Errors")
    ((1180, 820, False, True), ('Errors',))
    >>> read_state("hello")
    (None, ())
    """
    size, *tabs = text.strip().split("|")
    found = re.fullmatch(r"([0-9]{1,5})x([0-9]{1,5})( alone)?( touch)?", size)
    if found is None:
        return None, ()
    smallest = SMALLEST_ALONE if found[3] else SMALLEST
    width, height = (
        min(max(int(number), low), high)
        for number, low, high in zip(found.groups()[:2], smallest, LARGEST, strict=True)
    )
    return (width, height, found[3] is not None, found[4] is not None), tuple(tabs[:20])

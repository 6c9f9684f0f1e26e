"""Where things stand on the page, from the size of the browser's window."""

import re
from dataclasses import dataclass, replace

SMALLEST = (640, 400)
LARGEST = (7680, 4320)
SMALLEST_ALONE = (240, 160)
"""Of a view that fills the window: it may stand in a small frame of another page."""
WIDE_FROM_PX = 1600
"""From this width on the plots stand in two panels above each other; below, in one column of tabs."""

# First estimates: the page then lets its plots fill what its texts leave (static/room.js).
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
Window = tuple[int, int, bool, bool, float]
"""Width and height, CSS pixels; whether one view fills it; whether a finger is the pointer; width of letters
(`Layout.letter`).
"""


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
    letter : float
        Width of a text in the page's font over its width in Arial, for which the figures count their letters.
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
    letter: float = 1.0

    @property
    def text_px(self) -> float:
        """Width of a plot as its texts would see it in Arial: for figures that count letters."""
        return self.plot_px / self.letter

    def aspect(self, taken_px: int = 0) -> float:
        """Height / `text_px` of a plot that fills the panel, ``taken_px`` being used by something else."""
        return max(self.room_px - taken_px, 160) / self.text_px


def layout_for(
    width: int,
    height: int,
    alone: bool = False,
    touch: bool = False,
    letter: float = 1.0,
    *,
    presentation: bool = False,
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
        return Layout(False, 320, width, width - _COLUMN_PADDING_PX, room, size, alone=True, letter=letter)
    if presentation:
        return replace(_presented(width, height), letter=letter)
    if touch:
        mouse = layout_for(width, height, letter=letter)
        return replace(mouse, room_px=max(mouse.room_px - _TOUCH_PX, 200), touch=True)
    wide = width >= WIDE_FROM_PX
    left = 360 if width >= 1500 else 340 if width >= 1300 else 320
    right = width // 2 if wide else max(360, min(round(0.5 * width), width - left - 260))
    room = (height // 2 if wide else height) - _CHROME_PX[wide] - _MARGIN_PX - _LOOK_PX
    view = max(width - left - right, 120), height
    return Layout(wide, left, right, right - _COLUMN_PADDING_PX, max(room, 200), view, letter=letter)


def _presented(width: int, height: int) -> Layout:
    """One column of plots, and a narrow one for the few controls."""
    scale = round(min(max(height / _PRESENTED_PX, _LEAST_SCALE), _MOST_SCALE), 2)
    across, down = int(width / scale), int(height / scale)
    left, right = min(300, round(0.3 * across)), round(0.48 * across)
    room = down - _CHROME_PX[False] - _TABS_PX - _MARGIN_PX
    view = max(across - left - right, 120), down
    return Layout(False, left, right, right - _COLUMN_PADDING_PX, max(room, 200), view, scale)


def read_state(text: str) -> tuple[Window | None, dict[str, int]]:
    """Return the window and the tabs in front, as the page reports them; (None, {}) for any other text.

    A tab has the height of its plot where that is far from the one that the server took; else 0.

    Examples
    --------
    >>> read_state("1920x1080|Frequency|Errors")
    ((1920, 1080, False, False, 1.0), {'Frequency': 0, 'Errors': 0})
    >>> read_state("480x320 alone|Method|Poles")
    ((480, 320, True, False, 1.0), {'Method': 0, 'Poles': 0})
    >>> read_state("1180x820 touch 1.14|Poles~310")
    ((1180, 820, False, True, 1.14), {'Poles': 310})
    >>> read_state("hello")
    (None, {})
    """
    size, *tabs = text.strip().split("|")
    match = re.fullmatch(r"([0-9]{1,5})x([0-9]{1,5})( alone)?( touch)?(?: ([0-9][.][0-9]{2}))?", size)
    if match is None:
        return None, {}
    smallest = SMALLEST_ALONE if match[3] else SMALLEST
    width, height = (
        min(max(int(number), low), high)
        for number, low, high in zip(match.groups()[:2], smallest, LARGEST, strict=True)
    )
    named = (tab.partition("~") for tab in tabs[:20])
    rooms = {title: int(px) if re.fullmatch("[0-9]{1,4}", px) else 0 for title, _, px in named}
    letter = min(max(float(match[5] or 1.0), 0.5), 2.0)
    return (width, height, match[3] is not None, match[4] is not None, letter), rooms

"""Where things stand on the page, from the size of the browser's window."""

import re
from dataclasses import dataclass, replace

SMALLEST = (640, 400)
LARGEST = (7680, 4320)
WIDE_PX, LAPTOP_PX, ROOMY_PX = 1600, 1200, 900
_VIEW_SHARE, _VIEW_LESS_PX = 0.2166, 16
"""The 3D view has 400 px of 1920, 280 of 1366."""
SMALLEST_ALONE = (240, 160)
"""Of a view that fills the window: it may stand in a small frame of another page."""
BAR_PX, STRIP_PX = 44, 60
"""The top bar, and below it the strip of results; both over the whole width."""
TWO_FROM_PX = 740
"""From this height on the plots stand in two panels above each other; below, in one panel of tabs."""
RAIL_PX, LEAST_VIEW_PX, LEAST_LEFT_PX, LEAST_PLOTS_PX = 36, 160, 250, 360
"""Widths: of the folded 3D view, and the least ones of 3D view, controls and plots."""

# First estimates: the page then lets its plots fill what its texts leave (static/room.js).
_COLUMN_PADDING_PX = 12
"""Between the edges of a column and its plots, both sides together."""
_TABS_PX = 34
"""The tabs above a panel's content; the tools of most plots stand beside them."""
_MARGIN_PX = 18
"""Above and below the content of a window with one view."""
_PRESENTED_PX = 560.0
"""Height for which a page in presentation size is laid out: it is enlarged to the window's."""
_TOUCH_PX = 30
"""More height of tabs and of the tools above a plot, where a finger must hit them (static/touch.css)."""
_NAMES_PX = 34
"""The strip of results in presentation size, before it is enlarged."""
_SECOND_TABS_PX = 28
"""A second row of tabs in its column."""
_LEAST_SCALE, _MOST_SCALE = 1.25, 4.0
CHOOSER_PX = 36
"""A chooser above a plot."""
TOOLS = '<div class="sb-tools"></div>'
"""HTML that lets the controls of a tab stand in one row (static/page.css)."""


@dataclass(frozen=True)
class Columns:
    """How a visitor has set the dividers (static/columns.js).

    Attributes
    ----------
    left_px, view_px : int
        Widths of controls and of the 3D view, CSS pixels; 0: what suits the window.
    mode : str
        "plots": they have the most room; "view": the 3D view has it in their place; "rail": the 3D view is
        folded.
    """

    left_px: int = 0
    view_px: int = 0
    mode: str = "plots"

    def widths(self, width: int) -> tuple[int, int, int]:
        """Widths of controls, 3D view and plots in a window of this width."""
        suits = 320 if width >= WIDE_PX else 290 if width >= LAPTOP_PX else 280
        left = min(max(self.left_px or suits, LEAST_LEFT_PX), width // 3)
        free = width - left
        view = self.view_px or min(round(_VIEW_SHARE * width) - _VIEW_LESS_PX, 600)
        view = min(max(view, LEAST_VIEW_PX), free - LEAST_PLOTS_PX)
        if self.mode == "rail":
            view = RAIL_PX
        elif self.mode == "view":
            view = free - max(view, LEAST_PLOTS_PX)
        return left, view, free - view


_AS_IT_SUITS = Columns()
_STATE = (
    r"([0-9]{1,5})x([0-9]{1,5})( alone)?( touch)?(?: ([0-9][.][0-9]{2}))?"
    r"(?: ([0-9]{1,4}),([0-9]{1,4}),(plots|view|rail))?"
)
Window = tuple[int, int, bool, bool, float, Columns]
"""Width and height, CSS pixels; whether one view fills it; whether a finger is the pointer; width of letters
(`Layout.letter`); the dividers.
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
        Tables have room for type of the normal size.
    two : bool
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
    two: bool = False
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
    columns: Columns = _AS_IT_SUITS,
    *,
    presentation: bool = False,
) -> Layout:
    """Arrange the page for a window of this size (CSS pixels); ``alone``: one view fills it, in normal size.

    In presentation size a text is as high in every window, as a part of the window's height.

    Examples
    --------
    >>> [layout_for(w, h).view_px[0] for w, h in ((1920, 1080), (1366, 768))]
    [400, 280]
    >>> layout_for(1366, 768).two, layout_for(1280, 720).two
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
    left, view, right = columns.widths(width)
    two, below = height >= TWO_FROM_PX + 4 * _TOUCH_PX * touch, height - BAR_PX - STRIP_PX
    room = below // (2 if two else 1) - _TABS_PX - _TOUCH_PX * touch
    plot = right - _COLUMN_PADDING_PX
    return Layout(
        right >= ROOMY_PX, left, right, plot, max(room, 200), (view, below), two, touch=touch, letter=letter
    )


def _presented(width: int, height: int) -> Layout:
    """One column of plots, and a narrow one for the few controls."""
    scale = round(min(max(height / _PRESENTED_PX, _LEAST_SCALE), _MOST_SCALE), 2)
    across, down = int(width / scale), int(height / scale) - _NAMES_PX
    left, right = min(300, round(0.3 * across)), round(0.48 * across)
    room = down - _TABS_PX - _SECOND_TABS_PX
    view = max(across - left - right, 120), down
    return Layout(False, left, right, right - _COLUMN_PADDING_PX, max(room, 200), view, scale=scale)


def read_state(text: str) -> tuple[Window | None, dict[str, int]]:
    """Return the window and the tabs in front, as the page reports them; (None, {}) for any other text.

    A tab has the height of its plot where that is far from the one that the server took; else 0.

    Examples
    --------
    >>> window, rooms = read_state("1920x1080|Frequency|Errors")
    >>> window[:5], rooms
    ((1920, 1080, False, False, 1.0), {'Frequency': 0, 'Errors': 0})
    >>> read_state("480x320 alone|Method|Poles")[0][:3]
    (480, 320, True)
    >>> window, rooms = read_state("1180x820 touch 1.14 300,240,rail|Poles~310")
    >>> window[3:], rooms
    ((True, 1.14, Columns(left_px=300, view_px=240, mode='rail')), {'Poles': 310})
    >>> read_state("hello")
    (None, {})
    """
    size, *tabs = text.strip().split("|")
    match = re.fullmatch(_STATE, size)
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
    columns = Columns(int(match[6] or 0), int(match[7] or 0), match[8] or _AS_IT_SUITS.mode)
    return (width, height, match[3] is not None, match[4] is not None, letter, columns), rooms

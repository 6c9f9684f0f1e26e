"""When a page is sent a picture: as often as it can draw one, and everything once the hand rests.

The page says which picture it has painted, and whether a slider moves (static/drawn.js). Until it has painted
what it was sent, newer runs wait, and only the newest of them is shown. While a slider moves, a picture is
what stands in front; 3D view, tables and readout follow when it rests. They come last at the opening as well:
without a graphics card the first frame of the 3D view takes half a second.
"""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable

from app.shell.timer import timer

AHEAD = 2
"""Pictures that may be under way: one is drawn while the next is made."""
LATE_S = 0.7
"""A page that has not painted a picture in this time is not waited for: its tab may be hidden."""
_log = logging.getLogger("schuler.page")


class Pace:
    """Decides when the newest run is drawn, and how much of it.

    A page that never says what it has painted (a program that speaks viser's protocol) is sent every run,
    whole; `expect_answers` tells that a page will.

    Parameters
    ----------
    draw : callable
        ``draw(number, whole)`` shows the session's run as picture ``number``: everything, or only what stands
        in front. Called by one thread at a time, without any lock held by `Pace`.
    clock : callable
        Seconds, monotonic.
    """

    def __init__(
        self, draw: Callable[[int, bool], None], clock: Callable[[], float] = time.monotonic
    ) -> None:
        self._draw, self._clock = draw, clock
        self._lock = threading.Lock()
        self._sent = self._painted = 0
        self._sent_s = -1e9
        self._due = self._part = self._drawing = self._moving = self._closed = self._answers = False
        self._alarm: threading.Timer | None = None

    @property
    def moving(self) -> bool:
        """Whether a slider moves."""
        return self._moving

    def told(self, painted: int, *, moving: bool) -> None:
        """The page has painted a picture, or a slider begins to move or has come to rest."""
        with self._lock:
            self._moving = moving
            if self._painted < painted <= self._sent:
                self._painted = painted
        self._go()

    def expect_answers(self) -> None:
        """Send what stands in front first, and all the rest once the page has painted it."""
        self._answers = True

    def ended(self) -> None:
        """There is a run to show."""
        with self._lock:
            self._due = True
        self._go()

    def close(self) -> None:
        """Draw nothing any more."""
        with self._lock:
            self._closed = True
            if self._alarm is not None:
                self._alarm.cancel()

    def _go(self) -> None:
        while True:
            with self._lock:
                if not self._may_draw():
                    return
                whole = not self._moving and (self._sent > 0 or not self._answers)
                self._due, self._part, self._drawing = False, not whole, True
                self._sent, self._sent_s = self._sent + 1, self._clock()
                number = self._sent
            try:
                self._draw(number, whole)
            finally:
                with self._lock:
                    self._drawing = False

    def _may_draw(self) -> bool:
        """Whether there is something to draw, and room for it; else it is looked at again in time."""
        if self._closed or self._drawing or not (self._due or (self._part and not self._moving)):
            return False
        late_in_s = self._sent_s + LATE_S - self._clock()
        waits = self._part if self._painted == 0 else self._sent - self._painted >= AHEAD
        if not waits or late_in_s <= 0.0:
            return True
        if self._alarm is not None:
            self._alarm.cancel()
        self._alarm = timer(late_in_s, self._ring)
        self._alarm.start()
        return False

    def _ring(self) -> None:
        try:
            self._go()
        except Exception:
            _log.exception("a picture could not be shown")

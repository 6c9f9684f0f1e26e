"""The time that a page shows: at rest, moved by hand, or running; and the thread that lets it run."""

from __future__ import annotations

import logging
import math
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, replace

SPEEDS = (60, 300, 600, 1800, 3600, 7200)
"""Seconds of the run in a second of the page."""
TICK_S = 0.1
"""Between two updates; what an update takes is added."""
SLOW_S = 0.6
"""The same while the page is behind, or its user moves something: what is moved comes first."""
MOST_AHEAD = 6
"""Updates that may be under way to the page."""
_log = logging.getLogger("schuler.playback")


@dataclass(frozen=True)
class PlayState:
    """Where the playback stands.

    Attributes
    ----------
    time_s, span_s : float
        Time that is shown, and length of the run, s.
    playing, loop : bool
        It runs; it begins anew at the end.
    speed : int
        One of `SPEEDS`.
    """

    time_s: float = 0.0
    span_s: float = 0.0
    playing: bool = False
    loop: bool = False
    speed: int = 1800

    @property
    def at_end(self) -> bool:
        """Whether the whole run lies in the past."""
        return self.time_s >= self.span_s

    def later(self, elapsed_s: float) -> PlayState:
        """The state after some seconds of the page."""
        if not self.playing:
            return self
        time_s = self.time_s + self.speed * elapsed_s
        if time_s < self.span_s:
            return replace(self, time_s=time_s)
        if self.loop and self.span_s > 0.0:
            return replace(self, time_s=time_s % self.span_s)
        return replace(self, time_s=self.span_s, playing=False)


class Playback:
    """Lets the shown time run; its thread begins with the first `play` and ends with `close`.

    Parameters
    ----------
    show : callable
        ``show(state)`` whenever the state has changed, from the caller's thread or from that of the playback.
    """

    def __init__(self, show: Callable[[PlayState], None]) -> None:
        self._show = show
        self._changed = threading.Condition()
        self._state = PlayState()
        self._thread: threading.Thread | None = None
        self._closed = False
        self._ahead = 0

    @property
    def state(self) -> PlayState:
        """Where it stands."""
        with self._changed:
            return self._state

    def follow(self, span_s: float) -> None:
        """Take note of a run's length: who was at the end of the last one is at the end of this one."""
        with self._changed:
            at_end = self._state.at_end and not self._state.playing
            time_s = span_s if at_end else min(self._state.time_s, span_s)
            self._state = replace(self._state, time_s=time_s, span_s=span_s)

    def toggle(self) -> None:
        """Play, or pause; at the end of the run it begins anew."""
        state = self.state
        if state.playing:
            self._set(playing=False)
        else:
            self._set(playing=state.span_s > 0.0, time_s=0.0 if state.at_end else state.time_s)

    def seek(self, time_s: float) -> None:
        """Show another time of the run; a running playback goes on from there."""
        if math.isfinite(time_s):
            self._set(time_s=min(max(time_s, 0.0), self.state.span_s))

    def set_speed(self, speed: float) -> None:
        """Choose one of `SPEEDS`; another one is ignored."""
        if speed in SPEEDS:
            self._set(speed=int(speed))

    def set_loop(self, loop: bool) -> None:
        """Begin anew at the end of the run, or stop there."""
        self._set(loop=loop)

    def heard(self, behind: int) -> None:
        """The page has shown all updates but the last ``behind``."""
        with self._changed:
            self._ahead = max(behind, 0)

    def close(self) -> None:
        """End the thread; it is not waited for."""
        with self._changed:
            self._closed = True
            self._changed.notify_all()

    def _set(self, **changes: float | bool) -> None:
        with self._changed:
            if self._closed:
                return
            self._state = state = replace(self._state, **changes)  # pyright: ignore[reportArgumentType]
            if state.playing and self._thread is None:
                self._thread = threading.Thread(target=self._loop, name="playback", daemon=True)
                self._thread.start()
            self._changed.notify_all()
        self._show(state)

    def _loop(self) -> None:
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._closed or self._state.playing)
            last, self._ahead = time.monotonic(), 0
            while True:
                with self._changed:
                    pause_s = TICK_S if self._ahead < MOST_AHEAD else SLOW_S
                    self._ahead += 1
                time.sleep(pause_s)
                with self._changed:
                    if self._closed:
                        return
                    if not self._state.playing:
                        break
                    now = time.monotonic()
                    self._state = state = self._state.later(now - last)
                    last = now
                try:
                    self._show(state)
                except Exception:  # a page that is just going must not end the thread with a traceback
                    _log.exception("a time could not be shown")

"""When a page is sent a picture: as often as it can draw one, and everything once the slider rests.

The page says which picture it has painted, and whether a slider moves (static/drawn.js). Until it has painted
what it was sent, newer runs wait, and only the newest of them is shown. While a slider moves, a picture is
what stands in front; 3D view, tables and readout follow when it rests. They come last at the opening as well:
without a graphics card the first frame of the 3D view takes half a second. The other controls follow a slider
with its picture, or after a while if none comes.
"""

import logging
import threading
import time
from collections.abc import Callable
from enum import Enum, auto

AHEAD = 2
"""Pictures that may be under way: one is drawn while the next is made."""
LATE_S = 0.7
"""A page that has not painted a picture in this time is not waited for: its tab may be hidden."""
CONTROLS_LATE_S = 0.2
"""So long a picture may take before the controls that wait for it are shown without it."""
_log = logging.getLogger("schuler.page")


class State(Enum):
    """State of a page: what it has still to be sent, and whether a slider is held."""

    OPENING = auto()
    """Nothing is sent yet to a page that says what it paints."""
    FIRST = auto()
    """Its first run is there: the pictures in front go first."""
    SHOWN = auto()
    """The newest run is shown everywhere."""
    PARTLY = auto()
    """The pictures in front show a run; the other views have to follow."""
    DUE = auto()
    """A newer run has to be shown."""
    HELD = auto()
    """A slider is held; the newest run is shown everywhere."""
    HELD_PARTLY = auto()
    """A slider is held; the pictures in front show the newest run."""
    HELD_DUE = auto()
    """A slider is held; a newer run has to be shown in front."""
    CLOSED = auto()
    """The page has gone."""


class Event(Enum):
    """Events that change the state of a page; the value is the column of `NEXT`."""

    RUN = 0
    HELD = 1
    RESTS = 2
    SENT = 3


NEXT: dict[State, tuple[State, ...]] = {
    # state: after a run has ended, the slider is held, the slider rests, a picture is sent
    State.OPENING: (State.FIRST, State.HELD, State.OPENING, State.OPENING),
    State.FIRST: (State.FIRST, State.HELD_DUE, State.FIRST, State.PARTLY),
    State.SHOWN: (State.DUE, State.HELD, State.SHOWN, State.SHOWN),
    State.PARTLY: (State.PARTLY, State.HELD_PARTLY, State.PARTLY, State.SHOWN),
    State.DUE: (State.DUE, State.HELD_DUE, State.DUE, State.SHOWN),
    State.HELD: (State.HELD_DUE, State.HELD, State.SHOWN, State.HELD),
    State.HELD_PARTLY: (State.HELD_DUE, State.HELD_PARTLY, State.PARTLY, State.HELD_PARTLY),
    State.HELD_DUE: (State.HELD_DUE, State.HELD_DUE, State.DUE, State.HELD_PARTLY),
    State.CLOSED: (State.CLOSED,) * len(Event),
}
_TO_SEND = frozenset({State.FIRST, State.PARTLY, State.DUE, State.HELD_DUE})
_WHOLE = frozenset({State.PARTLY, State.DUE})
_SLIDER_HELD = frozenset({State.HELD, State.HELD_PARTLY, State.HELD_DUE})


class Pace:
    """Decides when the newest run is drawn, and how much of it.

    A page that never says what it has painted (a program that speaks viser's protocol) is sent every run,
    whole; `expect_answers` tells that a page will.

    Parameters
    ----------
    draw : callable
        ``draw(number, whole)`` shows the session's run as picture ``number``: everything, or only what stands
        in front. Called by one thread at a time, without any lock held by `Pace`.
    follow : callable
        ``follow()`` shows the controls, in a thread of its own, when no picture did within `CONTROLS_LATE_S`.
    clock : callable
        Seconds, monotonic.
    """

    def __init__(
        self,
        draw: Callable[[int, bool], None],
        follow: Callable[[], None],
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self.state = State.SHOWN
        self.controls_wait = False
        """The controls have to follow the slider."""
        self._draw, self._follow, self._clock = draw, follow, clock
        self._lock, self._drawer = threading.Lock(), threading.Lock()
        self._sent = self._painted = 0
        self._sent_s = -1e9
        self._picture_alarm: threading.Timer | None = None
        self._controls_alarm: threading.Timer | None = None

    @property
    def moving(self) -> bool:
        """Whether a slider is held."""
        return self.state in _SLIDER_HELD

    def expect_answers(self) -> None:
        """Send what stands in front first, and all the rest once the page has painted it."""
        self.state = State.OPENING

    def on_painted(self, painted: int, *, moving: bool) -> None:
        """The page has painted a picture, or a slider begins to move or has come to rest."""
        with self._lock:
            self._step(Event.HELD if moving else Event.RESTS)
            if self._painted < painted <= self._sent:
                self._painted = painted
        self._send()

    def ended(self) -> None:
        """There is a run to show."""
        with self._lock:
            self._step(Event.RUN)
        self._send()

    def follow_later(self) -> None:
        """Let the controls follow the slider with the next picture, or without it when it is late."""
        with self._lock:
            self.controls_wait = True
            if self._controls_alarm is None and self.state is not State.CLOSED:
                self._controls_alarm = timer(CONTROLS_LATE_S, self._controls_late)
                self._controls_alarm.start()

    def close(self) -> None:
        """Draw nothing any more."""
        with self._lock:
            self.state = State.CLOSED
            for alarm in (self._picture_alarm, self._controls_alarm):
                if alarm is not None:
                    alarm.cancel()

    def _step(self, event: Event) -> None:
        self.state = NEXT[self.state][event.value]

    def _send(self) -> None:
        while True:
            with self._lock:
                if not self._may_send():
                    return
                self._drawer.acquire()
                whole = self.state in _WHOLE
                self._step(Event.SENT)
                self._sent, self._sent_s = self._sent + 1, self._clock()
                number = self._sent
            try:
                self._draw(number, whole)
            finally:
                with self._lock:
                    self._drawer.release()

    def _may_send(self) -> bool:
        """Whether there is something to send, and room for it; else it is looked at again in time."""
        if self.state not in _TO_SEND or self._drawer.locked():
            return False
        late_in_s = self._sent_s + LATE_S - self._clock()
        answers = self._painted > 0 or self.moving
        waits = self._sent - self._painted >= AHEAD if answers else self.state is State.PARTLY
        if not waits or late_in_s <= 0.0:
            return True
        if self._picture_alarm is not None:
            self._picture_alarm.cancel()
        self._picture_alarm = timer(late_in_s, self._picture_late)
        self._picture_alarm.start()
        return False

    def _picture_late(self) -> None:
        try:
            self._send()
        except Exception:
            _log.exception("a picture could not be shown")

    def _controls_late(self) -> None:
        with self._lock:
            self._controls_alarm = None
            wanted = self.controls_wait and self.state is not State.CLOSED
        if wanted:
            self._follow()


def timer(delay_s: float, act: Callable[..., None], *arguments: object) -> threading.Timer:
    """Return a timer, not yet started, that calls ``act(*arguments)``; it does not keep the process alive."""
    alarm = threading.Timer(delay_s, act, arguments)
    alarm.daemon = True
    return alarm

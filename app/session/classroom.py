"""A class: visitors of one server who follow a lesson together; one page shows the answers of all.

``schuler serve --class`` makes one. Each visitor has a session and a run of his own; common are the step of
the lesson, and what each has answered there. Nobody's name is known.
"""

from __future__ import annotations

import hmac
import logging
import secrets
import threading
from collections import OrderedDict
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace

_log = logging.getLogger("schuler.session")
_PAUSE_S = 0.25
"""Between two rounds of telling the pages: thirty answers at once are one change."""
_MOST_PAGES, _MOST_STEPS = 200, 40
_DIGITS = 6
_MOST_TRIES = 20

Place = tuple[str, int]
"""Id of a lesson, and number of a step from 0."""


@dataclass(frozen=True)
class Given:
    """What one visitor has given at a step.

    Attributes
    ----------
    answer : str
        To its question; empty: none.
    right : bool
        Whether that is right.
    heights : tuple of float
        Of the sketch, from -1 to 1, NaN where nothing was drawn; empty: none.
    met : bool
        The visitor's run meets the task.
    """

    answer: str = ""
    right: bool = False
    heights: tuple[float, ...] = ()
    met: bool = False


@dataclass(frozen=True)
class Led:
    """What the class follows.

    Attributes
    ----------
    place : (str, int) or None
        Lesson and step; None: the list of lessons, or nobody leads.
    shown : int
        Counts "Show me" of the leader's page.
    revealed : bool
        The run's curve is drawn over the sketches of this step.
    """

    place: Place | None = None
    shown: int = 0
    revealed: bool = False


class Classroom:
    """The class of a server.

    Parameters
    ----------
    code : str, optional
        What the one who leads must know; drawn when it is empty.

    Attributes
    ----------
    code : str
    led : Led
        What the class follows.
    """

    def __init__(self, code: str = "") -> None:
        self.code = code or f"{secrets.randbelow(10**_DIGITS):0{_DIGITS}d}"
        self.led = Led()
        self._leader = ""
        self._tries = 0
        self._given: OrderedDict[Place, dict[str, Given]] = OrderedDict()
        self._watchers: dict[object, tuple[str, Callable[[], None]]] = {}
        self._followed: dict[str, Led] = {}
        self._changed = threading.Condition()
        self._untold = False
        self._thread: threading.Thread | None = None

    # ------------------------------------------------------------ pages

    def watch(self, page: object, session: str, tell: Callable[[], None]) -> None:
        """Tell a page of each change, from a thread of the class.

        Parameters
        ----------
        page : object
            Key with which `leave` ends it.
        session : str
            Id of its session.
        tell : callable
            ``tell()``; several changes within a quarter of a second are one.
        """
        with self._changed:
            if len(self._watchers) >= _MOST_PAGES:
                return
            self._watchers[page] = session, tell
            if self._thread is None:
                self._thread = threading.Thread(target=self._tell, name="class", daemon=True)
                self._thread.start()
            self._touch()

    def leave(self, page: object) -> None:
        """Forget a page that has closed; the class is led no more when it was the leader's last one."""
        with self._changed:
            self._watchers.pop(page, None)
            if self._leader and self._leader not in self._sessions():
                self._leader = ""
            self._touch()

    def close(self) -> None:
        """End the thread."""
        with self._changed:
            self._watchers.clear()
            thread, self._thread = self._thread, None
            self._touch()
        if thread is not None and thread is not threading.current_thread():
            thread.join(2.0)

    @property
    def here(self) -> int:
        """Visitors with an open page, without the one who leads."""
        with self._changed:
            return len(self._sessions() - {self._leader})

    @property
    def is_led(self) -> bool:
        """Whether somebody leads."""
        return bool(self._leader)

    def _sessions(self) -> set[str]:
        return {session for session, _ in self._watchers.values()}

    # ------------------------------------------------------------ leading

    def claim(self, session: str, code: str) -> bool:
        """Let a session lead that knows the code; after 20 wrong ones nobody can any more.

        Parameters
        ----------
        session : str
            Id.
        code : str
            As typed.
        """
        with self._changed:
            if self._tries >= _MOST_TRIES or not hmac.compare_digest(
                code.strip().encode(), self.code.encode()
            ):
                self._tries += 1
                return False
            self._leader, self._tries = session, 0
            self._touch()
            return True

    def release(self, session: str) -> None:
        """Stop leading."""
        with self._changed:
            if self.leads(session):
                self._leader, self.led = "", replace(self.led, place=None)
                self._touch()

    def leads(self, session: str) -> bool:
        """Whether a session leads."""
        return bool(session) and self._leader == session

    def go(self, session: str, place: Place | None) -> None:
        """Take the class to a step, if the session leads."""
        with self._changed:
            if self.leads(session) and place != self.led.place:
                self.led = replace(self.led, place=place, revealed=False)
                self._touch()

    def show(self, session: str) -> None:
        """Let all pages carry out the step's action, if the session leads."""
        with self._changed:
            if self.leads(session):
                self.led = replace(self.led, shown=self.led.shown + 1)
                self._touch()

    def reveal(self, session: str) -> None:
        """Draw the run's curve over all sketches, if the session leads."""
        with self._changed:
            if self.leads(session):
                self.led = replace(self.led, revealed=True)
                self._touch()

    def follow(self, session: str) -> tuple[Led, bool] | None:
        """Return what a session is to follow now, once for each change.

        Returns
        -------
        Led and whether "Show me" was pressed since; None: nothing new, nobody leads, or the session leads.
        """
        with self._changed:
            if not self._leader or self.leads(session):
                return None
            before = self._followed.get(session)
            if before == self.led:
                return None
            self._followed[session] = self.led
            return self.led, before is not None and before.shown != self.led.shown

    # ------------------------------------------------------------ what is given

    def give(self, session: str, place: Place, **given: object) -> None:
        """Note what a visitor gives at a step.

        Parameters
        ----------
        session : str
            Id.
        place : (str, int)
            The step.
        **given
            Fields of `Given` that are new.
        """
        with self._changed:
            of_step = self._given.setdefault(place, {})
            self._given.move_to_end(place)
            while len(self._given) > _MOST_STEPS:
                self._given.popitem(last=False)
            before = of_step.get(session, Given())
            after = replace(before, **given)  # pyright: ignore[reportArgumentType]
            if after != before and (session in of_step or len(of_step) < _MOST_PAGES):
                of_step[session] = after
                self._touch()

    def given(self, place: Place) -> tuple[Given, ...]:
        """All that the visitors gave at a step, without the one who leads."""
        with self._changed:
            of_step: Mapping[str, Given] = self._given.get(place, {})
            return tuple(given for session, given in of_step.items() if not self.leads(session))

    # ------------------------------------------------------------ telling

    def _touch(self) -> None:
        self._untold = True
        self._changed.notify_all()

    def _tell(self) -> None:
        me = threading.current_thread()
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._untold or self._thread is not me)
                if self._thread is not me:
                    return
                self._untold = False
                watchers: Iterable[tuple[str, Callable[[], None]]] = [*self._watchers.values()]
            # The one who leads first: the others' runs take their time.
            for _, tell in sorted(watchers, key=lambda one: not self.leads(one[0])):
                try:
                    tell()
                except Exception:
                    _log.exception("a page of the class could not be brought up to date")
            with self._changed:
                self._changed.wait_for(lambda: self._thread is not me, timeout=_PAUSE_S)

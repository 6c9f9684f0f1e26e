"""A page's part in the class: what it follows when another leads, and what it tells when it leads."""

from collections.abc import Callable

from schuler_bench.session.classroom import Given, Led, Place
from schuler_bench.session.session import Session
from schuler_bench.views.learn.lessons import Lesson
from schuler_bench.views.learn.shown import class_html


class Together:
    """The class of a session's server, as one page sees it; without a class nothing happens.

    Parameters
    ----------
    session : Session
        Of the page.
    """

    def __init__(self, session: Session) -> None:
        self._session, self._room = session, session.classroom

    def join(self, follow: Callable[[], None]) -> None:
        """Call ``follow()`` after each change of the class."""
        if self._room is not None:
            self._room.watch(self, self._session.id, follow)

    def leave(self) -> None:
        """Leave the class: the page has closed."""
        if self._room is not None:
            self._room.leave(self)

    @property
    def leads(self) -> bool:
        """Whether this session leads."""
        return self._room is not None and self._room.leads(self._session.id)

    def news(self) -> tuple[Led, bool] | None:
        """As of `Classroom.follow`."""
        return None if self._room is None else self._room.follow(self._session.id)

    def lead(self, code: str, place: Place | None) -> bool:
        """Lead the class from now on, at a step; False: that is not its code."""
        if self._room is None or not self._room.claim(self._session.id, code):
            return False
        self._room.go(self._session.id, place)
        return True

    def stop(self) -> None:
        """Lead no more."""
        if self._room is not None:
            self._room.release(self._session.id)

    def go(self, place: Place | None) -> None:
        """Take the class along, where this session leads."""
        if self._room is not None:
            self._room.go(self._session.id, place)

    def show(self) -> None:
        """Let the class carry out the step's action, where this session leads."""
        if self._room is not None:
            self._room.show(self._session.id)

    def reveal(self) -> None:
        """Draw the run's curve for the class, where this session leads."""
        if self._room is not None:
            self._room.reveal(self._session.id)

    def give(self, place: Place | None, **given: object) -> None:
        """Give the class what was answered, sketched or met at a step: fields of `Given`."""
        if self._room is not None and place is not None:
            self._room.give(self._session.id, place, **given)

    def given(self, place: Place | None) -> tuple[Given, ...]:
        """What the class gave at a step, on the page of the one who leads."""
        return () if self._room is None or place is None or not self.leads else self._room.given(place)

    def html(self, place: Place | None, lesson: Lesson | None) -> str:
        """Line about the class; empty without one."""
        if self._room is None:
            return ""
        return class_html(self._room, leads=self.leads, given=self.given(place), lesson=lesson)

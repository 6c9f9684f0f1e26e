"""The open pages of one session, and which of them presents."""

import logging
import threading
from collections.abc import Callable, Set

from schuler_bench.session.view import View

_log = logging.getLogger("schuler.session")


class OpenPages:
    """Pages that show one session.

    Parameters
    ----------
    lock : threading.RLock
        Of the session.

    Attributes
    ----------
    all : list of View
    presenter : View or None
        The page that drives; the others watch.
    """

    def __init__(self, lock: threading.RLock) -> None:
        self._lock = lock
        self.all: list[View] = []
        self.presenter: View | None = None

    def tell(self, message: Callable[[View], None]) -> None:
        """Give every page a message; one that fails with it does not hold up the others."""
        with self._lock:
            views = list(self.all)
        for view in views:
            try:
                message(view)
            except Exception as error:
                _log.exception("a page could not be brought up to date")
                view.run_failed(error)

    def add(self, view: View) -> None:
        """Add a page that has opened."""
        self.all.append(view)
        self._tell_their_number()

    def remove(self, view: View) -> bool:
        """Remove a page that has closed; whether it was the one that presents, which is to be freed then."""
        self.all = [other for other in self.all if other is not view]
        if self.presenter is view:
            return True
        self._tell_their_number()
        return False

    def _tell_their_number(self) -> None:
        if self.presenter is not None:
            self.tell(lambda other: other.presenter_changed())

    def present(self, view: View | None) -> bool:
        """Let one page drive alone, or (None) all; False while another page drives."""
        if view is not None and self.presenter not in (None, view):
            return False
        self.presenter = view
        self.tell(lambda other: other.presenter_changed())
        return True

    def tell_front(self, view: View, front: Set[str]) -> None:
        """Let the watchers follow the tabs that the presenting page brings to the front."""
        with self._lock:
            if self.presenter is view and front:
                self.tell(lambda other: other.front_changed(front) if other is not view else None)

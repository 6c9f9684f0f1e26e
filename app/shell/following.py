"""What is shown a little later: with the next picture, or after a while if none comes."""

from __future__ import annotations

import threading
from collections.abc import Callable

from app.shell.timer import timer

LATE_S = 0.2
"""So long a picture may take before what waits for it is shown without it."""


class Following:
    """Remembers that something is to be shown.

    Parameters
    ----------
    late : callable
        Called in a thread of its own when nothing was shown within `LATE_S`.
    """

    def __init__(self, late: Callable[[], None]) -> None:
        self._late = late
        self._lock = threading.Lock()
        self._due = self._closed = False
        self._alarm: threading.Timer | None = None

    @property
    def due(self) -> bool:
        """Whether something is to be shown."""
        return self._due

    def ask(self) -> None:
        """Something is to be shown."""
        with self._lock:
            self._due = True
            if self._alarm is None and not self._closed:
                self._alarm = timer(LATE_S, self._ring)
                self._alarm.start()

    def done(self) -> None:
        """It is shown."""
        with self._lock:
            self._due = False

    def close(self) -> None:
        """Show nothing any more."""
        with self._lock:
            self._closed = True
            if self._alarm is not None:
                self._alarm.cancel()

    def _ring(self) -> None:
        with self._lock:
            self._alarm = None
            wanted = self._due and not self._closed
        if wanted:
            self._late()

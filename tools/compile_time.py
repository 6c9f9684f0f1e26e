"""Compiling a kernel never counts against a test's timeout: its clock stands while numba compiles."""

import signal
import threading
from typing import Any

from numba.core import event

_COMPILING = "numba:compile"


class Uncounted(event.Listener):
    """Stops a timer while any thread of the process compiles.

    Parameters
    ----------
    timer : int
        Of `signal`; unless told that of pytest-timeout (its method "signal").
    """

    def __init__(self, timer: int | None = None) -> None:
        self._timer = getattr(signal, "ITIMER_REAL", 0) if timer is None else timer
        self._lock = threading.Lock()
        self._depth, self._left = 0, 0.0

    def listen(self) -> None:
        """Hear of every compilation from now on."""
        event.register(_COMPILING, self)

    def on_start(self, event: Any) -> None:
        """Take the timer out, remembering what was left of it."""
        with self._lock:
            self._depth += 1
            if self._depth == 1 and hasattr(signal, "setitimer"):
                self._left = signal.setitimer(self._timer, 0.0)[0]

    def on_end(self, event: Any) -> None:
        """Set the timer to what was left."""
        with self._lock:
            self._depth -= 1
            if self._depth == 0 and self._left > 0.0:
                signal.setitimer(self._timer, self._left)
                self._left = 0.0

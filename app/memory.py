"""Memory given back to the system: on Linux what is freed is kept, in an arena for every thread."""

from __future__ import annotations

import ctypes
import gc
import threading
from collections.abc import Callable

_ARENA_MAX = -8
_ARENAS = 2
_AFTER_S = 3.0


def _glibc() -> ctypes.CDLL | None:
    try:
        found = ctypes.CDLL(None)
    except (OSError, TypeError):  # not on this platform
        return None
    return found if hasattr(found, "malloc_trim") and hasattr(found, "mallopt") else None


def bound_arenas() -> None:
    """Let all threads share a few arenas: freed memory is found again, and can be given back."""
    libc = _glibc()
    if libc is not None:
        libc.mallopt(_ARENA_MAX, _ARENAS)


class GiveBack:
    """Gives freed memory back to the system, some time after it was asked to; asked often, once.

    Parameters
    ----------
    forget : callable
        ``forget()`` drops what nobody needs any more, before.
    after_s : float
        Time to wait, s.
    """

    def __init__(self, forget: Callable[[], None], after_s: float = _AFTER_S) -> None:
        self._forget, self._after_s = forget, after_s
        self._lock = threading.Lock()
        self._timer: threading.Timer | None = None

    def soon(self) -> None:
        """Give it back in a moment."""
        with self._lock:
            if self._timer is not None:
                return
            self._timer = threading.Timer(self._after_s, self._now)
            self._timer.daemon = True
            self._timer.start()

    def _now(self) -> None:
        with self._lock:
            self._timer = None
        self._forget()
        gc.collect()
        libc = _glibc()
        if libc is not None:
            libc.malloc_trim(0)

"""Memory of the server and its workers: its return to the system, and the interval of the garbage collector.

On Linux what is freed is kept, in an arena for every thread. Python's collector holds the interpreter while
it looks through all objects, and nobody is answered meanwhile.
"""

import ctypes
import gc
import threading
from collections.abc import Callable
from functools import cache

_TRIM_THRESHOLD, _MMAP_THRESHOLD, _ARENA_MAX = -1, -3, -8
_ARENAS = 2
_KEPT, _LARGEST_KEPT = 64 << 20, 32 << 20
"""Bytes that are kept at the end of the heap, and of an array whose memory is kept; glibc allows no more."""
_AFTER_S = 3.0
_THRESHOLDS = 5_000, 10, 10
"""Of new objects, and of rounds of the youngest and the middle generation (`gc.set_threshold`)."""


def _glibc() -> ctypes.CDLL | None:
    try:
        libc = ctypes.CDLL(None)
    except (OSError, TypeError):  # not on this platform
        return None
    return libc if hasattr(libc, "malloc_trim") and hasattr(libc, "mallopt") else None


def bound_arenas() -> None:
    """Let all threads share a few arenas: freed memory is found again, and can be given back."""
    libc = _glibc()
    if libc is not None:
        libc.mallopt(_ARENA_MAX, _ARENAS)


@cache
def keep_freed() -> None:
    """Let the memory of arrays be used again instead of going back to the system at once.

    Dask starts its workers with ``MALLOC_TRIM_THRESHOLD_``: each array then comes page by page.
    """
    libc = _glibc()
    if libc is not None:
        libc.mallopt(_TRIM_THRESHOLD, _KEPT)
        libc.mallopt(_MMAP_THRESHOLD, _LARGEST_KEPT)


def collect_seldom() -> None:
    """Leave what lives as long as the server out of the collector's rounds, and let it begin them less often.

    The modules, the kernels and the prepared run are several hundred thousand objects, to be called when they
    are there.
    """
    gc.freeze()
    gc.set_threshold(*_THRESHOLDS)


def give_back() -> None:
    """Give freed memory back to the system."""
    gc.collect()
    libc = _glibc()
    if libc is not None:
        libc.malloc_trim(0)


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
        give_back()

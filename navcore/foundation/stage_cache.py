"""A cache for what is large and slow to make: recordings, truth, sensor errors; within 300 MB in all.

Its limit is a number of bytes. `functools.lru_cache` serves small results of pure functions, where a number
of entries is limit enough.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Hashable
from pathlib import Path
from typing import Any

import numpy as np
from cachetools import LRUCache

_CACHE_BYTES = 300 * 1024 * 1024
_lock = threading.Lock()


def _size(value: Any) -> int:
    """Bytes of the arrays in a value, whatever objects and containers they lie in, and 1 KiB."""
    return 1024 + _array_bytes(value)


def _array_bytes(value: Any) -> int:
    if isinstance(value, np.ndarray):
        return value.nbytes
    if isinstance(value, dict):
        return sum(map(_array_bytes, value.values()))
    if isinstance(value, list | tuple):
        return sum(map(_array_bytes, value))
    return sum(map(_array_bytes, vars(value).values())) if hasattr(value, "__dict__") else 0


_cache: LRUCache[Hashable, Any] = LRUCache(_CACHE_BYTES, getsizeof=_size)


def kept(key: Hashable, make: Callable[[], Any]) -> Any:
    """Return what was made under this key, or make it; the least recently used are dropped beyond 300 MB."""
    with _lock:
        if key in _cache:
            return _cache[key]
    value = make()
    with _lock:
        if _size(value) <= _CACHE_BYTES:
            _cache[key] = value
    return value


def file_state(files: Any) -> tuple[tuple[str, int, int], ...]:
    """Name, time of change and size of files, for a key; a missing one is (name, 0, -1)."""
    paths = [files] if isinstance(files, str) else list(files or [])
    states = []
    for path in paths:
        try:
            stat = Path(path).stat()
            states.append((path, stat.st_mtime_ns, stat.st_size))
        except OSError:
            states.append((path, 0, -1))
    return tuple(states)

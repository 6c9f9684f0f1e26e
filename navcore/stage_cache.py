"""Stages of a scenario's environment, made once and kept, by what each depends on."""

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
    arrays = [item for item in vars(value).values() if isinstance(item, np.ndarray)]
    return 1024 + sum(array.nbytes for array in arrays)


_cache: LRUCache[Hashable, Any] = LRUCache(_CACHE_BYTES, getsizeof=_size)


def kept(key: Hashable, make: Callable[[], Any]) -> Any:
    """Return what was made under this key, or make it; the oldest are dropped beyond 300 MB."""
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

"""A cache for what is large and slow to make: recordings, truth, sensor errors; within 300 MB in all.

Its limit is a number of bytes. `functools.lru_cache` serves small results of pure functions, where a number
of entries is limit enough. Where several people share the process, each entry belongs to whom it was made
for, and what is dropped is the oldest of whoever holds most: one visitor's large runs do not displace what
all others need at their next step.
"""

import threading
from collections import Counter, OrderedDict
from collections.abc import Callable, Hashable, Iterator, Set
from contextlib import contextmanager
from contextvars import ContextVar
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

MAP_SUFFIX = ".map.toml"
"""Ending of the map that is saved beside a recording: ``log.csv.map.toml``."""
_CACHE_BYTES = 300 * 1024 * 1024
_owner: ContextVar[Hashable] = ContextVar("owner", default=None)


def bytes_of(value: Any) -> int:
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


class _Entry(NamedTuple):
    value: Any
    size: int
    owner: Hashable


class SharedCache:
    """Entries of several owners within one number of bytes.

    Parameters
    ----------
    most_bytes : int
        What all entries may take together; a larger one is not kept.
    """

    def __init__(self, most_bytes: int) -> None:
        self._most_bytes = most_bytes
        self._lock = threading.Lock()
        self._entries: OrderedDict[Hashable, _Entry] = OrderedDict()
        self._held: Counter[Hashable] = Counter()

    def get(self, key: Hashable) -> _Entry | None:
        """Return an entry, which counts as used now; None when there is none."""
        with self._lock:
            entry = self._entries.get(key)
            if entry is not None:
                self._entries.move_to_end(key)
            return entry

    def put(self, key: Hashable, value: Any, owner: Hashable) -> None:
        """Keep a value; beyond the limit the oldest entries of whoever holds most are dropped."""
        size = bytes_of(value)
        with self._lock:
            self._drop(key)
            if size > self._most_bytes:
                return
            self._entries[key] = _Entry(value, size, owner)
            self._held[owner] += size
            while self.bytes > self._most_bytes:
                most = max(self._held, key=self._held.__getitem__)
                self._drop(next(key for key, entry in self._entries.items() if entry.owner == most))

    def keep_only(self, owners: Set[Hashable]) -> None:
        """Drop the entries of all other owners."""
        with self._lock:
            for key in [key for key, entry in self._entries.items() if entry.owner not in owners]:
                self._drop(key)

    @property
    def bytes(self) -> int:
        """Bytes that the entries take."""
        return self._held.total()

    def _drop(self, key: Hashable) -> None:
        entry = self._entries.pop(key, None)
        if entry is not None:
            self._held[entry.owner] -= entry.size
            if self._held[entry.owner] <= 0:
                del self._held[entry.owner]


_cache = SharedCache(_CACHE_BYTES)


@contextmanager
def working_for(owner: Hashable) -> Iterator[None]:
    """Let what is made in this thread meanwhile belong to somebody."""
    before = _owner.set(owner)
    try:
        yield
    finally:
        _owner.reset(before)


def keep_only(owners: Set[Hashable]) -> None:
    """Forget what was made for anybody else; what belongs to nobody stays."""
    _cache.keep_only(owners | {None})


def kept(key: Hashable, make: Callable[[], Any]) -> Any:
    """Return what was made under this key, or make it and keep it."""
    entry = _cache.get(key)
    if entry is not None:
        return entry.value
    value = make()
    _cache.put(key, value, _owner.get())
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


def recorded_state(block: Any) -> tuple[tuple[str, int, int], ...]:
    """`file_state` of the recordings of a block of the scenario and of their maps."""
    return file_state(recorded_files(block))


def recorded_files(block: Any) -> list[str]:
    """Recordings of a block of the scenario and their maps: the one that is named, or those beside them."""
    files = getattr(block, "file", None)
    listed = [files] if isinstance(files, str) else list(files or [])
    named = getattr(block, "map", None)
    return [*listed, *([named] if named else (file + MAP_SUFFIX for file in listed))]

"""CPU time of the browser that a test or a measurement has started, by what it is for (Linux)."""

from __future__ import annotations

import os
from pathlib import Path

_PROC = Path("/proc")
_NS_PER_MS = 1e6


def browser_cpu_ms() -> tuple[float, float]:
    """CPU time of the pages' main threads, and of all else that paints: other threads of pages, GPU process.

    Counted by the scheduler in nanoseconds, so that a busy machine makes it longer only as far as its caches
    are shared.
    """
    main = other = 0
    for pid in _descendants(os.getpid()):
        kind = _kind(pid)
        if kind not in ("renderer", "gpu-process"):
            continue
        for thread in _entries(_PROC / str(pid) / "task"):
            time_ns = _cpu_ns(thread)
            if kind == "renderer" and thread.name == str(pid):
                main += time_ns
            else:
                other += time_ns
    return main / _NS_PER_MS, other / _NS_PER_MS


def _descendants(root: int) -> set[int]:
    children: dict[int, list[int]] = {}
    for entry in _entries(_PROC):
        if entry.name.isdigit():
            fields = _text(entry / "stat").rpartition(")")[2].split()
            if fields:
                children.setdefault(int(fields[1]), []).append(int(entry.name))
    found, waiting = set[int](), [root]
    while waiting:
        for child in children.get(waiting.pop(), ()):
            found.add(child)
            waiting.append(child)
    return found


def _kind(pid: int) -> str:
    words = _text(_PROC / str(pid) / "cmdline").replace("\0", " ").split()  # Chromium's children: by spaces
    return next((word.removeprefix("--type=") for word in words if word.startswith("--type=")), "")


def _cpu_ns(thread: Path) -> int:
    fields = _text(thread / "schedstat").split()
    return int(fields[0]) if fields else 0


def _entries(folder: Path) -> list[Path]:
    """What is in a folder of a process; nothing once the process has ended."""
    try:
        return list(folder.iterdir())
    except OSError:
        return []


def _text(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8", errors="replace")
    except OSError:
        return ""

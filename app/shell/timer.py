"""A timer that does not keep the process alive."""

from __future__ import annotations

import threading
from collections.abc import Callable


def timer(delay_s: float, act: Callable[..., None], *arguments: object) -> threading.Timer:
    """Return a timer, not yet started, that calls ``act(*arguments)`` after a delay."""
    made = threading.Timer(delay_s, act, arguments)
    made.daemon = True
    return made

"""Waiting for what threads do."""

import time
from collections.abc import Callable


def until(true: Callable[[], bool], seconds: float = 5.0) -> None:
    """Wait until something is so; fail when it is not in time."""
    end = time.monotonic() + seconds
    while not true():
        assert time.monotonic() < end, "did not happen"
        time.sleep(0.002)

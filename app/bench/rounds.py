"""Several pieces of work timed in turn, so that a slow minute of the machine hits all of them alike."""

from __future__ import annotations

import json
import statistics
import subprocess
import sys
import time
from collections.abc import Callable, Mapping
from typing import Any

from app.bench.process import environment

Timed = Callable[[], float]
"""Makes ready, does the work and returns the seconds of the work alone."""


def seconds_of(work: Callable[[], Any]) -> float:
    """Wall time of a call."""
    began = time.perf_counter()
    work()
    return time.perf_counter() - began


def median_ms(work: Callable[[], Any], repeats: int) -> float:
    """Median wall time of a call, ms; one before warms up."""
    return 1e3 * statistics.median(timed_rounds({"": lambda: seconds_of(work)}, repeats)[""])


def in_own_process(module: str) -> Any:
    """Run ``python -m module`` and read the JSON document it prints; its memory is its own."""
    words = [sys.executable, "-m", module]
    ended = subprocess.run(words, env=environment(), capture_output=True, text=True, check=True)
    return json.loads(ended.stdout)


def timed_rounds(works: Mapping[str, Timed], rounds: int) -> dict[str, list[float]]:
    """Seconds of each piece of work in each of some rounds; a round before them warms up."""
    times: dict[str, list[float]] = {name: [] for name in works}
    for number in range(rounds + 1):
        for name, work in works.items():
            seconds = work()
            if number:
                times[name].append(seconds)
    return times


def median_ratio(numerator: list[float], denominator: list[float]) -> float:
    """Median over the rounds of the ratio within a round."""
    return statistics.median(a / b for a, b in zip(numerator, denominator, strict=True))

"""Wall times: of calls one after the other, and of several pieces of work in turn."""

import json
import statistics
import subprocess
import sys
import time
from collections.abc import Callable, Iterable, Mapping
from typing import Any

from schuler_bench.bench.process import environment

Timed = Callable[[], float]
"""Makes ready, does the work and returns the seconds of the work alone."""


def seconds_of(work: Callable[[], Any]) -> float:
    """Wall time of a call."""
    began = time.perf_counter()
    work()
    return time.perf_counter() - began


def median_s(works: Iterable[Callable[[], Any]]) -> float:
    """Median wall time of some calls, s."""
    return statistics.median(map(seconds_of, works))


def in_own_process(module: str, *words: str) -> Any:
    """Run ``python -m module words`` and read the JSON document it prints; its memory is its own."""
    command = [sys.executable, "-m", module, *words]
    return json.loads(
        subprocess.run(command, env=environment(), capture_output=True, text=True, check=True).stdout
    )


def timed_rounds(works: Mapping[str, Timed], rounds: int) -> dict[str, list[float]]:
    """Seconds of each piece of work in each of some rounds; a round before them warms up.

    In turn, so that a slow minute of the machine hits all of them alike.
    """
    every = [{name: work() for name, work in works.items()} for _ in range(rounds + 1)]
    return {name: [times[name] for times in every[1:]] for name in works}


def median_ratio(numerator: list[float], denominator: list[float]) -> float:
    """Median over the rounds of the ratio within a round."""
    return statistics.median(a / b for a, b in zip(numerator, denominator, strict=True))

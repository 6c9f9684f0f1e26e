"""Looks for a worse log than the one that was found: ``python -m tools.worst_logs [--logs N] [--hours H]``.

For the methods of ten presets whose law looks at the data, random logs within the bound are played: telegraph
signals, sines, bounded walks and steps, at random rates and sizes. For each method it prints the largest of
their errors over the worst that `schuler worst` has found; above 1, a worse log exists.
"""

from __future__ import annotations

import argparse
import math
import time
from collections.abc import Iterator

import numpy as np

from navcore.design.worst.bounded import worst
from navcore.design.worst.played import silent
from navcore.design.worst.searched import Player
from navcore.quantities import COMPONENTS
from navcore.scenario.file import load

PRESETS = (
    "liu-limits",
    "liu-maneuvers",
    "liu-switching",
    "sun-ship",
    "sun-states",
    "sun-vehicle",
    "zha-drive",
    "zha-drive-2",
    "zha-drive-3",
    "zha-drive-5",
)
LOG_MAX = 1.0
"""m/s."""


def random_log(time_s: np.ndarray, generator: np.random.Generator) -> np.ndarray:
    """Errors of both axes within 1, shape (m, 2)."""
    return np.stack([_axis(time_s, generator) for _ in range(2)], axis=1)


def _axis(time_s: np.ndarray, generator: np.random.Generator) -> np.ndarray:
    end_s, size = float(time_s[-1]), float(generator.choice([1.0, generator.uniform(0.0, 1.0)]))
    kind = int(generator.integers(4))
    if kind == 0:  # telegraph
        mean_s = math.exp(generator.uniform(math.log(30.0), math.log(max(end_s, 60.0))))
        gaps = generator.exponential(mean_s, size=min(20_000, 10 + int(4.0 * end_s / mean_s)))
        turns = np.searchsorted(np.cumsum(gaps), time_s)
        return size * np.where(turns % 2, 1.0, -1.0) * generator.choice([-1.0, 1.0])
    if kind == 1:  # sine
        period_s = math.exp(generator.uniform(math.log(120.0), math.log(86400.0)))
        return size * np.sin(2.0 * math.pi * time_s / period_s + generator.uniform(0.0, 2.0 * math.pi))
    if kind == 2:  # a walk within the bound
        walk = np.cumsum(generator.normal(size=len(time_s)))
        return size * np.sin(walk * math.sqrt(generator.uniform(1e-6, 1e-2)))
    times = np.sort(generator.uniform(0.0, end_s, int(generator.integers(1, 12))))
    levels = generator.uniform(-1.0, 1.0, len(times) + 1)
    return size * levels[np.searchsorted(times, time_s)]


def compared(preset: str, logs: int, hours: float) -> Iterator[str]:
    """Yield a line a method of a preset."""
    scenario = load(preset)
    hours = min(hours, scenario.run.duration_h)
    scenario = load(preset, [f"run.duration_h={hours}"])
    found, quiet = worst(scenario, LOG_MAX), silent(scenario)
    for place, method in enumerate(quiet.method):
        if found.methods[place].bound != "found" or found.methods[place].diverged:
            continue
        told = scenario.model_copy(update={"method": (scenario.method[place],)})
        player, generator = Player(quiet, method, told), np.random.default_rng(place)
        largest = np.zeros(len(COMPONENTS))
        for _ in range(logs):
            largest = np.maximum(largest, player.largest(LOG_MAX * random_log(player.time_s, generator)))
        ratio = largest / np.maximum(found.methods[place].largest, 1e-300)
        worse = ", ".join(name for name, one in zip(COMPONENTS, ratio, strict=True) if one > 1.0)
        yield f"{preset:14} {method.name:28} {float(ratio.max()):6.3f}  {worse or 'none is worse'}"


def main() -> int:
    """Compare, and return 1 where a log is worse."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--logs", type=int, default=10_000, help="Random logs for each method.")
    parser.add_argument("--hours", type=float, default=6.0, help="Length of a run at most.")
    parser.add_argument("presets", nargs="*", default=PRESETS)
    given = parser.parse_args()
    beaten, began = False, time.perf_counter()
    for preset in given.presets:
        for line in compared(preset, given.logs, given.hours):
            print(line, flush=True)
            beaten |= not line.endswith("none is worse")
    print(f"{given.logs} logs a method, {time.perf_counter() - began:.0f} s")
    return int(beaten)


if __name__ == "__main__":
    raise SystemExit(main())

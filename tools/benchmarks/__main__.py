"""``python -m tools.benchmarks``: ours beside python-ins, then the strapdown keys of ``schuler bench``."""

from __future__ import annotations

import argparse
import json
import os
import statistics
import sys

from navcore.networks.compass import CompassNetwork
from navcore.networks.undamped import UndampedNetwork
from schuler_bench.bench.rounds import Timed, median_ratio, timed_rounds
from schuler_bench.bench.strapdown import YARDSTICK, StaticRecord, measure_strapdown
from tools.benchmarks.python_ins import PythonIns

HOUR_S = 3600
LEAST = {"kernel_to_free": 7.0, "public_call_to_free": 40.0}
"""How many times as fast as python-ins the free run must be (issue: Numbers)."""


def beside_python_ins(rounds: int = 5, seconds: int = HOUR_S) -> dict[str, float]:
    """Median ns a sample of both, and the ratios within a round.

    Raises
    ------
    ModuleNotFoundError
        The extra ``benchmarks`` is not installed.
    """
    record = StaticRecord(seconds)
    other = PythonIns(record)
    works: dict[str, Timed] = {
        "free": record.run("free", UndampedNetwork(), record.second),
        "damped": record.run("external", CompassNetwork(), record.second),
        "kernel": other.kernel(),
        "public_call": other.public_call(),
    }
    times = timed_rounds(works, rounds)
    names = {
        "free": "ours_free",
        "damped": "ours_damped",
        "kernel": "python_ins_kernel",
        "public_call": "python_ins_public_call",
    }
    found = {
        f"{name}_ns_per_sample": 1e9 * statistics.median(times[key]) / record.samples
        for key, name in names.items()
    }
    for theirs in ("kernel", "public_call"):
        for ours in ("free", "damped"):
            found[f"{theirs}_to_{ours}"] = median_ratio(times[theirs], times[ours])
    return found


def main(arguments: list[str] | None = None) -> int:
    """Measure and print; 1 when a ratio is below its goal, 2 when python-ins is not there."""
    parser = argparse.ArgumentParser(prog="python -m tools.benchmarks", description=__doc__)
    parser.add_argument("--json", action="store_true", help="print one JSON document")
    parser.add_argument("--rounds", type=int, default=5, help="repeats of which the median is taken")
    options = parser.parse_args(arguments)
    try:
        numbers = beside_python_ins(options.rounds)
    except ModuleNotFoundError as error:
        print(f"benchmarks: {error.name} is missing: run `make benchmarks`", file=sys.stderr)
        return 2
    numbers |= measure_strapdown(max(options.rounds, 5))
    if options.json:
        print(json.dumps({name: round(value, 4) for name, value in numbers.items()}))
    else:
        for name, value in numbers.items():
            goal = f"  (>= {LEAST[name]:g})" if name in LEAST else ""
            print(f"{name:<44} {value:10.2f}{goal}")
        if not os.environ.get(YARDSTICK):
            print(f"{YARDSTICK}=FILE adds the ratios to a reference timed in the same rounds")
    return int(any(numbers[name] < least for name, least in LEAST.items()))


if __name__ == "__main__":
    sys.exit(main())

"""Peak memory that a run of 24 h takes, in a process of its own: ``python -m app.bench.memory``."""

from __future__ import annotations

import statistics
import sys
from pathlib import Path

from app.bench.rounds import in_own_process

REPEATS = 5


def measure_memory() -> dict[str, float]:
    """Highest memory after a 24 h run of three methods, above that after a short run of the same, MiB."""
    return {
        "run_24h_memory_mb": statistics.median(in_own_process("app.bench.memory") for _ in range(REPEATS))
    }


def peak_mb() -> float:
    """Highest memory that this process has held so far, MiB."""
    status = Path("/proc/self/status")
    if status.exists():
        # On Linux ru_maxrss starts with the peak of the process that made this one.
        (peak,) = (line.split()[1] for line in status.read_text().splitlines() if line.startswith("VmHWM:"))
        return float(peak) / 1024.0
    import resource

    peak_bytes = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak_bytes / (1024.0 * 1024.0 if sys.platform == "darwin" else 1024.0)


def _above_start() -> float:
    from app.bench.error_model import day
    from navcore.engine.simulation import simulate

    simulate(day(seed=1, duration_h=0.1))
    start = peak_mb()
    simulate(day(seed=2))
    return peak_mb() - start


if __name__ == "__main__":
    print(f"{_above_start():.2f}")

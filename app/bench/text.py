"""The measured numbers as a table for people."""

from __future__ import annotations

from collections.abc import Mapping

from app.cli.table import columns, number

_ROWS = {
    "error_model_24h_ms_per_method": ("error model, 24 h at 1 s: a method, noise included", "ms", "20"),
    "error_model_24h_cold_ms": ("the same, one method, truth and noise made anew", "ms", ""),
    "run_24h_memory_mb": ("memory of a 24 h run of 3 methods above start", "MiB", "100"),
    "slider_to_frame_ms_p50": ("slider to last byte of the figures, 24 h, 3 methods: median", "ms", ""),
    "slider_to_frame_ms_p95": ("95th percentile", "ms", "100"),
    "startup_s": ("process start to page served", "s", "1.5"),
    "rss_mb": ("memory of the server after that", "MiB", ""),
}


def bench_text(numbers: Mapping[str, float]) -> list[str]:
    """One line a number, with unit and goal."""
    rows = [["", "measured", "", "goal"]]
    for key, value in numbers.items():
        what, unit, goal = _ROWS.get(key, (key, "", ""))
        rows.append([what, number(value, 3), unit, f"<= {goal}" if goal else ""])
    return columns(rows)

"""Start of the dashboard, and the way from a slider to the figures that answer it."""

from __future__ import annotations

import statistics

from app.bench.process import Server
from app.bench.visitor import PAGE_STATE, Visitor

STARTS = 5
STEPS = 40
_WARM_UP = 5
_PAUSE_S = 0.12
"""Between two steps of the slider, so that each is answered by itself; browsers send one in 50 ms at most."""
_WINDOW = "1920x1080|Method|Frequency|Errors"
"""Window and front tabs: Bode plots and all error curves are sent, and the ship's track in 3D."""


def measure_dashboard() -> dict[str, float]:
    """Median start; median and 95th percentile from the slider's message to the last byte of the figures."""
    starts = []
    for _ in range(STARTS - 1):
        with Server() as server:
            starts.append(server.startup_s)
    with Server() as server:
        starts.append(server.startup_s)
        answers = slider_to_frame_ms(server.port)
        memory = server.rss_mb()
    hundredths = statistics.quantiles(answers, n=100, method="inclusive")
    return {
        "slider_to_frame_ms_p50": hundredths[49],
        "slider_to_frame_ms_p95": hundredths[94],
        "startup_s": statistics.median(starts),
        "rss_mb": memory,
    }


def slider_to_frame_ms(port: int, steps: int = STEPS) -> list[float]:
    """Times of single steps of the slider zeta: 24 h at 1 s, three methods on a moving, noisy ship, ms."""
    with Visitor(port) as visitor:
        visitor.set(PAGE_STATE, _WINDOW)
        visitor.wait_for_run(1)
        _choose(visitor, "scenario", "sikuliaq-like")
        _choose(visitor, "duration (h), exact", 24.0)
        visitor.set("method to edit", "complementary")
        visitor.control("zeta")
        visitor.rest(1.0)
        answers = []
        for step in range(_WARM_UP + steps):
            number = visitor.run_number
            sent = visitor.set("zeta", round(0.6 + 0.01 * step, 3))
            answers.append(1e3 * (visitor.wait_for_run(number + 1) - sent))
            visitor.rest(_PAUSE_S)
    return answers[_WARM_UP:]


def _choose(visitor: Visitor, label: str, value: object) -> None:
    if visitor.held(label) == value:
        return
    number = visitor.run_number
    visitor.set(label, value)
    visitor.wait_for_run(number + 1)

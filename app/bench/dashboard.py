"""Start of the dashboard, and the way from a slider to the figures that answer it."""

import statistics

from navcore.networks.complementary import ComplementaryNetwork
from schuler_bench.bench.process import Server
from schuler_bench.bench.visitor import PAGE_STATE, Visitor
from schuler_bench.editing import form

STARTS = 5
STEPS = 40
_WARM_UP = 5
_PAUSE_S = 0.12
"""Between two steps of the slider, so that each is answered by itself; browsers send one in 30 ms at most."""
_WINDOW = "1920x1080|Method|Frequency|Errors"
"""Window and front tabs: Bode plots and all error curves are sent, and the ship's track in 3D."""
DESIGN = "1920x1080|Method|Design|Errors"
"""The steady budget and its floor follow the slider."""
_ALL_VIEWS = "1920x1080|Method|Frequency|Poles|Step|Errors|Metrics|Compare|Spectrum|Requirements|Scenario"
"""As if every tab were in front: more than any window shows at once."""
_MEASURED = (
    ("slider_to_frame", _WINDOW, 0),
    ("slider_design", DESIGN, 0),
    ("slider_all_views", _ALL_VIEWS, 2),
)
"""Name of the figure, window, and number of pinned runs."""
ZETA = form.full_label("zeta", ComplementaryNetwork.model_fields["zeta"])
"""Label of the slider that is moved."""


def measure_dashboard() -> dict[str, float]:
    """Median start; median and 95th percentile from the slider's message to the last byte of the figures."""
    starts: list[float] = []
    numbers: dict[str, float] = {}
    for start in range(STARTS):
        with Server() as server:
            starts.append(server.startup_s)
            if start == STARTS - 1:
                for name, window, pins in _MEASURED:
                    quantiles = median_and_p95(slider_to_frame_ms(server.port, window, pins))
                    numbers |= zip((f"{name}_ms_p50", f"{name}_ms_p95"), quantiles, strict=True)
                numbers["rss_mb"] = server.rss_mb()
    return numbers | {"startup_s": statistics.median(starts)}


def median_and_p95(times_ms: list[float]) -> tuple[float, float]:
    """Median and 95th percentile of at least two times."""
    hundredths = statistics.quantiles(times_ms, n=100, method="inclusive")
    return hundredths[49], hundredths[94]


def slider_to_frame_ms(port: int, window: str = _WINDOW, pins: int = 0, steps: int = STEPS) -> list[float]:
    """Times of single steps of the slider zeta: 24 h at 1 s, three methods on a moving, noisy ship, ms.

    Parameters
    ----------
    port : int
        Of the dashboard.
    window : str
        Size and front tabs, as the page reports them.
    pins : int
        So many runs are pinned first, and drawn with every answer.
    steps : int
        Timed steps.
    """
    upper = window.split("|")[2]
    with Visitor(port, f"bench-session-{upper}-{pins}") as visitor:
        visitor.set(PAGE_STATE, window)
        visitor.wait_for_run(1)
        _choose(visitor, "scenario", "sikuliaq-like")
        _choose(visitor, "duration (h), exact", "24")
        visitor.ask("edit-method", "2")
        visitor.control(ZETA)
        visitor.rest(1.0)
        for pin in range(pins):
            visitor.set(ZETA, 0.4 + 0.1 * pin)
            visitor.wait_for_run(visitor.run_number + 1)
            visitor.set("Pin this run", True)
            visitor.rest(0.5)
        answers = []
        for step in range(_WARM_UP + steps):
            number = visitor.run_number
            sent = visitor.set(ZETA, round(0.6 + 0.01 * step, 3))
            answers.append(1e3 * (visitor.wait_for_run(number + 1) - sent))
            visitor.rest(_PAUSE_S)
    return answers[_WARM_UP:]


def _choose(visitor: Visitor, label: str, value: object) -> None:
    if visitor.held(label) == value:
        return
    number = visitor.run_number
    visitor.set(label, value)
    visitor.wait_for_run(number + 1)

"""A method with a pair that is placed by hand: its scenario, and where its ring stands on the page."""

from typing import Any

import numpy as np

from navcore.scenario.file import load
from navcore.scenario.model import Scenario
from tests.browser.driver import Bench

NEAR = ("xaxis2", "yaxis2")


def placing_scenario(*more: dict[str, Any]) -> Scenario:
    """Two hours of a method whose network cannot place a pair, of one that can, and of ``more`` methods."""
    data = load("sikuliaq-like").canonical()
    data["run"] |= {"duration_h": 2.0}
    data["method"] = [
        {"name": "fixed", "damping": "external", "network": {"id": "classic2"}},
        {"name": "placed", "damping": "external", "network": {"id": "unity2", "zeta": 0.5, "r": 1.2}},
        *more,
    ]
    return Scenario.parse(data)


def place(bench: Bench, tab: str, *more: dict[str, Any]) -> None:
    """Select a method with a pair that can be placed, choices as at first, and bring a tab to the front."""
    origin = f"handles {bench.session.run_number}"
    bench.put(placing_scenario(*more), "Method", tab, origin=origin, selected=1)


def pair(bench: Bench) -> tuple[float, float]:
    network = bench.session.scenario.method[1].network.model_dump()
    return network["zeta"], network["r"]


def pole(bench: Bench) -> tuple[float, float]:
    zeta, r = pair(bench)
    return -zeta * r, r * np.sqrt(1.0 - zeta**2)


def ring_at(bench: Bench, *place: Any) -> None:
    """Wait until the last ring in view stands at a place of a panel."""
    bench.page.wait_for_function("look.at", arg=place or [*NEAR, *pole(bench)])


def spot(bench: Bench, *place: Any) -> tuple[float, float]:
    """Where a place of a panel lies in the window, CSS px."""
    return bench.page.evaluate("look.spot", place)


def centre(bench: Bench) -> tuple[float, float]:
    """Where the last ring in view stands, CSS px."""
    return bench.page.locator(".sb-handle:visible").last.evaluate("look.centre")


def drag(bench: Bench, to: tuple[float, float]) -> None:
    """Take the last ring in view to a place in the window."""
    mouse, (x, y) = bench.page.mouse, centre(bench)
    mouse.move(x, y)
    mouse.down()
    for part in (0.3, 0.6, 1.0):
        mouse.move(x + part * (to[0] - x), y + part * (to[1] - y))
    mouse.up()
    bench.settle()

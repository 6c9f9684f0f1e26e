"""The scenario of the tests that place a pair by hand."""

from __future__ import annotations

from typing import Any

from navcore.scenario.file import load
from navcore.scenario.model import Scenario


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

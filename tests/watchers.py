"""A page of a session that shows nothing, and runs that take no time: for tests of sessions."""

from __future__ import annotations

import threading
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

from navcore.foundation.errors import Fault, InputError
from navcore.scenario.model import Scenario


class Watcher:
    """A page that only notes what it is told: the method's name, and its first argument."""

    def __init__(self) -> None:
        self.told: list[tuple[str, Any]] = []

    def __getattr__(self, name: str) -> Callable[..., None]:
        return lambda *given: self.told.append((name, given[0] if given else None))

    def names(self) -> list[str]:
        return [name for name, _ in self.told]


def answer(scenario: Scenario, status: str = "ok") -> Any:
    return SimpleNamespace(scenario=scenario, status=status, methods=(), t_s=(), warnings=())


def simulate(scenario: Scenario, progress: Callable[[float], None], cancelled: Callable[[], bool]) -> Any:
    """Stand-in: 13 h cannot run, 14 h is a fault of ours, 15 h lasts until it is stopped."""
    hours = scenario.run.duration_h
    if hours == 13.0:
        raise InputError(Fault("", "motion.file", None, "is gone"))
    if hours == 14.0:
        raise ZeroDivisionError("ours")
    if hours == 15.0:
        progress(0.5)
        while not cancelled():
            threading.Event().wait(0.002)
        return answer(scenario, "stopped")
    return answer(scenario)

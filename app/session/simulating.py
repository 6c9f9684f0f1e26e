"""How a session runs its scenario, and which method its controls edit at first."""

from __future__ import annotations

from collections.abc import Callable

from navcore.engine.run import Run
from navcore.scenario.model import Scenario

Simulate = Callable[[Scenario, Callable[[float], None], Callable[[], bool]], Run]
"""``simulate(scenario, progress, cancelled)``."""


def simulate_after(before: Callable[[], Run | None]) -> Simulate:
    """Run scenarios; what the run that is shown has computed already is taken from it.

    Parameters
    ----------
    before : callable
        Gives the run that is shown.
    """

    def again(scenario: Scenario, progress: Callable[[float], None], cancelled: Callable[[], bool]) -> Run:
        from navcore.engine.simulation import simulate

        return simulate(scenario, progress, cancelled, before())

    return again


def first_editable(scenario: Scenario) -> int:
    """Index of the first method with something to tune; 0 if there is none."""
    tunable = (
        i for i, m in enumerate(scenario.method) if not m.undamped and len(type(m.network).model_fields) > 1
    )
    return next(tunable, 0)

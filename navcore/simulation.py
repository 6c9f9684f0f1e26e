"""simulate(scenario) -> Run: truth and sensors once, then every method on them, with progress and cancel."""

from __future__ import annotations

from navcore.drivers.common import Cancelled, Progress
from navcore.drivers.linear import run_linear
from navcore.run import Run
from navcore.scenario import Scenario


def simulate(scenario: Scenario, progress: Progress | None = None, cancelled: Cancelled | None = None) -> Run:
    """Run every method of a scenario on identical truth, sensor errors and log.

    Parameters
    ----------
    scenario : Scenario
        Complete and checked.
    progress : callable, optional
        Called with the fraction done, 0..1, from any thread.
    cancelled : callable, optional
        Asked between chunks; when it says True the run stops and what was computed is kept (status
        "stopped").

    Raises
    ------
    InputError
        The motion or a recording cannot serve the scenario.
    """
    if scenario.strapdown:
        # Only now: the strapdown kernels are slow to import, and most runs are linear.
        from navcore.drivers.strapdown import run_strapdown

        return run_strapdown(scenario, progress, cancelled)
    return run_linear(scenario, progress, cancelled)

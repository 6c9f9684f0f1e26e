"""Where a run that a visitor waits for is computed: here, or a long one beside others in a helper."""

from collections.abc import Callable

from navcore.engine.load import estimated_bytes
from navcore.engine.run import Run
from navcore.scenario.model import Scenario
from schuler_bench.jobs import helper
from schuler_bench.jobs.scheduler import Lane, scheduler
from schuler_bench.jobs.worker import Watch

_MOST_HERE = 256 << 20
"""Estimated bytes of a run in the server's own process."""
Progress = Callable[[float], None]
Cancelled = Callable[[], bool]


def run_for(
    visitor: object,
    here: Callable[[Scenario, Progress, Cancelled], Run],
    scenario: Scenario,
    progress: Progress,
    watch: Watch,
) -> Run | None:
    """Run a scenario for a visitor.

    A long run takes the interpreter from the answers to the others. While there are any, a helper does it,
    which has nothing of what the run before has computed. A helper also does what takes much memory: its
    process gives that back.

    Parameters
    ----------
    visitor : object
        Whose run it is.
    here : callable
        Runs it in this process.
    scenario : Scenario
        Complete and checked.
    progress : callable
        Told the fraction done.
    watch : Watch
        Of the job.

    Returns
    -------
    Run or None
        None: nobody wants it any more.
    """
    large = estimated_bytes(scenario) > _MOST_HERE
    if watch.lane is Lane.LONG and helper.helps(alone) and (large or scheduler().others_about(visitor)):
        found = helper.compute(alone, [scenario], progress, watch.cancelled)
        return None if found is None else found[0]
    return here(scenario, progress, watch.cancelled)


def alone(scenario: Scenario, progress: Progress, cancelled: Cancelled) -> Run:
    """Run a scenario; a helper finds this function by its name."""
    from navcore.engine.simulation import simulate

    return simulate(scenario, progress, cancelled)

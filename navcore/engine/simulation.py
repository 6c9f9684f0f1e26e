"""simulate(scenario) -> Run: truth and sensors once, then every method on them, with progress and cancel."""

from navcore.engine.drivers.common import Cancelled, Progress
from navcore.engine.drivers.linear import run_linear
from navcore.engine.drivers.outside import run_outside
from navcore.engine.run import Run
from navcore.scenario.model import Scenario


def simulate(
    scenario: Scenario,
    progress: Progress | None = None,
    cancelled: Cancelled | None = None,
    before: Run | None = None,
) -> Run:
    """Run every method of a scenario on the same truth, sensor errors and log.

    Parameters
    ----------
    scenario : Scenario
        What to run; `navcore.scenario.file.load` makes one.
    progress : callable, optional
        ``progress(fraction)`` is called with the part that is done, 0 to 1, from any thread.
    cancelled : callable, optional
        ``cancelled()`` is asked between chunks. When it returns True, the run stops and keeps what it has
        computed; its methods have the status "stopped".
    before : Run, optional
        An earlier run. A method of it that would come out the same, bit by bit, because neither it nor
        anything that all methods share has changed since, is taken over (linear fidelities).

    Returns
    -------
    Run
        One `MethodRun` for each method, in the scenario's order. A method that diverges does not raise: its
        status is "diverged", and its rows end where it did.

    Raises
    ------
    InputError
        The motion or a recording does not fit the scenario, such as a run longer than its recording.

    Examples
    --------
    >>> from navcore import load, simulate
    >>> run = simulate(load("zha-fast", ["run.duration_h=1"]))
    >>> [f"{m.method.name}: {m.loop.damping_ratio:.2f}" for m in run.methods]
    ['free: 0.00', 'classic2: 0.70', 'fast (compass): 0.70']
    """
    if scenario.strapdown:
        # Only now: the strapdown kernels are slow to import, and most runs are linear.
        from navcore.engine.drivers.strapdown import run_strapdown

        return run_strapdown(scenario, progress, cancelled)
    if scenario.on_ins:
        return run_outside(scenario, progress, cancelled)
    return run_linear(scenario, progress, cancelled, before)

"""What seeds say of the limits that one run is judged by: a run takes 0 where only a deviation is given."""

from collections.abc import Callable

from navcore.design.measures import TUNING_INTERVALS
from navcore.design.shares import Share, require_limits, shares_of, wilson
from navcore.design.ship import Ship
from navcore.engine.ensemble import outcomes
from navcore.engine.measures import SeedShare
from navcore.scenario.model import Scenario
from navcore.scenario.stochastic import given_deviations

SEEDS = 24


def draws_more_than_a_run(scenario: Scenario) -> bool:
    """Whether a scenario has limits, and gives standard deviations that one run does not draw by."""
    return bool(scenario.requirement and scenario.method and given_deviations(scenario))


def run_shares(
    scenario: Scenario,
    seeds: int = SEEDS,
    progress: Callable[[float], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> tuple[SeedShare, ...]:
    """Judge the methods of a scenario over seeds, as `navcore.designs` judges them as set.

    Parameters
    ----------
    scenario : Scenario
        With limits.
    seeds : int
        Runs of each method: the first seeds of a design.
    progress, cancelled : callable, optional
        As of `navcore.engine.ensemble.outcomes`.

    Returns
    -------
    tuple of SeedShare
        One a method; empty when it was cancelled before all seeds were run.

    Raises
    ------
    InputError
        There is a limit that a run cannot be judged by, or a seed that cannot be run.
    """
    require_limits(scenario)
    found = outcomes(scenario, scenario.method, range(seeds), progress, cancelled)
    if len(found) < seeds:
        return ()
    ship = Ship(scenario, True, TUNING_INTERVALS, drawn=True)
    return tuple(_shown(share, seeds) for share in shares_of(ship, scenario.method, found))


def _shown(share: Share, seeds: int) -> SeedShare:
    limits = tuple((one.met, wilson(round(one.met * seeds), seeds)) for one in share.limits)
    return SeedShare(seeds, share.met, (share.low, share.high), limits)

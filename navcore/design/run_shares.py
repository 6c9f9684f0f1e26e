"""What seeds say of the limits that one run is judged by: a run takes 0 where only a deviation is given."""

from collections.abc import Callable

from navcore.design.measures import TUNING_INTERVALS
from navcore.design.shares import Share, require_limits, shares_of
from navcore.design.ship import Ship
from navcore.engine.ensemble import outcomes
from navcore.engine.load import estimated_seconds
from navcore.engine.measures import SeedShare, needs_seeds
from navcore.scenario.model import Scenario
from navcore.scenario.stochastic import given_deviations

SEEDS, MOST_SEEDS = 24, 200
_LONGEST_S = 120.0
"""Processor time that the seeds of all methods may take."""


def draws_more_than_a_run(scenario: Scenario) -> bool:
    """Whether seeds say more of the limits than a run: these ask for them, or deviations are given."""
    limits = scenario.requirement
    return bool(limits and scenario.method and (given_deviations(scenario) or any(map(needs_seeds, limits))))


def seeds_for(scenario: Scenario, *, wanted: bool = False) -> int:
    """Seeds of `run_shares`: as many as of a design where they are wanted or a limit asks for them.

    Fewer where runs are long.
    """
    if not wanted and not any(map(needs_seeds, scenario.requirement)):
        return SEEDS
    return max(SEEDS, min(MOST_SEEDS, int(_LONGEST_S / max(estimated_seconds(scenario), 1e-3))))


def run_shares(
    scenario: Scenario,
    seeds: int | None = None,
    progress: Callable[[float], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> tuple[SeedShare, ...]:
    """Judge the methods of a scenario over seeds, as `navcore.designs` judges them as set.

    Parameters
    ----------
    scenario : Scenario
        With limits.
    seeds : int, optional
        Runs of each method: the first seeds of a design; by default `seeds_for` the scenario.
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
    seeds = seeds_for(scenario) if seeds is None else seeds
    found = outcomes(scenario, scenario.method, range(seeds), progress, cancelled)
    if len(found) < seeds:
        return ()
    ship = Ship(scenario, True, TUNING_INTERVALS, drawn=True)
    return tuple(seed_share(share, seeds) for share in shares_of(ship, scenario.method, found))


def seed_share(share: Share, seeds: int) -> SeedShare:
    """Share of a design as metrics hold it, of so many seeds."""
    limits = tuple(one.judgement for one in share.limits)
    return SeedShare(seeds, share.met, (share.low, share.high), limits)

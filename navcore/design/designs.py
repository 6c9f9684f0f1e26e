"""From limits to designs: which methods meet the requirements, on which share of seeds (theory.md 18)."""

from collections.abc import Callable, Sequence
from dataclasses import replace

from navcore.design.judged import Designs
from navcore.design.measures import TUNING_INTERVALS
from navcore.design.needed import needed
from navcore.design.shares import require_limits, shares_of
from navcore.design.ship import Ship
from navcore.design.stated import assumed_zero
from navcore.design.tuned_designs import held_as_set, kalman, tuned_methods
from navcore.engine.ensemble import outcomes
from navcore.engine.load import estimated_seconds
from navcore.foundation.errors import Fault, InputError, StoppedError
from navcore.foundation.progress import part_of
from navcore.foundation.text import Text
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario

SEEDS = 200
_FEW, _AFTER_STOP_S = 4, 2.0
"""Seeds that judge what was tuned before a stop, and about how long these may take, s."""
_TUNING_SHARE = 0.5
"""Of the time that a design takes."""


def designs(
    scenario: Scenario,
    seeds: int = SEEDS,
    *,
    as_set: bool = False,
    progress: Callable[[float], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> Designs:
    """Judge methods by the share of seeds on which they meet all requirements of a scenario.

    Parameters
    ----------
    scenario : Scenario
        With requirements.
    seeds : int
        Runs of each method; their seeds follow that of the scenario, the same for all methods. Each draws the
        noise and the constants (`navcore.engine.ensemble.drawn`).
    as_set : bool
        Judge the scenario's methods as they stand; else each network of the catalogue, tuned for the largest
        share, a Kalman filter that is told the same standard deviations, and the scenario's own methods with
        an azimuth network or a gyrocompass as they stand.
    progress, cancelled : callable, optional
        Told the fraction done, 0..1; when ``cancelled`` says True, what was completed is judged: what was
        tuned by then, on a few seeds, or all methods on the seeds that were run.

    Raises
    ------
    InputError
        There is no requirement, one that this run cannot be judged by, or no method.

    Examples
    --------
    >>> from navcore import designs, load
    >>> limit = ["requirement.0.quantity=velocity_rms_mps", "requirement.0.at_most=0.5"]
    >>> found = designs(load("zha-fast", ["run.duration_h=1", *limit]), 4, as_set=True)
    >>> found.seeds, len(found.methods)
    (4, 3)
    """
    require_limits(scenario)
    if seeds < 1:
        raise InputError(Fault("", "--seeds", seeds, Text("must be >= 1")))
    if scenario.on_ins and not as_set:
        told = Text(
            "is needed on [ins]: a recording is one draw, on which networks are not tuned for a share; tune "
            "one with tune, then judge it"
        )
        raise InputError(Fault("", "--as-set", None, told))
    share = 0.0 if as_set else _TUNING_SHARE
    if as_set:
        methods, left_out, early = scenario.method, (), False
    else:
        tuned, left_out = tuned_methods(scenario, part_of(progress, 0.0, share), cancelled)
        early = cancelled is not None and cancelled()
        methods = tuple(tuned) if early else (*tuned, *held_as_set(scenario), *kalman(scenario))
    if early:
        seeds, cancelled = _few(scenario, methods, seeds), None
    elif not methods:
        raise InputError([Fault("", "method", name, reason) for name, reason in left_out])
    found = outcomes(scenario, methods, range(seeds), part_of(progress, share, 1.0), cancelled)
    stopped = early or (cancelled is not None and cancelled())
    if not found:
        raise _too_early(seeds)
    ship = Ship(scenario, True, TUNING_INTERVALS, drawn=True)
    shares = tuple(sorted(shares_of(ship, methods, found), key=lambda share: share.order))
    left_out = (*((one.name, one.reason) for one in scenario.refused), *left_out)
    result = Designs(len(found), shares, assumed_zero(scenario), left_out, stopped=stopped)
    if result.met or stopped or scenario.on_ins:
        return result
    return replace(result, needed=needed(scenario, shares, cancelled))


def _few(scenario: Scenario, methods: Sequence[Method], seeds: int) -> int:
    """Seeds by which to judge what a search has found that was stopped: a few, which take little time.

    Raises
    ------
    StoppedError
        Not even one, or nothing was found.
    """
    each_s = estimated_seconds(scenario.model_copy(update={"method": tuple(methods)}))
    few = min(seeds, _FEW, int(_AFTER_STOP_S / each_s))
    if not (methods and few):
        raise _too_early(seeds)
    return few


def _too_early(seeds: int) -> StoppedError:
    return StoppedError(
        Fault("", "--seeds", seeds, Text("the command was stopped before a seed was completed"))
    )

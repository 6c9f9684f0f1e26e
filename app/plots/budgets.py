"""The steady error budget that several views show, computed once for each method of a scenario."""

from dataclasses import replace
from functools import lru_cache
from typing import Any

from navcore.design.budget import Budget, budget
from navcore.foundation.errors import InputError
from navcore.foundation.text import Text
from navcore.scenario.model import Scenario
from schuler_bench.plots.units import number


def steady_budget(scenario: Scenario) -> Budget:
    """Steady budget of a scenario; a method that is as it was is not computed again.

    Raises
    ------
    InputError
        A method has no loop of its own.
    """
    # frozen, and so hashable, which its type does not say
    keys: list[Any] = [scenario.model_copy(update={"method": (method,)}) for method in scenario.method]
    budgets = [_kept(key) for key in keys]
    beside = next((each for each in budgets if not each.floor_reason), budgets[0])
    return replace(beside, methods=tuple(each.methods[0] for each in budgets))


@lru_cache(maxsize=64)
def _kept(scenario: Any) -> Budget:
    return budget(scenario, steady=True)


def times_the_floor(scenario: Scenario) -> list[str]:
    """For every method its steady tilt and velocity over the floor, as text.

    Examples
    --------
    >>> from navcore import load
    >>> times_the_floor(load("sikuliaq-like"))[1]
    '1.68, 9.26'
    """
    try:
        steady = steady_budget(scenario)
    except InputError:
        return ["none"] * len(scenario.method)
    if steady.floor_reason:
        return [Text("no floor")] * len(scenario.method)
    texts = []
    for method, given in zip(steady.methods, scenario.method, strict=True):
        times = [number(value, 3) for value in steady.times_floor(method).values() if value is not None]
        ratios = Text("the floor itself") if given.kind.covering == "filter" else ", ".join(times)
        texts.append(ratios or (Text("no steady state") if given.reads_log else Text("without the log")))
    return texts

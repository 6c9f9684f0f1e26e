"""The steady error budget that several views show, computed once a scenario."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

from app.plots.units import number
from navcore.design.budget import Budget, budget
from navcore.foundation.errors import InputError
from navcore.scenario.model import Scenario


def steady_budget(scenario: Scenario) -> Budget:
    """Steady budget of a scenario.

    Raises
    ------
    InputError
        A method has no loop of its own.
    """
    key: Any = scenario  # frozen, and so hashable, which its type does not say
    return _kept(key)


@lru_cache(maxsize=32)
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
        found = steady_budget(scenario)
    except InputError:
        return ["none"] * len(scenario.method)
    if found.floor_reason:
        return ["no floor"] * len(scenario.method)
    texts = []
    for method in found.methods:
        times = [value for value in found.times_floor(method).values() if value is not None]
        texts.append(", ".join(number(value, 3) for value in times) or "no steady state")
    return texts

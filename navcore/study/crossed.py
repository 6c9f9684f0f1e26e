"""A study of a scenario as it stands, over one or two of its quantities, with several seeds."""

from __future__ import annotations

from collections.abc import Sequence

from navcore.design.vary import read_varied
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.scenario.model import Scenario
from navcore.study.model import OF_RUNS, Factor, Output, Study
from navcore.study.sweep import KEYS, swept_factor

_VALUES = 7
"""Of a parameter, over the range of its slider."""


def crossed(scenario: Scenario, keys: Sequence[str], seeds: int) -> Study:
    """Lay a grid over a scenario: every value of one quantity with every value of the other.

    Parameters
    ----------
    scenario : Scenario
        Complete and checked.
    keys : sequence of str
        What is varied: `navcore.study.sweep.KEYS`, or numbers of a method, ``method.1.network.xi``.
    seeds : int
        Runs at each point.

    Raises
    ------
    InputError
        A quantity that the scenario does not have, or twice the same one.

    Examples
    --------
    >>> from navcore import load
    >>> found = crossed(load("zha-fast"), ["latitude", "method.2.network.xi"], 10)
    >>> len(found.factor), len(found.factor[0].values), found.seeds
    (2, 7, 10)
    """
    if len({*keys}) < len(keys):
        raise InputError(Fault("", "factor", keys[0], Text("must not be varied twice")))
    factors = tuple(swept_factor(scenario, key) if key in KEYS else _parameter(scenario, key) for key in keys)
    return Study(
        title=scenario.title,
        scenario=scenario.canonical(),
        factor=factors,
        seeds=seeds,
        output=Output(metrics=OF_RUNS),
    )


def _parameter(scenario: Scenario, field: str) -> Factor:
    """Values over the range of a slider, with the present one."""
    (one,) = read_varied(scenario, [field])
    values = {float(f"{one.value(k / (_VALUES - 1)):.4g}") for k in range(_VALUES)}
    data = scenario.method[one.method].model_dump(mode="json", exclude_none=True)
    for name in one.path:
        data = data.get(name, {})
    present = {float(data)} if isinstance(data, float | int) else set()
    return Factor(field=field, values=(*sorted(values | present),))

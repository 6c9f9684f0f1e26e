"""An objective over each parameter of a network, the others as they are: what a search has before it."""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from navcore.design.measures import TUNING_INTERVALS, Setting, in_display_unit, measure, over_run
from navcore.design.ship import Ship
from navcore.design.vary import Varied, changed, present, read_varied
from navcore.foundation.answers import Answer, Column, Table, number
from navcore.foundation.errors import InputError
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario

_PLACES = 21


@dataclass(frozen=True)
class Profile:
    """An objective over one parameter.

    Attributes
    ----------
    field : str
        ``method.1.network.sigma``.
    log : bool
        The values stand in equal ratios.
    values : tuple of float
        Of the parameter, in the unit of its field.
    found : tuple of float
        Objective at each, SI; infinite where it has none.
    now : (float, float) or None
        Value and objective of the present setting; None where the parameter is not given.
    """

    field: str
    log: bool
    values: tuple[float, ...]
    found: tuple[float, ...]
    now: tuple[float, float] | None


@dataclass(frozen=True)
class Profiles(Answer):
    """An objective over each of some parameters.

    Attributes
    ----------
    of : str
        The objective.
    curves : tuple of Profile
        One a parameter.
    stopped : bool
        It was cancelled: the parameters that were done.
    """

    of: str
    curves: tuple[Profile, ...]
    stopped: bool = False

    def document(self) -> dict[str, Any]:
        """Return a document that JSON can hold."""
        return {
            "objective": self.of,
            "curves": [
                {
                    "field": one.field,
                    "values": list(one.values),
                    "objective": [_finite(value) for value in one.found],
                    "now": one.now and {"value": one.now[0], "objective": _finite(one.now[1])},
                }
                for one in self.curves
            ],
            "stopped": self.stopped,
        }

    def rows(self) -> Iterator[Table]:
        """Give a table for each parameter."""
        for one in self.curves:
            unit = in_display_unit(self.of, None)[1]
            found = [in_display_unit(self.of, value)[0] for value in one.found]
            rows = tuple((number(value), each) for value, each in zip(one.values, found, strict=True))
            yield Table((Column(one.field), Column(self.of, unit)), rows)


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None


def profiles(
    scenario: Scenario,
    objective: str,
    vary: Sequence[str],
    *,
    along: bool = False,
    whole: bool = False,
    progress: Callable[[float], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> Profiles:
    """Measure an objective at places over the range of each parameter.

    Parameters
    ----------
    scenario, objective, vary, along
        As of `navcore.design.tune.tune`; the objective is one measure.
    whole : bool
        Over all that the fields allow, not only what their sliders reach.
    progress, cancelled : callable, optional
        Told the fraction done, 0..1; when ``cancelled`` says True the parameters done so far are given.

    Raises
    ------
    InputError
        A field must not vary.
    """
    varied = read_varied(scenario, vary, whole)
    method = scenario.method[varied[0].method]
    ship = Ship(scenario, along or over_run((objective,)) or method.policy.tunes, TUNING_INTERVALS)

    def measured(setting: Method) -> float:
        try:
            return measure(Setting(ship, setting), objective)
        except InputError:
            return math.inf

    def at(one: Varied, value: float) -> float:
        try:
            return measured(changed(scenario, (one,), (value,)))
        except InputError:
            return math.inf  # the values do not go together

    lines: list[Profile] = []
    here = measured(scenario.designed(method))
    for one, value in zip(varied, present(scenario, varied), strict=True):
        if cancelled is not None and cancelled():
            break
        values = tuple(one.value(place / (_PLACES - 1)) for place in range(_PLACES))
        now = None if math.isnan(value) else (float(value), here)
        lines.append(Profile(one.field, one.log, values, tuple(at(one, each) for each in values), now))
        if progress is not None:
            progress(len(lines) / len(varied))
    return Profiles(objective, tuple(lines), len(lines) < len(varied))

"""The best setting of a method over a study's points, and what that costs in the scenario itself."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, fields, replace
from typing import Any

import numpy as np

from navcore.design.measures import TUNING_INTERVALS, Requirement, Setting, read_objective
from navcore.design.ship import Ship
from navcore.design.tune import tune
from navcore.design.tuned import Tuned, in_unit
from navcore.design.vary import read_varied
from navcore.foundation.answers import Column, Table
from navcore.foundation.errors import InputError
from navcore.foundation.progress import part_of
from navcore.foundation.text import Text
from navcore.scenario.model import Scenario
from navcore.study.model import Study
from navcore.study.robust import points_of

_SEARCHED = 6
"""Points for which a setting is searched, from the easiest to the hardest."""
_CANNOT_BE = (InputError, np.linalg.LinAlgError)
_ALONE = 0.3
"""Of the time, for the setting that is best in the scenario itself."""


@dataclass(frozen=True)
class TunedOver(Tuned):
    """Result of a search over points; its runs are of the point that was hardest before.

    Attributes
    ----------
    points : int
        Of the study, the scenario itself not counted.
    worst : float
        Objective where it is largest, SI; of a sum, relative to what the scenario itself gave before.
    where : dict
        Values of the factors there; empty for the scenario itself.
    here, best_here : float
        Objective in the scenario itself, and that of the setting that is best there.
    """

    points: int = 0
    worst: float = math.nan
    where: dict[str, Any] = field(default_factory=dict)
    here: float = math.nan
    best_here: float = math.nan

    def _about(self) -> Iterator[Table | str]:
        where = ", ".join(f"{name} = {value}" for name, value in self.where.items())
        yield Table(
            (Column(Text("over {points} points", points=self.points)), Column(), Column(), Column()),
            (
                (Text("  worst"), *in_unit(self.of, self.worst), where or Text("the scenario itself")),
                (Text("  in the scenario itself"), *in_unit(self.of, self.here), ""),
                (Text("  best there"), *in_unit(self.of, self.best_here), ""),
            ),
        )

    def document(self) -> dict[str, Any]:
        """Return the document of interface.md."""
        own = {"points": self.points, "worst": {"factors": self.where, "objective": self.worst}}
        return {**super().document(), "over": {**own, "here": self.here, "best_here": self.best_here}}


def tune_over(
    scenario: Scenario,
    study: Study,
    objective: str,
    vary: Sequence[str],
    require: Sequence[str | Requirement] = (),
    *,
    along: bool = False,
    whole: bool = False,
    default_limits: bool = True,
    confirm: bool = False,
    progress: Callable[[float], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> TunedOver:
    """Find the parameters that make the largest objective over a study's points least.

    The search sees six points, from the easiest to the hardest for the present setting; the worst of all
    points is given.

    Parameters
    ----------
    scenario : Scenario
        With the method; it counts as a point.
    study : Study
        Its factors and sample say what may differ; its own scenario, seeds and outputs do not count.
    objective, vary, require, along, whole, default_limits, progress, cancelled
        As of `navcore.design.tune.tune`.
    confirm : bool
        Run the present setting and the proposal on 32 seeds of the hardest point.

    Raises
    ------
    InputError
        As of `tune` and of `navcore.study.robust.robust_designs`; a study without points has none.
    UnstableError
        The level loop of every setting is unstable, or the proposal diverges in a run.
    """
    plan, places, points = points_of(scenario, study)
    wanted, index = read_objective(objective), read_varied(scenario, vary, whole)[0].method
    given = {"along": along, "whole": whole, "default_limits": default_limits, "cancelled": cancelled}
    units: dict[str, float] = {}

    def at(point: Scenario, setting: Scenario, over_the_run: bool) -> Setting:
        """The method as it is set in a scenario, at a point."""
        return Setting(Ship(point, over_the_run, TUNING_INTERVALS), setting.method[index])

    def value(point: Scenario, setting: Scenario, over_the_run: bool) -> float:
        """Objective there; infinite where it cannot be."""
        try:
            return wanted.value(at(point, setting, over_the_run), units)
        except _CANNOT_BE:
            return math.inf

    alone = tune(scenario, objective, vary, require, progress=part_of(progress, 0.0, _ALONE), **given)
    everywhere = (scenario, *points)
    over_the_run = alone.judged == "ensemble"
    with suppress(*_CANNOT_BE):
        units |= wanted.reference([at(scenario, scenario, over_the_run)])
    before = [value(one, one, over_the_run) for one in everywhere]
    order = np.argsort(before, kind="stable")
    picked = order[np.unique(np.linspace(0, len(order) - 1, _SEARCHED).round().astype(int))].tolist()
    *others, hardest = (everywhere[place] for place in picked)
    found = tune(
        hardest, objective, vary, require,
        worst_of=others, confirm=confirm, progress=part_of(progress, _ALONE, 1.0), **given,
    )  # fmt: skip
    methods = found.scenario.method
    over_the_run = found.judged == "ensemble"
    after = [value(one, found.scenario, over_the_run) for one in everywhere]
    worst = int(np.argmax(after))
    found = replace(found, scenario=scenario.model_copy(update={"method": methods}))
    return TunedOver(
        **{one.name: getattr(found, one.name) for one in fields(found)},
        points=len(points),
        worst=after[worst],
        where=plan.values(places[worst - 1]) if worst else {},
        here=after[0],
        best_here=value(scenario, alone.scenario, over_the_run),
    )

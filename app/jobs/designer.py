"""Error budgets along a run and searches for the best setting, one at a time, in the background."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from app.jobs.load import spare_load
from app.jobs.search import Search
from navcore.scenario.model import Scenario

if TYPE_CHECKING:
    from navcore.design.budget import Budget
    from navcore.design.tune import Tuned


class Budgeter(Search[Scenario, "Budget"]):
    """Computes the error budget along one scenario's run at a time.

    Parameters
    ----------
    tell : callable
        ``tell()`` whenever there is something new to show.
    name : str
        Of the visitor, for the turns.
    """

    def __init__(self, tell: Callable[[], None], name: str = "budgeter") -> None:
        super().__init__(tell, _budget, lambda found: True, "Stopped: no budget.", name, spare_load)

    def beside(self, scenario: Scenario) -> Budget | None:
        """Budget of exactly this scenario; None when there is none."""
        return self.result if self.asked == scenario else None


@dataclass(frozen=True)
class TuningTask:
    """What to tune.

    Attributes
    ----------
    scenario : Scenario
        As it stands.
    objective : str
        A name of `navcore.design.measures.MEASURES`.
    vary : tuple of str
        Fields, ``method.1.network.sigma``.
    require : tuple of str
        Limits, ``settling_s<=3600``.
    """

    scenario: Scenario
    objective: str
    vary: tuple[str, ...]
    require: tuple[str, ...]


class Designer(Search[TuningTask, "Tuned"]):
    """Searches for the best setting of one method at a time; a stopped search still proposes its best.

    Parameters
    ----------
    tell : callable
        ``tell()`` whenever there is something new to show.
    name : str
        Of the visitor, for the turns.
    """

    def __init__(self, tell: Callable[[], None], name: str = "designer") -> None:
        super().__init__(
            tell,
            _tune,
            lambda found: True,
            "Stopped: there is no proposal.",
            name,
            lambda task: spare_load(task.scenario),
        )

    def discard(self) -> None:
        """Forget the proposal."""
        self.result = self.asked = None
        self.words = ()
        self._tell()


def _budget(scenario: Scenario, progress: Callable[[float], None], cancelled: Callable[[], bool]) -> Budget:
    from navcore.design.budget import budget

    return budget(scenario, progress=progress, cancelled=cancelled)


def _tune(task: TuningTask, progress: Callable[[float], None], cancelled: Callable[[], bool]) -> Tuned:
    from navcore.design.tune import tune

    return tune(
        task.scenario, task.objective, task.vary, task.require, progress=progress, cancelled=cancelled
    )

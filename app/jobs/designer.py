"""Error budgets along a run and searches for the best setting, one at a time, in the background."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from app.jobs.load import heavy_load
from app.jobs.search import Search
from navcore.scenario.model import Scenario

if TYPE_CHECKING:
    from navcore.design.budget import Budget
    from navcore.design.pareto import Pareto
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
        super().__init__(tell, _budget, lambda found: True, "Stopped: no budget.", name, heavy_load)

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
    """Searches for the best setting of one method at a time.

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
            lambda task: heavy_load(task.scenario),
        )

    def discard(self) -> None:
        """Forget the proposal."""
        self.result = self.asked = None
        self.words = ()
        self._tell()


@dataclass(frozen=True)
class FrontsTask:
    """Whose Pareto fronts to find.

    Attributes
    ----------
    scenario : Scenario
        As it stands.
    method : int
        The method whose network is replaced by each of the catalogue.
    objectives : (str, str)
        Names of `navcore.design.measures.MEASURES`: what is on the axes.
    networks : tuple of str or None
        Ids; None: all of the catalogue that have a design of their own.
    """

    scenario: Scenario
    method: int
    objectives: tuple[str, str]
    networks: tuple[str, ...] | None = None

    def fits(self, scenario: Scenario) -> bool:
        """Whether the fronts are those of a scenario: all but the networks of its methods is the same."""
        if not 0 <= self.method < min(len(scenario.method), len(self.scenario.method)):
            return False
        own, other = self.scenario.method[self.method], scenario.method[self.method]
        same = own.model_copy(update={"network": other.network})
        return self.scenario.model_copy(update={"method": (same,)}) == scenario.model_copy(
            update={"method": (other,)}
        )


class Fronts(Search[FrontsTask, "Pareto"]):
    """Finds the Pareto fronts of all networks in place of one method's.

    Parameters
    ----------
    tell : callable
        ``tell()`` whenever there is something new to show.
    name : str
        Of the visitor, for the turns.
    """

    def __init__(self, tell: Callable[[], None], name: str = "fronts") -> None:
        super().__init__(
            tell,
            _fronts,
            lambda found: not found.stopped,
            "Stopped: no fronts were found.",
            name,
            lambda task: heavy_load(task.scenario),
        )


def _fronts(task: FrontsTask, progress: Callable[[float], None], cancelled: Callable[[], bool]) -> Pareto:
    from navcore.design.pareto import pareto

    return pareto(
        task.scenario,
        task.objectives,
        task.method,
        networks=task.networks,
        progress=progress,
        cancelled=cancelled,
    )


def _budget(scenario: Scenario, progress: Callable[[float], None], cancelled: Callable[[], bool]) -> Budget:
    from navcore.design.budget import budget

    return budget(scenario, progress=progress, cancelled=cancelled)


def _tune(task: TuningTask, progress: Callable[[float], None], cancelled: Callable[[], bool]) -> Tuned:
    from navcore.design.tune import tune

    return tune(
        task.scenario, task.objective, task.vary, task.require, progress=progress, cancelled=cancelled
    )

"""Error budgets along a run and searches for the best setting: what each asks for, and who computes it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from navcore.foundation.text import Text
from navcore.scenario.model import Scenario
from schuler_bench.jobs.search import Search

if TYPE_CHECKING:
    from navcore.design.budget import Budget
    from navcore.design.pareto import Pareto
    from navcore.design.sun import Tuning, TuningSettings
    from navcore.design.tune import Tuned

Progress = Callable[[float], None]
Cancelled = Callable[[], bool]


@dataclass(frozen=True)
class TuningTask:
    """A search for the best setting.

    Attributes
    ----------
    scenario : Scenario
        As it stands.
    objective : str
        One of `navcore.quantities.OBJECTIVES`.
    vary : tuple of str
        Fields, ``method.1.network.sigma``.
    require : tuple of str
        Limits, ``settling_s<=3600``.
    """

    scenario: Scenario
    objective: str
    vary: tuple[str, ...]
    require: tuple[str, ...]


@dataclass(frozen=True)
class TableTask:
    """For which scenario to find an adaptive damping table.

    Attributes
    ----------
    scenario : Scenario
        As it stands.
    settings : TuningSettings
        Differences, coefficients and network.
    """

    scenario: Scenario
    settings: TuningSettings


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
        Of `navcore.quantities.OBJECTIVES`: what is on the axes.
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


class Budgeter(Search[Scenario, "Budget"]):
    """Computes the error budget along one scenario's run at a time; ``tell`` and ``name`` as of `Search`."""

    def __init__(self, tell: Callable[[], None], name: str = "budgeter") -> None:
        super().__init__(tell, _budget, stopped=Text("Stopped: no budget."), name=name)

    def beside(self, scenario: Scenario) -> Budget | None:
        """Budget of exactly this scenario; None when there is none."""
        return self.result if self.asked == scenario else None


class Designer(Search[TuningTask, "Tuned"]):
    """Searches for the best setting of one method at a time; ``tell`` and ``name`` as of `Search`."""

    def __init__(self, tell: Callable[[], None], name: str = "designer") -> None:
        super().__init__(tell, _tune, stopped=Text("Stopped: there is no proposal."), name=name)

    def discard(self) -> None:
        """Forget the proposal."""
        self.forget()
        self._tell()


class Tuner(Search[TableTask, "Tuning"]):
    """Searches for one table (Sun's double loop) at a time; ``tell`` and ``name`` as of `Search`."""

    def __init__(self, tell: Callable[[], None], name: str = "tuner") -> None:
        super().__init__(
            tell, _table, lambda found: found.status == "ok", Text("Stopped: no table was found."), name
        )


class Fronts(Search[FrontsTask, "Pareto"]):
    """Searches for the Pareto fronts of all networks; ``tell`` and ``name`` as of `Search`."""

    def __init__(self, tell: Callable[[], None], name: str = "fronts") -> None:
        super().__init__(
            tell, _fronts, lambda found: not found.stopped, Text("Stopped: no fronts were found."), name
        )


def _budget(scenario: Scenario, progress: Progress, cancelled: Cancelled) -> Budget:
    from navcore.design.budget import budget

    return budget(scenario, progress=progress, cancelled=cancelled)


def _tune(task: TuningTask, progress: Progress, cancelled: Cancelled) -> Tuned:
    from navcore.design.tune import tune

    return tune(
        task.scenario, task.objective, task.vary, task.require, progress=progress, cancelled=cancelled
    )


def _table(task: TableTask, progress: Progress, cancelled: Cancelled) -> Tuning:
    from navcore.design.sun import tune_table

    return tune_table(task.scenario, task.settings, progress, cancelled)


def _fronts(task: FrontsTask, progress: Progress, cancelled: Cancelled) -> Pareto:
    from navcore.design.pareto import pareto

    return pareto(
        task.scenario,
        task.objectives,
        task.method,
        networks=task.networks,
        progress=progress,
        cancelled=cancelled,
    )

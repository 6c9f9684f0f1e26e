"""Error budgets along a run and searches for the best setting: what each asks for, and who computes it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from navcore.foundation.text import Text
from navcore.scenario.model import Scenario
from schuler_bench.jobs.judge import without_methods
from schuler_bench.jobs.search import Search

if TYPE_CHECKING:
    from navcore.design.designs import Designs
    from navcore.design.pareto import Pareto
    from navcore.design.sun import Tuning, TuningSettings
    from navcore.study.model import Study
    from navcore.study.robust import Robust

Progress = Callable[[float], None]
Cancelled = Callable[[], bool]


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
    whole : bool
        Search all that the fields allow, not only what their sliders reach.
    """

    scenario: Scenario
    method: int
    objectives: tuple[str, str]
    networks: tuple[str, ...] | None = None
    whole: bool = False

    def fits(self, scenario: Scenario) -> bool:
        """Whether the fronts are those of a scenario: all but its method's network and name is the same."""
        if not 0 <= self.method < min(len(scenario.method), len(self.scenario.method)):
            return False
        own, other = self.scenario.method[self.method], scenario.method[self.method]
        same = own.model_copy(update={"network": other.network, "name": other.name})
        return self.scenario.model_copy(update={"method": (same,)}) == scenario.model_copy(
            update={"method": (other,)}
        )


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
            tell,
            _fronts,
            lambda found: bool(found.fronts),
            Text("Stopped: no fronts were found."),
            name,
            keeps=True,
        )


@dataclass(frozen=True)
class LimitsTask:
    """A search for designs that meet the limits.

    Attributes
    ----------
    scenario : Scenario
        With limits.
    study : Study or None
        Over whose factors they must hold.
    """

    scenario: Scenario
    study: Study | None = None


class Limits(Search[LimitsTask, "Designs | Robust"]):
    """Tunes every network for the limits of one scenario at a time; ``tell`` and ``name`` as of `Search`."""

    def __init__(self, tell: Callable[[], None], name: str = "limits") -> None:
        super().__init__(tell, _designs, stopped=Text("Stopped: no design."), name=name, keeps=True)

    def beside(self, scenario: Scenario) -> Designs | Robust | None:
        """Designs for the same ship and limits; None when there are none."""
        asked = None if self.asked is None else self.asked.scenario
        same = asked is not None and without_methods(asked) == without_methods(scenario)
        return self.result if same else None


def _designs(task: LimitsTask, progress: Progress, cancelled: Cancelled) -> Designs | Robust:
    from navcore.design.designs import designs

    if task.study is None:
        return designs(task.scenario, progress=progress, cancelled=cancelled)
    from navcore.study.robust import robust_designs

    return robust_designs(task.scenario, task.study, progress=progress, cancelled=cancelled)


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
        whole=task.whole,
        progress=progress,
        cancelled=cancelled,
    )

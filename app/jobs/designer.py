"""Error budgets along a run and searches for the best setting: what each asks for, and who computes it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

from navcore.foundation.errors import InputError
from navcore.foundation.text import Text
from navcore.scenario.model import Scenario
from schuler_bench.jobs.judge import without_methods
from schuler_bench.jobs.load import spare_load
from schuler_bench.jobs.refusals import refusals
from schuler_bench.jobs.search import Search

if TYPE_CHECKING:
    from navcore.design.designs import Designs
    from navcore.design.pareto import Pareto
    from navcore.design.profile import Profile
    from navcore.design.sun import Tuning, TuningSettings
    from navcore.design.tune import Tuned
    from navcore.study.model import Study
    from navcore.study.robust import Robust

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
    default_limits : bool
        Keep `navcore.design.default_limits.DEFAULT_LIMITS` of what nothing limits.
    whole : bool
        Search all that the fields allow, not only what their sliders reach.
    over : Study or None
        At whose worst point the setting must be best; None: in the scenario.
    """

    scenario: Scenario
    objective: str
    vary: tuple[str, ...]
    require: tuple[str, ...]
    default_limits: bool = True
    whole: bool = False
    over: Study | None = None

    @property
    def method(self) -> int:
        """Index of the method."""
        return int(self.vary[0].split(".")[1])


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


class Designer(Search[TuningTask, "Tuned"]):
    """Searches for the best setting of one method at a time; ``tell`` and ``name`` as of `Search`."""

    def __init__(self, tell: Callable[[], None], name: str = "designer") -> None:
        super().__init__(tell, _tune, stopped=Text("Stopped: there is no proposal."), name=name, keeps=True)

    accepted: Scenario | None = None
    """The scenario with the proposal in place, once it was accepted."""

    def accept(self, scenario: Scenario) -> None:
        """Note that the proposal has been put into this scenario."""
        self.accepted = scenario
        self._tell()

    def forget(self) -> None:
        """Drop the proposal."""
        self.accepted = None
        super().forget()

    def begin(self, asked: TuningTask) -> None:
        """Search for another proposal."""
        self.forget()
        super().begin(asked)

    def discard(self) -> None:
        """Forget the proposal, and let the pages know."""
        self.forget()
        self._tell()

    def _refused(self, error: InputError) -> tuple[str, ...]:
        return refusals(error)


class Profiles(Search[TuningTask, "tuple[Profile, ...]"]):
    """Measures an objective over each parameter of one method; ``tell`` and ``name`` as of `Search`."""

    def __init__(self, tell: Callable[[], None], name: str = "profiles") -> None:
        super().__init__(
            tell, _profiles, bool, name=name, load=lambda task: spare_load(task.scenario), still_s=0.3
        )
        self._wanted: TuningTask | None = None

    def follow(self, task: TuningTask) -> None:
        """Measure this once it rests, unless that was wanted last."""
        if task != self._wanted:
            self._wanted = task
            self._submit(task, None)

    def beside(self, task: TuningTask) -> tuple[Profile, ...]:
        """Give the last ones of the same parameters and objective; nothing where there are none."""
        asked = self.asked
        fits = asked is not None and (asked.objective, asked.vary) == (task.objective, task.vary)
        return self.result or () if fits else ()


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


def _tune(task: TuningTask, progress: Progress, cancelled: Cancelled) -> Tuned:
    from navcore.design.tune import tune
    from navcore.design.vary import read_varied
    from navcore.scenario.stochastic import stochastic_model

    varied = read_varied(task.scenario, task.vary, task.whole)
    search = partial(tune, task.scenario)
    if task.over is not None:
        from navcore.study.robust_tune import tune_over

        search = partial(tune_over, task.scenario, task.over)
    return search(
        task.objective,
        [f"{one.field}={one.low!r}:{one.high!r}" for one in varied],
        task.require,
        # without a random error every setting is alike in the steady state
        along=stochastic_model(task.scenario).silent,
        default_limits=task.default_limits,
        confirm=True,
        progress=progress,
        cancelled=cancelled,
    )


def _profiles(task: TuningTask, progress: Progress, cancelled: Cancelled) -> tuple[Profile, ...]:
    from navcore.design.profile import profiles
    from navcore.scenario.stochastic import stochastic_model

    return profiles(
        task.scenario,
        task.objective,
        task.vary,
        along=stochastic_model(task.scenario).silent,
        whole=task.whole,
        progress=progress,
        cancelled=cancelled,
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
        whole=task.whole,
        progress=progress,
        cancelled=cancelled,
    )

"""Computes the bands of a scenario's error curves in the background, once the user stops changing it."""

from collections.abc import Callable
from dataclasses import dataclass, replace

from navcore.engine.run import Run
from navcore.foundation.text import Text
from navcore.scenario.model import Scenario
from schuler_bench.jobs.elsewhere import carried_out_all
from schuler_bench.jobs.helper import helps
from schuler_bench.jobs.rows import few_rows
from schuler_bench.jobs.scheduler import Lane
from schuler_bench.jobs.search import Search
from schuler_bench.jobs.worker import Watch
from schuler_bench.plots.envelope import BandKind, Envelope, covariance_envelope, envelope

SEEDS = 20
STILL_S = 0.7
"""The bands of a scenario are begun once it was unchanged for so long."""

Simulate = Callable[[Scenario, Callable[[float], None], Callable[[], bool]], Run]


@dataclass(frozen=True)
class _Asked:
    scenario: Scenario
    kind: BandKind


class Envelopes(Search[_Asked, Envelope]):
    """The bands of one session's scenario; a change of the scenario stops what is under way.

    Parameters
    ----------
    simulate : callable
        ``simulate(scenario, progress, cancelled)``.
    came_further, ended : callable
        Called without arguments: there is more progress to show; there is a new envelope.
    still_s : float
        The bands of a scenario are begun once it was unchanged for so long.
    name : str
        Of the visitor, for the turns.
    """

    report_after_s = report_every_s = 0.0

    def __init__(
        self,
        simulate: Simulate,
        came_further: Callable[[], None],
        ended: Callable[[], None],
        still_s: float = STILL_S,
        name: str = "envelopes",
    ) -> None:
        super().__init__(came_further, _covariance, name=name, still_s=still_s)
        self._simulate, self._told_ended = simulate, ended

    def follow(self, scenario: Scenario, kind: BandKind) -> None:
        """Make the bands of this scenario, if any are wanted and they are not there yet."""
        asked = _Asked(scenario, kind)
        if kind == "none":
            self.cancel()
            self.forget()
        elif self.asked == asked:
            self.cancel()
            self.words = ()
        elif self.under_way == asked:  # another page asks, or one that is back
            return
        elif kind == "seeds" and scenario.strapdown:
            self.cancel()
            self.words = (Text("Not for strapdown runs: it would take {seeds} of them.", seeds=SEEDS),)
            self._tell()
        else:
            self._submit(asked, 0.0)

    def beside(self, scenario: Scenario, kind: BandKind) -> Envelope | None:
        """The bands of this scenario, or those of an earlier one with the same methods, marked as old."""
        with self._lock:
            bands, asked = self.result, self.asked
        if bands is None or asked is None or asked.kind != kind:
            return None
        if asked.scenario == scenario:
            return bands
        return replace(bands, old=True) if _alike(asked.scenario, scenario) else None

    def _ended(self) -> None:
        self._told_ended()

    def _carry_out(self, asked: _Asked, progress: Callable[[float], None], watch: Watch) -> Envelope | None:
        if asked.kind == "covariance":
            return super()._carry_out(asked, progress, watch)
        scenario = asked.scenario
        seeds = [with_seed(scenario, scenario.run.seed + number) for number in range(1, SEEDS + 1)]
        # On a cluster all of them side by side; else each takes over what the last one had in common with it.
        one = _of_a_seed if watch.lane is Lane.CLUSTER or helps(_of_a_seed) else self._of_a_seed
        runs = carried_out_all(one, seeds, progress, watch)
        if runs is None or watch.unwanted() or any(run.status == "stopped" for run in runs):
            return None
        return envelope(runs)

    def _of_a_seed(
        self, scenario: Scenario, progress: Callable[[float], None], cancelled: Callable[[], bool]
    ) -> Run:
        run = few_rows(self._simulate(scenario, lambda _: None, cancelled), 2)
        progress(1.0)
        return run


def _covariance(
    asked: _Asked, progress: Callable[[float], None], cancelled: Callable[[], bool]
) -> Envelope | None:
    from navcore.design.bands import covariance_bands

    bands = covariance_bands(asked.scenario, progress, cancelled)
    return None if bands is None else covariance_envelope(asked.scenario, bands)


def _of_a_seed(scenario: Scenario, progress: Callable[[float], None], cancelled: Callable[[], bool]) -> Run:
    """Run another seed for the bands; found by its name on a cluster and by a helper."""
    from navcore.engine.simulation import simulate

    return few_rows(simulate(scenario, progress, cancelled), 2)


def _alike(one: Scenario, other: Scenario) -> bool:
    """Whether bands of the one may stay behind the curves of the other until its own are there."""
    names = ([method.name for method in scenario.method] for scenario in (one, other))
    return one.run.duration_h == other.run.duration_h and next(names) == next(names)


def with_seed(scenario: Scenario, seed: int) -> Scenario:
    """The same scenario with other noise."""
    return scenario.model_copy(update={"run": scenario.run.model_copy(update={"seed": seed})})

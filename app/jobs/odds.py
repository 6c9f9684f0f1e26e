"""Shares of seeds on which the methods of a scenario meet its limits, computed once the scenario rests."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from navcore.engine.load import estimated_seconds
from navcore.questions.design import DesignQuestion
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario
from schuler_bench.jobs.asking import Asker

if TYPE_CHECKING:
    from navcore.design.shares import Share
    from navcore.engine.measures import SeedShare

STILL_S = 0.7
"""The seeds of a scenario are run once it was unchanged for so long."""
FEW, SEEDS = 24, 200
"""First for a guess, then for the interval."""
_LONGEST_S = 120.0
"""Processor time that the seeds of all methods may take."""


@dataclass(frozen=True)
class Odds:
    """Share of one method over seeds.

    Attributes
    ----------
    share : Share
        What the seeds gave.
    seeds : int
        How many there were.
    """

    share: Share
    seeds: int


class Judge(Asker):
    """Judges the methods of one session's scenario; a method that stays as it was is not run again.

    Parameters
    ----------
    tell : callable
        ``tell()`` whenever there is something new to show.
    name : str
        Of the visitor, for the turns.

    Attributes
    ----------
    known : mapping of Method to Odds
        Of `base`.
    """

    def __init__(self, tell: Callable[[], None], name: str = "judge", still_s: float = STILL_S) -> None:
        super().__init__(tell, DesignQuestion, name, still_s=still_s, keeps=False)
        # methods are frozen, and so hashable, which their type does not say
        self.known: Mapping[Any, Odds] = {}
        self._base: Scenario | None = None
        self._wanted: Scenario | None = None

    def judge(self, scenario: Scenario) -> None:
        """Judge the methods of this scenario, unless that is done or under way."""
        if not scenario.requirement:
            self._wanted = None
            self.cancel()
            return
        base = without_methods(scenario)
        with self._lock:
            if base != self._base:
                self._base, self.known = base, {}
            self._wanted = scenario
        self._go_on()

    def odds(self, scenario: Scenario, method: Method) -> Odds | None:
        """Give the share of a method in a scenario; None where it is not known."""
        with self._lock:
            return self.known.get(method) if without_methods(scenario) == self._base else None

    def shares(self, scenario: Scenario) -> tuple[SeedShare, ...]:
        """Give the shares of all methods of a scenario, for its metrics; none where one is not known yet."""
        from navcore.design.run_shares import seed_share

        found = [self.odds(scenario, method) for method in scenario.method]
        known = [seed_share(one.share, one.seeds) for one in found if one is not None]
        return tuple(known) if len(known) == len(found) else ()

    def learn(self, scenario: Scenario, method: Any, odds: Odds) -> None:
        """Take over what other runs have said of a method."""
        with self._lock:
            if without_methods(scenario) == self._base:
                self.known = {**self.known, method: odds}

    def _go_on(self) -> None:
        with self._lock:
            scenario = self._wanted
            if scenario is None:
                return
            most = _seeds(scenario)
            methods: tuple[Any, ...] = scenario.method
            seen = {method: self.known[method].seeds for method in methods if method in self.known}
        fresh = tuple(method for method in methods if method not in seen)
        few = tuple(method for method in methods if seen.get(method, most) < most)
        chosen, seeds = (fresh, min(FEW, most)) if fresh else (few, most)
        of = scenario.model_copy(update={"method": chosen})
        asked = DesignQuestion(scenario=of, seeds=seeds, as_set=True)
        if chosen and asked != self.under_way:
            self._submit(asked, 0.0)
        elif not chosen:
            self.cancel()

    def _ended(self) -> None:
        with self._lock:
            found, asked = self.result, self.asked
            if found is not None and asked is not None and without_methods(asked.scenario) == self._base:
                more = {share.method: Odds(share, found.seeds) for share in found.methods}
                self.known = {**self.known, **more}
        self._tell()
        self._go_on()


def _seeds(scenario: Scenario) -> int:
    """Number of seeds that a scenario is judged by: fewer where its runs are long."""
    return max(8, min(SEEDS, int(_LONGEST_S / max(estimated_seconds(scenario), 1e-3))))


def without_methods(scenario: Scenario) -> Scenario:
    """Ship and limits of a scenario: two that are equal judge a method alike."""
    plain = type(scenario.view)()
    return scenario.model_copy(update={"method": (), "title": "", "source": "", "view": plain})

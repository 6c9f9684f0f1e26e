"""Sweeps of a session's scenario: one quantity after the other, each shown as soon as it is there."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from navcore.foundation.progress import part_of
from navcore.foundation.text import Text
from navcore.scenario.model import Scenario
from schuler_bench.jobs.odds import without_methods
from schuler_bench.jobs.search import Search

if TYPE_CHECKING:
    from navcore.study.sweep import Sweep


@dataclass(frozen=True)
class SweepTask:
    """One quantity to vary.

    Attributes
    ----------
    scenario : Scenario
        As it stands.
    place : int
        Of the quantity in `navcore.study.sweep.KEYS`.
    """

    scenario: Scenario
    place: int


class Sweeper(Search[SweepTask, "Sweep"]):
    """Sweeps one scenario at a time; ``tell`` and ``name`` as of `Search`.

    Attributes
    ----------
    known : mapping of str to Sweep
        What has been swept, by key.
    swept : Scenario or None
        Of which.
    """

    def __init__(self, tell: Callable[[], None], name: str = "sweeper") -> None:
        super().__init__(tell, _sweep, stopped=Text("Stopped: the rest is not swept."), name=name)
        self.known: Mapping[str, Sweep] = {}
        self.swept: Scenario | None = None

    def sweep(self, scenario: Scenario) -> None:
        """Vary all quantities of this scenario, in the place of what was known."""
        with self._lock:
            self.known, self.swept = {}, scenario
        self.begin(SweepTask(scenario, 0))

    def fits(self, scenario: Scenario) -> bool:
        """Whether what is known is of this scenario: its limits, title and view do not count."""
        return self.swept is not None and _plain(self.swept) == _plain(scenario)

    def _ended(self) -> None:
        from navcore.study.sweep import KEYS

        found, asked = self.result, self.asked
        assert found is not None  # `Search` calls this after a result
        assert asked is not None
        with self._lock:
            if asked.scenario is not self.swept:
                return
            self.known = {**self.known, found.key: found}
        if asked.place + 1 < len(KEYS):
            self.begin(SweepTask(asked.scenario, asked.place + 1))
        else:
            self._tell()


def _plain(scenario: Scenario) -> Scenario:
    return without_methods(scenario).model_copy(update={"method": scenario.method, "requirement": ()})


def _sweep(task: SweepTask, progress: Callable[[float], None], cancelled: Callable[[], bool]) -> Sweep | None:
    from navcore.study.sweep import KEYS, sweep

    share = part_of(progress, task.place / len(KEYS), (task.place + 1) / len(KEYS))
    return sweep(task.scenario, KEYS[task.place], share, cancelled)

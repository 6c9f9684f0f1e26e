"""Sweeps of a session's scenario: one quantity after the other, each shown as soon as it is there."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING

from navcore.questions.sweep import SweepQuestion
from navcore.scenario.model import Scenario
from schuler_bench.jobs.asking import Asker
from schuler_bench.jobs.odds import without_methods

if TYPE_CHECKING:
    from navcore.study.sweep import Sweep

_KEYS: tuple[str, ...] = SweepQuestion.model_fields["over"].default


class Sweeper(Asker):
    """Sweeps one scenario at a time; ``tell`` and ``name`` as of `Asker`.

    Attributes
    ----------
    known : mapping of str to Sweep
        What has been swept, by key.
    swept : Scenario or None
        Of which.
    """

    def __init__(self, tell: Callable[[], None], name: str = "sweeper") -> None:
        super().__init__(tell, SweepQuestion, name, keeps=False)
        self.known: Mapping[str, Sweep] = {}
        self.swept: Scenario | None = None

    def sweep(self, scenario: Scenario) -> None:
        """Vary all quantities of this scenario, in the place of what was known."""
        with self._lock:
            self.known, self.swept = {}, scenario
        self.begin(_next(scenario, {}))

    def fits(self, scenario: Scenario) -> bool:
        """Whether what is known is of this scenario: its limits, title and view do not count."""
        return self.swept is not None and _plain(self.swept) == _plain(scenario)

    def _ended(self) -> None:
        found, asked = self.result, self.asked
        assert found is not None  # `Search` calls this after a result
        assert asked is not None
        with self._lock:
            if asked.scenario is not self.swept:
                return
            self.known = {**self.known, **found.found}
        if len(self.known) < len(_KEYS):
            self.begin(_next(asked.scenario, self.known))
        else:
            self._tell()


def _next(scenario: Scenario, known: Mapping[str, Sweep]) -> SweepQuestion:
    """Ask for the first quantity that is not there."""
    return SweepQuestion.model_construct(scenario=scenario, over=(_KEYS[len(known)],))


def _plain(scenario: Scenario) -> Scenario:
    return without_methods(scenario).model_copy(update={"method": scenario.method, "requirement": ()})

"""One visitor's search for an adaptive damping table (Sun's double loop), in the background."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from app.jobs.load import spare_load
from app.jobs.search import Search
from navcore.scenario.model import Scenario

if TYPE_CHECKING:
    from navcore.studies.tuning import Tuning, TuningSettings

STOPPED = "Stopped: no table was found."

Tune = Callable[
    [Scenario, "TuningSettings", Callable[[float], None], Callable[[], bool]],
    "Tuning",
]


class Tuner(Search[tuple[Scenario, "TuningSettings"], "Tuning"]):
    """Searches for one table at a time.

    Parameters
    ----------
    tell : callable
        ``tell()`` whenever there is something new to show, from the thread that searches.
    tune : callable, optional
        In place of `navcore.studies.tuning.tune`.
    name : str
        Of the visitor, for the turns.
    """

    def __init__(self, tell: Callable[[], None], tune: Tune | None = None, name: str = "tuner") -> None:
        self._tune = tune or _tune
        super().__init__(
            tell,
            lambda asked, *watch: self._tune(*asked, *watch),
            lambda found: found.status == "ok",
            STOPPED,
            name,
            lambda asked: spare_load(asked[0]),
        )

    @property
    def scenario(self) -> Scenario | None:
        """What the result is of."""
        return None if self.asked is None else self.asked[0]

    def start(self, scenario: Scenario, settings: TuningSettings) -> None:
        """Search for a table, in place of a search that is under way."""
        self.begin((scenario, settings))


def _tune(
    scenario: Scenario,
    settings: TuningSettings,
    progress: Callable[[float], None],
    cancelled: Callable[[], bool],
) -> Tuning:
    from navcore.studies.tuning import tune

    return tune(scenario, settings, progress, cancelled)

"""One visitor's search for an adaptive damping table (Sun's double loop), in the background."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from app.jobs.load import heavy_load
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
        super().__init__(
            tell,
            _tune if tune is None else lambda asked, *watch: tune(*asked, *watch),
            lambda found: found.status == "ok",
            STOPPED,
            name,
            lambda asked: heavy_load(asked[0]),
        )

    @property
    def scenario(self) -> Scenario | None:
        """What the result is of."""
        return None if self.asked is None else self.asked[0]

    def start(self, scenario: Scenario, settings: TuningSettings) -> None:
        """Search for a table, in place of a search that is under way."""
        self.begin((scenario, settings))


def _tune(
    asked: tuple[Scenario, TuningSettings],
    progress: Callable[[float], None],
    cancelled: Callable[[], bool],
) -> Tuning:
    from navcore.studies.tuning import tune

    return tune(*asked, progress, cancelled)

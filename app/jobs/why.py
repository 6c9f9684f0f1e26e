"""The sources that dominate a run whose metrics are in front, computed once the run rests for a moment."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from navcore.engine.run import Run
from schuler_bench.jobs.load import spare_load
from schuler_bench.jobs.search import Search

if TYPE_CHECKING:
    from navcore.design.dominance import Why

STILL_S = 1.0
"""So long a run must have been shown before the processors are spent on it."""


class Explainer(Search[Run, "Why"]):
    """Explains one run at a time; the next one, or any change, stops it at once.

    Parameters
    ----------
    tell : callable
        ``tell()`` whenever there is something new to show, from the thread that explains.
    name : str
        Of the visitor, for the turns.
    """

    report_after_s, report_every_s = 0.5, 0.25

    def __init__(self, tell: Callable[[], None], name: str = "explainer", still_s: float = STILL_S) -> None:
        super().__init__(
            tell,
            _why,
            lambda found: found.complete,
            name=name,
            load=lambda run: spare_load(run.scenario),
            still_s=still_s,
        )

    def follow(self, run: Run) -> None:
        """Explain this run once it rests, unless that is done or under way."""
        if run is not self.under_way and run is not self.asked:
            self._submit(run, None)


def _why(run: Run, progress: Callable[[float], None], cancelled: Callable[[], bool]) -> Why:
    from navcore.design.dominance import why

    return why(run, progress, cancelled)

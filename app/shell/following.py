"""Which views follow the session's scenario and searches: those in sight; the others catch up."""

from collections.abc import Sequence, Set

from schuler_bench.shell.column import Column
from schuler_bench.shell.view import View
from schuler_bench.shell.view_faults import ViewFaults


class Following:
    """Lets the views in sight follow; a tab of the results behind others does once it comes to the front.

    Parameters
    ----------
    views : sequence of View
        All of the page.
    column : Column
        Knows which of them are tabs of the results.
    faults : ViewFaults
        Calls their methods.
    """

    def __init__(self, views: Sequence[View], column: Column, faults: ViewFaults) -> None:
        self._views, self._column, self._faults = views, column, faults
        self._late: set[str] = set()

    def follow(self, front: Set[str], *, jobs_alone: bool = False) -> None:
        """Show the session's scenario, and how far its searches are."""
        behind = self._column.behind(front)
        self._late |= behind
        self._follow([view for view in self._views if view.title not in behind], jobs_alone=jobs_alone)

    def is_late(self, front: Set[str]) -> bool:
        """Whether a tab has come to the front that did not follow."""
        return bool(self._late & front)

    def catch_up(self, front: Set[str]) -> None:
        """Let those tabs follow."""
        late, self._late = self._late & front, self._late - front
        self._follow([view for view in self._views if view.title in late])

    def _follow(self, views: Sequence[View], *, jobs_alone: bool = False) -> None:
        for view in views:
            if not jobs_alone:
                self._faults.call(view.follow_scenario)
            self._faults.call(view.follow_jobs)

"""Work beside the runs of a session: what dominates the result, budgets, tuning, fronts."""

import logging
import threading
from collections.abc import Callable

from navcore.engine.run import Run
from navcore.questions import QUESTIONS
from navcore.questions.why import WhyQuestion
from navcore.scenario.model import Scenario
from schuler_bench.jobs.asking import Asker
from schuler_bench.jobs.load import run_load
from schuler_bench.jobs.long_runs import alone
from schuler_bench.jobs.odds import Judge
from schuler_bench.jobs.search import Search
from schuler_bench.jobs.sweeps import Sweeper

_log = logging.getLogger("schuler.searches")


class Searches:
    """The searches of one session. They go on when its last page has gone, as the scheduler lets them.

    Parameters
    ----------
    name : str
        In the names of the threads.

    Attributes
    ----------
    asking : dict of Asker
        By the name of the question that it asks.
    runner : Search
        Runs of scenarios beside the session's own, such as a lesson's.
    judge : Judge
        Shares of seeds that meet the limits.
    sweeper : Sweeper
        Runs at other latitudes, log errors, sensor grades and sea states.
    """

    def __init__(self, name: str) -> None:
        self._lock = threading.Lock()
        self._watchers: list[Callable[[], None]] = []
        self.asking = {id: Asker(self._tell, question, name) for id, question in QUESTIONS.items()}
        self.judge = Judge(self._tell, name)
        self.runner = Search[Scenario, Run](
            self._tell, alone, lambda run: run.status != "stopped", name=name, load=run_load
        )
        self.sweeper = Sweeper(self._tell, name)
        self._all = (
            *self.asking.values(),
            self.judge,
            self.runner,
            self.sweeper,
        )

    def watch(self, changed: Callable[[], None]) -> None:
        """Tell an open page whenever there is something new."""
        with self._lock:
            self._watchers.append(changed)

    def unwatch(self, changed: Callable[[], None]) -> None:
        """Forget a closed page."""
        with self._lock:
            self._watchers = [other for other in self._watchers if other != changed]

    def changed(self) -> None:
        """The scenario has changed: the processors belong to its run."""
        self.asking["why"].cancel()
        self.judge.cancel()
        self.sweeper.cancel()

    def explain(self, run: Run) -> None:
        """Compute what dominates a run: a view that says so is in front and shows the run."""
        with self._lock:
            watched = bool(self._watchers)
        if watched:
            self.asking["why"].follow(WhyQuestion.of(run))

    def stop(self) -> None:
        """End the threads."""
        for search in self._all:
            search.stop()

    def _tell(self) -> None:
        with self._lock:
            watchers = list(self._watchers)
        for changed in watchers:
            try:
                changed()
            except Exception:
                _log.exception("a page could not be brought up to date")

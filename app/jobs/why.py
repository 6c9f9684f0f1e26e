"""What dominates a run whose metrics are looked at, found once it has stood still for a moment."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable
from typing import TYPE_CHECKING

from app.jobs.load import spare_load
from app.jobs.scheduler import Load
from app.jobs.worker import Watch, Worker
from navcore.engine.run import Run

if TYPE_CHECKING:
    from navcore.studies.dominance import Why

STILL_S = 1.0
"""So long a run must have been shown before the processors are spent on it."""
_REPORT_AFTER_S, _REPORT_EVERY_S = 0.5, 0.25
_log = logging.getLogger("schuler.why")

Find = Callable[[Run, Callable[[float], None], Callable[[], bool]], "Why"]


class Explainer:
    """Explains one run at a time; the next one, or any change, stops it at once.

    Parameters
    ----------
    tell : callable
        ``tell()`` whenever there is something new to show, from the thread that explains.
    find : callable, optional
        In place of `navcore.studies.dominance.why`.
    name : str
        Of the visitor, for the turns.

    Attributes
    ----------
    result : Why or None
        The last complete one.
    fraction : float or None
        Part that is done, once it takes a while.
    failed : bool
        The last one ended by a fault of ours.
    """

    def __init__(self, tell: Callable[[], None], find: Find | None = None, name: str = "explainer") -> None:
        self._tell, self._find = tell, find or _why
        self._lock = threading.Lock()
        self._worker: Worker[Run] = Worker(self._work, visitor=name, load=_load, still_s=STILL_S)
        self._of: Run | None = None
        self._wanted: Run | None = None
        self.result: Why | None = None
        self.fraction: float | None = None
        self.failed = False

    def follow(self, run: Run) -> None:
        """Explain this run, after it has stood still."""
        with self._lock:
            self.fraction, self.failed, self._wanted = None, False, run
        self._worker.submit(run)

    def cancel(self) -> None:
        """Stop: the run is about to change."""
        with self._lock:
            self.fraction, self._wanted = None, None
        self._worker.cancel()

    def fits(self, run: Run) -> bool:
        """Whether the result is of this run."""
        with self._lock:
            return self._of is run

    def follows(self, run: Run) -> bool:
        """Whether this run has been asked about last, or the result is of it."""
        with self._lock:
            return self._wanted is run or self._of is run

    def stop(self) -> None:
        """End the thread."""
        self._worker.stop()

    def wait_idle(self, timeout_s: float | None = None) -> bool:
        """Block until nothing is looked for; False after the timeout."""
        return self._worker.wait_idle(timeout_s)

    def _work(self, run: Run, watch: Watch) -> None:
        last_s = _REPORT_AFTER_S - _REPORT_EVERY_S

        def progress(fraction: float) -> None:
            nonlocal last_s
            if watch.elapsed_s - last_s >= _REPORT_EVERY_S and not watch.unwanted():
                last_s = watch.elapsed_s
                with self._lock:
                    self.fraction = fraction
                self._tell()

        result = None
        try:
            result = self._find(run, progress, watch.unwanted)
        except Exception:
            _log.exception("a run could not be explained")
        with self._lock:
            if self._wanted is not run:
                return
            self.fraction, self.failed = None, result is None
            if result is not None and result.complete:
                self.result, self._of = result, run
        self._tell()


def _load(run: Run) -> Load:
    return spare_load(run.scenario)


def _why(run: Run, progress: Callable[[float], None], cancelled: Callable[[], bool]) -> Why:
    from navcore.studies.dominance import why

    return why(run, progress, cancelled)

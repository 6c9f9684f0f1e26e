"""One visitor's search for an adaptive damping table (Sun's double loop), in the background."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable
from typing import TYPE_CHECKING

from app.background.worker import Watch, Worker
from navcore.errors import InputError
from navcore.scenario import Scenario

if TYPE_CHECKING:
    from navcore.tuning import Tuning, TuningSettings

STOPPED = "Stopped: no table was found."
_REPORT_EVERY_S = 0.15
_log = logging.getLogger("schuler.tuner")

Tune = Callable[
    [Scenario, "TuningSettings", Callable[[float], None], Callable[[], bool]],
    "Tuning",
]
_Job = tuple[Scenario, "TuningSettings"]


class Tuner:
    """Searches for one table at a time; the last one that was found stays until the next.

    Parameters
    ----------
    tell : callable
        ``tell()`` whenever there is something new to show, from the thread that searches.
    tune : callable, optional
        In place of `navcore.tuning.tune`.
    name : str
        Of the thread.

    Attributes
    ----------
    fraction : float or None
        Part that is done while a search is under way.
    result : Tuning or None
        The last complete one.
    scenario : Scenario or None
        What it is of.
    words : tuple of str
        Why there is no newer result: stopped, refused, failed.
    """

    def __init__(self, tell: Callable[[], None], tune: Tune | None = None, name: str = "tuner") -> None:
        self._tell, self._tune = tell, tune or _tune
        self._lock = threading.Lock()
        self._worker: Worker[_Job] = Worker(self._work, name)
        self._under_way: _Job | None = None
        self.fraction: float | None = None
        self.result: Tuning | None = None
        self.scenario: Scenario | None = None
        self.words: tuple[str, ...] = ()

    def start(self, scenario: Scenario, settings: TuningSettings) -> None:
        """Search for a table, in place of a search that is under way."""
        job = (scenario, settings)
        with self._lock:
            self.fraction, self.words, self._under_way = 0.0, (), job
        self._worker.submit(job)
        self._tell()

    def cancel(self) -> None:
        """Stop; an earlier result stays."""
        with self._lock:
            if self.fraction is None:
                return
            self.fraction, self.words, self._under_way = None, (STOPPED,), None
        self._worker.cancel()
        self._tell()

    def stop(self) -> None:
        """End the thread."""
        self._worker.stop()

    def wait_idle(self, timeout_s: float | None = None) -> bool:
        """Block until no search is under way; False after the timeout."""
        return self._worker.wait_idle(timeout_s)

    def _work(self, job: _Job, watch: Watch) -> None:
        last_s = 0.0

        def progress(fraction: float) -> None:
            nonlocal last_s
            if watch.elapsed_s - last_s < _REPORT_EVERY_S:
                return
            last_s = watch.elapsed_s
            with self._lock:
                if self._under_way is not job:
                    return
                self.fraction = fraction
            self._tell()

        found, words = None, ()
        try:
            found = self._tune(*job, progress, lambda: watch.stop_asked.is_set() or watch.superseded())
        except InputError as error:
            words = tuple(str(fault) for fault in error.faults)
        except Exception as error:
            _log.exception("a search for a table failed")
            words = (f"Something went wrong: {type(error).__name__}: {error}",)
        with self._lock:
            if self._under_way is not job:  # stopped, or another one waits
                return
            self.fraction, self._under_way, self.words = None, None, words
            if found is not None and found.status == "ok":
                self.result, self.scenario = found, job[0]
            elif found is not None:
                self.words = (STOPPED,)
        self._tell()


def _tune(
    scenario: Scenario,
    settings: TuningSettings,
    progress: Callable[[float], None],
    cancelled: Callable[[], bool],
) -> Tuning:
    from navcore.tuning import tune

    return tune(scenario, settings, progress, cancelled)

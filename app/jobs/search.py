"""One thing computed at a time in the background, at a user's word: progress, end, what came of it."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable
from typing import Generic, TypeVar

from app.jobs.elsewhere import LOST, carried_out
from app.jobs.scheduler import Load
from app.jobs.words import for_a_page
from app.jobs.worker import ElsewhereLost, Watch, Worker
from navcore.foundation.errors import InputError

Asked = TypeVar("Asked")
Found = TypeVar("Found")
_REPORT_EVERY_S = 0.15
_log = logging.getLogger("schuler.search")


class Search(Generic[Asked, Found]):
    """Computes one thing at a time; the last complete result stays until the next.

    Parameters
    ----------
    tell : callable
        ``tell()`` whenever there is something new to show, from the thread that computes.
    compute : callable
        ``compute(asked, progress, cancelled)``; raises `InputError` when it is refused. On a cluster it is
        found by its name.
    complete : callable
        ``complete(found)``: it came to its end; else it was stopped.
    stopped : str
        What is said when it was stopped.
    name : str
        Of the visitor, for the turns and for the log.
    load : callable
        ``load(asked)``: what it will take.

    Attributes
    ----------
    fraction : float or None
        Part that is done while it is under way.
    result
        The last complete one, or None.
    asked
        What that is of.
    words : tuple of str
        Why there is no newer result: stopped, refused, failed. While one is under way: what is to be known.
    """

    def __init__(
        self,
        tell: Callable[[], None],
        compute: Callable[[Asked, Callable[[float], None], Callable[[], bool]], Found],
        complete: Callable[[Found], bool],
        stopped: str,
        name: str,
        load: Callable[[Asked], Load],
    ) -> None:
        self._tell, self._compute, self._complete = tell, compute, complete
        self._stopped, self._name = stopped, name
        self._lock = threading.Lock()
        self._worker: Worker[Asked] = Worker(self._work, visitor=name, load=load)
        self._under_way: Asked | None = None
        self.fraction: float | None = None
        self.result: Found | None = None
        self.asked: Asked | None = None
        self.words: tuple[str, ...] = ()

    @property
    def under_way(self) -> Asked | None:
        """What is being computed now."""
        return self._under_way

    def begin(self, asked: Asked) -> None:
        """Compute this, in place of what is under way."""
        with self._lock:
            self.fraction, self.words, self._under_way = 0.0, (), asked
        self._worker.submit(asked)
        self._tell()

    def cancel(self, why: str = "") -> None:
        """Stop, and say why; an earlier result stays."""
        with self._lock:
            if self.fraction is None:
                return
            self.fraction, self.words, self._under_way = None, (why or self._stopped,), None
        self._worker.cancel()
        self._tell()

    def stop(self) -> None:
        """End the thread."""
        self._worker.stop()

    def wait_idle(self, timeout_s: float | None = None) -> bool:
        """Block until nothing is under way; False after the timeout."""
        return self._worker.wait_idle(timeout_s)

    def _work(self, asked: Asked, watch: Watch) -> None:
        last_s = 0.0

        def progress(fraction: float) -> None:
            nonlocal last_s
            if watch.elapsed_s - last_s < _REPORT_EVERY_S:
                return
            last_s = watch.elapsed_s
            with self._lock:
                if self._under_way is not asked:
                    return
                self.fraction = fraction
            self._tell()

        found, words = None, ()
        try:
            found = carried_out(self._compute, asked, progress, watch)
        except ElsewhereLost:
            with self._lock:
                if self._under_way is asked:
                    self.fraction, self.words = 0.0, (LOST,)
            self._tell()
            raise
        except InputError as error:
            words = tuple(str(fault) for fault in for_a_page(error).faults)
        except Exception as error:
            _log.exception("%s failed", self._name)
            words = (f"Something went wrong: {type(error).__name__}: {error}",)
        with self._lock:
            if self._under_way is not asked:  # stopped, or another one waits
                return
            self.fraction, self._under_way, self.words = None, None, words
            if found is not None and self._complete(found):
                self.result, self.asked = found, asked
            elif found is not None:
                self.words = (self._stopped,)
        self._tell()

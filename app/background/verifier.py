"""One visitor's verifications: the scenario as full strapdown beside the linear model, in the background."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from app.background.worker import Watch, Worker
from navcore.errors import InputError
from navcore.scenario import Scenario

if TYPE_CHECKING:
    from navcore.verification import Verification


@dataclass(frozen=True)
class Verified:
    """A verification to be shown beside a run.

    Attributes
    ----------
    verification : Verification
        Of the same methods.
    old : bool
        It is of an earlier scenario.
    """

    verification: Verification
    old: bool


STOPPED, CHANGED = "Stopped: nothing was verified.", "Stopped: the scenario was changed meanwhile."
_REPORT_EVERY_S = 0.15
_log = logging.getLogger("schuler.verifier")

Verify = Callable[[Scenario, Callable[[float], None], Callable[[], bool]], "Verification"]


class Verifier:
    """Verifies one scenario at a time; a change of the scenario stops it, and makes its result an old one.

    Parameters
    ----------
    tell : callable
        ``tell()`` whenever there is something new to show, from the thread that verifies.
    verify : callable, optional
        In place of `navcore.verification.verify`.
    name : str
        Of the thread.

    Attributes
    ----------
    fraction : float or None
        Part that is done while a verification is under way.
    result : Verification or None
        The last complete one.
    scenario : Scenario or None
        What it is of.
    words : tuple of str
        Why there is no newer result: stopped, refused, failed.
    """

    def __init__(
        self, tell: Callable[[], None], verify: Verify | None = None, name: str = "verifier"
    ) -> None:
        self._tell, self._verify = tell, verify or _verify
        self._lock = threading.Lock()
        self._worker: Worker[Scenario] = Worker(self._work, name)
        self._under_way: Scenario | None = None
        self.fraction: float | None = None
        self.result: Verification | None = None
        self.scenario: Scenario | None = None
        self.words: tuple[str, ...] = ()

    def start(self, scenario: Scenario) -> None:
        """Verify a scenario, in place of one that is under way."""
        with self._lock:
            self.fraction, self.words, self._under_way = 0.0, (), scenario
        self._worker.submit(scenario)
        self._tell()

    def cancel(self, why: str = STOPPED) -> None:
        """Stop; an earlier result stays."""
        with self._lock:
            if self.fraction is None:
                return
            self.fraction, self.words, self._under_way = None, (why,), None
        self._worker.cancel()
        self._tell()

    def forget(self) -> None:
        """Drop the result: quite another scenario was opened."""
        with self._lock:
            self.result = self.scenario = None

    def follow(self, scenario: Scenario) -> None:
        """Take note that this is the scenario now."""
        with self._lock:
            self.words = ()
            outdated = self._under_way is not None and self._under_way != scenario
        if outdated:
            self.cancel(CHANGED)

    def beside(self, scenario: Scenario) -> Verified | None:
        """What can be shown beside a run of this scenario: a result with the same methods by name."""
        with self._lock:
            result, of = self.result, self.scenario
        if result is None or of is None or [m.name for m in of.method] != [m.name for m in scenario.method]:
            return None
        return Verified(result, of != scenario)

    def stop(self) -> None:
        """End the thread."""
        self._worker.stop()

    def wait_idle(self, timeout_s: float | None = None) -> bool:
        """Block until no verification is under way; False after the timeout."""
        return self._worker.wait_idle(timeout_s)

    def _work(self, scenario: Scenario, watch: Watch) -> None:
        last_s = 0.0

        def progress(fraction: float) -> None:
            nonlocal last_s
            if watch.elapsed_s - last_s < _REPORT_EVERY_S:
                return
            last_s = watch.elapsed_s
            with self._lock:
                if self._under_way is not scenario:
                    return
                self.fraction = fraction
            self._tell()

        result, words = None, ()
        try:
            result = self._verify(scenario, progress, watch.cancelled)
        except InputError as error:
            words = tuple(str(fault) for fault in error.faults)
        except Exception as error:
            _log.exception("a verification failed")
            words = (f"Something went wrong: {type(error).__name__}: {error}",)
        with self._lock:
            if self._under_way is not scenario:  # stopped, or another one waits
                return
            self.fraction, self._under_way, self.words = None, None, words
            if result is not None and result.complete:
                self.result, self.scenario = result, scenario
            elif result is not None:
                self.words = (STOPPED,)
        self._tell()


def _verify(
    scenario: Scenario, progress: Callable[[float], None], cancelled: Callable[[], bool]
) -> Verification:
    from navcore.verification import verify

    return verify(scenario, progress, cancelled)

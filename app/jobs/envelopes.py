"""Computes the envelope of a scenario over many seeds in the background, once the user's hands are still."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable
from dataclasses import dataclass

from app.jobs.load import spare_load
from app.jobs.rows import few_rows
from app.jobs.words import for_a_page
from app.jobs.worker import Watch, Worker
from app.plots.envelope import Envelope, envelope
from navcore.engine.run import Run
from navcore.foundation.errors import InputError
from navcore.scenario.model import Scenario

SEEDS = 20
STILL_S = 0.7
"""A scenario must stand still for so long before its envelope is begun."""
_log = logging.getLogger("schuler.envelopes")

Simulate = Callable[[Scenario, Callable[[float], None], Callable[[], bool]], Run]


@dataclass(frozen=True)
class _Found:
    scenario: Scenario
    envelope: Envelope


class Envelopes:
    """The envelope of one session's scenario; a change of the scenario stops it.

    Parameters
    ----------
    simulate : callable
        ``simulate(scenario, progress, cancelled)``.
    came_further, ended : callable
        Called without arguments: there is more progress to show; there is a new envelope, or none any more.

    Attributes
    ----------
    fraction : float or None
        Part that is done while one is under way.
    words : str
        Why there is none; empty otherwise.
    """

    def __init__(
        self,
        simulate: Simulate,
        came_further: Callable[[], None],
        ended: Callable[[], None],
        still_s: float = STILL_S,
        visitor: object = None,
    ) -> None:
        self._simulate, self._came_further, self._ended = simulate, came_further, ended
        self._lock = threading.Lock()
        self._worker: Worker[Scenario] = Worker(self._work, visitor=visitor, load=spare_load, still_s=still_s)
        self._found: _Found | None = None
        self.fraction: float | None = None
        self.words = ""

    def follow(self, scenario: Scenario, wanted: bool) -> None:
        """Make the envelope of this scenario, if it is wanted and is not there yet."""
        if not wanted:
            self.cancel()
            with self._lock:
                self._found, self.words = None, ""
            return
        if self.beside(scenario) is not None:
            return
        if scenario.strapdown:
            with self._lock:
                self.words = f"Not for strapdown runs: it would take {SEEDS} of them."
            self._came_further()
            return
        with self._lock:
            self.fraction, self.words = 0.0, ""
        self._worker.submit(scenario)

    def cancel(self) -> None:
        """Stop one that is under way."""
        with self._lock:
            self.fraction = None
        self._worker.cancel()

    def beside(self, scenario: Scenario) -> Envelope | None:
        """The envelope of exactly this scenario; None when there is none."""
        found = self._found
        return found.envelope if found is not None and found.scenario == scenario else None

    def stop(self) -> None:
        """End the thread."""
        self._worker.stop()

    def wait_idle(self, timeout_s: float | None = None) -> bool:
        """Block until none is under way; False after the timeout."""
        return self._worker.wait_idle(timeout_s)

    def _work(self, scenario: Scenario, watch: Watch) -> None:
        runs: list[Run] = []
        try:
            for number in range(1, SEEDS + 1):
                run = self._simulate(with_seed(scenario, scenario.run.seed + number), _silent, watch.unwanted)
                if watch.unwanted() or run.status == "stopped":
                    return
                runs.append(few_rows(run, 2))
                with self._lock:
                    self.fraction = number / SEEDS
                self._came_further()
        except InputError as error:
            self._give_up(str(for_a_page(error).faults[0]))
            return
        except Exception as error:
            _log.exception("an envelope failed")
            self._give_up(f"Something went wrong: {type(error).__name__}: {error}")
            return
        found = _Found(scenario, envelope(runs))
        with self._lock:
            self.fraction, self._found = None, found
        self._ended()

    def _give_up(self, words: str) -> None:
        with self._lock:
            self.fraction, self.words = None, words
        self._came_further()


def with_seed(scenario: Scenario, seed: int) -> Scenario:
    """The same scenario with other noise."""
    return scenario.model_copy(update={"run": scenario.run.model_copy(update={"seed": seed})})


def _silent(_: float) -> None:
    pass

"""Computes the bands of a scenario's error curves in the background, once the user's hands are still."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable
from dataclasses import dataclass, replace

from app.jobs.elsewhere import LOST, carried_out, carried_out_all
from app.jobs.load import heavy_load
from app.jobs.rows import few_rows
from app.jobs.scheduler import Lane
from app.jobs.words import for_a_page
from app.jobs.worker import ElsewhereLost, Watch, Worker
from app.plots.envelope import BandKind, Envelope, covariance_envelope, envelope
from navcore.engine.run import Run
from navcore.foundation.errors import InputError
from navcore.scenario.model import Scenario

SEEDS = 20
STILL_S = 0.7
"""A scenario must stand still for so long before its bands are begun."""
_log = logging.getLogger("schuler.envelopes")

Simulate = Callable[[Scenario, Callable[[float], None], Callable[[], bool]], Run]


@dataclass(frozen=True)
class _Asked:
    scenario: Scenario
    kind: BandKind


@dataclass(frozen=True)
class _Found:
    asked: _Asked
    envelope: Envelope


class Envelopes:
    """The bands of one session's scenario; a change of the scenario stops what is under way.

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
        Why there is none, or what is to be known while one is under way; empty otherwise.
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
        self._worker: Worker[_Asked] = Worker(
            self._work, visitor=visitor, load=lambda asked: heavy_load(asked.scenario), still_s=still_s
        )
        self._found: _Found | None = None
        self.fraction: float | None = None
        self.words = ""

    def follow(self, scenario: Scenario, kind: BandKind) -> None:
        """Make the bands of this scenario, if any are wanted and they are not there yet."""
        asked, found = _Asked(scenario, kind), self._found
        if kind == "none" or (found is not None and found.asked == asked):
            self.cancel()
            with self._lock:
                self.words = ""
                self._found = None if kind == "none" else found
            return
        if kind == "seeds" and scenario.strapdown:
            self.cancel()
            with self._lock:
                self.words = f"Not for strapdown runs: it would take {SEEDS} of them."
            self._came_further()
            return
        with self._lock:
            self.fraction, self.words = 0.0, ""
        self._worker.submit(asked)

    def cancel(self) -> None:
        """Stop one that is under way."""
        with self._lock:
            self.fraction = None
        self._worker.cancel()

    def beside(self, scenario: Scenario, kind: BandKind) -> Envelope | None:
        """The bands of this scenario, or those of an earlier one with the same methods, marked as old."""
        found = self._found
        if found is None or found.asked.kind != kind:
            return None
        if found.asked.scenario == scenario:
            return found.envelope
        return replace(found.envelope, old=True) if _alike(found.asked.scenario, scenario) else None

    def stop(self) -> None:
        """End the thread."""
        self._worker.stop()

    def wait_idle(self, timeout_s: float | None = None) -> bool:
        """Block until none is under way; False after the timeout."""
        return self._worker.wait_idle(timeout_s)

    def _work(self, asked: _Asked, watch: Watch) -> None:
        try:
            made = self._over_seeds(asked, watch) if asked.kind == "seeds" else self._covariance(asked, watch)
        except ElsewhereLost:
            with self._lock:
                self.fraction, self.words = 0.0, LOST
            self._came_further()
            raise
        except InputError as error:
            self._give_up(str(for_a_page(error).faults[0]))
            return
        except Exception as error:
            _log.exception("an envelope failed")
            self._give_up(f"Something went wrong: {type(error).__name__}: {error}")
            return
        if made is None:
            return
        with self._lock:
            self.fraction, self.words, self._found = None, "", _Found(asked, made)
        self._ended()

    def _over_seeds(self, asked: _Asked, watch: Watch) -> Envelope | None:
        scenario = asked.scenario
        seeds = [with_seed(scenario, scenario.run.seed + number) for number in range(1, SEEDS + 1)]
        # On a cluster all of them side by side; here each takes over what the last one had in common with it.
        one = _of_a_seed if watch.lane is Lane.CLUSTER else self._of_a_seed
        runs = carried_out_all(one, seeds, self._tell, watch)
        if runs is None or watch.unwanted() or any(run.status == "stopped" for run in runs):
            return None
        return envelope(runs)

    def _of_a_seed(
        self, scenario: Scenario, progress: Callable[[float], None], cancelled: Callable[[], bool]
    ) -> Run:
        found = few_rows(self._simulate(scenario, _silent, cancelled), 2)
        progress(1.0)
        return found

    def _covariance(self, asked: _Asked, watch: Watch) -> Envelope | None:
        from navcore.design.bands import covariance_bands

        found = carried_out(covariance_bands, asked.scenario, self._tell, watch)
        return None if found is None or watch.unwanted() else covariance_envelope(asked.scenario, found)

    def _tell(self, fraction: float) -> None:
        with self._lock:
            self.fraction = fraction
        self._came_further()

    def _give_up(self, words: str) -> None:
        with self._lock:
            self.fraction, self.words = None, words
        self._came_further()


def _of_a_seed(scenario: Scenario, progress: Callable[[float], None], cancelled: Callable[[], bool]) -> Run:
    """What a run with another seed needs for the bands; found by its name on a cluster."""
    from navcore.engine.simulation import simulate

    return few_rows(simulate(scenario, progress, cancelled), 2)


def _alike(one: Scenario, other: Scenario) -> bool:
    """Whether bands of the one may stay behind the curves of the other until its own are there."""
    names = ([method.name for method in scenario.method] for scenario in (one, other))
    return one.run.duration_h == other.run.duration_h and next(names) == next(names)


def with_seed(scenario: Scenario, seed: int) -> Scenario:
    """The same scenario with other noise."""
    return scenario.model_copy(update={"run": scenario.run.model_copy(update={"seed": seed})})


def _silent(_: float) -> None:
    pass

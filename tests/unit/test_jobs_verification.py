"""The verification as a job: its result, its progress, and how it is stopped or refused."""

import threading
from collections.abc import Callable, Iterator
from types import SimpleNamespace
from typing import Any

import pytest

from navcore.foundation.errors import Fault, InputError
from navcore.questions.verify import VerifyQuestion
from navcore.scenario.model import Scenario
from schuler_bench.editing import edits
from schuler_bench.jobs.asking import CHANGED, Asker
from schuler_bench.session.shown import verified_beside
from tests.waiting import until

DURATION = ("run", "duration_h")


def verify(question: Any, progress: Callable[[float], None], cancelled: Callable[[], bool]) -> Any:
    """Stand-in: 3 h cannot be verified, 4 h is a fault of ours, 5 h lasts until it is stopped."""
    scenario = question.scenario
    hours = scenario.run.duration_h
    if hours == 3.0:
        raise InputError(Fault("", "run.fidelity", "channel", "leaves the Earth out"))
    if hours == 4.0:
        raise ZeroDivisionError("ours")
    if hours == 5.0:
        while not cancelled():
            progress(0.5)
            threading.Event().wait(0.002)
        return SimpleNamespace(complete=False)
    return SimpleNamespace(complete=True, of=scenario)


def hours(value: float) -> Scenario:
    return edits.with_value(Scenario(), DURATION, value)


def asked_of(value: float) -> VerifyQuestion:
    return VerifyQuestion(scenario=hours(value))


@pytest.fixture
def made() -> Iterator[tuple[Asker, list[float | None]]]:
    told: list[float | None] = []
    verifier = Asker(lambda: told.append(verifier.fraction), VerifyQuestion)
    verifier._compute = verify
    yield verifier, told
    verifier.cancel()
    verifier.stop()


def under_way(verifier: Asker, told: list[float | None]) -> None:
    verifier.begin(asked_of(5.0))
    until(lambda: 0.5 in told)


def test_a_result_is_of_its_scenario_until_that_changes(made: tuple[Asker, list]) -> None:
    verifier, told = made
    verifier.begin(asked_of(1.0))
    assert verifier.wait_idle(5.0)
    assert told == [0.0, None]
    beside = verified_beside(verifier, hours(1.0))
    assert beside is not None and not beside.old
    changed = verified_beside(verifier, hours(2.0))
    assert changed is not None and changed.old
    other, _ = edits.with_method(edits.with_value(Scenario(), ("reference", "kind"), "log"), None)
    assert verified_beside(verifier, other) is None  # not the same methods
    verifier.forget()
    assert verified_beside(verifier, hours(1.0)) is None


def test_progress_is_told_and_a_stop_keeps_the_earlier_result(made: tuple[Asker, list]) -> None:
    verifier, told = made
    verifier.begin(asked_of(1.0))
    assert verifier.wait_idle(5.0)
    kept = verifier.result
    under_way(verifier, told)
    verifier.cancel()
    assert verifier.wait_idle(5.0)
    assert (verifier.fraction, verifier.words) == (None, (VerifyQuestion.stopped,))
    assert verifier.result is kept


def test_a_change_of_the_scenario_stops_it_and_says_so(made: tuple[Asker, list]) -> None:
    verifier, told = made
    under_way(verifier, told)
    verifier.leave(hours(5.0))
    assert verifier.fraction is not None
    verifier.leave(hours(2.0))
    assert verifier.wait_idle(5.0)
    assert verifier.words == (CHANGED,)
    verifier.leave(hours(2.5))
    assert verifier.words == ()
    assert verifier.result is None


@pytest.mark.parametrize(("length", "words"), [(3.0, "leaves the Earth out"), (4.0, "ZeroDivisionError")])
def test_what_is_wrong_is_said(made: tuple[Asker, list], length: float, words: str) -> None:
    verifier, _ = made
    verifier.begin(asked_of(length))
    assert verifier.wait_idle(5.0)
    assert words in verifier.words[0]
    assert verifier.result is None


def test_a_second_start_takes_the_place_of_the_first(made: tuple[Asker, list]) -> None:
    verifier, told = made
    under_way(verifier, told)
    verifier.begin(asked_of(1.0))
    assert verifier.wait_idle(5.0)
    assert verifier.asked == asked_of(1.0)
    assert verifier.words == ()

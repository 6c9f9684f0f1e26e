"""What is shown with the next picture, or after a while if none comes."""

from __future__ import annotations

import threading

import pytest

from app.shell import following
from app.shell.following import Following


@pytest.fixture(autouse=True)
def at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(following, "LATE_S", 0.01)


def test_what_no_picture_shows_is_shown_late() -> None:
    rung = threading.Event()
    follow = Following(rung.set)
    assert not follow.due
    follow.ask()
    assert follow.due and rung.wait(5.0)
    assert follow.due, "until it says that it is done"
    follow.done()
    assert not follow.due


def test_it_may_be_put_off_again_and_is_asked_for_again() -> None:
    rung = threading.Semaphore(0)

    def late() -> None:
        rung.release()
        follow.ask()

    follow = Following(late)
    follow.ask()
    for _ in range(3):
        assert rung.acquire(timeout=5.0)
    follow.close()


def test_what_a_picture_has_shown_is_not_shown_again(monkeypatch: pytest.MonkeyPatch) -> None:
    shown: list[str] = []
    waiting: list[threading.Timer] = []

    class Held(threading.Timer):
        def start(self) -> None:
            waiting.append(self)

    monkeypatch.setattr(following, "timer", lambda delay_s, act: Held(delay_s, act))
    follow = Following(lambda: shown.append("late"))
    follow.ask()
    follow.ask()
    assert len(waiting) == 1, "one alarm however often it is asked"
    follow.done()
    waiting[0].function()
    assert shown == []
    follow.ask()
    assert len(waiting) == 2
    follow.close()
    waiting[1].function()
    assert shown == []

"""The time that a page shows: by hand, running, at the end; and its thread."""

from __future__ import annotations

import threading
from dataclasses import replace

import pytest

from app.views.scene.playback import MOST_AHEAD, SLOW_S, SPEEDS, TICK_S, Playback, PlayState


def test_the_time_runs_with_its_speed_and_stops_at_the_end() -> None:
    state = PlayState(time_s=100.0, span_s=1000.0, playing=True, speed=300)
    ended, again = state.later(10.0), replace(state, loop=True).later(4.0)
    assert state.later(1.0).time_s == 400.0
    assert (ended.time_s, ended.playing, ended.at_end) == (1000.0, False, True)
    assert (again.time_s, again.playing) == (300.0, True)
    still = replace(state, playing=False)
    assert still.later(5.0) is still


def test_what_is_asked_for_is_held_within_the_run() -> None:
    told: list[PlayState] = []
    playback = Playback(told.append)
    playback.follow(3600.0)
    assert playback.state.time_s == 3600.0  # a new page shows the whole run
    for asked, shown in ((100.0, 100.0), (-5.0, 0.0), (1e9, 3600.0), (1800.0, 1800.0)):
        playback.seek(asked)
        assert playback.state.time_s == told[-1].time_s == shown
    count = len(told)
    for wrong in (float("nan"), float("inf")):
        playback.seek(wrong)
    playback.set_speed(61.0)
    assert len(told) == count and playback.state.speed in SPEEDS
    playback.set_speed(SPEEDS[0])
    playback.set_loop(True)
    assert (told[-1].speed, told[-1].loop) == (SPEEDS[0], True)


def test_a_run_of_another_length_keeps_the_place() -> None:
    playback = Playback(lambda state: None)
    for seek, span, place in (
        (None, 3600.0, 3600.0),
        (None, 7200.0, 7200.0),  # at the end it stays at the end
        (5000.0, 3600.0, 3600.0),
        (1000.0, 7200.0, 1000.0),
    ):
        if seek is not None:
            playback.seek(seek)
        playback.follow(span)
        assert playback.state.time_s == place


def test_it_plays_pauses_and_ends_with_its_page() -> None:
    moved, threads = threading.Event(), set()

    def show(state: PlayState) -> None:
        if state.playing and state.time_s > 50.0:
            threads.add(threading.current_thread())
            moved.set()

    playback = Playback(show)
    playback.follow(1e6)
    playback.toggle()  # from the end it begins anew
    assert playback.state.playing and playback.state.time_s < 1e6
    assert moved.wait(10.0)
    playback.toggle()
    held = playback.state
    assert not held.playing
    (thread,) = [t for t in threads if t.name == "playback"]
    assert playback.state == held
    playback.toggle()
    playback.close()
    thread.join(10.0)
    assert not thread.is_alive()
    playback.seek(1.0)
    assert playback.state.time_s != 1.0


def test_without_a_run_nothing_plays() -> None:
    playback = Playback(lambda state: None)
    playback.toggle()
    assert not playback.state.playing


def test_a_fault_of_the_page_does_not_end_the_playback(caplog: pytest.LogCaptureFixture) -> None:
    calls = []

    def show(state: PlayState) -> None:
        calls.append(state)
        if len(calls) == 3:
            raise ConnectionError("gone")
        if len(calls) == 5:
            done.set()

    done = threading.Event()
    playback = Playback(show)
    playback.follow(1e6)
    playback.toggle()
    assert done.wait(10.0)
    playback.close()
    assert "could not be shown" in caplog.text


def test_a_page_that_falls_behind_gets_fewer_updates(monkeypatch: pytest.MonkeyPatch) -> None:
    paused: list[float] = []
    enough = threading.Event()

    def sleep(seconds: float) -> None:
        paused.append(seconds)
        if len(paused) == MOST_AHEAD + 3:
            playback.heard(0)
        if len(paused) >= MOST_AHEAD + 6:
            enough.set()

    playback = Playback(lambda state: None)
    monkeypatch.setattr("app.views.scene.playback.time.sleep", sleep)
    playback.follow(1e9)
    playback.toggle()
    assert enough.wait(10.0)
    playback.close()
    assert paused[:MOST_AHEAD] == [TICK_S] * MOST_AHEAD
    assert paused[MOST_AHEAD : MOST_AHEAD + 3] == [SLOW_S] * 3
    assert paused[MOST_AHEAD + 3 : MOST_AHEAD + 6] == [TICK_S] * 3

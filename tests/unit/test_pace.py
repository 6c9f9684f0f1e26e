"""A page is sent what it has time for while a slider moves, and everything at rest: one state machine."""

import threading
from collections.abc import Iterator

import pytest

from schuler_bench.shell import pace as module
from schuler_bench.shell.pace import AHEAD, LATE_S, NEXT, Event, Pace, State

RUN, LATE, OPENS, CLOSES = "a run ends", "the page is late", "the page will answer", "the page goes"
Step = str | tuple[int, bool]
"""One of the words above, or what the page says: its painted picture, and whether a slider moves."""


class Played:
    """A pace whose clock stands, and the pictures that it sent."""

    def __init__(self) -> None:
        self.now_s = 100.0
        self.sent: list[tuple[int, bool]] = []
        self.followed = threading.Semaphore(0)
        self.pace = Pace(
            lambda *picture: self.sent.append(picture), self.followed.release, lambda: self.now_s
        )

    def play(self, step: Step) -> None:
        if isinstance(step, tuple):
            self.pace.on_painted(step[0], moving=step[1])
        elif step == LATE:
            self.now_s += LATE_S
        else:
            {RUN: self.pace.ended, OPENS: self.pace.expect_answers, CLOSES: self.pace.close}[step]()


@pytest.fixture
def played() -> Iterator[Played]:
    played = Played()
    yield played
    played.pace.close()


@pytest.mark.parametrize(
    ("steps", "sent", "state"),
    [
        pytest.param([RUN] * 5, [(n, True) for n in range(1, 6)], State.SHOWN, id="a program says nothing"),
        pytest.param(
            [RUN, (1, False), *[RUN] * (AHEAD + 3)], [(n, True) for n in (1, 2, 3)], State.DUE, id="runs wait"
        ),
        pytest.param(
            [RUN, (1, False), *[RUN] * (AHEAD + 3), (3, False), (4, False)],
            [(n, True) for n in (1, 2, 3, 4)],
            State.SHOWN,
            id="the last one is shown, once",
        ),
        pytest.param(
            [RUN, (1, False), *[RUN] * (AHEAD + 1), LATE, RUN],
            [(n, True) for n in (1, 2, 3, 4)],
            State.SHOWN,
            id="a late page is not waited for",
        ),
        pytest.param(
            [RUN, (1, True), RUN, (2, True), RUN],
            [(1, True), (2, False), (3, False)],
            State.HELD_PARTLY,
            id="while a slider moves only what is in front",
        ),
        pytest.param(
            [RUN, (1, True), RUN, (2, True), RUN, (2, False), (4, False)],
            [(1, True), (2, False), (3, False), (4, True)],
            State.SHOWN,
            id="at rest all of it, once",
        ),
        pytest.param(
            [RUN, (1, True), (1, False)], [(1, True)], State.SHOWN, id="a slider that was only held"
        ),
        pytest.param(
            [RUN, (7, False), *[RUN] * 4],
            [(n, True) for n in range(1, 6)],
            State.SHOWN,
            id="a number that was never sent changes nothing",
        ),
        pytest.param([CLOSES, RUN, (1, False)], [], State.CLOSED, id="a closed page"),
        pytest.param(
            [OPENS, (0, False), RUN], [(1, False)], State.PARTLY, id="an opening page: pictures first"
        ),
        pytest.param(
            [OPENS, RUN, RUN], [(1, False)], State.PARTLY, id="the rest waits until they are painted"
        ),
        pytest.param(
            [OPENS, RUN, RUN, (1, False), (2, False)],
            [(1, False), (2, True)],
            State.SHOWN,
            id="the rest, once",
        ),
        pytest.param(
            [OPENS, RUN, LATE, (0, False), RUN],
            [(1, False), (2, True), (3, True)],
            State.SHOWN,
            id="a page that opens out of sight is waited for once",
        ),
    ],
)
def test_pictures_are_sent_as_the_page_paints_them(
    played: Played, steps: list[Step], sent: list[tuple[int, bool]], state: State
) -> None:
    for step in steps:
        played.play(step)
    assert (played.sent, played.pace.state) == (sent, state)


@pytest.mark.parametrize("state", State)
def test_every_state_has_its_way_on(state: State) -> None:
    run, held, rests, sent = NEXT[state]
    if state is State.CLOSED:
        assert {run, held, rests, sent} == {State.CLOSED}
        return
    # A slider that is held or rests stays so until the page says otherwise, and no run is forgotten by it.
    assert NEXT[held][Event.RESTS.value] not in (State.CLOSED, held)
    lasting = ((held, Event.HELD), (rests, Event.RESTS), (run, Event.RUN))
    assert all(NEXT[state][event.value] is state for state, event in lasting)
    assert {s.name.startswith("HELD") for s in (run, sent)} == {state.name.startswith("HELD")}
    assert sent not in (State.FIRST, State.DUE, State.HELD_DUE)


def test_controls_follow_late_until_they_have_and_may_be_put_off(
    played: Played, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "CONTROLS_LATE_S", 0.01)
    for _ in range(3):
        played.pace.follow_later()
        assert played.followed.acquire(timeout=5.0)
        assert played.pace.controls_wait, "until the page says that they are shown"


def test_controls_that_a_picture_has_shown_do_not_follow_again(
    played: Played, monkeypatch: pytest.MonkeyPatch
) -> None:
    alarms: list[threading.Timer] = []

    class Held(threading.Timer):
        def start(self) -> None:
            alarms.append(self)

    monkeypatch.setattr(module, "timer", Held)
    played.pace.follow_later()
    played.pace.follow_later()
    assert len(alarms) == 1, "one alarm however often it is asked"
    played.pace.controls_wait = False
    alarms[0].function()
    played.pace.follow_later()
    assert len(alarms) == 2
    played.pace.close()
    alarms[1].function()
    assert not played.followed.acquire(blocking=False)

"""A class: one leads, the others follow, and what they give is seen by the one who leads."""

import threading
import time
from collections.abc import Callable, Iterator

import pytest

from schuler_bench.session.classroom import Classroom, Given, Led

PLACE = ("1-schuler-pendulum", 0)


@pytest.fixture
def room() -> Iterator[Classroom]:
    made = Classroom("123456")
    yield made
    made.close()


def soon(holds: Callable[[], bool]) -> None:
    end = time.monotonic() + 10.0
    while not holds():
        assert time.monotonic() < end
        time.sleep(0.01)


def test_the_code_is_drawn_anew_for_each_class() -> None:
    codes = {Classroom().code for _ in range(20)}
    assert len(codes) > 15 and all(len(code) == 6 and code.isdecimal() for code in codes)


def test_only_who_knows_the_code_leads(room: Classroom) -> None:
    assert not room.claim("a", "000000") and not room.is_led
    room.go("a", PLACE)
    assert room.led == Led()
    assert room.claim("a", " 123456 ") and room.leads("a") and not room.leads("b")
    room.go("b", PLACE)
    assert room.led.place is None
    room.go("a", PLACE)
    assert room.led.place == PLACE


def test_codes_cannot_be_tried_without_end(room: Classroom) -> None:
    for number in range(20):
        assert not room.claim("a", f"{number:06d}")
    assert not room.claim("a", "123456")


def test_each_change_is_followed_once_and_show_me_is_told(room: Classroom) -> None:
    room.claim("teacher", "123456")
    room.go("teacher", PLACE)
    assert room.follow("teacher") is None
    assert room.follow("pupil") == (Led(PLACE), False)
    assert room.follow("pupil") is None
    room.show("teacher")
    assert room.follow("pupil") == (Led(PLACE, 1), True)
    # Who comes later is taken to the step; what was pressed before is not pressed for him.
    assert room.follow("late") == (Led(PLACE, 1), False)
    room.reveal("teacher")
    assert room.follow("pupil") == (Led(PLACE, 1, True), False)
    room.go("teacher", (PLACE[0], 1))
    assert room.led == Led((PLACE[0], 1), 1, False)
    room.release("teacher")
    assert room.follow("pupil") is None


def test_what_is_given_is_that_of_the_others_and_bounded(room: Classroom) -> None:
    room.claim("teacher", "123456")
    room.give("teacher", PLACE, answer="1")
    room.give("a", PLACE, answer="84")
    room.give("a", PLACE, right=True)
    room.give("b", PLACE, heights=(0.5,))
    assert room.given(PLACE) == (Given("84", True), Given(heights=(0.5,)))
    assert room.given(("other", 0)) == ()
    for number in range(300):
        room.give(f"many {number}", PLACE, met=True)
    assert len(room.given(PLACE)) <= 200
    for number in range(100):
        room.give("a", ("lesson", number), answer="1")
    assert room.given(PLACE) == ()


def test_pages_are_told_from_a_thread_of_the_class_the_leader_first(room: Classroom) -> None:
    told: list[str] = []
    for name in ("a", "teacher", "b"):
        room.watch(name, name, lambda name=name: told.append(name))
    room.claim("teacher", "123456")
    soon(lambda: told.count("teacher") >= 1 and told.count("b") >= 1)
    time.sleep(0.6)
    told.clear()
    for number in range(50):
        room.give("a", PLACE, answer=str(number))
    soon(lambda: len(told) >= 3)
    time.sleep(0.6)
    assert told[0] == "teacher" and len(told) <= 9, "fifty changes at once are told in few rounds"
    assert room.here == 2


def test_a_page_that_fails_does_not_hold_up_the_others(room: Classroom) -> None:
    told = threading.Event()

    def fail() -> None:
        raise RuntimeError("gone")

    room.watch("a", "a", fail)
    room.watch("b", "b", told.set)
    assert told.wait(10.0)


def test_the_class_is_led_no_more_when_its_leader_has_closed(room: Classroom) -> None:
    room.watch("page", "teacher", lambda: None)
    room.watch("second", "teacher", lambda: None)
    room.claim("teacher", "123456")
    room.leave("page")
    assert room.is_led
    room.leave("second")
    assert not room.is_led

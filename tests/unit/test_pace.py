"""A page is sent what it has time for while a slider moves, and everything at rest."""

from __future__ import annotations

import pytest

from app.shell.pace import AHEAD, LATE_S, Pace


class Told:
    """What a page was sent, and the time."""

    def __init__(self) -> None:
        self.now_s = 100.0
        self.drawn: list[tuple[int, bool]] = []
        self.pace = Pace(lambda number, whole: self.drawn.append((number, whole)), lambda: self.now_s)


@pytest.fixture
def page() -> Told:
    return Told()


def test_a_program_that_says_nothing_is_sent_every_run(page: Told) -> None:
    for _ in range(5):
        page.pace.ended()
    assert page.drawn == [(number, True) for number in range(1, 6)]


def test_runs_wait_for_a_page_that_draws_and_the_last_is_shown(page: Told) -> None:
    page.pace.ended()
    page.pace.told(1, moving=False)
    for _ in range(AHEAD + 3):
        page.pace.ended()
    assert len(page.drawn) == 1 + AHEAD
    page.pace.told(1 + AHEAD, moving=False)
    assert page.drawn[-1] == (2 + AHEAD, True)
    page.pace.told(2 + AHEAD, moving=False)
    assert len(page.drawn) == 2 + AHEAD
    page.pace.close()


def test_a_page_that_is_late_is_not_waited_for(page: Told) -> None:
    page.pace.ended()
    page.pace.told(1, moving=False)
    for _ in range(AHEAD + 1):
        page.pace.ended()
    page.now_s += LATE_S
    page.pace.ended()
    assert len(page.drawn) == 2 + AHEAD
    page.pace.close()


def test_while_a_slider_moves_only_what_is_in_front_and_at_rest_all_of_it(page: Told) -> None:
    page.pace.ended()
    page.pace.told(1, moving=True)
    page.pace.ended()
    page.pace.told(2, moving=True)
    page.pace.ended()
    assert page.drawn[1:] == [(2, False), (3, False)]
    page.pace.told(2, moving=False)
    assert page.drawn[3:] == [(4, True)]
    page.pace.told(4, moving=False)
    assert len(page.drawn) == 4, "nothing is shown twice"


def test_a_number_that_was_never_sent_changes_nothing(page: Told) -> None:
    page.pace.ended()
    page.pace.told(7, moving=False)
    for _ in range(4):
        page.pace.ended()
    assert len(page.drawn) == 5


def test_a_closed_page_is_sent_nothing(page: Told) -> None:
    page.pace.close()
    page.pace.ended()
    assert page.drawn == []


def test_a_page_that_opens_has_its_pictures_first(page: Told) -> None:
    page.pace.expect_answers()
    page.pace.ended()
    assert page.drawn == [(1, False)]
    page.pace.ended()
    assert len(page.drawn) == 1, "the rest waits until they are painted"
    page.pace.told(1, moving=False)
    assert page.drawn[1:] == [(2, True)]
    page.pace.told(2, moving=False)
    assert len(page.drawn) == 2, "nothing is shown twice"


def test_a_page_that_opens_out_of_sight_has_everything_soon(page: Told) -> None:
    page.pace.expect_answers()
    page.pace.ended()
    page.now_s += LATE_S
    page.pace.told(0, moving=False)
    assert page.drawn[1:] == [(2, True)]
    page.pace.ended()
    assert page.drawn[2:] == [(3, True)], "it is not waited for again"
    page.pace.close()

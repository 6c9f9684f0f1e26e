"""Pins that a reviewer sends back with a link: beside the author's, nothing lost, one step of undo."""

from collections.abc import Iterator
from contextlib import closing

import pytest

from navcore.foundation.errors import InputError
from navcore.scenario.file import load
from schuler_bench.editing import edits
from schuler_bench.http.ids import SessionIds
from schuler_bench.session.pins import MOST_PINS
from schuler_bench.session.session import Session
from schuler_bench.session.sessions import Sessions
from schuler_bench.session.taking import take_pins

PRESET = load("zha-fast", ["run.duration_h=1"])
XI = ("method", 2, "network", "xi")


@pytest.fixture
def sessions() -> Iterator[Sessions]:
    with closing(Sessions(lambda: (PRESET, "zha-fast"))) as sessions:
        yield sessions


def pinned(session: Session, xi: float, note: str = "") -> None:
    session.change(edits.with_value(session.scenario, XI, xi), None)
    session.redo_run()
    assert session.wait_idle(60.0) and session.run is not None
    pin = session.pins.add(session.run, session.origin, method="fast (compass)")
    session.pins.change(pin.id, note=note)


def reviewed(sessions: Sessions) -> tuple[Session, str]:
    """Author with a pin, and the link of a reviewer who has added two."""
    author = sessions.get("author-of-the-tests-0000")
    pinned(author, 0.5)
    reviewer = sessions.get(SessionIds().new_copy(author.share()))
    pinned(reviewer, 0.6, "calmer")
    pinned(reviewer, 0.9, "too stiff")
    pinned(author, 0.8)
    return author, f"http://bench.example/s/{reviewer.share()}/?tab=Compare"


def test_they_stand_beside_the_own_ones_and_undo_takes_them_back(sessions: Sessions) -> None:
    author, link = reviewed(sessions)
    scenario, own, steps = author.scenario, author.pins.all, len(author.history.steps)
    assert take_pins(author, link) == 2
    assert author.pins.wait_idle(60.0)
    taken = author.pins.all[2:]
    assert author.scenario == scenario and author.pins.all[:2] == own
    assert [(pin.name, pin.note) for pin in taken] == [("pin 3", "calmer"), ("pin 4", "too stiff")]
    assert [edits.value_at(pin.scenario, XI) for pin in taken] == [0.6, 0.9]
    assert all(pin.run is not None for pin in taken) and len({pin.color for pin in author.pins.all}) == 4
    assert author.history.undo_name == "take pins from a link" and len(author.history.steps) == steps + 1
    assert author.undo() and author.pins.all == own and author.scenario == scenario
    assert author.redo() and [pin.id for pin in author.pins.all] == [1, 2, 3, 4]
    assert author.undo() and author.undo() and author.pins.all == own


def test_what_is_here_already_is_not_taken_twice(sessions: Sessions) -> None:
    author, link = reviewed(sessions)
    steps = len(author.history.steps)
    assert [take_pins(author, link) for _ in range(2)] == [2, 0]
    assert len(author.pins.all) == 4 and len(author.history.steps) == steps + 1


@pytest.mark.parametrize("link", ["", "nothing", "/s/share-" + "x" * 24 + "/", "author-of-the-tests-0000"])
def test_what_is_no_link_takes_nothing(sessions: Sessions, link: str) -> None:
    author, _ = reviewed(sessions)
    assert take_pins(author, link) is None and len(author.pins.all) == 2


def test_more_than_the_most_are_refused_and_none_is_lost(sessions: Sessions) -> None:
    author, link = reviewed(sessions)
    assert author.run is not None
    for _ in range(MOST_PINS - 3):
        author.pins.add(author.run, "")
    own = author.pins.all
    with pytest.raises(InputError, match=f"at most {MOST_PINS}"):
        take_pins(author, link)
    assert author.pins.all == own

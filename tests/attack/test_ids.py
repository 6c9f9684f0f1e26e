"""Ids of sessions that the server did not make: a stranger must not choose where a visitor works."""

from __future__ import annotations

import pytest

from app.http.ids import SessionIds, new_shared_id
from tests.attack.conftest import Bench, eventually, running
from tests.attack.wire import ask, shake_hands, visit

pytestmark = pytest.mark.attack

CHOSEN = "chosen-by-a-stranger-000"


@pytest.fixture(scope="module")
def strict():
    with running(session_ids=SessionIds()) as bench:
        yield bench


def made_by(bench: Bench) -> str:
    return ask(bench.port, "/").headers["Location"].split("/")[1]


@pytest.mark.parametrize("slash", ["", "/"])
def test_a_chosen_id_is_answered_with_another(strict: Bench, slash: str) -> None:
    answer = ask(strict.port, f"/s/{CHOSEN}{slash}?a=b")
    assert answer.status == 302 and CHOSEN not in answer.headers["Location"]
    assert answer.headers["Location"].endswith("/?a=b")
    own = answer.headers["Location"].removeprefix("../").split("/")[0]
    assert ask(strict.port, f"/s/{own}/").status == 200


def test_a_websocket_with_a_chosen_id_gets_a_session_of_its_own(strict: Bench) -> None:
    with visit(strict.port, CHOSEN) as first, visit(strict.port, CHOSEN) as second:
        first.control("last")
        second.control("last")
        eventually(lambda: len(strict.handles) == 2)
        assert CHOSEN not in strict.handles
    assert ask(strict.port, f"/s/{CHOSEN}/place").status == 410


def test_an_id_of_the_server_is_accepted_and_kept(strict: Bench) -> None:
    own = made_by(strict)
    assert ask(strict.port, f"/s/{own}/").status == 200
    assert shake_hands(strict.port, f"/s/{own}").status == 101
    with visit(strict.port, own) as page:
        page.control("last")
        assert own in strict.handles


def test_an_id_changed_in_one_place_is_none(strict: Bench) -> None:
    own = made_by(strict)
    for at in (0, 10, 16, 23):
        other = own[:at] + ("A" if own[at] != "A" else "B") + own[at + 1 :]
        assert ask(strict.port, f"/s/{other}/").status == 302


def test_a_copy_of_a_shared_state_cannot_be_named_by_a_stranger(strict: Bench) -> None:
    shared = new_shared_id()
    assert ask(strict.port, f"/s/{shared}-{CHOSEN}/").status == 302
    copy = ask(strict.port, f"/s/{shared}/").headers["Location"].removeprefix("../").rstrip("/")
    assert ask(strict.port, f"/s/{copy}/").status == 200

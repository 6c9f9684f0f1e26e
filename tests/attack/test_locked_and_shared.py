"""A page that only watches changes nothing, whatever it sends; nobody works on a shared state itself."""

from __future__ import annotations

import pytest

from app.bridge.controls import lock_controls
from app.http.ids import copied_from, is_shared, new_shared_id
from tests.attack.conftest import Bench, eventually
from tests.attack.wire import SESSION, ask, shake_hands, visit

pytestmark = pytest.mark.attack


def test_controls_of_a_locked_page_take_nothing_until_it_is_freed(bench: Bench) -> None:
    with visit(bench.port) as visitor:
        ids = {label: visitor.control(label) for label in ("gain", "on", "title", "frozen", "last")}
        handles = bench.of(SESSION)
        client = next(iter(bench.server.viser.get_clients().values()))
        bench.events.clear()
        lock_controls(client, frozenset({ids["title"]}))
        shown = {label: handles[label].disabled for label in ids}
        assert shown == {"gain": True, "on": True, "title": False, "frozen": True, "last": True}
        visitor.set(ids["gain"], 0.7)
        visitor.set(ids["on"], False)
        visitor.set(ids["last"], True)
        late = client.gui.add_number("late", 1)  # made after the lock
        visitor.set(visitor.control("late"), 5)
        visitor.set(ids["title"], "said")
        eventually(lambda: ("title", "said") in bench.events)
        assert bench.events == [("title", "said")]
        assert (handles["gain"].value, handles["on"].value, late.value) == (0.5, True, 1)
        lock_controls(client, None)
        assert [handles[label].disabled for label in ("gain", "frozen")] == [False, True]
        visitor.set(ids["gain"], 0.7)
        eventually(lambda: ("gain", 0.7) in bench.events)


@pytest.mark.parametrize("slash", ["", "/"])
def test_a_shared_state_is_answered_with_a_copy_of_ones_own(bench: Bench, slash: str) -> None:
    shared = new_shared_id()
    targets = []
    for _ in range(2):
        answer = ask(bench.port, f"/s/{shared}{slash}?fixedDpr=1")
        assert answer.status == 302
        target = answer.headers["Location"]
        assert target.startswith("../" if slash else shared)
        copy, _, rest = target.removeprefix("../").partition("/")
        assert (copied_from(copy), rest) == (shared, "?fixedDpr=1")
        assert not is_shared(copy)
        targets.append(copy)
    assert targets[0] != targets[1]
    assert ask(bench.port, f"/s/{targets[0]}/").status == 200
    assert shake_hands(bench.port, f"/s/{targets[0]}").status == 101


def test_no_websocket_opens_a_shared_state_itself(bench: Bench) -> None:
    for slash in ("", "/"):
        assert shake_hands(bench.port, f"/s/{new_shared_id()}{slash}").status == 404

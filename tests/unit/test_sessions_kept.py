"""Sessions over a restart and as shared copies: what comes back, and what a strange file can do."""

import json
import logging
from collections.abc import Callable, Iterator
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest

from navcore.scenario.file import load
from schuler_bench.editing import edits
from schuler_bench.http.ids import SessionIds, is_shared
from schuler_bench.session.database import Database
from schuler_bench.session.recordings import recorded_scenario
from schuler_bench.session.session import Session
from schuler_bench.session.sessions import Sessions
from schuler_bench.session.store import open_store

ID, PRESET = "visitor-of-the-tests-000", load("zha-fast")
XI = ("method", 2, "network", "xi")
LOG = b"t_s,speed_mps,heading_deg\n" + b"".join(b"%d,5.0,90.0\n" % t for t in range(120))
Document = dict[str, Any]


@pytest.fixture
def started(tmp_path: Path) -> Iterator[Callable[[], Sessions]]:
    """Starts the sessions of a server on the same folder, the one before being stopped."""
    running: list[Sessions] = []

    def stop() -> None:
        while running:
            running.pop().close()

    def start() -> Sessions:
        stop()
        running.append(Sessions(lambda: (PRESET, "zha-fast"), open_store(tmp_path / "sessions")))
        return running[-1]

    yield start
    stop()


def set_xi(session: Session, xi: float) -> None:
    session.change(edits.with_value(session.scenario, XI, xi), None, name=f"xi {xi}")


def xi_of(session: Session) -> Any:
    return edits.value_at(session.scenario, XI)


def worked_on(sessions: Sessions) -> Session:
    session = sessions.get(ID)
    session.select(2, None)
    set_xi(session, 0.5)
    set_xi(session, 0.6)
    session.undo()
    session.show(None, scale="log", theme="dark")
    return session


@pytest.fixture
def after(
    started: Callable[[], Sessions], tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> Callable[[Callable[[Document], Any]], Session]:
    """Gives the session after its document was changed where it lies."""

    def restarted(spoil: Callable[[Document], Any]) -> Session:
        worked_on(started())
        started()
        with closing(Database(tmp_path / "sessions")) as database:
            document = json.loads(database.read(ID) or b"")
            spoil(document)
            database.write(ID, json.dumps(document).encode())
        caplog.clear()
        with caplog.at_level(logging.WARNING):
            session = started().get(ID)
        assert len(caplog.records) == 1
        return session

    return restarted


def test_a_session_comes_back_after_a_restart(started: Callable[[], Sessions]) -> None:
    before = worked_on(started())
    after = started().get(ID)
    assert after is not before and after.state == before.state
    assert (xi_of(after), after.origin, after.selected) == (0.5, "zha-fast", 2)
    assert after.display == before.display
    assert (after.history.undo_name, after.history.redo_name) == ("xi 0.5", "xi 0.6")
    assert after.redo() and xi_of(after) == 0.6
    assert after.reset(None) and after.scenario == PRESET


def test_a_session_only_looked_at_is_not_kept(started: Callable[[], Sessions]) -> None:
    started().get(ID)
    assert not started().knows(ID)


def test_a_session_that_had_to_make_room_comes_back(
    started: Callable[[], Sessions], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("schuler_bench.session.sessions.MOST_SESSIONS", 1)
    sessions = started()
    state = worked_on(sessions).state
    assert sessions._store.saving.flush()
    for number in range(3):
        sessions.get(f"another-{number}")
    assert ID not in sessions._by_id and sessions.get(ID).state == state


def test_uploads_come_back_and_the_scenario_runs_on_them(started: Callable[[], Sessions]) -> None:
    session = started().get(ID)
    upload = session.uploads.add("log.csv", LOG)
    kept, _ = recorded_scenario(session.scenario, session.uploads)
    session.change(kept, None, origin="uploaded")
    assert session.wait_idle(30.0) and session.run.scenario == kept
    after = started().get(ID)
    assert after.scenario == kept and list(after.uploads.files) == ["log.csv"]
    assert after.uploads.files["log.csv"].quantities == upload.quantities
    assert Path(edits.files_of(kept).pop()).read_bytes() == LOG


def change(key: str, value: Any) -> Callable[[Document], None]:
    return lambda document: document.update({key: value})


def put_in(place: str, key: str, value: Any) -> Callable[[Document], None]:
    """Change a value of every entry of a list."""

    def put(document: Document) -> None:
        for entry in document[place]:
            entry[key] = value

    return put


def name_a_file_of_the_server(document: Document) -> None:
    for scenario in document["scenarios"]:
        scenario["reference"] = {"kind": "file", "file": [__file__]}


@pytest.mark.parametrize(
    "spoil",
    [
        name_a_file_of_the_server,
        change("schema", 99),
        change("steps", []),
        change("steps", "text"),
        change("at", 1000),
        change("at", None),
        change("scenarios", []),
        change("scenarios", [{"run": {"duration_h": 1e300}}] * 9),
        change("scenarios", [{"method": "x"}] * 9),
        lambda document: document.pop("steps"),
        lambda document: document["steps"][document["at"]].update(selected="many"),
        change("schema", 2),
        change("schema", None),
        change("at", -1),
        change("at", float("inf")),
        change("at", float("nan")),
        change("at", True),
        put_in("steps", "scenario", -1),
        put_in("steps", "opened", 1e9),
        put_in("steps", "selected", float("inf")),
        put_in("scenarios", "from_the_future", {}),
        put_in("scenarios", "run", {"duration_h": float("nan")}),
        put_in("scenarios", "method", []),
    ],
)
def test_a_strange_document_is_a_fresh_session_and_stays_as_it_was(
    after: Callable[..., Session],
    caplog: pytest.LogCaptureFixture,
    started: Callable[[], Sessions],
    spoil: Any,
) -> None:
    strange: list[str] = []

    def spoilt(document: Document) -> None:
        spoil(document)
        strange.append(json.dumps(document))

    session = after(spoilt)
    assert "begins anew" in caplog.text
    assert (session.scenario, session.origin) == (PRESET, "zha-fast")
    assert (
        "could not be opened as it was kept" in session.keeping.unreadable
        and "begins anew" in session.keeping.unreadable
    )
    assert session.change(edits.with_value(session.scenario, XI, 0.4), None)
    again = started().get(ID)
    assert xi_of(again) == 0.4 and not again.keeping.unreadable
    for one in (session, again):
        (aside,) = one.keeping.aside
        assert aside.name == "session-1.json"
    assert aside.content() == strange[0].encode()
    started().get(ID)
    assert len(started().get(ID).keeping.aside) == 1


@pytest.mark.parametrize("content", [b"", b"{", b"\xff", b"[" * 100_000, b"null", b'{"id": "of another"}'])
def test_what_is_no_document_stays_as_it_was(
    started: Callable[[], Sessions], tmp_path: Path, content: bytes
) -> None:
    started()
    running = started()
    running._store.database.write(ID, content)
    session = running.get(ID)
    assert session.scenario == PRESET and "it is damaged" in session.keeping.unreadable
    set_xi(session, 0.4)
    again = started().get(ID)
    assert xi_of(again) == 0.4 and [one.content() for one in again.keeping.aside] == [content]


def test_who_lost_a_session_with_a_damaged_page_is_told(
    started: Callable[[], Sessions], tmp_path: Path
) -> None:
    running = started()
    worked_on(running)
    started()
    file = next(tmp_path.rglob("sessions.sqlite"))
    pages = bytearray(file.read_bytes())
    for at in range(4096, len(pages), 4096):  # all but the head and the index
        if b'"schema"' in pages[at : at + 4096]:
            pages[at : at + 4096] = bytes(4096)
    file.write_bytes(pages)
    session = started().get(ID)
    assert "is lost: the database of the server was damaged" in session.keeping.unreadable
    assert not session.keeping.aside and session.scenario == PRESET
    assert not started().get(SessionIds().new()).keeping.unreadable


def test_what_began_without_a_store_is_kept_once_there_is_one(
    started: Callable[[], Sessions], tmp_path: Path
) -> None:
    sessions = Sessions(lambda: (PRESET, "zha-fast"))
    session = worked_on(sessions)
    session.uploads.add("log.csv", LOG)
    link = session.share()
    sessions.get("looked-at-alone-000000000")
    store = open_store(tmp_path / "sessions")
    assert store is not None
    sessions.keep_in(store)
    session.uploads.add("later.csv", LOG)
    set_xi(session, 0.7)
    second = session.share()
    sessions.close()
    again = started()
    found = again.get(ID)
    assert xi_of(found) == 0.7 and {*found.uploads.files} == {"log.csv", "later.csv"}
    assert not found.keeping.aside and not again.knows("looked-at-alone-000000000")
    for id, xi, names in ((link, 0.5, {"log.csv"}), (second, 0.7, {"log.csv", "later.csv"})):
        copy = again.get(SessionIds().new_copy(id))
        assert (xi_of(copy), {*copy.uploads.files}) == (xi, names)
        assert not copy.keeping.unreadable


def test_what_was_kept_before_is_not_written_over_by_who_could_not_read_it(
    started: Callable[[], Sessions], tmp_path: Path
) -> None:
    worked_on(started())
    started().close()
    sessions = Sessions(lambda: (PRESET, "zha-fast"))
    untouched = sessions.get(ID)
    store = open_store(tmp_path / "sessions")
    assert store is not None
    sessions.keep_in(store)
    assert sessions.get(ID) is not untouched and xi_of(sessions.get(ID)) == 0.5
    sessions.close()
    sessions = Sessions(lambda: (PRESET, "zha-fast"))
    set_xi(sessions.get(ID), 0.9)
    store = open_store(tmp_path / "sessions")
    assert store is not None
    sessions.keep_in(store)
    assert "kept earlier" in sessions.get(ID).keeping.unreadable
    (aside,) = sessions.get(ID).keeping.aside
    assert b"0.6" in (aside.content() or b"")
    sessions.close()
    assert xi_of(started().get(ID)) == 0.9


def test_what_cannot_be_read_at_present_is_not_written_over(
    started: Callable[[], Sessions], monkeypatch: pytest.MonkeyPatch
) -> None:
    worked_on(started())
    sessions = started()

    def fail(_: str) -> None:
        raise OSError(5, "Input/output error")

    with monkeypatch.context() as patched:
        patched.setattr(sessions._store, "read", fail)
        session = sessions.get(ID)
        assert session.keeping.fault is not None
        assert "cannot be read at present" in session.keeping.fault.reason
        set_xi(session, 0.9)
    assert xi_of(sessions.get(ID)) == 0.5
    assert xi_of(started().get(ID)) == 0.5


def test_a_full_disk_keeps_nobody_from_reading(started: Callable[[], Sessions]) -> None:
    worked_on(started())
    sessions = started()
    execute = sessions._store.database._connection.execute
    execute("PRAGMA query_only = ON")
    assert xi_of(sessions.get(ID)) == 0.5


def test_a_session_that_could_not_be_written_yet_is_opened_as_it_is(
    started: Callable[[], Sessions], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("schuler_bench.session.sessions.MOST_SESSIONS", 0)
    sessions = started()
    execute = sessions._store.database._connection.execute
    execute("PRAGMA query_only = ON")
    set_xi(sessions.get(ID), 0.7)
    assert sessions._store.saving.flush()
    sessions.get("another")
    sessions.forget_idle()
    assert ID not in sessions._by_id and xi_of(sessions.get(ID)) == 0.7
    execute("PRAGMA query_only = OFF")


def test_a_link_that_cannot_be_read_stays_and_says_so(started: Callable[[], Sessions]) -> None:
    sessions = started()
    shared = worked_on(sessions).share()
    database = sessions._store.database
    document = json.loads(database.read(shared)) | {"schema": 7}
    database.write(shared, strange := json.dumps(document).encode())
    for _ in range(2):
        copy = started().get(SessionIds().new_copy(shared))
        assert copy.scenario == PRESET and "another version of this program" in copy.keeping.unreadable
        set_xi(copy, 0.4)
        assert [one.content() for one in copy.keeping.aside] == [strange]
    assert started()._store.database.read(shared) == strange


@pytest.mark.parametrize(
    ("spoil", "lost"),
    [
        (change("display", {"scale": "cubic"}), "display"),
        (change("display", {"colour": "red"}), "display"),
        (change("pins", [{"name": "x"}]), "pins"),
        (change("pins", [float("nan")]), "pins"),
        (change("display", {"theme": float("inf")}), "display"),
        (change("study", 7), "study"),
        (change("of_tomorrow", {"a": 1}), "what this version does not know"),
        (put_in("steps", "of_tomorrow", 1), "what this version does not know"),
        (lambda document: document["steps"][0].update(scenario=77), "history"),
    ],
)
def test_what_cannot_be_read_beside_the_scenario_is_left_out(
    after: Callable[..., Session], spoil: Any, lost: str
) -> None:
    session = after(spoil)
    assert lost in session.keeping.unreadable and len(session.keeping.aside) == 1
    assert xi_of(session) == 0.5
    assert session.display.scale == ("linear" if lost == "display" else "log")
    assert session.history.undo_name == (None if lost == "history" else "xi 0.5")


@pytest.mark.parametrize("stored", [True, False])
def test_a_shared_state_is_a_frozen_copy(started: Callable[[], Sessions], stored: bool) -> None:
    sessions = started() if stored else Sessions(lambda: (PRESET, "zha-fast"))
    session = worked_on(sessions)
    session.uploads.add("log.csv", LOG)
    shared, frozen = session.share(), session.scenario
    assert is_shared(shared)
    set_xi(session, 0.9)
    session.uploads.clear()
    if stored:
        sessions = started()
    for _ in range(2):
        copy = sessions.get(SessionIds().new_copy(shared))
        assert (copy.scenario, copy.origin, copy.selected) == (frozen, "zha-fast", 2)
        assert (copy.display.scale, copy.history.undo_name, copy.history.redo_name) == ("log", None, None)
        assert copy.uploads.files["log.csv"].path.read_bytes() == LOG
        set_xi(copy, 0.8)
        copy.uploads.clear()
    assert xi_of(sessions.get(ID)) == 0.9
    sessions.close()


def test_a_copy_of_a_state_that_is_gone_is_a_fresh_session(started: Callable[[], Sessions]) -> None:
    assert started().get(SessionIds().new_copy("share-" + "x" * 24)).scenario == PRESET

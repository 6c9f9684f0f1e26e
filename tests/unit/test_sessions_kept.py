"""Sessions over a restart and as shared copies: what comes back, and what a strange file can do."""

from __future__ import annotations

import json
import logging
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from app.editing import edits
from app.http.ids import SessionIds, is_shared
from app.session.database import Database
from app.session.session import Session
from app.session.sessions import Sessions
from app.session.store import open_store
from app.session.uploads import recorded_scenario
from navcore.scenario.file import load

ID = "visitor-of-the-tests-000"
XI = ("method", 2, "network", "xi")
LOG = b"t_s,speed_mps,heading_deg\n" + b"".join(b"%d,5.0,90.0\n" % t for t in range(120))


@pytest.fixture
def started(tmp_path: Path) -> Iterator[Callable[[], Sessions]]:
    """Starts the sessions of a server on the same folder, the one before being stopped."""
    running: list[Sessions] = []

    def start() -> Sessions:
        while running:
            running.pop().close()
        store = open_store(tmp_path / "sessions")
        running.append(Sessions(lambda: (load("zha-fast"), "zha-fast"), store))
        return running[-1]

    yield start
    while running:
        running.pop().close()


def rewritten(tmp_path: Path, spoil: Callable[[dict[str, Any]], Any] | None = None) -> dict[str, Any] | None:
    """Document of the session as it lies in the database, after it was changed there."""
    database = Database(tmp_path / "sessions")
    content = database.read(ID)
    document = None if content is None else json.loads(content)
    if document is not None and spoil is not None:
        spoil(document)
        database.write(ID, json.dumps(document).encode())
    database.close()
    return document


def xi_of(session: Session) -> Any:
    return edits.value_at(session.scenario, XI)


def worked_on(sessions: Sessions) -> Session:
    session = sessions.get(ID)
    session.select(2, None)
    for xi in (0.5, 0.6):
        session.change(edits.with_value(session.scenario, XI, xi), None, name=f"xi {xi}")
    session.undo()
    session.show(None, scale="log", theme="dark")
    return session


def test_a_session_comes_back_after_a_restart(started: Callable[[], Sessions]) -> None:
    before = worked_on(started())
    after = started().get(ID)
    assert after is not before
    assert after.state == before.state
    assert xi_of(after) == 0.5
    assert (after.origin, after.selected, after.display) == ("zha-fast", 2, before.display)
    assert (after.history.undo_name, after.history.redo_name) == ("xi 0.5", "xi 0.6")
    assert after.redo() and xi_of(after) == 0.6
    assert after.reset(None) and after.scenario == load("zha-fast")


def test_a_session_only_looked_at_is_not_kept(started: Callable[[], Sessions], tmp_path: Path) -> None:
    started().get(ID)
    started()
    assert rewritten(tmp_path) is None


def test_a_session_that_had_to_make_room_comes_back(
    started: Callable[[], Sessions], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("app.session.sessions.MOST_SESSIONS", 1)
    sessions = started()
    state = worked_on(sessions).state
    assert sessions._store.flush()
    for number in range(3):
        sessions.get(f"another-{number}")
    assert ID not in sessions._by_id
    assert sessions.get(ID).state == state


def test_uploads_come_back_and_the_scenario_runs_on_them(started: Callable[[], Sessions]) -> None:
    session = started().get(ID)
    upload = session.uploads.add("log.csv", LOG)
    kept, _ = recorded_scenario(session.scenario, session.uploads)
    session.change(kept, None, origin="uploaded")
    assert session.wait_idle(30.0)
    assert session.run.scenario == kept
    after = started().get(ID)
    assert list(after.uploads.files) == ["log.csv"]
    assert after.uploads.files["log.csv"].quantities == upload.quantities
    assert after.scenario == kept
    assert Path(edits.files_of(after.scenario).pop()).read_bytes() == LOG


def test_a_scenario_in_a_file_cannot_name_a_file_of_the_server(
    started: Callable[[], Sessions], tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    secret = tmp_path / "secret.csv"
    secret.write_bytes(LOG)
    worked_on(started())
    started()

    def spoil(document: dict[str, Any]) -> None:
        for scenario in document["scenarios"]:
            scenario["reference"] = {"kind": "file", "file": [str(secret)]}

    rewritten(tmp_path, spoil)
    with caplog.at_level(logging.WARNING):
        after = started().get(ID)
    assert after.scenario == load("zha-fast")
    assert "begins anew" in caplog.text


def change(key: str, value: Any) -> Callable[[dict[str, Any]], None]:
    return lambda document: document.update({key: value})


@pytest.mark.parametrize(
    "spoil",
    [
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
    ],
)
def test_a_strange_document_is_a_fresh_session_and_one_log_line(
    started: Callable[[], Sessions], tmp_path: Path, caplog: pytest.LogCaptureFixture, spoil: Any
) -> None:
    worked_on(started())
    started()
    rewritten(tmp_path, spoil)
    caplog.clear()
    after = started().get(ID)
    assert (after.scenario, after.origin) == (load("zha-fast"), "zha-fast")
    assert len(caplog.records) == 1
    assert after.change(edits.with_value(after.scenario, XI, 0.4), None)


@pytest.mark.parametrize(
    ("spoil", "lost"),
    [
        (change("display", {"scale": "cubic"}), "display"),
        (change("display", {"colour": "red"}), "display"),
        (change("pins", [{"name": "x"}]), "pins"),
        (lambda document: document["steps"][0].update(scenario=77), "history"),
    ],
)
def test_what_cannot_be_read_beside_the_scenario_is_left_out(
    started: Callable[[], Sessions], tmp_path: Path, caplog: pytest.LogCaptureFixture, spoil: Any, lost: str
) -> None:
    before = worked_on(started())
    started()
    rewritten(tmp_path, spoil)
    caplog.clear()
    after = started().get(ID)
    assert after.scenario == before.scenario
    assert len(caplog.records) == 1
    assert (after.display == before.display) == (lost != "display")
    assert (after.history.undo_name is None) == (lost == "history")


# ------------------------------------------------------------ shared


@pytest.mark.parametrize("stored", [True, False])
def test_a_shared_state_is_a_frozen_copy(started: Callable[[], Sessions], stored: bool) -> None:
    sessions = started() if stored else Sessions(lambda: (load("zha-fast"), "zha-fast"))
    session = worked_on(sessions)
    session.uploads.add("log.csv", LOG)
    shared, frozen = session.share(), session.scenario
    assert is_shared(shared)
    session.change(edits.with_value(session.scenario, XI, 0.9), None)
    session.uploads.clear()
    if stored:
        sessions = started()
    first = sessions.get(SessionIds().new_copy(shared))
    assert (first.scenario, first.origin, first.selected) == (frozen, "zha-fast", 2)
    assert first.display.scale == "log"
    assert first.uploads.files["log.csv"].path.read_bytes() == LOG
    assert (first.history.undo_name, first.history.redo_name) == (None, None)
    first.change(edits.with_value(first.scenario, XI, 0.8), None)
    first.uploads.clear()
    second = sessions.get(SessionIds().new_copy(shared))
    assert second.scenario == frozen
    assert list(second.uploads.files) == ["log.csv"]
    assert xi_of(sessions.get(ID)) == 0.9
    if not stored:
        sessions.close()


def test_a_copy_of_a_state_that_is_gone_is_a_fresh_session(started: Callable[[], Sessions]) -> None:
    sessions = started()
    assert sessions.get(SessionIds().new_copy("share-" + "x" * 24)).scenario == load("zha-fast")

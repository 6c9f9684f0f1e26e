"""Files of sessions: written soon and whole, ours alone, read with distrust, removed when old."""

from __future__ import annotations

import json
import logging
import os
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from app.session import store as store_module
from app.session.store import Store, default_folder, open_store

ID = "a" * 24


@pytest.fixture
def store(tmp_path: Path) -> Iterator[Store]:
    made = open_store(tmp_path / "state" / "sessions")
    assert made is not None
    yield made
    made.close()


def document(id: str = ID, **more: object) -> dict[str, object]:
    return {"id": id, **more}


def mode(path: Path) -> int:
    return path.stat().st_mode & 0o777


def test_a_document_comes_back_and_only_the_owner_can_read_it(store: Store) -> None:
    store.write(ID, document(text="ä"))
    assert store.read(ID) == document(text="ä")
    assert store.read("b" * 24) is None
    assert (mode(store.folder), mode(store.folder / f"{ID}.json")) == (0o700, 0o600)
    assert [path.name for path in store.folder.iterdir()] == [f"{ID}.json"]


def test_changes_that_follow_each_other_are_written_once_by_another_thread(
    store: Store, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(store_module, "WRITE_AFTER_S", 0.05)
    held, made = {"count": 0}, []

    def make() -> dict[str, object]:
        made.append(threading.current_thread().name)
        return document(**held)

    for _ in range(20):
        held["count"] += 1
        store.soon(ID, make)
    assert store.flush()
    assert made == ["store"]
    assert store.read(ID) == document(count=20)


def test_closing_writes_what_waits(store: Store, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(store_module, "WRITE_AFTER_S", 60.0)
    store.soon(ID, document)
    store.close()
    assert store.read(ID) == document()
    store.soon("b" * 24, lambda: document("b" * 24))
    assert store.read("b" * 24) is None


@pytest.mark.parametrize(
    "content",
    [b"", b"{", b"[]", b"null", b"\xff\xfe", b'{"id": "another"}', b"[" * 100_000, b"{}"],
)
def test_a_broken_or_foreign_file_is_none_with_one_log_line(
    store: Store, content: bytes, caplog: pytest.LogCaptureFixture
) -> None:
    (store.folder / f"{ID}.json").write_bytes(content)
    assert store.read(ID) is None
    assert len(caplog.records) == 1
    assert len(caplog.records[0].getMessage()) < 400


def test_a_huge_file_is_not_read(store: Store, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(store_module, "LARGEST_FILE", 10)
    (store.folder / f"{ID}.json").write_text(json.dumps(document()))
    assert store.read(ID) is None


@pytest.mark.parametrize("id", ["", "..", "a/b", "../x", "x" * 65, "a.b"])
def test_an_id_is_no_path(store: Store, id: str) -> None:
    with pytest.raises(ValueError, match="no id"):
        store.read(id)
    with pytest.raises(ValueError, match="no id"):
        store.write(id, document(id))


def test_a_failed_write_leaves_the_old_document_and_no_litter(
    store: Store, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    store.write(ID, document(count=1))

    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    for count in (2, 3):
        store.soon(ID, lambda count=count: document(count=count))
        assert store.flush()
    assert store.read(ID) == document(count=1)
    assert [path.name for path in store.folder.iterdir()] == [f"{ID}.json"]
    assert [record.getMessage() for record in caplog.records] == [
        "sessions cannot be kept at present: No space left on device"
    ]
    monkeypatch.undo()
    store.soon(ID, lambda: document(count=4))
    assert store.flush()
    assert store.read(ID) == document(count=4)


def test_a_read_only_folder_is_no_store(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    def refused(*_: object, **__: object) -> None:
        raise OSError(30, "Read-only file system")

    monkeypatch.setattr(store_module.tempfile, "TemporaryFile", refused)
    assert open_store(tmp_path / "sessions") is None
    assert ["Read-only" in record.getMessage() for record in caplog.records] == [True]


def test_a_place_that_is_no_folder_is_no_store(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    (tmp_path / "file").write_text("")
    with caplog.at_level(logging.WARNING):
        assert open_store(tmp_path / "file" / "sessions") is None
    assert "not kept over a restart" in caplog.text
    assert len(caplog.records) == 1


def test_old_files_and_too_many_are_removed_with_what_was_uploaded(
    store: Store, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(store_module, "MOST_KEPT", 3)
    now = time.time()

    def put(name: str, age_s: float) -> None:
        (store.folder / f"{name}.json").write_text("{}")
        files = store.files_folder(name)
        files.mkdir()
        (files / "log.txt").write_text("x")
        for path in (store.folder / f"{name}.json", files):
            os.utime(path, (now - age_s, now - age_s))

    put("fresh", 10.0)
    put("share-x", 2.0 * store_module.OLDEST_S)
    put("ancient", 2.0 * store_module.OLDEST_S)
    store.remove_old()
    left = sorted(path.name for path in store.folder.iterdir())
    assert left == ["fresh.files", "fresh.json", "share-x.files", "share-x.json"]
    for number in range(4):
        put(f"more{number}", 20.0 + number)
    orphan = store.files_folder("orphan")
    orphan.mkdir()
    os.utime(orphan, (now - 2e5, now - 2e5))
    store.remove_old()
    left = sorted(path.name for path in store.folder.iterdir() if path.suffix == ".json")
    assert left == ["fresh.json", "more0.json", "more1.json"]
    assert not orphan.exists()


def test_the_place_is_the_one_the_user_names(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
    assert default_folder() == tmp_path / "schuler-bench" / "sessions"
    monkeypatch.setenv("XDG_STATE_HOME", "relative")
    monkeypatch.setattr(Path, "home", lambda: tmp_path / "home")
    monkeypatch.setattr("sys.platform", "linux")
    assert default_folder() == tmp_path / "home" / ".local" / "state" / "schuler-bench" / "sessions"
    monkeypatch.setattr("sys.platform", "darwin")
    assert (tmp_path / "home" / "Library") in default_folder().parents

"""Files of sessions: written soon and whole, ours alone, read with distrust, removed when old."""

from __future__ import annotations

import logging
import os
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from app.session import content as content_module
from app.session import store as store_module
from app.session.store import Store, default_folder, open_store, session_key

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
    assert store.read("b" * 24) is None and store.has(ID) and not store.has("b" * 24)
    assert mode(store.folder) == 0o700
    assert {mode(path) for path in store.folder.iterdir()} == {0o600}


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
    store.soon("b" * 24, lambda: document("b" * 24))
    again = open_store(store.folder)
    assert again is not None
    assert again.read(ID) == document() and again.read("b" * 24) is None
    again.close()


@pytest.mark.parametrize(
    "content",
    [b"", b"{", b"[]", b"null", b"\xff\xfe", b'{"id": "another"}', b"[" * 100_000, b"{}"],
)
def test_a_broken_or_foreign_document_is_none_with_one_log_line(
    store: Store, content: bytes, caplog: pytest.LogCaptureFixture
) -> None:
    store.database.write(ID, content)
    assert store.read(ID) is None
    assert len(caplog.records) == 1
    assert len(caplog.records[0].getMessage()) < 400 and ID not in caplog.text


def test_a_huge_document_is_not_written(store: Store, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(store_module, "LARGEST_DOCUMENT", 100)
    store.write(ID, document())
    with pytest.raises(OSError, match="takes more than"):
        store.write(ID, document(text="x" * 1000))
    assert store.read(ID) == document()


@pytest.mark.parametrize("id", ["", "..", "a/b", "../x", "x" * 65, "a.b"])
def test_an_id_is_no_path(store: Store, id: str) -> None:
    with pytest.raises(ValueError, match="no id"):
        store.read(id)
    with pytest.raises(ValueError, match="no id"):
        store.write(id, document(id))


def test_a_full_disk_leaves_the_old_document_and_is_told(
    store: Store, caplog: pytest.LogCaptureFixture
) -> None:
    store.write(ID, document(count=1))
    pages = store.database._connection.execute("PRAGMA page_count").fetchone()[0]
    store.database._connection.execute(f"PRAGMA max_page_count = {pages}")
    told: list[str] = []
    for count in (2, 3):
        store.soon(ID, lambda count=count: document(count=count, text="x" * 100_000), told.append)
        assert store.flush()
    assert store.read(ID) == document(count=1)
    assert told == ["database or disk is full"] * 2
    assert [record.getMessage() for record in caplog.records] == [
        "sessions cannot be kept at present: database or disk is full"
    ]
    store.database._connection.execute("PRAGMA max_page_count = 1000000")
    store.soon(ID, lambda: document(count=4), told.append)
    assert store.flush()
    assert store.read(ID) == document(count=4) and len(told) == 2


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


def put(store: Store, name: str, age_s: float, shared_by: str | None = None) -> None:
    store.write(name, document(name), shared_by)
    files = store.files_folder(name)
    files.mkdir()
    (files / "log.txt").write_text(name)
    store.contents.keep_once(files / "log.txt")
    with store.database._changing() as connection:
        connection.execute("UPDATE document SET used_s = used_s - ? WHERE id = ?", (age_s, name))


def test_old_sessions_and_too_many_are_removed_with_their_files_but_no_link(
    store: Store, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(store_module, "MOST_KEPT", 3)
    monkeypatch.setattr(content_module, "_UNLINKED_S", -1.0)
    put(store, "fresh", 10.0)
    put(store, "share-x", 2.0 * store_module.OLDEST_S, shared_by="fresh")
    put(store, "ancient", 2.0 * store_module.OLDEST_S)
    store.remove_old()
    assert [store.has(name) for name in ("fresh", "share-x", "ancient")] == [True, True, False]
    assert not store.files_folder("ancient").exists() and store.files_folder("share-x").is_dir()
    assert len(list(store.contents.folder.iterdir())) == 2
    for number in range(4):
        put(store, f"more{number}", 20.0 + number)
    for number in range(9):
        put(store, f"share-{number}", 50.0, shared_by="fresh")
    orphan = store.files_folder("orphan")
    orphan.mkdir()
    os.utime(orphan, (time.time() - 2e5,) * 2)
    store.remove_old()
    left = {name for name in ("fresh", "more0", "more1", "more2", "more3") if store.has(name)}
    assert left == {"fresh", "more0", "more1"}
    assert store.has("share-x") and all(store.has(f"share-{number}") for number in range(9))
    assert not orphan.exists()


def test_shared_files_take_room_once(store: Store, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = store.files_folder(ID)
    folder.mkdir()
    (folder / "log.csv").write_bytes(b"x" * 1_000_000)
    store.contents.keep_once(folder / "log.csv")
    for number in range(40):
        store.share(ID, f"share-{number}", document(f"share-{number}"))
    other = store.files_folder("another")
    other.mkdir()
    (other / "same.csv").write_bytes(b"x" * 1_000_000)
    store.contents.keep_once(other / "same.csv")
    inodes = {path.stat().st_ino for path in store.folder.rglob("*.csv")}
    assert len(list(store.folder.rglob("*.csv"))) == 42 and len(inodes) == 1
    assert store.contents.bytes() == 1_000_000
    (folder / "log.csv").unlink()
    assert (store.files_folder("share-7") / "log.csv").read_bytes() == b"x" * 1_000_000
    monkeypatch.setattr(store_module, "LARGEST_UPLOADS", 1_500_000)
    assert store.has_room(400_000) and not store.has_room(600_000)


def test_only_unused_contents_of_ours_are_removed_and_no_linked_folder_is_entered(
    store: Store, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(content_module, "_UNLINKED_S", -1.0)
    put(store, "used", 0.0)
    own = store.contents.folder
    (used,) = own.iterdir()
    (own / ("0" * 64)).write_text("unused")
    (own / "notes.txt").write_text("not ours")
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    (elsewhere / ("1" * 64)).write_text("somebody's")
    (own / ("2" * 64)).symlink_to(elsewhere / ("1" * 64))
    store.contents.remove_unused()
    assert {path.name for path in own.iterdir()} == {used.name, "notes.txt", "2" * 64}
    own.rename(tmp_path / "moved")
    own.symlink_to(elsewhere)
    with pytest.raises(OSError):
        store.contents.remove_unused()
    assert [path.name for path in elsewhere.iterdir()] == ["1" * 64]


def test_one_session_makes_a_bounded_number_of_links(store: Store, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(store_module, "MOST_LINKS", 3)
    for number in range(3):
        store.share(ID, f"share-{number}", document(f"share-{number}"))
    with pytest.raises(OSError, match="at most 3 links"):
        store.share(ID, "share-3", document("share-3"))
    store.share("b" * 24, "share-4", document("share-4"))
    assert all(store.has(f"share-{number}") for number in (0, 1, 2, 4))


def test_two_servers_on_one_folder_the_second_is_told_in_one_line(
    store: Store, caplog: pytest.LogCaptureFixture
) -> None:
    assert open_store(store.folder) is None
    assert len(caplog.records) == 1
    assert "another server keeps its sessions there" in caplog.text
    store.close()
    second = open_store(store.folder)
    assert second is not None
    second.close()


@pytest.mark.parametrize("name", ["sessions.sqlite", "lock", "session.key"])
def test_a_fifo_in_the_folder_hangs_nothing(tmp_path: Path, name: str) -> None:
    folder = tmp_path / "sessions"
    folder.mkdir()
    os.mkfifo(folder / name)
    done: list[bool] = []

    def use() -> None:
        assert len(session_key(folder)) == 32
        made = open_store(folder)
        if made is not None:
            assert made.read(ID) is None
            made.close()
        done.append(True)

    thread = threading.Thread(target=use, daemon=True)
    thread.start()
    thread.join(10.0)
    assert done == [True]


def test_a_broken_database_is_put_aside(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    folder = tmp_path / "sessions"
    folder.mkdir()
    (folder / "sessions.sqlite").write_bytes(b"no database" * 1000)
    made = open_store(folder)
    assert made is not None
    made.write(ID, document())
    assert made.read(ID) == document()
    made.close()
    assert len(list(folder.glob("sessions.broken-*"))) == 1 and "put aside" in caplog.text


def test_a_key_is_kept_and_is_ours_alone(tmp_path: Path) -> None:
    first = session_key(tmp_path / "sessions")
    assert session_key(tmp_path / "sessions") == first
    assert mode(tmp_path / "sessions" / "session.key") == 0o600
    assert session_key(None) != session_key(None)


def test_the_place_is_the_one_the_user_names(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
    assert default_folder() == tmp_path / "schuler-bench" / "sessions"
    monkeypatch.setenv("XDG_STATE_HOME", "relative")
    monkeypatch.setattr(Path, "home", lambda: tmp_path / "home")
    monkeypatch.setattr("sys.platform", "linux")
    assert default_folder() == tmp_path / "home" / ".local" / "state" / "schuler-bench" / "sessions"
    monkeypatch.setattr("sys.platform", "darwin")
    assert (tmp_path / "home" / "Library") in default_folder().parents

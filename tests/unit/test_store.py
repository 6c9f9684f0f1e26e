"""Files of sessions: written soon and whole, ours alone, read with distrust, removed when old."""

import logging
import os
import threading
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

import pytest

from schuler_bench.session import content, saving
from schuler_bench.session import store as store_module
from schuler_bench.session.keeping import Keeping
from schuler_bench.session.store import Store, UnreadableError, default_folder, open_store, session_key
from tests.waiting import until

ID, OTHER = "a" * 24, "b" * 24


def opened(folder: Path) -> Store:
    store = open_store(folder)
    assert store is not None
    return store


@pytest.fixture
def store(tmp_path: Path) -> Iterator[Store]:
    with closing(opened(tmp_path / "state" / "sessions")) as store:
        yield store


def document(id: str = ID, **more: object) -> dict[str, object]:
    return {"id": id, **more}


def mode(path: Path) -> int:
    return path.stat().st_mode & 0o777


def upload(store: Store, id: str, name: str, content: bytes) -> Path:
    """Put a file into a session's folder as an upload."""
    file = store.files_folder(id) / name
    file.parent.mkdir()
    file.write_bytes(content)
    store.contents.keep_once(file)
    return file


def serve_for(store: Store, seconds: float) -> None:
    """Let the server have served so long."""
    store.database._counter._counted_s -= seconds
    store.database._do(lambda one: one.execute("UPDATE served SET counted_s = -1e18"))


def test_a_document_comes_back_and_only_the_owner_can_read_it(store: Store) -> None:
    store.write(ID, document(text="ä"))
    assert store.read(ID) == document(text="ä")
    assert (store.read(OTHER), store.has(ID), store.has(OTHER)) == (None, True, False)
    assert mode(store.folder) == 0o700
    assert {mode(path) for path in store.folder.iterdir()} == {0o600}


def test_changes_that_follow_each_other_are_written_once_by_another_thread(
    store: Store, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(saving, "WRITE_AFTER_S", 0.05)
    writers, counts = list[str](), [0]

    def make() -> dict[str, object]:
        writers.append(threading.current_thread().name)
        return document(count=counts[-1])

    for number in range(20):
        counts.append(number)
        store.saving.soon(ID, make)
    assert store.saving.flush() and writers == ["store"]
    assert store.read(ID) == document(count=19)


def test_closing_writes_what_waits(store: Store, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(saving, "WRITE_AFTER_S", 60.0)
    store.saving.soon(ID, document)
    store.close()
    store.saving.soon(OTHER, lambda: document(OTHER))
    with closing(opened(store.folder)) as again:
        assert (again.read(ID), again.read(OTHER)) == (document(), None)


@pytest.mark.parametrize(
    "content",
    [b"", b"{", b"[]", b"null", b"\xff\xfe", b'{"id": "another"}', b"[" * 100_000, b"{}"],
)
def test_a_broken_or_foreign_document_is_told_in_one_line_and_stays(store: Store, content: bytes) -> None:
    store.database.write(ID, content)
    with pytest.raises(UnreadableError) as caught:
        store.read(ID)
    assert len(str(caught.value)) < 400 and ID not in str(caught.value)
    assert store.database.read(ID) == content


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
    tmp_path: Path, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(saving, "AGAIN_AFTER_S", 0.2)
    keeping = Keeping()
    said: list[str] = []
    keeping.watch(lambda fault: said.append("" if fault is None else f"{fault.reason}. {fault.remedy}"))
    store = open_store(tmp_path / "sessions", keeping)
    assert store is not None
    with closing(store):
        store.write(ID, document(count=1))
        pragma = store.database._connection.execute
        pragma(f"PRAGMA max_page_count = {pragma('PRAGMA page_count').fetchone()[0]}")
        for count in (2, 3):
            store.saving.soon(ID, lambda: document(count=count, text="x" * 100_000))  # noqa: B023
            assert store.saving.flush()
        assert store.database.read(ID) == b'{"id":"%s","count":1}' % ID.encode()
        reason = (
            "the state folder: database or disk is full. "
            "Make room on the disk. Saving is tried again by itself."
        )
        assert said == [reason]
        assert caplog.messages == [f"sessions are not kept: {reason}"]
        pragma("PRAGMA max_page_count = 1000000")
        until(lambda: keeping.fault is None)  # without another change
        assert said == [reason, ""]
        assert store.read(ID) == document(count=3, text="x" * 100_000)


def test_a_folder_that_cannot_be_written_or_made_is_no_store(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    (tmp_path / "file").write_text("")
    keeping = Keeping()
    with caplog.at_level(logging.WARNING):
        assert open_store(tmp_path / "file" / "sessions", keeping) is None
    assert keeping.fault is not None and "File exists" in keeping.fault.reason
    keeping = Keeping()

    def refused(*_: object, **__: object) -> None:
        raise OSError(30, "Read-only file system")

    monkeypatch.setattr(store_module.tempfile, "TemporaryFile", refused)
    assert open_store(tmp_path / "sessions", keeping) is None
    assert keeping.fault is not None and keeping.fault.reason == "the state folder: Read-only file system"
    assert keeping.fault.remedy.startswith("Make it writable, or set XDG_STATE_HOME to another folder")
    assert str(tmp_path) in caplog.text and str(tmp_path) not in keeping.fault.reason


def test_old_sessions_and_too_many_are_removed_with_their_files_but_no_link(
    store: Store, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(store_module, "MOST_KEPT", 3)
    monkeypatch.setattr(content, "UNLINKED_S", -1.0)

    def put(name: str, age_s: float, shared_by: str | None = None) -> None:
        store.write(name, document(name), shared_by)
        upload(store, name, "log.txt", name.encode())
        query = "UPDATE document SET used_served = used_served - ? WHERE id = ?"
        store.database._do(lambda one: one.execute(query, (age_s, name)))

    serve_for(store, 3.0 * store_module.OLDEST_S)
    put("fresh", 10.0)
    put("share-x", 2.0 * store_module.OLDEST_S, shared_by="fresh")
    put("ancient", 2.0 * store_module.OLDEST_S)
    store.remove_old()
    assert [store.has(name) for name in ("fresh", "share-x", "ancient")] == [True, True, False]
    assert not store.files_folder("ancient").exists() and store.files_folder("share-x").is_dir()
    assert len(list(store.contents.folder.iterdir())) == 2
    for number in range(4):
        put(f"more{number}", 20.0 + number)
    shares = [f"share-{number}" for number in range(9)]
    for name in shares:
        put(name, 50.0, shared_by="fresh")
    orphan = store.files_folder("orphan")
    orphan.mkdir()
    store.remove_old()
    assert orphan.is_dir()
    serve_for(store, 2e5)
    store.remove_old()
    sessions = ("fresh", "more0", "more1", "more2", "more3")
    assert [name for name in sessions if store.has(name)] == ["fresh", "more0", "more1"]
    assert all(map(store.has, ["share-x", *shares]))
    assert not orphan.exists()


def test_shared_files_take_room_once(store: Store, monkeypatch: pytest.MonkeyPatch) -> None:
    log = upload(store, ID, "log.csv", b"x" * 1_000_000)
    for number in range(40):
        store.share(ID, f"share-{number}", document(f"share-{number}"))
    upload(store, "another", "same.csv", b"x" * 1_000_000)
    copies = list(store.folder.rglob("*.csv"))
    assert len(copies) == 42 and len({path.stat().st_ino for path in copies}) == 1
    assert store.contents.bytes() == 1_000_000
    log.unlink()
    assert (store.files_folder("share-7") / "log.csv").read_bytes() == b"x" * 1_000_000
    monkeypatch.setattr(store_module, "LARGEST_UPLOADS", 1_500_000)
    assert store.has_room(400_000) and not store.has_room(600_000)


def test_only_unused_contents_of_ours_are_removed_and_no_linked_folder_is_entered(
    store: Store, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(content, "UNLINKED_S", -1.0)
    upload(store, "used", "log.txt", b"used")
    own, elsewhere = store.contents.folder, tmp_path / "elsewhere"
    (used,) = own.iterdir()
    (own / ("0" * 64)).write_text("unused")
    (own / "notes.txt").write_text("not ours")
    elsewhere.mkdir()
    (elsewhere / ("1" * 64)).write_text("somebody's")
    (own / ("2" * 64)).symlink_to(elsewhere / ("1" * 64))
    store.remove_old()
    assert {path.name for path in own.iterdir()} == {used.name, "notes.txt", "2" * 64}
    own.rename(tmp_path / "moved")
    own.symlink_to(elsewhere)
    with pytest.raises(OSError):
        store.remove_old()
    assert [path.name for path in elsewhere.iterdir()] == ["1" * 64]


def test_one_session_makes_a_bounded_number_of_links(store: Store, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(store_module, "MOST_LINKS", 3)
    for id, number in ((ID, 0), (ID, 1), (ID, 2), (OTHER, 4)):
        store.share(id, f"share-{number}", document(f"share-{number}"))
    with pytest.raises(OSError, match="at most 3 links"):
        store.share(ID, "share-3", document("share-3"))
    assert [store.has(f"share-{number}") for number in range(5)] == [True, True, True, False, True]


def test_two_servers_on_one_folder_the_second_is_told_in_one_line(
    store: Store, caplog: pytest.LogCaptureFixture
) -> None:
    keeping = Keeping()
    assert open_store(store.folder, keeping) is None
    (line,) = caplog.messages
    assert "another server uses the same state folder. End that server, or set XDG_STATE_HOME" in line
    assert keeping.fault is not None
    store.close()
    opened(store.folder).close()


@pytest.mark.parametrize("name", ["sessions.sqlite", "lock", "session.key"])
def test_a_fifo_in_the_folder_hangs_nothing(tmp_path: Path, name: str) -> None:
    folder = tmp_path / "sessions"
    folder.mkdir()
    os.mkfifo(folder / name)
    answers: list[object] = []

    def use() -> None:
        answers.append(len(session_key(folder)))
        if (store := open_store(folder)) is not None:
            with closing(store):
                answers.append(store.read(ID))

    thread = threading.Thread(target=use, daemon=True)
    thread.start()
    thread.join(10.0)
    assert not thread.is_alive() and answers in ([32], [32, None])


def test_a_broken_database_is_put_aside(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    (tmp_path / "sessions.sqlite").write_bytes(b"no database" * 1000)
    with closing(opened(tmp_path)) as store:
        store.write(ID, document())
        assert store.read(ID) == document()
    assert len(list(tmp_path.glob("sessions.broken-*"))) == 1 and "put aside" in caplog.text


def test_a_key_is_kept_and_is_ours_alone(tmp_path: Path) -> None:
    assert session_key(tmp_path / "sessions") == session_key(tmp_path / "sessions")
    assert mode(tmp_path / "sessions" / "session.key") == 0o600
    assert session_key(None) != session_key(None)


@pytest.mark.parametrize(
    ("chosen", "platform", "base"),
    [
        ("/state", "linux", "/state"),
        ("relative", "linux", "/me/.local/state"),
        ("", "darwin", "/me/Library/Application Support"),
    ],
)
def test_the_place_is_the_one_the_user_names(
    monkeypatch: pytest.MonkeyPatch, chosen: str, platform: str, base: str
) -> None:
    monkeypatch.setenv("XDG_STATE_HOME", chosen)
    monkeypatch.setattr(Path, "home", lambda: Path("/me"))
    monkeypatch.setattr("sys.platform", platform)
    assert default_folder() == Path(base, "schuler-bench", "sessions")


def test_without_a_home_folder_there_is_no_place(monkeypatch: pytest.MonkeyPatch) -> None:
    def none() -> Path:
        raise RuntimeError("Could not determine home directory.")

    monkeypatch.delenv("XDG_STATE_HOME")
    monkeypatch.setattr(Path, "home", none)
    assert default_folder() is None

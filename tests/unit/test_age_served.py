"""Age of what is kept: time that servers have served, whatever the clock of the machine says."""

import sqlite3
import time
from collections.abc import Callable, Iterator
from contextlib import closing
from pathlib import Path

import pytest

from schuler_bench.session import content, served
from schuler_bench.session.database import Database
from schuler_bench.session.store import Store, open_store

NAME = "sessions.sqlite"


@pytest.fixture
def store(tmp_path: Path) -> Iterator[Store]:
    store = open_store(tmp_path / "sessions")
    assert store is not None
    with closing(store):
        yield store


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Callable[[float], None]:
    """Sets the clock of the machine, as seconds from what it is."""
    real = time.time

    def set_to(offset_s: float) -> None:
        monkeypatch.setattr(time, "time", lambda: real() + offset_s)

    return set_to


@pytest.mark.parametrize("jumps", [(20 * 365.0, 0.0), (-20 * 365.0, 0.0), (0.0, 20 * 365.0, -20 * 365.0)])
@pytest.mark.parametrize("restarts", [True, False])
def test_nothing_is_cleaned_after_a_jump_of_the_clock(
    tmp_path: Path, clock: Callable[[float], None], jumps: tuple[float, ...], restarts: bool
) -> None:
    store = open_store(tmp_path / "sessions")
    assert store is not None
    clock(jumps[0] * 86_400.0)
    store.write("a", {"id": "a"})
    for folder, name in (("a", "log.csv"), ("of-nobody", "track.csv")):
        (file := store.files_folder(folder) / name).parent.mkdir()
        file.write_text(name)
        store.contents.keep_once(file)
    store.share("a", "share-1", {"id": "share-1"})
    (store.folder / "content" / ("0" * 64)).write_text("just uploaded")
    for days in jumps[1:]:
        clock(days * 86_400.0)
        if restarts:
            store.close()
            store = open_store(tmp_path / "sessions")
            assert store is not None
        store.upkeep()
    assert store.has("a") and store.has("share-1")
    files = {path.relative_to(store.folder).parts[0] for path in store.folder.rglob("*.csv")}
    assert files == {"a.files", "share-1.files", "of-nobody.files"}
    assert len(list((store.folder / "content").iterdir())) == 3
    store.close()


def test_a_file_of_the_version_before_is_taken_over_and_all_of_it_is_young(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    with closing(sqlite3.connect(tmp_path / NAME)) as old, old:
        old.executescript(
            "PRAGMA journal_mode = WAL; CREATE TABLE document (id TEXT PRIMARY KEY, shared_by TEXT,"
            " used_s REAL NOT NULL, content BLOB NOT NULL) WITHOUT ROWID;"
            "CREATE INDEX document_used ON document (used_s);"
            "CREATE INDEX document_shared ON document (shared_by); PRAGMA user_version = 1;"
        )
        old.executemany(
            "INSERT INTO document VALUES (?, ?, ?, ?)",
            [(f"s-{n}", "s-0" if n % 3 else None, 1.0 + n, b'{"id": "s-%d"}' % n) for n in range(12)],
        )
    (tmp_path / NAME).chmod(0o600)
    store = open_store(tmp_path)
    assert store is not None
    with closing(store):
        store.upkeep()
        assert all(store.read(f"s-{n}") == {"id": f"s-{n}"} for n in range(12))
    assert not caplog.messages and not list(tmp_path.glob("sessions.broken*"))


def test_two_workers_count_the_time_they_serve_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    now = [1000.0]
    monkeypatch.setattr(served.time, "monotonic", lambda: now[0])
    with closing(Database(tmp_path)) as database:
        counters = [served.Counter(), served.Counter()]
        for step in range(20):
            now[0] += 50.0
            seconds = database._do(counters[step % 2].count)
        assert seconds == pytest.approx(1000.0)  # pyright: ignore[reportPossiblyUnboundVariable]
        now[0] = 5.0  # after a new start of the machine
        later = served.Counter()
        now[0] = 15.0
        assert database._do(later.count) == pytest.approx(1010.0)


def test_what_is_not_used_for_sixty_days_served_goes(store: Store, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(content, "UNLINKED_S", 1e9)
    store.write("a", {"id": "a"})
    for days, there in ((59.0, True), (2.0, False)):
        query = "UPDATE served SET seconds = seconds + ?, again = again + ?"
        store.database._do(lambda one: one.execute(query, (days * 86_400.0,) * 2))  # noqa: B023
        store.remove_old()
        assert store.has("a") == there

"""A damaged file of sessions: put aside whole, what can be read in it taken over, saving goes on."""

import json
import logging
import random
import shutil
import sqlite3
import subprocess
import sys
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

import pytest

from schuler_bench.bench.process import environment
from schuler_bench.session.database import Database
from schuler_bench.session.keeping import HELD, Keeping
from schuler_bench.session.store import Store, open_store
from tests.waiting import until

NAME, LOG, NEW = "sessions.sqlite", "sessions.sqlite-wal", "begun-after-the-damage-0"
PAGE, FRAME = 4096, 4096 + 24
MARGIN = 64
"""Bytes before a document in which the row's head, its id and its type stand."""
Documents = dict[str, bytes]


def text(number: int) -> bytes:
    """A document of which every piece says whose it is."""
    pieces = (20, 80, 300, 900)[number % 4]
    words = "".join(f"<{number:03d}.{piece:03d}>" for piece in range(pieces))
    return json.dumps({"id": id_of(number), "words": words}).encode()


def id_of(number: int) -> str:
    return f"visitor-number-{number:03d}-of-xx"


def fill(database: Database, count: int = 24) -> Documents:
    documents = {id_of(number): text(number) for number in range(count)}
    for number, (id, one) in enumerate(documents.items()):
        database.write(id, one, id_of(0) if number % 7 == 3 else None)
    return documents


@pytest.fixture(scope="module")
def kept(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path, Documents]:
    """A state folder after a stop, one after a kill (everything is in the log still), and what they hold."""
    folder = tmp_path_factory.mktemp("damage")
    stopped, killed = folder / "stopped", folder / "killed"
    stopped.mkdir()
    with closing(Database(stopped)) as database:
        documents = fill(database)
        shutil.copytree(stopped, killed)
    return stopped, killed, documents


def places(file: bytes, number: int) -> list[tuple[int, int]]:
    """Where the pieces of a document stand in a file, with the head of its row."""
    found, mark, at = list[tuple[int, int]](), f"<{number:03d}.".encode(), 0
    id = id_of(number).encode()
    for word in (mark, id):
        at = file.find(word)
        while at >= 0:
            found.append((at - MARGIN, at + MARGIN))
            at = file.find(word, at + 1)
    return found


def damage(file: Path, dice: random.Random, kind: str) -> tuple[int, int]:
    """Damage a file somewhere; where, from and to."""
    data = bytearray(file.read_bytes())
    start, unit = (32, FRAME) if file.name == LOG else (0, PAGE)
    at = dice.randrange(len(data))
    if kind in ("zero", "noise"):
        at = start + (at - start) // unit * unit if at > start else start
        size = min(dice.choice([unit, 2 * unit]), len(data) - at)
        data[at : at + size] = bytes(size) if kind == "zero" else dice.randbytes(size)
    elif kind == "cut":
        size = len(data) - at
        del data[at:]
    else:
        size = min(dice.choice([1, 8, 64, 500]), len(data) - at)
        data[at : at + size] = dice.randbytes(size)
    file.write_bytes(data)
    return at, at + size


def holds(folder: Path, documents: Documents) -> Documents:
    """What a server finds in a folder, which it uses and starts again in."""
    found: list[Documents] = []
    for again in (False, True):
        store = open_store(folder)
        assert store is not None
        with closing(store):
            store.upkeep()
            if again:
                assert store.read(NEW) == {"id": NEW}
            else:
                store.saving.soon(NEW, lambda: {"id": NEW})
                assert store.saving.flush(20.0)
            found.append({id: one for id in documents if (one := store.database.read(id)) is not None})
    assert found[0] == found[1]
    return found[1]


def survive(kept: tuple[Path, Path, Documents], tmp_path: Path, seed: int) -> None:
    """Damage a copy; every document whose bytes were not touched is there, and a new one is kept."""
    stopped, killed, documents = kept
    dice = random.Random(seed)
    source, name = dice.choice([(stopped, NAME), (stopped, NAME), (killed, NAME), (killed, LOG)])
    kind = dice.choice(["zero", "noise", "cut", "bytes"])
    folder = tmp_path / str(seed)
    shutil.copytree(source, folder)
    before = (folder / name).read_bytes()
    start, end = damage(folder / name, dice, kind)
    found = holds(folder, documents)
    for number, (id, one) in enumerate(documents.items()):
        touched = any(low < end and start < high for low, high in places(before, number))
        assert touched or found.get(id) == one, f"seed {seed}: {kind} of {name} {start}..{end} lost {id}"
    shutil.rmtree(folder)


def test_a_file_that_is_whole_stays(
    kept: tuple[Path, Path, Documents], tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    for source in kept[:2]:
        folder = tmp_path / source.name
        shutil.copytree(source, folder)
        assert holds(folder, kept[2]) == kept[2]
        assert not caplog.messages and {path.name for path in folder.iterdir()} <= {"lock", NAME}


def test_whatever_is_damaged_what_can_be_read_is_kept_and_saving_goes_on(
    kept: tuple[Path, Path, Documents], tmp_path: Path
) -> None:
    for seed in range(24):
        survive(kept, tmp_path, seed)


@pytest.mark.slow
def test_damage_at_many_places(kept: tuple[Path, Path, Documents], tmp_path: Path) -> None:
    for seed in range(1000, 1100):
        survive(kept, tmp_path, seed)


@pytest.mark.parametrize("place", range(0, 100, 3))
def test_each_byte_of_the_head_may_be_wrong(
    kept: tuple[Path, Path, Documents], tmp_path: Path, place: int
) -> None:
    folder, documents = tmp_path / "state", kept[2]
    shutil.copytree(kept[0], folder)
    data = bytearray((folder / NAME).read_bytes())
    data[place : place + 3] = b"\xff\x00\x55"
    (folder / NAME).write_bytes(data)
    with closing(Database(folder)) as database:
        assert {id: database.read(id) for id in documents} == documents


def test_every_document_that_is_lost_is_named(kept: tuple[Path, Path, Documents], tmp_path: Path) -> None:
    """A visitor whose row lay in a damaged page began anew without a word."""
    stopped, _, documents = kept
    content, lost = (stopped / NAME).read_bytes(), set[str]()
    for number in range(len(content) // PAGE):
        folder = tmp_path / str(number)
        folder.mkdir()
        (folder / NAME).write_bytes(content[: number * PAGE] + bytes(PAGE) + content[(number + 1) * PAGE :])
        with closing(Database(folder)) as database:
            missing = {id for id in documents if database.read(id) is None}
            assert {id for id in documents if database.asides(id)} == missing, number
            lost |= {id for id in missing if not any(one.left for one in database.asides(id))}
    assert lost


def test_the_damaged_file_stays_beside_as_it_was(kept: tuple[Path, Path, Documents], tmp_path: Path) -> None:
    folder = tmp_path / "state"
    shutil.copytree(kept[0], folder)
    for number in (1, 2):
        data = bytearray((folder / NAME).read_bytes())
        data[:PAGE] = bytes(PAGE)
        (folder / NAME).write_bytes(data)
        with closing(Database(folder)) as database:
            assert database.read(id_of(5)) == text(5)
        assert (folder / f"sessions.broken-{number}").read_bytes() == data


@pytest.fixture
def store(tmp_path: Path) -> Iterator[Store]:
    store = open_store(tmp_path / "sessions")
    assert store is not None
    with closing(store):
        until(lambda: store.saving.upkeep_s > 0.0)
        yield store


BAD_ROWS: list[tuple[str, tuple[object, ...]]] = [
    ("INSERT INTO document VALUES (?, NULL, 0.0, x'7b7d', 0.0)", ("../../etc/passwd",)),
    ("INSERT INTO document VALUES (?, NULL, 0.0, x'7b7d', 0.0)", (b"\xff\xfe",)),
    ("INSERT INTO document VALUES (CAST(? AS TEXT), NULL, 0.0, x'7b7d', 0.0)", (b"\xff\xfe\x00x",)),
    ("INSERT INTO document VALUES (?, NULL, 0.0, x'7b7d', 0.0)", ("",)),
    ("UPDATE document SET used_s = ?", ("long ago",)),
    ("UPDATE document SET used_s = ?", (b"\x00",)),
    ("UPDATE document SET used_served = ?", ("text",)),
    ("UPDATE document SET used_served = ?", (-1e300,)),
    ("UPDATE document SET used_served = ?", (1e300,)),
    ("UPDATE document SET shared_by = ?", (b"\xff",)),
    ("UPDATE document SET shared_by = ?", ("no id at all!",)),
    ("UPDATE document SET content = CAST(content AS TEXT)", ()),
    ("UPDATE document SET content = ? WHERE id = 'b'", (17,)),
    ("UPDATE served SET seconds = ?", (1e9,)),
    ("UPDATE served SET seconds = ?, again = ?", ("x", b"y")),
    ("DELETE FROM served", ()),
    ("UPDATE served SET counted_s = ?", ("x",)),
    ("INSERT INTO unused VALUES (?, ?)", ("content", "x")),
]


@pytest.mark.parametrize(("query", "values"), BAD_ROWS)
@pytest.mark.parametrize("running", [True, False])
def test_a_single_bad_row_costs_nothing_but_itself(
    store: Store, query: str, values: tuple[object, ...], running: bool
) -> None:
    a, folder = {"id": "a", "text": "of a"}, store.folder
    store.write("a", a)
    store.write("b", {"id": "b"})
    if not running:
        store.close()
    with closing(sqlite3.connect(folder / NAME)) as other, other:
        other.execute(query, values)
    again = store if running else open_store(folder)
    assert again is not None
    again.saving.upkeep_s = 0.0
    again.saving.soon("c", lambda: {"id": "c"})
    assert again.saving.flush()
    until(lambda: again.saving.upkeep_s > 0.0)
    assert again.read("a") == a and again.read("c") == {"id": "c"}
    again.upkeep()
    assert again.has("a") and again.has("b") == ("content = ?" not in query)
    again.close()


def test_no_fault_of_the_upkeep_or_of_a_session_ends_the_saving(
    store: Store, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object) -> None:
        raise RuntimeError("a fault of ours")

    monkeypatch.setattr(store.saving, "_upkeep", fail)
    store.saving.upkeep_s = 0.0
    store.saving.soon("a", fail, fail)  # pyright: ignore[reportArgumentType]
    assert store.saving.flush()
    store.saving.soon("b", lambda: {"id": "b"}, fail)
    assert store.saving.flush() and store.read("b") == {"id": "b"}


@pytest.mark.parametrize("how", ["noise", "zero", "removed", "cut", "empty"])
def test_damage_that_appears_while_it_serves_is_noticed_and_mended(
    store: Store, how: str, caplog: pytest.LogCaptureFixture
) -> None:
    documents = fill(store.database)
    store.database._do(lambda one: one.execute("PRAGMA cache_size = 1"))
    with closing(sqlite3.connect(store.folder / NAME)) as other:
        other.execute("PRAGMA wal_checkpoint(TRUNCATE)")
    file = store.folder / NAME
    if how == "removed":
        file.unlink()
    else:
        data, pages = bytearray(file.read_bytes()), range(6 * PAGE, 9 * PAGE)
        with file.open("r+b") as opened:
            if how in ("cut", "empty"):
                opened.truncate(len(data) // 2 if how == "cut" else 0)
            else:
                opened.seek(pages.start)
                opened.write(bytes(len(pages)) if how == "zero" else random.Random(0).randbytes(len(pages)))
    store.saving.soon(NEW, lambda: {"id": NEW})
    assert store.saving.flush(20.0)
    store.upkeep()
    found = [id for id, one in documents.items() if store.database.read(id) == one]
    assert store.read(NEW) == {"id": NEW}
    assert "put aside as sessions.broken-1" in caplog.text or "is made again" in caplog.text
    if how != "empty":
        assert len(found) >= (24 if how == "removed" else 1)
    store.upkeep()
    assert [id for id, one in documents.items() if store.database.read(id) == one] == found


_WORKER = """
import sys
from pathlib import Path
from schuler_bench.session.database import Database
database = Database(Path(sys.argv[1]))
database.write("of-a-worker-before", b'{"id": "of-a-worker-before"}')
print("ready", flush=True)
sys.stdin.readline()
database.write("of-a-worker-after", b'{"id": "of-a-worker-after"}')
print("written", flush=True)
sys.stdin.readline()
database.close()
"""


def test_another_worker_goes_on_in_the_file_that_was_made_anew(tmp_path: Path) -> None:
    folder = tmp_path / "state"
    folder.mkdir()
    with (
        closing(Database(folder)) as database,
        subprocess.Popen(
            [sys.executable, "-c", _WORKER, str(folder)],
            env=environment(),
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        ) as worker,
    ):
        assert worker.stdout is not None and worker.stdin is not None
        assert worker.stdout.readline() == "ready\n"
        database.write("a", b'{"id": "a"}')
        with closing(sqlite3.connect(folder / NAME)) as other:
            other.execute("PRAGMA wal_checkpoint(TRUNCATE)")
        with (folder / NAME).open("r+b") as file:
            file.write(bytes(PAGE))
        database.check()
        database.write("b", b'{"id": "b"}')
        worker.stdin.write("\n")
        worker.stdin.flush()
        assert worker.stdout.readline() == "written\n"
        database.write("c", b'{"id": "c"}')
        worker.stdin.write("\n")
        worker.stdin.flush()
        assert worker.wait(20.0) == 0
        database.write("d", b'{"id": "d"}')
        wanted = ["a", "b", "c", "d", "of-a-worker-before", "of-a-worker-after"]
        assert [id for id in wanted if database.has(id)] == wanted
    with closing(Database(folder)) as database:
        assert [id for id in wanted if database.has(id)] == wanted
    assert len([path for path in folder.iterdir() if not path.name.endswith("-wal")]) == 2


@pytest.mark.parametrize("version", [3, 99, 1 << 30])
def test_a_file_of_a_newer_version_is_not_touched_and_what_can_be_read_is_taken_over(
    kept: tuple[Path, Path, Documents], tmp_path: Path, version: int, caplog: pytest.LogCaptureFixture
) -> None:
    folder = tmp_path / "state"
    shutil.copytree(kept[0], folder)
    with closing(sqlite3.connect(folder / NAME)) as other, other:
        other.execute("CREATE TABLE later (thing)")
        other.execute(f"PRAGMA user_version = {version}")
    before = (folder / NAME).read_bytes()
    with closing(Database(folder)) as database:
        assert {id: database.read(id) for id in kept[2]} == kept[2]
    assert (folder / "sessions.newer-1").read_bytes() == before
    assert f"made by a newer version of this program ({version})" in caplog.text


def test_keeping_tells_of_changes_alone_and_outlives_who_cannot_hear(
    caplog: pytest.LogCaptureFixture,
) -> None:
    keeping, told = Keeping(), list[object]()

    def deaf(_: object) -> None:
        raise RuntimeError

    keeping.watch(deaf)
    keeping.watch(told.append)
    with caplog.at_level(logging.CRITICAL):
        for fault in (None, HELD, HELD, None, None):
            keeping.becomes(fault)
    assert told == [HELD, None]

"""What is not ours in the state folder: refused at the start, left alone by a server that runs."""

import logging
import os
import socket
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager, suppress
from pathlib import Path

import pytest

from navcore.foundation.errors import InputError
from schuler_bench.bench.process import environment
from schuler_bench.session import content, folder
from schuler_bench.session import store as store_module
from schuler_bench.session.content import Contents
from schuler_bench.session.folder import refuse_others
from schuler_bench.session.store import Store, open_store, session_key
from schuler_bench.session.uploads import Uploads
from tests.waiting import until

ID = "a" * 24
LOG = b"t_s,speed_mps,heading_deg\n" + b"".join(b"%d,5.0,90.0\n" % t for t in range(120))
OTHER = "0" * 64
"""Name of a content that nobody uses."""
FILE_ENTRIES = (
    "lock",
    "session.key",
    "sessions.sqlite",
    "sessions.sqlite-wal",
    "sessions.sqlite-shm",
    f"content/{OTHER}",
    f".{'0' * 16}.tmp",
)
FOLDER_ENTRIES = ("", "content", f"{ID}.files", "orphan.files")
VISITORS = (f"{ID}.files/log.csv", f"{ID}.files/.{'0' * 16}.tmp")
"""Names that a visitor may choose are not judged at the start."""


def a_link(place: Path, decoys: Path) -> None:
    place.symlink_to(decoys / "file")


def a_link_to_a_folder(place: Path, decoys: Path) -> None:
    place.symlink_to(decoys)


def a_dead_link(place: Path, decoys: Path) -> None:
    place.symlink_to(decoys / "made")


def a_folder(place: Path, decoys: Path) -> None:
    place.mkdir()
    (place / "notes.txt").write_text("somebody's")
    (place / OTHER).mkdir()


def a_fifo(place: Path, decoys: Path) -> None:
    os.mkfifo(place)


def a_file_of_others(place: Path, decoys: Path) -> None:
    place.write_bytes(b"somebody's")
    os.chown(place, 12345, 12345)


def a_folder_of_others(place: Path, decoys: Path) -> None:
    place.mkdir()
    (place / OTHER).write_text("somebody's")
    (place / "log.csv").write_text("somebody's")
    os.chown(place, 12345, 12345)


OTHERS = (a_link, a_link_to_a_folder, a_dead_link, a_fifo, a_file_of_others)
IN_PLACE = [
    (entry, kind)
    for entries, kinds in (
        ((*FILE_ENTRIES, *VISITORS), (*OTHERS, a_folder)),
        (FOLDER_ENTRIES, (*OTHERS, a_folder_of_others)),
    )
    for entry in entries
    for kind in kinds
]


def tree(path: Path) -> dict[str, tuple[object, ...]]:
    """All there is, without following links."""
    found = {}
    for one in [path, *sorted(path.rglob("*"))]:
        state = one.lstat()
        regular = one.is_file() and not one.is_symlink()
        inside = one.read_bytes() if regular else os.readlink(one) if one.is_symlink() else b""
        found[str(one)] = (oct(state.st_mode), state.st_uid, state.st_nlink, inside)
    return found


@pytest.fixture
def decoys(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder of somebody's, and a server to which everything is old."""
    monkeypatch.setattr(content, "UNLINKED_S", -1.0)
    for name in ("_ORPHAN_S", "OLDEST_S"):
        monkeypatch.setattr(store_module, name, -1.0)
    place = tmp_path / "decoys"
    (place / OTHER).mkdir(parents=True)
    for name in ("file", "1" * 64, "log.csv", "sessions.sqlite"):
        (place / name).write_text("somebody's")
        (place / name).chmod(0o644)
    return place


def put(kind: Callable[[Path, Path], None], place: Path, decoys: Path) -> None:
    if "others" in kind.__name__ and os.getuid() != 0:
        pytest.skip("only root can give a file away")
    place.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
    kind(place, decoys)


@contextmanager
def serving(state: Path) -> Iterator[Store | None]:
    """A store that does all that a server does in its folder."""
    session_key(state)
    store = open_store(state)
    if store is None:
        yield None
        return
    with closing(store):
        yield store


def use(store: Store) -> None:
    """Upload, share, reopen, clean, forget."""
    uploads = Uploads(store.files_folder(ID), keep_once=store.contents.keep_once)
    steps: list[Callable[[], object]] = [
        lambda: store.write(ID, {"id": ID}),
        lambda: uploads.add("log.csv", LOG),
        lambda: uploads.reopen(),
        lambda: store.share(ID, "share-of-it", {"id": "share-of-it"}),
        lambda: store.remove_old(),
        lambda: uploads.add("log.csv", LOG + b"120,5.0,90.0\n"),
        lambda: store.contents.bytes(),
        lambda: store.read(ID),
        lambda: uploads.clear(),
        lambda: store.remove_old(),
    ]
    for step in steps:
        with suppress(OSError, InputError):
            step()


@pytest.mark.parametrize(
    ("entry", "kind"), IN_PLACE, ids=lambda one: getattr(one, "__name__", one or "itself")
)
def test_what_is_not_ours_is_left_alone_by_a_server(
    tmp_path: Path, decoys: Path, entry: str, kind: Callable[[Path, Path], None]
) -> None:
    """It starts, serves, cleans and stops, as if it had not looked before the start."""
    state = tmp_path / "schuler-bench" / "sessions"
    place = state / entry if entry else state
    put(kind, place, decoys)
    before = tree(decoys) | tree(place)
    with serving(state) as store:
        if store is not None:
            use(store)
    assert tree(decoys) | tree(place) == before


@pytest.mark.parametrize(
    ("entry", "kind"),
    [pair for pair in IN_PLACE if pair[0] and not pair[0].startswith("sessions.sqlite")],  # these are open
    ids=lambda one: getattr(one, "__name__", one),
)
def test_what_comes_while_it_serves_is_left_alone_too(
    tmp_path: Path, decoys: Path, entry: str, kind: Callable[[Path, Path], None]
) -> None:
    state = tmp_path / "schuler-bench" / "sessions"
    with serving(state) as store:
        assert store is not None
        until(lambda: store.saving.upkeep_s > 0.0)  # it looks for what is old when it starts
        place = state / entry
        place.unlink(missing_ok=True)
        put(kind, place, decoys)
        before = tree(decoys) | tree(place)
        use(store)
    assert tree(decoys) | tree(place) == before


@pytest.mark.parametrize(
    ("entry", "kind"),
    [pair for pair in IN_PLACE if pair[0] not in VISITORS],
    ids=lambda one: getattr(one, "__name__", one or "itself"),
)
def test_what_is_not_ours_is_refused_at_the_start_with_path_and_remedy(
    tmp_path: Path, decoys: Path, entry: str, kind: Callable[[Path, Path], None]
) -> None:
    state = tmp_path / "schuler-bench" / "sessions"
    refuse_others(state)
    place = state / entry if entry else state
    put(kind, place, decoys)
    with pytest.raises(InputError) as caught:
        refuse_others(state)
    (fault,) = caught.value.faults
    assert fault.where == str(place).replace(ID, "a" * 6 + "*").replace("orphan.", "orphan*.")
    assert ID not in str(fault) and "XDG_STATE_HOME" in fault.allowed


def test_a_folder_of_ours_is_accepted_with_everything_in_it(tmp_path: Path) -> None:
    state = tmp_path / "schuler-bench" / "sessions"
    with serving(state) as store:
        assert store is not None
        Uploads(store.files_folder(ID), keep_once=store.contents.keep_once).add("log.csv", LOG)
        (state / "notes.txt").symlink_to(tmp_path)
        refuse_others(state)


def test_each_removal_is_a_line_of_the_log_without_the_address_of_a_session(
    tmp_path: Path, decoys: Path, caplog: pytest.LogCaptureFixture
) -> None:
    caplog.set_level(logging.INFO, "schuler")
    state = tmp_path / "schuler-bench" / "sessions"
    with serving(state) as store:
        assert store is not None
        until(lambda: store.saving.upkeep_s > 0.0)
        store.write(ID, {"id": ID})
        Uploads(store.files_folder(ID), keep_once=store.contents.keep_once).add("log.csv", LOG)
        (state / f".{'0' * 16}.tmp").write_text("left by a crash")
        (store.files_folder(ID) / "of others").mkdir()
        store.remove_old()
        name = folder.log_name(ID)
        assert f"removed session {name}: not used for long, or one too many" in caplog.messages
        assert f"removed 1 files of session {name}" in caplog.messages
        assert f"files of session {name} cannot be removed: Directory not empty" in caplog.messages
        assert f"removed .{'0' * 16}.tmp, which was never put in its place" in caplog.messages
        assert caplog.messages[-1].startswith("removed content ") and ID not in caplog.text
        assert {path.name for path in store.files_folder(ID).iterdir()} == {"of others"}


@pytest.mark.parametrize("more", [(), ("--workers", "2")], ids=["one", "workers"])
def test_the_command_refuses_to_start_in_one_line(
    tmp_path: Path, decoys: Path, more: tuple[str, ...]
) -> None:
    state = tmp_path / "schuler-bench" / "sessions"
    put(a_link_to_a_folder, state / "content", decoys)
    before = tree(decoys)
    with closing(socket.create_server(("127.0.0.1", 0))) as free:
        port = str(free.getsockname()[1])
    done = subprocess.run(
        [sys.executable, "-m", "schuler_bench", "serve", "--port", port, *more],
        env=environment() | {"XDG_STATE_HOME": str(tmp_path)},
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert done.returncode == 2 and tree(decoys) == before
    assert f"{state}/content" in done.stderr and "is a link, which is not followed" in done.stderr
    assert len(done.stderr.strip().splitlines()) == 1


def test_a_content_is_shared_only_with_a_file_of_ours(tmp_path: Path) -> None:
    (tmp_path / "own").mkdir()
    (tmp_path / "own" / "log.csv").write_bytes(LOG)
    Contents(tmp_path / "content").keep_once(tmp_path / "own" / "log.csv")
    (kept,) = (tmp_path / "content").iterdir()
    kept.unlink()
    kept.symlink_to(tmp_path / "own" / "log.csv")
    (tmp_path / "own" / "same.csv").write_bytes(LOG)
    Contents(tmp_path / "content").keep_once(tmp_path / "own" / "same.csv")
    assert not (tmp_path / "own" / "same.csv").is_symlink() and kept.is_symlink()

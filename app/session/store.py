"""Documents of sessions on disk, in the user's own folder, written soon after a change; uploads beside."""

from __future__ import annotations

import contextlib
import logging
import os
import re
import secrets
import sys
import tempfile
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import IO, Any

from navcore.foundation.text import Text
from schuler_bench.http.ids import log_name
from schuler_bench.jobs.words import without_folders
from schuler_bench.session.content import Contents
from schuler_bench.session.database import Database, parsed
from schuler_bench.session.folder import (
    FILES,
    TEMPORARY,
    Folder,
    link_files,
    opened,
    refuse_others,
    remove_files,
    temporary_name,
)

WRITE_AFTER_S = 0.5
"""Between a change and the file: changes that follow each other are written once."""
MOST_KEPT = 2000
OLDEST_S = 60 * 86_400.0
"""Number and age of the sessions that are kept; of a link that was shared, ten times that age."""
MOST_LINKS = 100
"""States that may be shared from one session."""
LARGEST_DOCUMENT = 16 << 20
LARGEST_UPLOADS = 2 << 30
"""Bytes of the uploaded files of all sessions, each content counted once."""
CLAIMED = "SCHULER_STATE_CLAIMED"
"""Set in the environment of a worker whose door has claimed the folder."""
_UPKEEP_EVERY_S = 600.0
_ORPHAN_S = 86_400.0
NO_HOME = Text("there is no home folder: set XDG_STATE_HOME")
_ID = re.compile(r"[A-Za-z0-9_-]{1,64}")
_KEY, _KEY_BYTES = "session.key", 32
_log = logging.getLogger("schuler.store")


def default_folder() -> Path | None:
    """Where the user's sessions are kept: under ``XDG_STATE_HOME``, else where the platform keeps such.

    None, with a line in the log, where there is neither that nor a home folder.
    """
    chosen = os.environ.get("XDG_STATE_HOME")
    if chosen and Path(chosen).is_absolute():
        base = Path(chosen)
    else:
        try:
            within = "Library/Application Support" if sys.platform == "darwin" else ".local/state"
            base = Path.home() / within
        except RuntimeError:
            _log.warning("sessions are not kept over a restart: %s", NO_HOME)
            return None
    return base / "schuler-bench" / "sessions"


def checked_folder() -> Path | None:
    """Return the `default_folder`, in which nothing else is in the place of something of ours.

    Raises
    ------
    InputError
        As `refuse_others`.
    """
    folder = default_folder()
    if folder is not None:
        refuse_others(folder)
    return folder


def open_store(folder: Path) -> Store | None:
    """Open a folder of documents, made if need be; None, with a line in the log, if it cannot be used."""
    try:
        folder.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        with opened(folder, make=True) as ours:
            os.fchmod(ours.handle, 0o700)
        with tempfile.TemporaryFile(dir=folder):
            pass
        return Store(folder, claim(folder, shared=bool(os.environ.get(CLAIMED))))
    except OSError as error:
        _log.warning("sessions are not kept over a restart: %s: %s", folder, error.strerror or error)
        return None


def claim(folder: Path, *, shared: bool = False) -> IO[bytes]:
    """Hold the folder for this server: with two on one folder, the last writer would win.

    Parameters
    ----------
    folder : Path
        Exists.
    shared : bool
        The door of this worker has claimed the folder already (`share_claim`).

    Raises
    ------
    OSError
        Another server holds it.
    """
    with opened(folder) as ours:
        file = os.fdopen(ours.open("lock", os.O_RDWR | os.O_CREAT), "r+b")
    try:
        import fcntl

        fcntl.flock(file, (fcntl.LOCK_SH if shared else fcntl.LOCK_EX) | fcntl.LOCK_NB)
    except ImportError:  # not on this platform
        return file
    except OSError:
        file.close()
        raise OSError(None, Text("another server keeps its sessions there; set XDG_STATE_HOME")) from None
    return file


def share_claim(claimed: IO[bytes]) -> None:
    """Let the workers of this server use the folder that it has claimed, and still no other server."""
    import fcntl

    fcntl.flock(claimed, fcntl.LOCK_SH | fcntl.LOCK_NB)


class Store:
    """A folder of documents, and the thread that writes them.

    Parameters
    ----------
    folder : Path
        Exists, can be written to, and is ours alone.
    claim : file
        Held open as long as the folder is used.

    Raises
    ------
    OSError
        The documents cannot be opened.
    """

    def __init__(self, folder: Path, claim: IO[bytes]) -> None:
        self.folder, self._claim = folder, claim
        self.contents = Contents(folder / "content")
        try:
            self.database = Database(folder)
        except BaseException:
            claim.close()
            raise
        self._changed = threading.Condition()
        self._due: dict[str, tuple[float, Callable[[], Any], Callable[[str], None]]] = {}
        self._writing = 0
        self._closed = self._complained = False
        self._upkeep_s = 0.0
        self._thread = threading.Thread(target=self._loop, name="store", daemon=True)
        self._thread.start()

    # ------------------------------------------------------------ reading

    def read(self, id: str) -> dict[str, Any] | None:
        """Document of that id; None, with a line in the log if it is broken, when there is none."""
        _checked(id)
        try:
            content = self.database.read(id)
            return None if content is None else parsed(id, content)
        except (OSError, ValueError, RecursionError) as error:
            words = getattr(error, "strerror", None) or error
            _log.warning("session %s cannot be read: %.200s", log_name(id), words)
        return None

    def has(self, id: str) -> bool:
        """Whether there is a document of that id."""
        try:
            return _ID.fullmatch(id) is not None and self.database.has(id)
        except OSError:
            return False

    def files_folder(self, id: str) -> Path:
        """Where the uploaded files of a session are kept; need not exist."""
        return self.folder / f"{_checked(id)}.files"

    def has_room(self, size: int) -> bool:
        """Whether a file of this size can still be kept."""
        return self.contents.bytes() + size <= LARGEST_UPLOADS

    # ------------------------------------------------------------ writing

    def soon(
        self, id: str, make: Callable[[], dict[str, Any]], failed: Callable[[str], None] = lambda _: None
    ) -> None:
        """Let a document be made and written in a moment, in another thread; the first request counts.

        Parameters
        ----------
        id : str
            Of the session.
        make : callable
            Gives the document.
        failed : callable
            Told in words why it could not be written.
        """
        with self._changed:
            if not self._closed and id not in self._due:
                self._due[_checked(id)] = (time.monotonic() + WRITE_AFTER_S, make, failed)
                self._changed.notify_all()

    def write(self, id: str, document: dict[str, Any], shared_by: str | None = None) -> None:
        """Write a document now: whole or not at all.

        Raises
        ------
        OSError
            There is no room, or the folder is gone.
        """
        import orjson

        content = orjson.dumps(document, option=orjson.OPT_NON_STR_KEYS)
        if len(content) > LARGEST_DOCUMENT:
            raise OSError(
                None,
                Text(
                    "the session takes more than {largest_document} MiB",
                    largest_document=LARGEST_DOCUMENT >> 20,
                ),
            )
        self.database.write(_checked(id), content, shared_by)

    def share(self, id: str, shared: str, document: dict[str, Any]) -> None:
        """Keep a state of a session for others, with the session's files.

        Raises
        ------
        OSError
            There is no room, or the session has shared too many already.
        """
        if self.database.shared_by(id) >= MOST_LINKS:
            raise OSError(
                None, Text("at most {most_links} links are made from one session", most_links=MOST_LINKS)
            )
        link_files(self.files_folder(id), self.files_folder(shared))
        self.write(shared, document, shared_by=id)

    def flush(self, timeout_s: float = 5.0) -> bool:
        """Write at once what waits; False if that takes longer."""
        with self._changed:
            self._due = {id: (0.0, make, failed) for id, (_, make, failed) in self._due.items()}
            self._changed.notify_all()
            return self._changed.wait_for(lambda: not self._due and not self._writing, timeout_s)

    def close(self) -> None:
        """Write what waits, end the thread and let the folder go."""
        self.flush()
        with self._changed:
            self._closed = True
            self._changed.notify_all()
        self._thread.join(1.0)
        self.database.close()
        self._claim.close()

    def _loop(self) -> None:
        while True:
            if time.monotonic() >= self._upkeep_s:
                self.remove_old()
                self._upkeep_s = time.monotonic() + _UPKEEP_EVERY_S
            with self._changed:
                while not self._closed and not self._ready() and time.monotonic() < self._upkeep_s:
                    dues = [self._upkeep_s, *(due for due, *_ in self._due.values())]
                    self._changed.wait(max(0.0, min(dues) - time.monotonic()))
                if self._closed:
                    return
                makes = {id: self._due.pop(id)[1:] for id in self._ready()}
                self._writing += 1
            try:
                for id, (make, failed) in makes.items():
                    self._try_to_write(id, make, failed)
            finally:
                with self._changed:
                    self._writing -= 1
                    self._changed.notify_all()

    def _ready(self) -> list[str]:
        now = time.monotonic()
        return [id for id, (due, *_) in self._due.items() if due <= now]

    def _try_to_write(
        self, id: str, make: Callable[[], dict[str, Any]], failed: Callable[[str], None]
    ) -> None:
        try:
            self.write(id, make())
            self._complained = False
        except OSError as error:
            words = without_folders(str(error.strerror or error))
            if not self._complained:
                _log.warning("sessions cannot be kept at present: %s", words)
            self._complained = True
            failed(words)
        except Exception:  # the thread must outlive a document that cannot be made
            _log.exception("a session cannot be kept")
            failed(Text("an error of this program"))

    # ------------------------------------------------------------ upkeep

    def remove_old(self) -> None:
        """Remove what is too old, then the oldest of too many sessions, and what nobody uses any more."""
        now = time.time()
        try:
            for id in self.database.remove_old(now - OLDEST_S, now - 10.0 * OLDEST_S, MOST_KEPT):
                _log.info("removed session %s: not used for long, or one too many", log_name(id))
                remove_files(self.files_folder(id))
            self._remove_orphans(now)
            self.contents.remove_unused()
        except OSError as error:
            _log.warning("old sessions cannot be removed: %s", error.strerror or error)

    def _remove_orphans(self, now: float) -> None:
        with opened(self.folder) as ours:
            for name in ours.names():
                state = ours.state(name)
                if state is None or now - state.st_mtime < _ORPHAN_S:
                    continue
                if TEMPORARY.fullmatch(name) and ours.file(name):
                    ours.remove(name, f"{name}, which was never put in its place")
                elif FILES.fullmatch(name) and not self.has(Path(name).stem):
                    remove_files(self.folder / name)


def _checked(id: str) -> str:
    if _ID.fullmatch(id) is None:
        raise ValueError(f"{id!r} is no id of a session")
    return id


def session_key(folder: Path | None) -> bytes:
    """Read the key of a state folder, or make one there.

    Parameters
    ----------
    folder : Path or None
        Made if need be. Where nothing can be kept, the key is that of this process alone.
    """
    made = secrets.token_bytes(_KEY_BYTES)
    if folder is None:
        return made
    with contextlib.suppress(OSError):
        folder.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        with opened(folder, make=True) as ours:
            if ours.state(_KEY) is None:
                _place(made, ours)
            with ours.read(_KEY) as file:
                kept = file.read(_KEY_BYTES + 1)
        if len(kept) == _KEY_BYTES:
            return kept
    return made


def _place(key: bytes, folder: Folder) -> None:
    """Link a key into its place whole; when two servers start at once, the first one's stays."""
    fresh = temporary_name()
    try:
        with folder.create(fresh) as file:
            file.write(key)
        with contextlib.suppress(FileExistsError):
            folder.link(fresh, folder, _KEY)
    finally:
        folder.discard(fresh)

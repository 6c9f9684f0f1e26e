"""Documents of sessions on disk, in the user's own folder, written soon after a change; uploads beside."""

from __future__ import annotations

import contextlib
import logging
import os
import re
import secrets
import sys
import tempfile
from pathlib import Path
from typing import IO, Any

from navcore.foundation.text import Text
from schuler_bench.http.ids import log_name
from schuler_bench.session import content
from schuler_bench.session.content import Contents
from schuler_bench.session.database import Database, parsed
from schuler_bench.session.folder import (
    FILES,
    PUT_ASIDE,
    STUDY,
    TEMPORARY,
    Folder,
    bytes_of,
    link_files,
    opened,
    refuse_others,
    remove_files,
    remove_study,
    temporary_name,
)
from schuler_bench.session.keeping import HELD, Keeping, not_kept
from schuler_bench.session.saving import Saving, UnfitError

MOST_KEPT = 2000
OLDEST_S = 60 * 86_400.0
"""Number of the sessions that are kept, and time served since their last use; of a link ten times that."""
MOST_LINKS = 100
"""States that may be shared from one session."""
LARGEST_DOCUMENT = 16 << 20
LARGEST_UPLOADS = 2 << 30
"""Bytes of the uploaded files of all sessions, each content counted once."""
CLAIMED = "SCHULER_STATE_CLAIMED"
"""Set in the environment of a worker whose door has claimed the folder."""
LARGEST_STUDIES = 1 << 30
"""Bytes of the studies of all sessions."""
_ORPHAN_S = 86_400.0
"""So long a server must have served since a file or folder has no session."""
_ID = re.compile(r"[A-Za-z0-9_-]{1,64}")
_KEY, _KEY_BYTES = "session.key", 32
_log = logging.getLogger("schuler.store")


def default_folder() -> Path | None:
    """Where the user's sessions are kept: under ``XDG_STATE_HOME``, else where the platform keeps such.

    None where there is neither that nor a home folder.
    """
    chosen = os.environ.get("XDG_STATE_HOME")
    if chosen and Path(chosen).is_absolute():
        base = Path(chosen)
    else:
        try:
            within = "Library/Application Support" if sys.platform == "darwin" else ".local/state"
            base = Path.home() / within
        except RuntimeError:
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


def open_store(folder: Path, keeping: Keeping | None = None) -> Store | None:
    """Open a folder of documents, made if need be.

    Parameters
    ----------
    folder : Path
        Of the state.
    keeping : Keeping, optional
        Told why nothing is kept, and when that changes.

    Returns
    -------
    Store or None
        None: the folder cannot be used.
    """
    keeping = keeping or Keeping()
    try:
        folder.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        with opened(folder, make=True) as ours:
            os.fchmod(ours.handle, 0o700)
        with tempfile.TemporaryFile(dir=folder):
            pass
        return Store(folder, claim(folder, shared=bool(os.environ.get(CLAIMED))), keeping)
    except HeldError:
        keeping.becomes(HELD)
    except OSError as error:
        if keeping.fault is None:  # not at every further try
            _log.warning("%s cannot be used: %s", folder, error.strerror or error)
        keeping.becomes(not_kept(error))
    return None


class HeldError(OSError):
    """Another server holds the folder."""


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
    HeldError
        Another server holds it.
    OSError
        It cannot be held.
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
        raise HeldError(None, Text("another server keeps its sessions there; set XDG_STATE_HOME")) from None
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
    keeping : Keeping
        Told whether documents can be written.

    Raises
    ------
    OSError
        The documents cannot be opened.
    """

    def __init__(self, folder: Path, claim: IO[bytes], keeping: Keeping) -> None:
        self.folder, self._claim = folder, claim
        self.contents = Contents(folder / "content")
        try:
            self.database = Database(folder)
        except BaseException:
            claim.close()
            raise
        self.saving = Saving(self.write, self.upkeep, keeping)

    # ------------------------------------------------------------ reading

    def read(self, id: str) -> dict[str, Any] | None:
        """Document of that id; None when there is none.

        Raises
        ------
        UnreadableError
            There is one that is broken; a copy of it is put aside.
        OSError
            It cannot be read at present.
        """
        waiting = self.saving.waiting(_checked(id))
        if waiting is not None:
            return waiting()
        content = self.database.read(id)
        if content is None:
            return None
        try:
            return parsed(id, content)
        except (ValueError, RecursionError) as error:
            raise UnreadableError(f"{type(error).__name__}: {error}"[:200]) from error

    def has(self, id: str) -> bool:
        """Whether there is a document of that id."""
        try:
            return _ID.fullmatch(id) is not None and self.database.has(id)
        except OSError:
            return False

    def files_folder(self, id: str) -> Path:
        """Where the uploaded files of a session are kept; need not exist."""
        return self.folder / f"{_checked(id)}.files"

    def study_folder(self, id: str) -> Path:
        """Where the last study of a session is kept; need not exist."""
        return self.folder / f"{_checked(id)}.study"

    def has_room(self, size: int) -> bool:
        """Whether a file of this size can still be kept."""
        return self.contents.bytes() + size <= LARGEST_UPLOADS

    # ------------------------------------------------------------ writing

    def write(self, id: str, document: dict[str, Any], shared_by: str | None = None) -> None:
        """Write a document now: whole or not at all.

        Raises
        ------
        UnfitError
            It is too large.
        OSError
            There is no room, or the folder is gone.
        """
        import orjson

        content = orjson.dumps(document, option=orjson.OPT_NON_STR_KEYS)
        if len(content) > LARGEST_DOCUMENT:
            raise UnfitError(
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

    def close(self) -> None:
        """Write what waits, end the thread and let the folder go."""
        self.saving.close()
        self.database.close()
        self._claim.close()

    # ------------------------------------------------------------ upkeep

    def upkeep(self) -> None:
        """Look for damage, then remove what is old; OSError when that is not possible."""
        self.database.check()
        self.remove_old()

    def remove_old(self) -> None:
        """Remove what is too old, then the oldest of too many sessions, and what nobody uses any more.

        Age is the time in which servers have served: the clock of the machine may be wrong.
        """
        for id in self.database.remove_old(OLDEST_S, 10.0 * OLDEST_S, MOST_KEPT):
            _log.info("removed session %s: not used for long, or one too many", log_name(id))
            remove_files(self.files_folder(id))
            remove_study(self.study_folder(id))
        contents = self.contents.unused()
        with opened(self.folder) as ours:
            names = ours.names()
            left = {name for name in names if TEMPORARY.fullmatch(name) and ours.file(name)}
            # Of a session that was lost with a damaged file, the recordings are all there is.
            lost = any(PUT_ASIDE.fullmatch(name) for name in names)
            studies = set(filter(STUDY.fullmatch, names))
            folders = set() if lost else studies | set(filter(FILES.fullmatch, names))
            orphans = {name for name in folders if not self._knows(Path(name).stem)}
            unused_s = self.database.unused_s({*contents, *left, *orphans})
            for name in left:
                if unused_s[name] > _ORPHAN_S:
                    ours.remove(name, f"{name}, which was never put in its place")
            for name in orphans:
                if unused_s[name] > _ORPHAN_S:
                    (remove_study if name in studies else remove_files)(self.folder / name)
        self._bound_studies(studies)
        self.contents.remove(name for name in contents if unused_s[name] > content.UNLINKED_S)

    def _bound_studies(self, names: set[str]) -> None:
        """Remove the studies that were written to longest ago, of those that take too much room."""
        room = LARGEST_STUDIES
        by_age = sorted((self.folder / name for name in names), key=_written_s, reverse=True)
        for path in by_age:
            room -= bytes_of(path)
            if room < 0:
                remove_study(path)

    def _knows(self, id: str) -> bool:
        return self.saving.waiting(id) is not None or self.database.knows(id)


def _written_s(path: Path) -> float:
    with contextlib.suppress(OSError):
        return path.lstat().st_mtime
    return 0.0


class UnreadableError(ValueError):
    """A document cannot be read."""


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

"""The documents of sessions and shared states in one SQLite file, and what may be in it."""

import json
import logging
import os
import sqlite3
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from schuler_bench.session.folder import opened

NAME = "sessions.sqlite"
_ENDINGS = ("-wal", "-shm", "-journal")
"""Of the files that SQLite keeps beside it."""
_SCHEMA = 1
_BUSY_S = 5.0
_TABLES = """
CREATE TABLE IF NOT EXISTS document (
    id TEXT PRIMARY KEY,
    shared_by TEXT,
    used_s REAL NOT NULL,
    content BLOB NOT NULL
) WITHOUT ROWID;
CREATE INDEX IF NOT EXISTS document_used ON document (used_s);
CREATE INDEX IF NOT EXISTS document_shared ON document (shared_by);
"""
_log = logging.getLogger("schuler.store")


class Database:
    """The file, opened for several processes and several threads of this one.

    A change is whole or not there at all, also when the process is killed in the middle of it (write-ahead
    log).

    Parameters
    ----------
    folder : Path
        Where it lies, or is made.

    Raises
    ------
    OSError
        There is something else of that name, or it cannot be written.
    """

    def __init__(self, folder: Path) -> None:
        self.path = folder / NAME
        self._lock = threading.Lock()
        with _as_os_error():
            try:
                self._connection = self._open()
            except sqlite3.DatabaseError as error:
                if isinstance(error, sqlite3.OperationalError):
                    raise
                aside = self.path.with_suffix(f".broken-{int(time.time())}")
                _log.warning("%s cannot be read (%s) and is put aside as %s", NAME, error, aside.name)
                self.path.replace(aside)
                self._connection = self._open()

    def close(self) -> None:
        """Close the file."""
        with self._lock:
            self._connection.close()

    def read(self, id: str) -> bytes | None:
        """Content of a document, which counts as used now; None when there is none."""
        with self._changing() as connection:
            row = connection.execute("SELECT content FROM document WHERE id = ?", (id,)).fetchone()
            if row is not None:
                connection.execute("UPDATE document SET used_s = ? WHERE id = ?", (time.time(), id))
        return None if row is None else bytes(row[0])

    def _first(self, query: str, *values: str) -> Any:
        """First row of an answer."""
        with self._changing() as connection:
            return connection.execute(query, values).fetchone()

    def has(self, id: str) -> bool:
        """Whether there is a document of that id."""
        return self._first("SELECT 1 FROM document WHERE id = ?", id) is not None

    def write(self, id: str, content: bytes, shared_by: str | None = None) -> None:
        """Put a document in place of an earlier one; ``shared_by`` is the session a shared state is of."""
        with self._changing() as connection:
            connection.execute(
                "INSERT INTO document (id, shared_by, used_s, content) VALUES (?, ?, ?, ?)"
                " ON CONFLICT (id) DO UPDATE SET used_s = excluded.used_s, content = excluded.content",
                (id, shared_by, time.time(), content),
            )

    def shared_by(self, id: str) -> int:
        """How many states were shared from a session."""
        return self._first("SELECT count(*) FROM document WHERE shared_by = ?", id)[0]

    def remove_old(self, sessions_before_s: float, shared_before_s: float, most: int) -> list[str]:
        """Remove what was last used before these times, and the oldest beyond ``most``; their ids."""
        with self._changing() as connection:
            gone = connection.execute(
                "SELECT id FROM document WHERE used_s < CASE WHEN shared_by IS NULL THEN ? ELSE ? END"
                " UNION SELECT id FROM (SELECT id FROM document WHERE shared_by IS NULL"
                " ORDER BY used_s DESC LIMIT -1 OFFSET ?)",
                (sessions_before_s, shared_before_s, most),
            ).fetchall()
            connection.executemany("DELETE FROM document WHERE id = ?", gone)
        return [row[0] for row in gone]

    def figures(self) -> dict[str, float]:
        """Documents and bytes kept, for ``/metrics``."""
        counts = self._first("SELECT count(*) - count(shared_by), count(shared_by) FROM document")
        return dict(zip(("kept_sessions", "kept_shared"), map(float, counts), strict=True))

    @contextmanager
    def _changing(self) -> Iterator[sqlite3.Connection]:
        with self._lock, _as_os_error(), self._connection:
            yield self._connection

    def _open(self) -> sqlite3.Connection:
        # SQLite would follow a link of that name, wait for ever at a FIFO, and remove what bears the others.
        with opened(self.path.parent) as folder:
            os.close(folder.open(NAME, os.O_RDWR | os.O_CREAT))
            for name in (f"{NAME}{ending}" for ending in _ENDINGS):
                if folder.state(name) is not None and folder.file(name) is None:
                    raise OSError(None, f"{name} is no file of ours")
        connection = sqlite3.connect(self.path, timeout=_BUSY_S, check_same_thread=False)
        try:
            connection.execute("PRAGMA journal_mode = WAL")
            connection.execute("PRAGMA synchronous = NORMAL")
            connection.executescript(_TABLES)
            connection.execute(f"PRAGMA user_version = {_SCHEMA}")
        except BaseException:
            connection.close()
            raise
        return connection


@contextmanager
def _as_os_error() -> Iterator[None]:
    """Raise an error of SQLite about a full or broken disk as Python's own error."""
    try:
        yield
    except (sqlite3.OperationalError, sqlite3.ProgrammingError) as error:  # the latter: it is closed
        raise OSError(None, str(error)) from error


def parsed(id: str, content: bytes) -> dict[str, Any]:
    """A document, if the content is one of this id.

    Raises
    ------
    ValueError, RecursionError
        It is not.
    """
    document = json.loads(content)
    if not isinstance(document, dict) or document.get("id") != id:
        raise ValueError("is of another session")
    return document

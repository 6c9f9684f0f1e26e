"""The documents of sessions and shared states in one SQLite file; damage of it is put aside."""

import json
import os
import sqlite3
import threading
import time
from collections.abc import Callable, Iterable
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

from schuler_bench.session import served
from schuler_bench.session.database_file import (
    DamagedError,
    as_os_error,
    begin_anew,
    beside,
    check,
    close_moved,
    mend_rows,
    open_checked,
    rescued,
    take_over,
    unless_of_the_machine,
)
from schuler_bench.session.folder import Folder, alone, opened
from schuler_bench.session.salvage import NAME

T = TypeVar("T")


@dataclass(frozen=True)
class Aside:
    """A document that could not be read, or not wholly, as it was.

    Attributes
    ----------
    number : int
        By which it is found.
    why : str
        What is wrong with it.
    left : bool
        Something of it is left, and not only that there was one.
    """

    number: int
    why: str
    left: bool


class Database:
    """The file, opened for several processes and several threads of this one.

    A change is whole or not there at all, also when the process is killed in the middle of it (write-ahead
    log). A file that is damaged, or of a newer version, is moved to ``sessions.broken-N`` or
    ``sessions.newer-N``, as soon as that is noticed, and every document that can be read in it is taken over.

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
        self._lock = threading.RLock()
        self._counter = served.Counter()
        self._connection: sqlite3.Connection | None = None
        self._file = (0, 0)
        with self._lock, as_os_error():
            self._open()

    def close(self) -> None:
        """Close the file; what is asked of it from now on raises OSError."""
        with self._lock:
            self._let_go()
            self._file = (-1, -1)

    # ------------------------------------------------------------ documents

    def read(self, id: str) -> bytes | None:
        """Content of a document, which counts as used now; None when there is none."""

        def act(connection: sqlite3.Connection) -> bytes | None:
            row = connection.execute("SELECT content FROM document WHERE id = ?", (id,)).fetchone()
            if row is None:
                return None
            with unless_of_the_machine():  # what can be read is read on a full disk too
                now = self._counter.count(connection)
                connection.execute(
                    "UPDATE document SET used_s = ?, used_served = ? WHERE id = ?", (time.time(), now, id)
                )
            return _as_bytes(row[0])

        return self._do(act)

    def _first(self, query: str, *values: object) -> Any:
        """First row of an answer."""
        return self._do(lambda connection: connection.execute(query, values).fetchone())

    def has(self, id: str) -> bool:
        """Whether there is a document of that id."""
        return self._first("SELECT 1 FROM document WHERE id = ?", id) is not None

    def write(self, id: str, content: bytes, shared_by: str | None = None) -> None:
        """Put a document in place of an earlier one; ``shared_by`` is the session a shared state is of."""

        def act(connection: sqlite3.Connection) -> None:
            connection.execute(
                "INSERT INTO document (id, shared_by, used_s, content, used_served) VALUES (?, ?, ?, ?, ?)"
                " ON CONFLICT (id) DO UPDATE SET used_s = excluded.used_s, content = excluded.content,"
                " used_served = excluded.used_served",
                (id, shared_by, time.time(), content, self._counter.count(connection)),
            )

        self._do(act)

    def shared_by(self, id: str) -> int:
        """How many states were shared from a session."""
        return self._first("SELECT count(*) FROM document WHERE shared_by = ?", id)[0]

    def figures(self) -> dict[str, float]:
        """Documents and bytes kept, for ``/metrics``."""
        counts = self._first("SELECT count(*) - count(shared_by), count(shared_by) FROM document")
        return dict(zip(("kept_sessions", "kept_shared"), map(float, counts), strict=True))

    # ------------------------------------------------------------ aside

    def put_aside(self, id: str, why: str) -> None:
        """Keep a copy of a document as it is, beside the one that will be written over; once."""

        def act(connection: sqlite3.Connection) -> None:
            connection.execute(
                "INSERT INTO aside (id, why, content, used_served)"
                " SELECT id, ?, content, ? FROM document WHERE id = ? AND NOT EXISTS"
                " (SELECT 1 FROM aside WHERE aside.id = document.id AND aside.content = document.content)",
                (why, self._counter.count(connection), id),
            )

        self._do(act)

    def asides(self, id: str) -> list[Aside]:
        """What was put aside of a session, the newest first."""
        query = "SELECT number, why, content IS NOT NULL FROM aside WHERE id = ? ORDER BY number DESC"
        rows = self._do(lambda one: one.execute(query, (id,)).fetchall())
        return [Aside(number, why, bool(left)) for number, why, left in rows]

    def aside(self, id: str, number: int) -> bytes | None:
        """Content of a document that was put aside, as it was."""
        row = self._first("SELECT content FROM aside WHERE id = ? AND number = ?", id, number)
        return None if row is None else _as_bytes(row[0])

    # ------------------------------------------------------------ upkeep

    def remove_old(self, sessions_s: float, shared_s: float, most: int) -> list[str]:
        """Remove what was not used for so long, and the oldest beyond ``most``; their ids.

        Parameters
        ----------
        sessions_s, shared_s : float
            Of the time in which a server has served; of shared states, and of what was put aside.
        most : int
            Of sessions.
        """

        def act(connection: sqlite3.Connection) -> list[str]:
            now = self._counter.count(connection)
            mend_rows(connection, now)
            gone = connection.execute(
                "SELECT id FROM document WHERE used_served < CASE WHEN shared_by IS NULL THEN ? ELSE ? END"
                " UNION SELECT id FROM (SELECT id FROM document WHERE shared_by IS NULL"
                " ORDER BY used_served DESC, used_s DESC LIMIT -1 OFFSET ?)",
                (now - sessions_s, now - shared_s, most),
            ).fetchall()
            connection.executemany("DELETE FROM document WHERE id = ?", gone)
            connection.execute("DELETE FROM aside WHERE used_served < ?", (now - shared_s,))
            return [row[0] for row in gone]

        return self._do(act)

    def unused_s(self, names: Iterable[str]) -> dict[str, float]:
        """Of names that nobody uses: for how long that is so, in seconds served; of others it begins anew."""
        return self._do(lambda connection: self._counter.unused_s(connection, names))

    def knows(self, id: str) -> bool:
        """Whether there is a document of that id, or one put aside."""
        return self.has(id) or self._first("SELECT 1 FROM aside WHERE id = ?", id) is not None

    def check(self) -> None:
        """Look at the whole file, beside those who use it; put it aside if it is damaged."""
        try:
            with as_os_error(), beside(self.path) as connection:
                check(connection)
        except DamagedError as error:
            with self._lock, as_os_error():
                if self._connection is not None:
                    self._put_aside(error)

    # ------------------------------------------------------------ the file

    def _do(self, act: Callable[[sqlite3.Connection], T]) -> T:
        """Change or read the file as a whole; after damage, once more in what was made in its place."""
        with self._lock:
            for last in (False, False, True):
                try:
                    with as_os_error():
                        if self._file == (-1, -1):
                            raise OSError(None, "the file of the sessions is closed")
                        if self._connection is None or self._was_moved():
                            self._open()
                        assert self._connection is not None
                        with self._connection:
                            result = act(self._connection)
                        # Another worker may have put the file aside meanwhile, and have read it before.
                        if last or not self._was_moved():
                            return result
                except DamagedError as error:
                    if last:
                        raise
                    with as_os_error():
                        self._put_aside(error)
        raise AssertionError

    def _was_moved(self) -> bool:
        try:
            state = os.stat(self.path)
        except FileNotFoundError:
            return True
        return (state.st_dev, state.st_ino) != self._file

    def _open(self) -> None:
        with opened(self.path.parent) as folder, alone(folder):
            before, self._connection = self._connection, None
            rows = rescued(folder, before) if before is not None else []
            try:
                self._connection = open_checked(folder, self.path, self._counter)
            except DamagedError as error:
                self._connection = begin_anew(folder, self.path, error)
            self._note_file(folder)
            if rows:
                take_over(self._connection, rows)

    def _put_aside(self, error: DamagedError) -> None:
        """Begin anew with what can be read, unless another worker has done so."""
        if self._connection is not None and not self._was_moved():
            self._let_go()
            with opened(self.path.parent) as folder, alone(folder):
                if not self._was_moved():
                    self._connection = begin_anew(folder, self.path, error)
                    self._note_file(folder)

    def _note_file(self, folder: Folder) -> None:
        state = folder.state(NAME)
        assert state is not None
        self._file = (state.st_dev, state.st_ino)

    def _let_go(self) -> None:
        connection, self._connection = self._connection, None
        if connection is None:
            return
        if not self._was_moved():
            with suppress(sqlite3.Error):
                connection.close()
            return
        with suppress(OSError), opened(self.path.parent) as folder, alone(folder):
            close_moved(folder, connection)


def _as_bytes(content: object) -> bytes:
    return content if isinstance(content, bytes) else str(content).encode("utf-8", "surrogateescape")


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

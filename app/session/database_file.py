"""The file of the documents: opened with care, checked, mended, put aside when it is damaged."""

import logging
import os
import sqlite3
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from schuler_bench.http.ids import log_name
from schuler_bench.session import salvage, served
from schuler_bench.session.folder import OF_A_SESSION, Folder, temporary_name
from schuler_bench.session.salvage import NAME, PAGE_BYTES

_ENDINGS = ("-wal", "-shm", "-journal")
"""Of the files that SQLite keeps beside it."""
SCHEMA = 2
_BUSY_S = 5.0
_TABLES = f"""
CREATE TABLE IF NOT EXISTS document (
    id TEXT PRIMARY KEY,
    shared_by TEXT,
    used_s REAL NOT NULL,
    content BLOB NOT NULL,
    used_served REAL
) WITHOUT ROWID;
CREATE INDEX IF NOT EXISTS document_shared ON document (shared_by);
DROP INDEX IF EXISTS document_used;
CREATE TABLE IF NOT EXISTS aside (
    number INTEGER PRIMARY KEY,
    id,
    why TEXT NOT NULL,
    content,
    used_served REAL NOT NULL
);
CREATE INDEX IF NOT EXISTS aside_id ON aside (id);
{served.TABLES}
"""
_FOREIGN = (
    "typeof(id) <> 'text' OR length(id) NOT BETWEEN 1 AND 64 OR id GLOB '*[^A-Za-z0-9_-]*'"
    " OR length(CAST(id AS BLOB)) <> length(id) OR typeof(content) NOT IN ('blob', 'text')"
)
"""Rows that no session can have."""
_MENDS = (
    ("content that is text", "content = CAST(content AS BLOB)", "typeof(content) = 'text'"),
    (
        "foreign shared_by",
        "shared_by = ''",
        "shared_by IS NOT NULL AND (typeof(shared_by) <> 'text' OR shared_by GLOB '*[^A-Za-z0-9_-]*'"
        " OR length(CAST(shared_by AS BLOB)) <> length(shared_by))",
    ),
    ("time of use that is no number", "used_s = 0.0", "typeof(used_s) NOT IN ('real', 'integer')"),
    (
        "count of use that cannot be",
        "used_served = :served",
        "typeof(used_served) NOT IN ('real', 'integer') OR used_served NOT BETWEEN 0.0 AND :served",
    ),
)
"""What is wrong with a single column, the value that is put in its place, and how it is recognised."""
_OF_THE_MACHINE = {
    sqlite3.SQLITE_PERM,
    sqlite3.SQLITE_BUSY,
    sqlite3.SQLITE_LOCKED,
    sqlite3.SQLITE_NOMEM,
    sqlite3.SQLITE_READONLY,
    sqlite3.SQLITE_INTERRUPT,
    sqlite3.SQLITE_IOERR,
    sqlite3.SQLITE_FULL,
    sqlite3.SQLITE_CANTOPEN,
    sqlite3.SQLITE_PROTOCOL,
}
"""SQLite's errors that say nothing against the file; every other one of our statements does."""
_log = logging.getLogger("schuler.store")


class DamagedError(OSError):
    """The file is damaged, or was made by a newer version of this program.

    Parameters
    ----------
    why : str
    kind : str
        Of the name under which it is put aside: "broken" or "newer".
    """

    def __init__(self, why: str, kind: str = "broken") -> None:
        super().__init__(None, why)
        self.kind = kind


def open_checked(folder: Folder, path: Path, counter: served.Counter) -> sqlite3.Connection:
    """Open the file, made if need be, once all of it was looked at.

    Parameters
    ----------
    folder : Folder
        In which it lies.
    path : Path
        Of the file.
    counter : Counter
        Of the seconds served.

    Raises
    ------
    DamagedError
        It is damaged, or of a newer version.
    OSError
        There is something else of that name, or it cannot be used.
    """
    # SQLite would follow a link of that name, wait for ever at a FIFO, and remove what bears the others.
    os.close(folder.open(NAME, os.O_RDWR | os.O_CREAT))
    for name in (f"{NAME}{ending}" for ending in _ENDINGS):
        if folder.state(name) is not None and folder.file(name) is None:
            raise OSError(None, f"{name} is no file of ours")
    if salvage.log_is_broken(folder):
        raise DamagedError("its write-ahead log is broken in the middle")
    if salvage.head_is_broken(folder):
        raise DamagedError("its head is broken")
    connection = _connect(path)
    try:
        with as_os_error():
            check(connection)
            with connection:
                mend_rows(connection, counter.count(connection))
    except BaseException:
        with suppress(sqlite3.Error):
            connection.close()
        raise
    return connection


def _connect(path: Path) -> sqlite3.Connection:
    """Open the file with its tables, those of an older version brought up to date."""
    connection = sqlite3.connect(path, timeout=_BUSY_S, check_same_thread=False)
    try:
        with as_os_error():
            version = connection.execute("PRAGMA user_version").fetchone()[0]
            if version > SCHEMA:
                check(connection)
                raise DamagedError(f"it was made by a newer version of this program ({version})", "newer")
            connection.execute(f"PRAGMA page_size = {PAGE_BYTES}")
            connection.execute("PRAGMA journal_mode = WAL")
            connection.execute("PRAGMA synchronous = NORMAL")
            columns = [row[1] for row in connection.execute("PRAGMA table_info(document)")]
            if columns and "used_served" not in columns:
                connection.execute("ALTER TABLE document ADD COLUMN used_served REAL")
            connection.executescript(_TABLES)
            if version != SCHEMA:
                connection.execute(f"PRAGMA user_version = {SCHEMA}")
    except BaseException:
        with suppress(sqlite3.Error):
            connection.close()
        raise
    return connection


@contextmanager
def beside(path: Path) -> Iterator[sqlite3.Connection]:
    """Open the file a second time, to look at it without holding up those who use it."""
    connection = sqlite3.connect(f"{path.as_uri()}?mode=rw", timeout=_BUSY_S, uri=True)  # never made anew
    try:
        yield connection
    finally:
        connection.close()


def check(connection: sqlite3.Connection) -> None:
    """Raise DamagedError if the file is damaged anywhere."""
    found = [row[0] for row in connection.execute("PRAGMA integrity_check(1000)")]
    if not found or any(line != "ok" and not _is_of_a_row(line) for line in found):
        raise DamagedError("; ".join(" ".join(str(line).split()) for line in found)[:300])


def _is_of_a_row(line: str) -> bool:
    """Whether a complaint is about a single row, which is mended by itself."""
    return line.startswith(("NUMERIC value in", "TEXT value in", "NULL value in", "non-"))


def mend_rows(connection: sqlite3.Connection, now: float) -> None:
    """Put rows aside that no session can have, and give a fitting value to columns that hold none."""
    put = connection.execute(
        "INSERT INTO aside (id, why, content, used_served)"
        f" SELECT id, 'no row of a session', content, ? FROM document WHERE {_FOREIGN}",
        (now,),
    ).rowcount
    if put > 0:
        connection.execute(f"DELETE FROM document WHERE {_FOREIGN}")
        _log.warning("%s: put aside %d rows that no session can have (table aside)", NAME, put)
    for what, change, wrong in _MENDS:
        values = {"served": now} if ":served" in change else {}
        changed = connection.execute(f"UPDATE document SET {change} WHERE {wrong}", values).rowcount
        if changed > 0 and not values:
            _log.warning("%s: mended %d rows: %s", NAME, changed, what)


def begin_anew(folder: Folder, path: Path, error: DamagedError) -> sqlite3.Connection:
    """Put the file aside and open a new one, with the documents that can be read in the old one."""
    found, fresh = _readable(folder), temporary_name()
    try:
        made = _connect(path.with_name(fresh))
        try:
            with as_os_error(), made:
                _put(made, found)
            with as_os_error():
                made.execute("PRAGMA journal_mode = DELETE")  # one file, to be renamed
        finally:
            made.close()
        number = next(n for n in range(1, 1 << 30) if folder.state(f"sessions.{error.kind}-{n}") is None)
        aside = f"sessions.{error.kind}-{number}"
        with suppress(OSError):
            folder.link(NAME, folder, aside)
        if folder.state(aside) is None:  # no links on this file system
            folder.place(NAME, aside)
        for ending in ("-wal", "-journal"):
            if folder.file(NAME + ending) is not None:
                folder.place(NAME + ending, aside + ending)
        folder.discard(f"{NAME}-shm")
        folder.place(fresh, NAME)
    finally:
        for ending in ("", *_ENDINGS):
            folder.discard(fresh + ending)
    whole, nothing = sum(one.whole for one in found), sum(not one.content for one in found)
    _log.warning(
        "%s is put aside as %s (%s); %d documents of it are taken over, %d are in part only, %d are lost",
        NAME,
        aside,
        error.strerror,
        whole,
        len(found) - whole - nothing,
        nothing,
    )
    return _connect(path)


def _readable(folder: Folder) -> list[salvage.Found]:
    """Documents of the damaged file, and those of which only files beside it tell."""
    try:
        found = salvage.documents(folder)
    except Exception:  # whatever it holds: it is kept, and the work goes on
        _log.exception("no document can be read in the damaged file")
        found = []
    known = {one.id for one in found}
    named = {name.rpartition(".")[0] for name in folder.names() if OF_A_SESSION.fullmatch(name)}
    return found + [salvage.Found(id, None, 0.0, b"", False) for id in sorted(named - known)]


def _put(connection: sqlite3.Connection, found: Iterable[salvage.Found]) -> None:
    for one in found:
        if one.whole:
            connection.execute(
                "INSERT INTO document (id, shared_by, used_s, content) VALUES (?, ?, ?, ?)",
                (one.id, one.shared_by, one.used_s, one.content),
            )
        else:
            connection.execute(
                "INSERT INTO aside (id, why, content, used_served) VALUES (?, 'it is damaged', ?, 0.0)",
                (one.id, one.content or None),
            )
            _log.warning("the document of session %s is damaged, and put aside", log_name(one.id))


def rescued(folder: Folder, connection: sqlite3.Connection) -> list[tuple[object, ...]]:
    """Close a file that is no longer in its place.

    Returns
    -------
    list of tuple
        Its rows, if it was removed: as long as it is open, it can be read.
    """
    rows: list[tuple[object, ...]] = []
    if folder.state(NAME) is None:
        with suppress(sqlite3.Error):
            rows = connection.execute("SELECT id, shared_by, used_s, content FROM document").fetchall()
        with suppress(sqlite3.Error):
            connection.close()
        for ending in _ENDINGS:
            folder.discard(NAME + ending)
    else:
        close_moved(folder, connection)
    return rows


def take_over(connection: sqlite3.Connection, rows: list[tuple[object, ...]]) -> None:
    """Put rows of a file that was removed into the one that was made in its place."""
    with connection:
        connection.executemany(
            "INSERT OR IGNORE INTO document (id, shared_by, used_s, content) VALUES (?, ?, ?, ?)", rows
        )
    _log.warning("%s was removed, and is made again with the %d documents it held", NAME, len(rows))


def close_moved(folder: Folder, connection: sqlite3.Connection) -> None:
    """Close a file that is no longer in its place.

    SQLite removes, by their names, the files beside it: they belong to the one that is in its place now.
    """
    kept: dict[str, str] = {}
    for name in (f"{NAME}{ending}" for ending in _ENDINGS):
        with suppress(OSError):
            folder.link(name, folder, fresh := temporary_name())
            kept[name] = fresh
    with suppress(sqlite3.Error):
        connection.close()
    for name, fresh in kept.items():
        with suppress(OSError):
            folder.place(fresh, name)


@contextmanager
def as_os_error() -> Iterator[None]:
    """Raise an error of SQLite as Python's own: of the machine as OSError, of the file as DamagedError."""
    try:
        yield
    except UnicodeDecodeError as error:  # of a message of SQLite that quotes the noise
        raise DamagedError("it holds noise") from error
    except sqlite3.Error as error:
        code = getattr(error, "sqlite_errorcode", None)
        if code is None:  # of the module itself, such as that it is closed
            raise OSError(None, str(error)) from error
        if code & 0xFF in _OF_THE_MACHINE:
            raise OSError(None, str(error)) from error
        raise DamagedError(str(error)) from error


@contextmanager
def unless_of_the_machine() -> Iterator[None]:
    """Do what may be left out when the machine cannot do it, such as on a full disk."""
    try:
        yield
    except sqlite3.Error as error:
        if getattr(error, "sqlite_errorcode", 0) & 0xFF not in _OF_THE_MACHINE:
            raise

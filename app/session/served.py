"""Time in which a server has served: by it what is old is judged, for the clock of a machine may jump."""

import sqlite3
import time
from collections.abc import Iterable

TABLES = """
CREATE TABLE IF NOT EXISTS served (
    one INTEGER PRIMARY KEY CHECK (one = 1),
    seconds REAL NOT NULL,
    again REAL NOT NULL,
    counted_s REAL NOT NULL
);
CREATE TABLE IF NOT EXISTS unused (
    name TEXT PRIMARY KEY,
    since REAL NOT NULL
) WITHOUT ROWID;
"""
"""``seconds`` stands twice: noise in one of them must not make everything old."""
_MOST_S = 1e11


class Counter:
    """Counts the seconds served in a database, together with other processes on it.

    Each adds the time since anybody has counted last, by the machine's monotonic clock, which all of them
    share and nobody can set.
    """

    def __init__(self) -> None:
        self._counted_s = time.monotonic()

    def count(self, connection: sqlite3.Connection) -> float:
        """Seconds served so far, within a change of the database."""
        now = time.monotonic()
        row = connection.execute("SELECT seconds, again, counted_s FROM served").fetchone()
        plausible = [0.0]
        since = self._counted_s
        if row is not None:
            plausible = [s for s in row[:2] if isinstance(s, float) and 0.0 <= s < _MOST_S] or [0.0]
            if isinstance(row[2], float) and since <= row[2] <= now:
                since = row[2]
        seconds = min(plausible) + now - since
        self._counted_s = now
        connection.execute("INSERT OR REPLACE INTO served VALUES (1, ?, ?, ?)", (seconds, seconds, now))
        return seconds

    def unused_s(self, connection: sqlite3.Connection, names: Iterable[str]) -> dict[str, float]:
        """Of names that nobody uses: for how long that is so, in seconds served."""
        now, wanted = self.count(connection), set(names)
        rows = connection.execute("SELECT name, since FROM unused").fetchall()
        known = {
            name: since
            for name, since in rows
            if name in wanted and isinstance(since, float) and 0.0 <= since <= now
        }
        gone = [(name,) for name, _ in rows if name not in known]
        connection.executemany("DELETE FROM unused WHERE name = ?", gone)
        fresh = [(name, now) for name in wanted if name not in known]
        connection.executemany("INSERT OR REPLACE INTO unused VALUES (?, ?)", fresh)
        return {name: now - known.get(name, now) for name in wanted}

"""Whether the work of visitors is kept, and if not, why and what can be done."""

from __future__ import annotations

import errno
import logging
import sqlite3
import threading
from collections.abc import Callable
from dataclasses import dataclass

from navcore.foundation.text import Text
from schuler_bench.jobs.words import without_folders

_log = logging.getLogger("schuler.store")
_AGAIN = Text("Saving is tried again by itself.")
_ELSEWHERE = Text(
    "Make it writable, or set XDG_STATE_HOME to another folder and start the server again. {again}",
    again=_AGAIN,
)


@dataclass(frozen=True)
class NotKept:
    """Why work is not kept.

    Attributes
    ----------
    reason : str
        Without a place on the server.
    remedy : str
        What can be done; whole sentences.
    """

    reason: str
    remedy: str


NO_HOME = NotKept(
    Text("the user of the server has no home folder"),
    Text("Set XDG_STATE_HOME to a folder that can be written to; then start the server again."),
)
HELD = NotKept(
    Text("another server uses the same state folder"),
    Text(
        "End that server, or set XDG_STATE_HOME to another folder and start this one again. {again}",
        again=_AGAIN,
    ),
)
OF_PROGRAM = NotKept(Text("an error of this program"), Text("The log of the server says more."))
_REMEDIES = {
    errno.ENOSPC: Text("Make room on the disk. {again}", again=_AGAIN),
    errno.EDQUOT: Text("Make room on the disk. {again}", again=_AGAIN),
    errno.EROFS: _ELSEWHERE,
    errno.EACCES: _ELSEWHERE,
    errno.EPERM: _ELSEWHERE,
}
_LIKE = {
    sqlite3.SQLITE_FULL: errno.ENOSPC,
    sqlite3.SQLITE_READONLY: errno.EROFS,
    sqlite3.SQLITE_CANTOPEN: errno.EACCES,
    sqlite3.SQLITE_PERM: errno.EACCES,
}
"""The error of the system that an error of SQLite stands for."""


def not_kept(error: OSError, *, while_serving: bool = False) -> NotKept:
    """Say why something could not be written.

    Parameters
    ----------
    error : OSError
        Of the system, or of SQLite as `schuler_bench.session.database` passes it on.
    while_serving : bool
        It is tried again without a new start.
    """
    code = error.errno
    if isinstance(error.__cause__, sqlite3.Error):
        code = _LIKE.get(getattr(error.__cause__, "sqlite_errorcode", 0) & 0xFF)
    remedy = _REMEDIES.get(code or 0)
    if remedy is _ELSEWHERE and while_serving:
        remedy = Text("Let the user of the server write to its state folder. {again}", again=_AGAIN)
    if remedy is None:
        remedy = _AGAIN if while_serving else _ELSEWHERE
    words = error.strerror or str(error) or type(error).__name__
    if not isinstance(words, Text):
        words = Text("the state folder: {words}", words=without_folders(words))
    return NotKept(words, remedy)


@dataclass(frozen=True)
class SetAside:
    """What was kept of a session and cannot be read, or not wholly, by this version.

    Attributes
    ----------
    name : str
        For the file in which a browser saves it.
    why : str
        What is wrong with it.
    content : callable
        Gives it as it is; None when it is gone.
    """

    name: str
    why: str
    content: Callable[[], bytes | None]


class OwnKeeping:
    """Whether one session is kept, and what could not be read of what was.

    Parameters
    ----------
    tell : callable
        ``tell()`` lets the pages of the session say so anew.

    Attributes
    ----------
    server : Keeping
        Of all sessions.
    alone : NotKept or None
        Why this session alone is not kept.
    unreadable : str
        What could not be read of what was kept, in words; empty: nothing.
    aside : tuple of SetAside
        What was put aside because it could not be read, to be downloaded.
    """

    def __init__(self, tell: Callable[[], None]) -> None:
        self.tell, self.server = tell, Keeping()
        self.alone: NotKept | None = None
        self.unreadable, self.aside = "", tuple[SetAside, ...]()

    @property
    def fault(self) -> NotKept | None:
        """Why the work is not kept at present; None: it is."""
        return self.alone or self.server.fault

    def becomes(self, alone: NotKept | None) -> None:
        """Take note why this session alone is not kept, or (None) that it is."""
        if alone != self.alone:
            self.alone = alone
            self.tell()


class Keeping:
    """Whether a server keeps anything at present.

    Attributes
    ----------
    fault : NotKept or None
        Why nothing is kept; None: all is well.
    """

    def __init__(self) -> None:
        self.fault: NotKept | None = None
        self._lock = threading.Lock()
        self._watchers: list[Callable[[NotKept | None], None]] = []

    def watch(self, told: Callable[[NotKept | None], None]) -> None:
        """Call ``told(fault)`` after every change from now on, and now if there is a fault already."""
        with self._lock:
            self._watchers.append(told)
            fault = self.fault
        if fault is not None:
            told(fault)

    def becomes(self, fault: NotKept | None) -> None:
        """Take note that nothing is kept, or that all is well; with a line in the log if that is new."""
        with self._lock:
            if fault == self.fault:
                return
            self.fault = fault
            watchers = list(self._watchers)
        if fault is None:
            _log.warning("sessions are kept again")
        else:
            _log.warning("sessions are not kept: %s. %s", fault.reason, fault.remedy)
        for told in watchers:
            try:
                told(fault)
            except Exception:  # whoever cannot hear it must not stop the saving
                _log.exception("somebody could not be told whether sessions are kept")

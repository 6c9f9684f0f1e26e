"""The thread that saves: what is due is written soon after a change, again after a failure, and cleaned."""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

from navcore.foundation.text import Text
from schuler_bench.session.keeping import OF_PROGRAM, Keeping, NotKept, not_kept

WRITE_AFTER_S = 0.5
"""Between a change and the file: changes that follow each other are written once."""
AGAIN_AFTER_S = 10.0
"""Between two tries of what could not be written."""
_UPKEEP_EVERY_S = 600.0
_OF_ITS_OWN = Text("Download the scenario and open it in a new session. Other sessions are kept.")
_log = logging.getLogger("schuler.store")

Make = Callable[[], dict[str, Any]]
Told = Callable[[NotKept | None], None]


class UnfitError(OSError):
    """A single document that cannot be kept, whatever is tried; all others can."""


@dataclass(frozen=True)
class Due:
    """A document that is to be written.

    Attributes
    ----------
    at_s : float
        When, monotonic.
    make : callable
        Gives the document.
    told : callable
        Told why this one is not kept, or (None) that it is.
    """

    at_s: float
    make: Make
    told: Told


class Saving:
    """Writes documents in a thread of its own, which outlives every failure.

    Parameters
    ----------
    write : callable
        ``write(id, document)``; raises OSError when nothing can be written, `UnfitError` when this cannot.
    upkeep : callable
        Cleans, now and then.
    keeping : Keeping
        Told whether writing works.
    """

    def __init__(
        self, write: Callable[[str, dict[str, Any]], None], upkeep: Callable[[], None], keeping: Keeping
    ) -> None:
        self._write, self._upkeep, self._keeping = write, upkeep, keeping
        self._changed = threading.Condition()
        self._due: dict[str, Due] = {}
        self._writing = 0
        self._closed = False
        self.upkeep_s = 0.0
        """When the next upkeep is due, monotonic."""
        self._thread = threading.Thread(target=self._loop, name="store", daemon=True)
        self._thread.start()

    def soon(self, id: str, make: Make, told: Told = lambda _: None) -> None:
        """Let a document be made and written in a moment; the first request sets the time.

        Parameters
        ----------
        id, make, told
            See `Due`.
        """
        with self._changed:
            if self._closed:
                return
            at_s, before = time.monotonic() + WRITE_AFTER_S, self._due.get(id)
            self._due[id] = Due(at_s if before is None else min(at_s, before.at_s), make, told)
            self._changed.notify_all()

    def waiting(self, id: str) -> Make | None:
        """What gives the document of that id that is not written yet, if there is one."""
        with self._changed:
            due = self._due.get(id)
            return None if due is None else due.make

    def flush(self, timeout_s: float = 5.0) -> bool:
        """Write at once what waits; False if that takes longer. What cannot be written goes on waiting."""
        with self._changed:
            self._due = {id: replace(due, at_s=0.0) for id, due in self._due.items()}
            self._changed.notify_all()
            return self._changed.wait_for(lambda: not self._ready() and not self._writing, timeout_s)

    def close(self) -> None:
        """Write what waits and end the thread."""
        self.flush()
        with self._changed:
            self._closed = True
            self._changed.notify_all()
        self._thread.join(1.0)

    def _loop(self) -> None:
        while not self._closed:
            if time.monotonic() >= self.upkeep_s:
                self._clean()
                self.upkeep_s = time.monotonic() + _UPKEEP_EVERY_S
            with self._changed:
                while not self._closed and not self._ready() and time.monotonic() < self.upkeep_s:
                    dues = [self.upkeep_s, *(due.at_s for due in self._due.values())]
                    self._changed.wait(max(0.0, min(dues) - time.monotonic()))
                ready = {} if self._closed else {id: self._due.pop(id) for id in self._ready()}
                self._writing += 1
            try:
                for id, due in ready.items():
                    self._try(id, due)
            finally:
                with self._changed:
                    self._writing -= 1
                    self._changed.notify_all()

    def _ready(self) -> list[str]:
        now = time.monotonic()
        return [id for id, due in self._due.items() if due.at_s <= now]

    def _clean(self) -> None:
        try:
            self._upkeep()
        except OSError as error:
            _log.warning("old sessions cannot be removed: %s", error.strerror or error)
        except Exception:  # nothing that lies in the folder may end the saving
            _log.exception("old sessions cannot be removed")

    def _try(self, id: str, due: Due) -> None:
        fault = None
        try:
            self._write(id, due.make())
            self._keeping.becomes(None)
        except UnfitError as error:
            fault = NotKept(error.strerror or str(error), _OF_ITS_OWN)
        except OSError as error:
            with self._changed:  # of one that has changed again, the newest
                self._due.setdefault(id, replace(due, at_s=time.monotonic() + AGAIN_AFTER_S))
            self._keeping.becomes(not_kept(error, while_serving=True))
        except Exception:  # the thread must outlive a document that cannot be made
            _log.exception("a session cannot be kept")
            fault = OF_PROGRAM
        try:
            due.told(fault)
        except Exception:
            _log.exception("a session could not be told whether it is kept")

"""The sessions of all visitors, by id: kept over reloads, and over restarts as far as there is a `Store`."""

from __future__ import annotations

import atexit
import logging
import shutil
import tempfile
import threading
from collections import OrderedDict
from collections.abc import Callable
from functools import partial
from pathlib import Path

from app.http.ids import copied_from, log_name, new_shared_id
from app.session.content import link_files
from app.session.document import Document, Unreadable, restore, to_document
from app.session.session import Session
from app.session.store import Store
from navcore.engine.run import Run
from navcore.scenario.model import Scenario

MOST_SESSIONS = 64
"""Sessions held without an open page; with one they are always held."""
MOST_IDLE_RUNS = 8
"""Runs kept of sessions without an open page; the others are computed again on return."""
MOST_SHARED = 64
"""States that can be shared when there is no store to put them in."""
FIRST_PRESET = "sikuliaq-like"
_log = logging.getLogger("schuler.sessions")


class Sessions:
    """All sessions by id; without an open page the least recently used ones are dropped.

    Parameters
    ----------
    first : callable, optional
        Gives the scenario and the name to begin with.
    store : Store, optional
        Where they outlive the server; without one a dropped session begins anew.
    on_answer : callable, optional
        ``on_answer(seconds)`` after every run that is shown.
    """

    def __init__(
        self,
        first: Callable[[], tuple[Scenario, str]] | None = None,
        store: Store | None = None,
        on_answer: Callable[[float], None] = lambda _: None,
    ) -> None:
        self._first, self._store, self._on_answer = first or first_scenario, store, on_answer
        self._lock = threading.Lock()
        self._by_id: OrderedDict[str, Session] = OrderedDict()
        self._made: dict[str, threading.Lock] = {}
        self._shared: OrderedDict[str, Document] = OrderedDict()
        self._folder: Path | None = None
        self.prepared: Run | None = None
        """Run of the scenario that a new visitor sees; its first picture need not wait for it."""
        atexit.register(self.close)

    def get(self, id: str) -> Session:
        """Return the session with that id: as it was left, a copy of a shared state, or new."""
        with self._lock:
            session = self._held(id)
            making = self._made.setdefault(id, threading.Lock())
        # Reading files takes its time: other visitors need not wait.
        with making:
            with self._lock:
                session = self._held(id)
            made = self._make(id) if session is None else session
            with self._lock:
                self._made.pop(id, None)
                self._by_id[id] = made
                self._by_id.move_to_end(id)
                self._trim(keep=made)
                return made

    def knows(self, id: str) -> bool:
        """Whether there is a session with that id already, held or kept."""
        with self._lock:
            held = id in self._by_id or id in self._shared
        return held or (self._store is not None and self._store.has(id))

    @property
    def names_with_pages(self) -> set[str]:
        """Names (`app.http.ids.log_name`) of the sessions that are open in a browser."""
        with self._lock:
            return {log_name(id) for id, session in self._by_id.items() if session.open_pages}

    def figures(self) -> dict[str, float]:
        """What is held and kept, for ``/metrics``."""
        with self._lock:
            held = {"sessions_held": float(len(self._by_id))}
        if self._store is not None:
            held |= self._store.database.figures() | {"upload_bytes": float(self._store.contents.bytes())}
        return held

    def __len__(self) -> int:
        return len(self._by_id)

    def close(self) -> None:
        """End all sessions; those in a store are written, the files of others removed."""
        if self._store is not None:
            self._store.close()
        with self._lock:
            for session in self._by_id.values():
                session.close(keep_files=self._store is not None)
            self._by_id.clear()
            if self._folder is not None:
                shutil.rmtree(self._folder, ignore_errors=True)
                self._folder = None
        atexit.unregister(self.close)

    # ------------------------------------------------------------ beginning

    def _held(self, id: str) -> Session | None:
        return self._by_id.get(id)

    def _make(self, id: str) -> Session:
        scenario, origin = self._first()
        session = Session(id, scenario, origin, self._files_folder(id))
        session.prepared = self.prepared
        document, source = self._kept(id), id
        shared = copied_from(id)
        if document is None and shared is not None:
            document, source = self._kept(shared), shared
        if document is not None:
            self._fill(session, document, source)
        if self._store is not None:
            session.uploads.has_room = self._store.has_room
            session.uploads.keep_once = self._store.contents.keep_once
        session.on_answer = self._on_answer
        session.on_change = partial(self._changed, session)
        session.share = partial(self._share, session)
        return session

    def _kept(self, id: str) -> Document | None:
        return self._shared.get(id) if self._store is None else self._store.read(id)

    def _fill(self, session: Session, document: Document, source: str) -> None:
        try:
            if source != session.id:
                link_files(self._files_folder(source), session.uploads.folder)
            if session.uploads.folder.is_dir():
                session.uploads.reopen()
            restore(session, document)
        except (*Unreadable, OSError) as error:
            _log.warning("a kept session begins anew: %s: %.200s", type(error).__name__, error)

    # ------------------------------------------------------------ keeping

    def _changed(self, session: Session) -> None:
        if self._store is not None:
            self._store.soon(session.id, partial(to_document, session), session.not_kept)

    def _share(self, session: Session) -> str:
        id = new_shared_id()
        document = to_document(session, whole=False) | {"id": id}
        if self._store is not None:
            self._store.share(session.id, id, document)
            return id
        link_files(session.uploads.folder, self._files_folder(id))
        with self._lock:
            self._shared[id] = document
            while len(self._shared) > MOST_SHARED:
                old, _ = self._shared.popitem(last=False)
                shutil.rmtree(self._files_folder(old), ignore_errors=True)
        return id

    def _files_folder(self, id: str) -> Path:
        if self._store is not None:
            return self._store.files_folder(id)
        if self._folder is None:
            self._folder = Path(tempfile.mkdtemp(prefix="schuler-uploads-"))
        return self._folder / id

    def forget_idle(self) -> None:
        """Drop the runs, and the sessions, that are more than are held without an open page."""
        with self._lock:
            self._trim()

    def _trim(self, keep: Session | None = None) -> None:
        idle = [s for s in self._by_id.values() if s is not keep and s.open_pages == 0]
        for session in idle[: max(0, len(idle) - MOST_SESSIONS)]:
            del self._by_id[session.id]
            session.close(keep_files=self._store is not None)
        for session in idle[: max(0, len(idle) - MOST_IDLE_RUNS)]:
            session.run = None
            session.verifier.forget()


def first_scenario() -> tuple[Scenario, str]:
    """Preset that a new visitor sees."""
    from navcore.scenario.file import load, presets

    names = list(presets())
    name = FIRST_PRESET if FIRST_PRESET in names else next(iter(names), "")
    return (load(name), name) if name else (Scenario(), "")

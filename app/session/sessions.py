"""The sessions of all visitors, by id: kept over reloads, and over restarts as far as there is a `Store`."""

import atexit
import logging
import shutil
import tempfile
import threading
from collections import OrderedDict
from collections.abc import Callable
from functools import partial
from pathlib import Path
from weakref import WeakSet

from navcore.engine.run import Run
from navcore.foundation.stage_cache import bytes_of
from navcore.foundation.text import Text
from navcore.scenario.model import Scenario
from schuler_bench.http.ids import copied_from, log_name, new_shared_id, shared_in
from schuler_bench.session.classroom import Classroom
from schuler_bench.session.document import (
    BROKEN,
    IN_PART,
    Document,
    ReadingError,
    pins_of,
    restore,
    to_document,
)
from schuler_bench.session.folder import link_files, remove_files
from schuler_bench.session.keeping import Keeping, NotKept, SetAside
from schuler_bench.session.kept_study import keep_study
from schuler_bench.session.session import Session
from schuler_bench.session.store import Store, UnreadableError
from schuler_bench.session.studying import study_name

MOST_SESSIONS = 64
"""Sessions held without an open page; with one they are always held."""
MOST_IDLE_RUNS = 8
"""Runs kept of sessions without an open page; the others are computed again on return."""
MOST_IDLE_BYTES = 64 << 20
"""Bytes that these runs may take together, the newest first."""
MOST_SHARED = 64
"""States that can be shared when there is no store to put them in."""
FIRST_PRESET = "sikuliaq-like"
NOT_READ = NotKept(
    Text("the kept session cannot be read at present"),
    Text("What is kept stays as it is. Close this page and open the address again later."),
)
LOST = Text("What was kept of this session is lost: the database of the server was damaged. It begins anew.")
LOST_IN_PART = Text(
    "Only a part of what was kept of this session is left: the database of the server was damaged. It begins "
    "anew."
)
EARLIER = Text("it was kept before, when nothing could be read here")
EARLIER_TOLD = Text(
    "This session was kept earlier, which this server could not read when it started. What was kept then is "
    "put aside, untouched; what is shown here is kept from now on."
)
_ANEW = Text("It begins anew; what was kept is put aside, untouched.")
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
    keeping : Keeping, optional
        Whether anything is kept at present.
    classroom : Classroom, optional
        The class that the visitors form.
    """

    def __init__(
        self,
        first: Callable[[], tuple[Scenario, str]] | None = None,
        store: Store | None = None,
        on_answer: Callable[[float], None] = lambda _: None,
        keeping: Keeping | None = None,
        classroom: Classroom | None = None,
    ) -> None:
        self._first, self._store, self._on_answer = first or first_scenario, store, on_answer
        self._keeping, self._classroom = keeping or Keeping(), classroom
        self._lock = threading.Lock()
        self._by_id: OrderedDict[str, Session] = OrderedDict()
        self._opening: dict[str, threading.Lock] = {}
        self._shared: OrderedDict[str, Document] = OrderedDict()
        self._folder: Path | None = None
        self._without_store = WeakSet[Session]()
        self.prepared: Run | None = None
        """Run of the scenario that a new visitor sees; its first picture need not wait for it."""
        atexit.register(self.close)
        self._keeping.watch(self._tell_kept)

    def get(self, id: str) -> Session:
        """Return the session with that id: as it was left, a copy of a shared state, or new."""
        with self._lock:
            session = self._by_id.get(id)
            making = self._opening.setdefault(id, threading.Lock())
        # Reading files takes its time: other visitors need not wait.
        with making:
            with self._lock:
                session = self._by_id.get(id)
            if session is not None and session.keeping.alone is NOT_READ and not session.open_pages:
                session = None  # perhaps it can be read now
            opened = self._make(id) if session is None else session
            with self._lock:
                self._opening.pop(id, None)
                self._by_id[id] = opened
                self._by_id.move_to_end(id)
                self._trim(keep=opened)
                late = self._store is not None and opened in self._without_store
            if late:  # the store came while it was made
                self._keep_late(opened)
            return opened

    def knows(self, id: str) -> bool:
        """Whether there is a session with that id already, held or kept."""
        with self._lock:
            held = id in self._by_id or id in self._shared
        return held or (self._store is not None and self._store.has(id))

    @property
    def names_with_pages(self) -> set[str]:
        """Names (`schuler_bench.http.ids.log_name`) of the sessions that are open in a browser."""
        with self._lock:
            return {log_name(id) for id, session in self._by_id.items() if session.open_pages}

    def figures(self) -> dict[str, float]:
        """Numbers of sessions and bytes that are kept, for ``/metrics``."""
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

    def _make(self, id: str) -> Session:
        scenario, origin = self._first()
        session = Session(id, scenario, origin, self._files_folder(id))
        session.prepared, session.keeping.server = self.prepared, self._keeping
        session.classroom = self._classroom
        session.on_change = partial(self._changed, session)
        shared = copied_from(id)
        try:
            if not self._fill(session, id) and shared is not None:
                self._fill(session, shared)
        except OSError as error:
            _log.warning("session %s cannot be read at present: %s", log_name(id), error.strerror or error)
            session.keeping.becomes(NOT_READ)
            session.on_change = lambda: None  # it would be written over
        if self._store is None:
            self._without_store.add(session)
        else:
            session.uploads.has_room = self._store.has_room
            session.uploads.keep_once = self._store.contents.keep_once
            keep_study(session.searches.asking["study"], self._store.study_folder(id), study_name(session))
        session.on_answer = self._on_answer
        session.share = partial(self._share, session)
        session.shared_pins = partial(self._shared_pins, session)
        return session

    def _kept(self, id: str) -> Document | None:
        return self._shared.get(id) if self._store is None else self._store.read(id)

    def _fill(self, session: Session, source: str) -> bool:
        """Put into a new session what is kept under an id; False when there is nothing.

        What cannot be read is put aside, and the session says so.

        Raises
        ------
        OSError
            It cannot be read, or put aside, at present.
        """
        try:
            document = self._kept(source)
            if document is None:
                if self._show_aside(session, source):
                    offered = session.keeping.aside
                    session.keeping.unreadable = LOST_IN_PART if offered else LOST
                return False
            if source != session.id:
                link_files(self._files_folder(source), session.uploads.folder)
            if session.uploads.folder.is_dir():
                session.uploads.reopen()
            left = restore(session, document)
            if left:
                why, told = IN_PART, Text("Left out: {parts}.", parts=Text.joined(", ", left))
                self._put_aside(session, source, why, told)
        except UnreadableError as error:
            _log.warning("a kept session begins anew: %s", error)
            self._put_aside(session, source, BROKEN, _ANEW)
        except ReadingError as error:
            _log.warning("a kept session begins anew: %s", error)
            self._put_aside(session, source, error.why, _ANEW)
        self._show_aside(session, source)
        return True

    def _put_aside(self, session: Session, source: str, why: str, told: str) -> None:
        if self._store is None:
            return
        self._store.database.put_aside(source, str(why))
        session.keeping.unreadable = Text(
            "This session could not be opened as it was kept: {why}. {told}", why=why, told=told
        )

    def _show_aside(self, session: Session, source: str) -> bool:
        """Offer what was put aside of a session to its page; whether there is anything, if only its loss."""
        if self._store is None:
            return False
        database = self._store.database
        asides = database.asides(source)
        session.keeping.aside += tuple(
            SetAside(f"session-{one.number}.json", one.why, partial(database.aside, source, one.number))
            for one in asides
            if one.left
        )
        return bool(asides)

    # ------------------------------------------------------------ keeping

    def _changed(self, session: Session) -> None:
        if self._store is not None:
            self._store.saving.soon(session.id, partial(self._document, session), session.keeping.becomes)

    def _document(self, session: Session, *, whole: bool = True) -> Document:
        """Document of a session whose files lie where they are kept."""
        kept = self._files_folder(session.id)
        if session.uploads.folder != kept:  # it began before there was a store
            link_files(session.uploads.folder, kept)
        return to_document(session, whole=whole)

    def keep_in(self, store: Store) -> None:
        """Keep in a store, which was not to be had at the start, all that is held, from now on."""
        with self._lock:
            self._store = store
            held, shared = list(self._by_id.values()), dict(self._shared)
        for id, document in shared.items():
            try:
                if self._folder is not None:
                    link_files(self._folder / id, store.files_folder(id))
                store.write(id, document, shared_by="")
            except OSError as error:
                _log.warning("a shared state cannot be kept: %s", error.strerror or error)
        for session in held:
            if session in self._without_store:
                self._keep_late(session)

    def _keep_late(self, session: Session) -> None:
        """Keep a session that began without a store; what the store has of it already is put aside."""
        store = self._store
        assert store is not None
        self._without_store.discard(session)
        if not session.open_pages and len(session.history.steps) == 1 and not session.uploads.files:
            with self._lock:  # nothing was done in it: it is opened anew, as it was kept
                if self._by_id.get(session.id) is session:
                    del self._by_id[session.id]
            session.close()
            return
        try:
            if store.has(session.id):
                store.database.put_aside(session.id, str(EARLIER))
                session.keeping.unreadable = EARLIER_TOLD
                self._show_aside(session, session.id)
        except OSError as error:
            _log.warning("session %s cannot be kept: %s", log_name(session.id), error.strerror or error)
            session.keeping.becomes(NOT_READ)
            session.on_change = lambda: None  # what is there would be written over
            return
        session.uploads.has_room = store.has_room
        if not store.study_folder(session.id).is_dir():
            keep_study(session.searches.asking["study"], store.study_folder(session.id), study_name(session))
        self._changed(session)
        session.keeping.tell()

    def _tell_kept(self, _: NotKept | None) -> None:
        with self._lock:
            sessions = list(self._by_id.values())
        for session in sessions:
            session.keeping.tell()

    def _share(self, session: Session) -> str:
        id = new_shared_id()
        document = self._document(session, whole=False) | {"id": id}
        if self._store is not None:
            self._store.share(session.id, id, document)
            return id
        link_files(session.uploads.folder, self._files_folder(id))
        with self._lock:
            self._shared[id] = document
            while len(self._shared) > MOST_SHARED:
                old, _ = self._shared.popitem(last=False)
                remove_files(self._files_folder(old))
        return id

    def _shared_pins(self, session: Session, address: str) -> list[Document] | None:
        id = shared_in(address)
        try:
            document = None if id is None else self._kept(id)
            return None if document is None else pins_of(session, document)
        except (UnreadableError, OSError) as error:
            _log.warning("a shared state cannot be read: %s", error)
            return None

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
        left, room = MOST_IDLE_RUNS, MOST_IDLE_BYTES
        for session in reversed(idle):
            left, room = left - 1, room - (0 if session.run is None else bytes_of(session.run))
            if left < 0 or room < 0:
                session.run = None
                if not session.expected:
                    session.verifier.forget()


def first_scenario() -> tuple[Scenario, str]:
    """Preset that a new visitor sees."""
    from navcore.scenario.file import load, presets

    names = list(presets())
    name = FIRST_PRESET if FIRST_PRESET in names else next(iter(names), "")
    return (load(name), name) if name else (Scenario(), "")

"""The sessions of all visitors, by id: kept over reloads, and over restarts as far as there is a `Store`."""

import atexit
import logging
import shutil
import tempfile
import threading
from collections import OrderedDict
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import Any, TypeVar
from weakref import WeakKeyDictionary

from pydantic import ValidationError

from navcore.engine.run import Run
from navcore.foundation.errors import InputError
from navcore.scenario.model import Scenario
from schuler_bench.http.ids import copied_from, log_name, new_shared_id, shared_in
from schuler_bench.session.display import Display
from schuler_bench.session.folder import link_files, remove_files
from schuler_bench.session.history import History, State
from schuler_bench.session.session import Session
from schuler_bench.session.store import Store
from schuler_bench.session.studying import LARGEST_TEXT
from schuler_bench.session.uploads import plain_names, shared_files

MOST_SESSIONS = 64
"""Sessions held without an open page; with one they are always held."""
MOST_IDLE_RUNS = 8
"""Runs kept of sessions without an open page; the others are computed again on return."""
MOST_SHARED = 64
"""States that can be shared when there is no store to put them in."""
FIRST_PRESET = "sikuliaq-like"
_log = logging.getLogger("schuler.sessions")
_document_log = logging.getLogger("schuler.document")
SCHEMA = 1
STEPS_BACK, STEPS_FORWARD = 50, 20
"""Steps of the history that are kept."""
_LONGEST_NAME = 60

Document = dict[str, Any]
T = TypeVar("T")
_numbered: WeakKeyDictionary[Session, dict[int, tuple[Scenario, Document]]] = WeakKeyDictionary()
"""Content of each session's last document: scenarios by their identity, as they are written."""
Unreadable = (InputError, ValidationError, ValueError, TypeError, KeyError, IndexError, AttributeError)
"""Errors that reading a document of strange content raises."""


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
        self._opening: dict[str, threading.Lock] = {}
        self._shared: OrderedDict[str, Document] = OrderedDict()
        self._folder: Path | None = None
        self.prepared: Run | None = None
        """Run of the scenario that a new visitor sees; its first picture need not wait for it."""
        atexit.register(self.close)

    def get(self, id: str) -> Session:
        """Return the session with that id: as it was left, a copy of a shared state, or new."""
        with self._lock:
            session = self._by_id.get(id)
            making = self._opening.setdefault(id, threading.Lock())
        # Reading files takes its time: other visitors need not wait.
        with making:
            with self._lock:
                session = self._by_id.get(id)
            opened = self._make(id) if session is None else session
            with self._lock:
                self._opening.pop(id, None)
                self._by_id[id] = opened
                self._by_id.move_to_end(id)
                self._trim(keep=opened)
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
        session.shared_pins = partial(self._shared_pins, session)
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
                remove_files(self._files_folder(old))
        return id

    def _shared_pins(self, session: Session, address: str) -> list[Document] | None:
        id = shared_in(address)
        document = None if id is None else self._kept(id)
        return None if document is None else _pins(session, document)

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


# ------------------------------------------------------------ documents


def to_document(session: Session, *, whole: bool = True) -> Document:
    """Everything of a session that is kept.

    Parameters
    ----------
    session : Session
        Stays as it is; it is locked meanwhile.
    whole : bool
        With the history; a copy for others has none.

    Returns
    -------
    dict
        Plain values. Recordings are named, by their names alone.
    """
    with session.lock:
        steps, at = tuple(session.history.steps), session.history.at
        display, pins = session.display, session.pins.to_json()
        files, shown = list(session.uploads.files), session.pins.all
        state, study = session.state, session.study_file
    if not whole:
        steps, at = ((state, ""),), 0
    first = max(0, at - STEPS_BACK)
    kept = steps[first : at + STEPS_FORWARD + 1]
    scenarios = _Scenarios(_numbered.get(session, {}))
    baseline = next((index for index, pin in enumerate(shown, start=1) if pin.id == display.baseline), None)
    listed = [_step(one, name, scenarios) for one, name in kept]
    if whole:
        _numbered[session] = scenarios.numbered
    return {
        "schema": SCHEMA,
        "id": session.id,
        "at": at - first,
        "steps": listed,
        "scenarios": [document for _, document in scenarios.numbered.values()],
        "display": display.model_dump(mode="json") | {"baseline": baseline},
        "pins": [pin | {"scenario": plain_names(pin["scenario"])} for pin in pins],
        "files": files,
        "study": [*study],
    }


class _Scenarios:
    """Scenarios of a document, each once, in the order in which they are first met.

    Parameters
    ----------
    before : dict
        What the document before held: a session is written after every change, most of it as it was.
    """

    def __init__(self, before: dict[int, tuple[Scenario, Document]]) -> None:
        self._before = before
        self.numbered: dict[int, tuple[Scenario, Document]] = {}
        self._numbers: dict[int, int] = {}

    def number(self, scenario: Scenario) -> int:
        key = id(scenario)
        if key not in self.numbered:
            known, document = self._before.get(key, (None, {}))
            if known is not scenario:
                document = plain_names(scenario.canonical())
            self.numbered[key] = scenario, document
        return self._numbers.setdefault(key, len(self._numbers))


def _step(state: State, name: str, scenarios: _Scenarios) -> Document:
    document = {"scenario": scenarios.number(state.scenario), "opened": scenarios.number(state.opened)}
    return document | {"origin": state.origin, "selected": state.selected} | ({"name": name} if name else {})


def restore(session: Session, document: Document) -> None:
    """Put what a document holds into a new session, whose uploaded files are there already.

    Raises
    ------
    InputError, ValueError, TypeError, KeyError ...
        `Unreadable`: the present state cannot be read; the session stays as it is. Anything else that cannot
        be read is left out, with a line in the log.
    """
    if document["schema"] != SCHEMA:
        raise ValueError(f"schema {document['schema']!r}, not {SCHEMA}")
    names = _recordings(session)
    steps, at = list(document["steps"]), int(document["at"])
    scenarios: dict[int, Scenario] = {}

    def state(step: Document) -> State:
        pair = []
        for number in (int(step["scenario"]), int(step["opened"])):
            if number not in scenarios:
                scenarios[number] = _scenario(document["scenarios"][number], names)
            pair.append(scenarios[number])
        selected = min(max(int(step["selected"]), 0), len(pair[0].method) - 1)
        return State(pair[0], str(step["origin"])[:_LONGEST_NAME], selected, pair[1])

    def part(name: str, read: Callable[[], T], otherwise: T) -> T:
        """Read a part that the session can do without."""
        try:
            return read()
        except Unreadable as error:
            _document_log.warning("the %s of a kept session cannot be read: %s", name, _line(error))
            return otherwise

    def history() -> History:
        return History.of([(state(step), str(step.get("name", ""))[:200]) for step in steps], at)

    def study() -> tuple[str, str]:
        name, text = document.get("study", ("", ""))
        return str(name)[:_LONGEST_NAME], str(text)[:LARGEST_TEXT]

    present = state(steps[at])
    session.resume(
        part("history", history, History(present)),
        part(
            "display",
            lambda: Display.model_validate(document["display"]),
            Display(),
        ),
    )
    part("pins", lambda: session.pins.from_json(_pins(session, document)), None)
    session.study_file = part("study", study, ("", ""))


def _pins(session: Session, document: Document) -> list[Document]:
    """Pins of a document, their recordings those of the session."""
    names = _recordings(session)
    return [pin | {"scenario": _scenario(pin["scenario"], names).canonical()} for pin in document["pins"]]


def _recordings(session: Session) -> dict[str, Path]:
    return {name: upload.path for name, upload in session.uploads.files.items()}


def _scenario(data: Any, names: Mapping[str, Path]) -> Scenario:
    return shared_files(Scenario.parse(data), names)


def _line(error: BaseException) -> str:
    return f"{type(error).__name__}: {str(error).splitlines()[0] if str(error) else ''}"[:200]

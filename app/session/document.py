"""Documents: what is kept of a session, as plain values, and how a session is made from it again."""

import logging
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, TypeVar
from weakref import WeakKeyDictionary

from navcore.foundation.text import Text
from navcore.scenario.model import Scenario
from schuler_bench.session.display import Display
from schuler_bench.session.history import History, State
from schuler_bench.session.session import Session
from schuler_bench.session.studying import LARGEST_TEXT
from schuler_bench.session.uploads import plain_names, shared_files

SCHEMA = 1
STEPS_BACK, STEPS_FORWARD = 50, 20
"""Steps of the history that are kept."""
BROKEN = Text("it is damaged")
OTHER_VERSION = Text("it was written by another version of this program")
NO_SCENARIO = Text("its scenario cannot be read by this version")
IN_PART = Text("a part of it cannot be read")
"""Why a document was put aside."""
_LONGEST_NAME = 60
_PARTS = {"schema", "id", "at", "steps", "scenarios", "display", "pins", "files", "study"}
_PARTS_OF_A_STEP = {"scenario", "opened", "origin", "selected", "name"}
_log = logging.getLogger("schuler.document")

Document = dict[str, Any]
T = TypeVar("T")
_numbered: WeakKeyDictionary[Session, dict[int, tuple[Scenario, Document]]] = WeakKeyDictionary()
"""Content of each session's last document: scenarios by their identity, as they are written."""


class ReadingError(ValueError):
    """A document from which no session can be made.

    Parameters
    ----------
    why : str
        For a page.
    detail : str
        For the log.
    """

    def __init__(self, why: str, detail: str) -> None:
        super().__init__(f"{why}: {detail}")
        self.why = why


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


def restore(session: Session, document: Document) -> list[str]:
    """Put what a document holds into a new session, whose uploaded files are there already.

    Returns
    -------
    list of str
        Parts that cannot be read and are left out, or that this version does not know.

    Raises
    ------
    ReadingError
        The present state cannot be read; the session stays as it is.
    """
    left: list[str] = []

    def part(name: str, read: Callable[[], T], otherwise: T) -> T:
        """Read a part that the session can do without."""
        try:
            return read()
        except Exception as error:  # it may hold anything
            _log.warning("the %s of a kept session cannot be read: %s", name, _line(error))
            left.append(name)
            return otherwise

    if document.get("schema") != SCHEMA:
        raise ReadingError(OTHER_VERSION, f"schema {document.get('schema')!r:.20}, not {SCHEMA}")
    names = _recordings(session)
    try:
        steps, at = list(document["steps"]), _index(document["at"])
        states = _States(document["scenarios"], names)
        present = states.read(steps[at])
    except Exception as error:
        raise ReadingError(NO_SCENARIO, _line(error)) from error

    def history() -> History:
        return History.of([(states.read(step), str(step.get("name", ""))[:200]) for step in steps], at)

    def study() -> tuple[str, str]:
        name, text = document.get("study", ("", ""))
        return str(name)[:_LONGEST_NAME], str(text)[:LARGEST_TEXT]

    session.resume(
        part(Text("history"), history, History(present)),
        part(Text("display"), lambda: Display.model_validate(document["display"]), Display()),
    )
    part(Text("pins"), lambda: session.pins.from_json(pins_of(session, document)), None)
    session.study_file = part(Text("study"), study, ("", ""))
    missing = [str(name) for name in document.get("files", ()) if name not in names]
    if missing:
        _log.warning("%d files of a kept session are not there any more", len(missing))
    unknown = document.keys() - _PARTS or {key for step in steps for key in step.keys() - _PARTS_OF_A_STEP}
    if unknown:
        _log.warning("a kept session has parts that are not known here: %.200s", ", ".join(sorted(unknown)))
        left.append(Text("what this version does not know"))
    return left


class _States:
    """States of the history; each scenario is read once.

    Parameters
    ----------
    scenarios : list
        Their canonical data.
    names : mapping
        Recordings by name.
    """

    def __init__(self, scenarios: Sequence[Any], names: Mapping[str, Path]) -> None:
        self._data, self._names = scenarios, names
        self._read: dict[int, Scenario] = {}

    def read(self, step: Document) -> State:
        pair = []
        for number in (_index(step["scenario"]), _index(step["opened"])):
            if number not in self._read:
                self._read[number] = _scenario(self._data[number], self._names)
            pair.append(self._read[number])
        selected = min(max(int(step["selected"]), 0), len(pair[0].method) - 1)
        return State(pair[0], str(step["origin"])[:_LONGEST_NAME], selected, pair[1])


def _index(value: Any) -> int:
    """Index in a list; raises ValueError: Python would count a negative one from the end."""
    if not isinstance(value, int) or isinstance(value, bool) or value < 0:
        raise ValueError(f"{value!r:.20} is no index")
    return value


def pins_of(session: Session, document: Document) -> list[Document]:
    """Pins of a document, their recordings those of the session."""
    names = _recordings(session)
    return [pin | {"scenario": _scenario(pin["scenario"], names).canonical()} for pin in document["pins"]]


def _recordings(session: Session) -> dict[str, Path]:
    return {name: upload.path for name, upload in session.uploads.files.items()}


def _scenario(data: Any, names: Mapping[str, Path]) -> Scenario:
    return shared_files(Scenario.parse(data), names)


def _line(error: BaseException) -> str:
    return f"{type(error).__name__}: {str(error).splitlines()[0] if str(error) else ''}"[:200]

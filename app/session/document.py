"""A session as a JSON document and back: what outlives the server. What is read is never trusted."""

from __future__ import annotations

import logging
from collections.abc import Mapping
from pathlib import Path
from typing import Any
from weakref import WeakKeyDictionary

from pydantic import ValidationError

from app.session.display import Display
from app.session.history import History, State
from app.session.session import Session
from app.session.uploads import plain_names, shared_files
from navcore.foundation.errors import InputError
from navcore.scenario.model import Scenario

SCHEMA = 1
STEPS_BACK, STEPS_FORWARD = 50, 20
"""Steps of the history that are kept."""
_LONGEST_NAME = 60
_log = logging.getLogger("schuler.document")

Document = dict[str, Any]
_made: WeakKeyDictionary[Session, dict[int, tuple[Scenario, Document]]] = WeakKeyDictionary()
"""What each session's last document holds: scenarios by their identity, as they are written."""
Unreadable = (InputError, ValidationError, ValueError, TypeError, KeyError, IndexError, AttributeError)
"""What reading a document of strange content raises."""


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
        steps, at = session.history.steps, session.history.at
        display, pins = session.display, session.pins.to_json()
        files, shown = list(session.uploads.files), session.pins.all
        state = session.state
    if not whole:
        steps, at = ((state, ""),), 0
    first = max(0, at - STEPS_BACK)
    kept = steps[first : at + STEPS_FORWARD + 1]
    scenarios = _Scenarios(_made.get(session, {}))
    baseline = next((index for index, pin in enumerate(shown, start=1) if pin.id == display.baseline), None)
    listed = [_step(one, name, scenarios) for one, name in kept]
    if whole:
        _made[session] = scenarios.made
    return {
        "schema": SCHEMA,
        "id": session.id,
        "at": at - first,
        "steps": listed,
        "scenarios": [document for _, document in scenarios.made.values()],
        "display": display.model_dump(mode="json") | {"baseline": baseline},
        "pins": [pin | {"scenario": plain_names(pin["scenario"])} for pin in pins],
        "files": files,
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
        self.made: dict[int, tuple[Scenario, Document]] = {}
        self._numbers: dict[int, int] = {}

    def number(self, scenario: Scenario) -> int:
        key = id(scenario)
        if key not in self.made:
            known, document = self._before.get(key, (None, {}))
            if known is not scenario:
                document = plain_names(scenario.canonical())
            self.made[key] = scenario, document
        return self._numbers.setdefault(key, len(self._numbers))


def _step(state: State, name: str, scenarios: _Scenarios) -> Document:
    found = {"scenario": scenarios.number(state.scenario), "opened": scenarios.number(state.opened)}
    return found | {"origin": state.origin, "selected": state.selected} | ({"name": name} if name else {})


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
    names = {name: upload.path for name, upload in session.uploads.files.items()}
    steps, at = list(document["steps"]), int(document["at"])
    scenarios: dict[int, Scenario] = {}

    def state(step: Document) -> State:
        found = []
        for number in (int(step["scenario"]), int(step["opened"])):
            if number not in scenarios:
                scenarios[number] = _scenario(document["scenarios"][number], names)
            found.append(scenarios[number])
        selected = min(max(int(step["selected"]), 0), len(found[0].method) - 1)
        return State(found[0], str(step["origin"])[:_LONGEST_NAME], selected, found[1])

    present = state(steps[at])
    history = History(present)
    try:
        history = History.of([(state(step), str(step.get("name", ""))[:200]) for step in steps], at)
    except Unreadable as error:
        _log.warning("the history of a session was left out: %s", _line(error))
    display, pins = Display(), []
    try:
        display = Display.model_validate(document["display"])
    except Unreadable as error:
        _log.warning("how a session shows its pictures was left out: %s", _line(error))
    try:
        pins = [pin | {"scenario": _scenario(pin["scenario"], names).canonical()} for pin in document["pins"]]
    except Unreadable as error:
        _log.warning("the pins of a session were left out: %s", _line(error))
    session.resume(history, display)
    try:
        session.pins.from_json(pins)
    except Unreadable as error:
        _log.warning("the pins of a session were left out: %s", _line(error))


def _scenario(data: Any, names: Mapping[str, Path]) -> Scenario:
    return shared_files(Scenario.parse(data), names)


def _line(error: BaseException) -> str:
    return f"{type(error).__name__}: {str(error).splitlines()[0] if str(error) else ''}"[:200]

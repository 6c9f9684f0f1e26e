"""What the user does by buttons and choosers: methods, log events, scenarios, files."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from app.editing import edits
from app.page import notices
from app.panels.files import SCENARIO
from app.panels.header import UPLOADED
from app.panels.inputs import ADD_EVENT, ADD_OUTAGE, REMOVE_EVENT
from app.panels.method import ADD, COPY
from app.session.session import Session, first_editable
from app.session.uploads import opened_scenario, recorded_scenario, with_plain_names
from navcore.errors import InputError
from navcore.measures import metrics
from navcore.scenario_file import load, presets, to_toml

if TYPE_CHECKING:
    import viser


class Actions:
    """Changes of a session that no single control stands for.

    Parameters
    ----------
    client : viser.ClientHandle
        The browser, for notices and downloads.
    session : Session
        Whose work it is.
    refresh : callable
        Lets all controls show the session's scenario again.
    """

    def __init__(self, client: viser.ClientHandle, session: Session, refresh: Callable[[], None]) -> None:
        self._client, self._session, self._refresh = client, session, refresh

    def scenarios(self) -> tuple[str, ...]:
        """Names to choose from."""
        return (*presets(), *((UPLOADED,) if self._session.uploads.files else ()))

    def choose_scenario(self, name: str) -> None:
        """Begin anew with a preset, or with the uploaded recording."""
        with self._session.lock, self._told(f"{name} cannot be opened"):
            if name == self._session.origin:
                return
            if name not in presets():
                self.use_files()
                return
            opened = load(name)
            self._session.change(opened, None, origin=name, selected=first_editable(opened))

    def verify(self) -> None:
        """Compare the scenario with the full strapdown."""
        with self._session.lock:
            scenario = self._session.scenario
        self._session.verifier.start(scenario)

    # ------------------------------------------------------------ methods and events

    def select(self, index: int) -> None:
        """Edit another method."""
        self._session.select(index, None)

    def arrange_methods(self, what: str) -> None:
        """Add, copy or remove a method."""
        session = self._session
        with session.lock, self._told("Not possible"):
            at = session.selected
            if what in (ADD, COPY):
                changed, at = edits.with_method(session.scenario, at if what == COPY else None)
            else:
                changed = edits.without_method(session.scenario, at)
            session.change(changed, None, selected=at)

    def arrange_log(self, what: str) -> None:
        """Add or remove an event or outage of the log."""
        session = self._session
        with session.lock, self._told("Not possible"):
            block = "event" if what in (ADD_EVENT, REMOVE_EVENT) else "outage"
            change = edits.with_block if what in (ADD_EVENT, ADD_OUTAGE) else edits.without_block
            session.change(change(session.scenario, ("reference", block)), None)

    # ------------------------------------------------------------ files

    def take_file(self, name: str, content: bytes) -> None:
        """Keep an uploaded recording and run on it, or open an uploaded scenario."""
        session = self._session
        with session.lock, self._told("The file cannot be used; nothing was changed"):
            if name.lower().endswith(".toml"):
                opened = opened_scenario(name, content, session.uploads)
                session.change(opened, None, origin=name[:60], selected=first_editable(opened))
                return
            upload = session.uploads.add(name, content)
            session.on_change()
            held = f"It holds: {', '.join(sorted(upload.quantities))}."
            self._run_on_files(f"{upload.path.name}: {upload.kind}", [held, *upload.warnings])

    def use_files(self) -> None:
        """Run on the uploaded recording."""
        with self._session.lock:
            self._run_on_files("Running on the uploaded recording", [])

    def _run_on_files(self, title: str, lines: list[str]) -> None:
        """Run on the files if they suffice, and say in one notice what was done."""
        session = self._session
        tone: notices.Tone = "info"
        try:
            changed, notes = recorded_scenario(session.scenario, session.uploads)
            session.change(changed, None, origin=UPLOADED)
        except InputError as error:
            notes, tone = ["Not run on the files yet:", *notices.fault_lines(error)], "warning"
        notices.tell(self._client, title, [*lines, *notes], tone)
        self._refresh()

    def forget_files(self) -> None:
        """Remove the uploaded files, unless the scenario runs on them."""
        uploads = self._session.uploads
        with self._session.lock:
            used = {str(upload.path) for upload in uploads.files.values()}
            if used & edits.files_of(self._session.scenario):
                reason = "the scenario runs on them: choose another scenario first"
                notices.tell(self._client, "The files were kept", [reason], "warning")
                return
            uploads.clear()
            self._session.on_change()
        self._refresh()

    def give_file(self, name: str) -> None:
        """Let the browser save the scenario or the numbers."""
        with self._session.lock:
            scenario, run = self._session.scenario, self._session.run
        if name == SCENARIO:
            content = to_toml(with_plain_names(scenario)).encode()
        elif run is not None:
            content = as_json(metrics(run), indent=True)
        else:
            notices.tell(self._client, "No run yet", ["there are no numbers to download"], "warning")
            return
        self._client.send_file_download(name, content, save_immediately=True)
        self._client.flush()

    @contextmanager
    def _told(self, title: str) -> Iterator[None]:
        """Say what is wrong with the input, or why a file cannot be stored; the session stays as it is."""
        try:
            yield
        except InputError as error:
            notices.tell(self._client, title, notices.fault_lines(error))
            self._refresh()
        except OSError as error:
            notices.tell(self._client, title, [error.strerror or str(error)])
            self._refresh()


def as_json(document: Any, *, indent: bool = False) -> bytes:
    """JSON text of a document of plain values."""
    import orjson

    return orjson.dumps(document, option=orjson.OPT_INDENT_2 if indent else None)

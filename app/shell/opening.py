"""Scenarios and files: what is opened, what is uploaded, what is saved."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from navcore.engine.measures import metrics
from navcore.foundation.errors import InputError
from navcore.foundation.stage_cache import MAP_SUFFIX
from navcore.foundation.text import Text
from navcore.scenario.file import load, presets, to_toml
from schuler_bench.editing import edits
from schuler_bench.http.limits import MIB
from schuler_bench.session.history import first_editable
from schuler_bench.session.own_ins import Taken, own_scenario
from schuler_bench.session.recordings import recorded_scenario
from schuler_bench.session.session import Session
from schuler_bench.session.studying import LARGEST_TEXT, is_study, uploaded_study
from schuler_bench.session.uploads import Upload, opened_scenario, with_plain_names
from schuler_bench.shell import notices

if TYPE_CHECKING:
    import viser

    from navcore.engine.run import MethodRun, Run

VOYAGE = "voyage.toml"
"""Origin of a scenario that was made like a recorded voyage."""
UPLOADED = "uploaded"
"""Stands for the uploaded recordings in the scenario chooser, and for the uploaded study in its own."""
SCENARIO, METRICS = "scenario.toml", "metrics.json"
"""Files that can be saved."""


class Opening:
    """Opens scenarios, keeps uploaded files and gives files to save.

    Parameters
    ----------
    client : viser.ClientHandle
        The browser, for notifications and downloads.
    session : Session
        Whose scenario is replaced.
    refresh : callable
        Lets all controls show the session's scenario again.
    """

    def __init__(self, client: viser.ClientHandle, session: Session, refresh: Callable[[], None]) -> None:
        self._client, self._session, self._refresh = client, session, refresh
        self._presets = tuple(presets())

    def scenarios(self) -> tuple[str, ...]:
        """Names to choose from."""
        return (*self._presets, *((UPLOADED,) if self._session.uploads.files else ()))

    def choose_scenario(self, name: str) -> None:
        """Open a preset, or run on the uploaded recordings."""
        with (
            self._session.lock,
            notices.told(self._client, Text("{name} cannot be opened", name=name), self._refresh),
        ):
            if name == self._session.origin:
                return
            if name not in self._presets:
                self.use_files()
                return
            opened = load(name)
            self._session.change(opened, None, origin=name, selected=first_editable(opened))

    # ------------------------------------------------------------ files

    def take_file(self, name: str, content: bytes) -> None:
        """Keep an uploaded recording and run on it, or open an uploaded scenario."""
        session = self._session
        title = Text("The file cannot be used; nothing was changed")
        reading = Text("Reading {name}, {size:.1f} MiB", name=name[:60], size=len(content) / MIB)
        with (
            notices.busy(self._client, reading, len(content)) as say,
            session.lock,
            notices.told(self._client, title, self._refresh),
        ):
            if name.lower().endswith(".toml"):
                if is_study(text := content[: LARGEST_TEXT + 1].decode("utf-8", "replace")):
                    self._take_study(name[:60], text)
                    return
                opened = opened_scenario(name, content, session.uploads)
                session.change(opened, None, origin=name[:60], selected=first_editable(opened))
                return
            say(Text("1 of 2: what it holds; about a second for each MiB."))
            upload = session.uploads.add(name, content)
            session.on_change()
            say(Text("2 of 2: the ship's motion and log from it."))
            self._run_on(upload)

    def play(self, files: Mapping[str, str], what: str) -> None:
        """Keep the recordings of an answer and open the scenario that runs on them, the last of the files.

        Parameters
        ----------
        files : mapping from str to str
            Text by name.
        what : str
            What it shows.
        """
        session = self._session
        title = Text("{what} cannot be played; nothing was changed", what=what)
        with session.lock, notices.told(self._client, title, self._refresh):
            *recordings, (name, text) = files.items()
            for recording, content in recordings:
                session.uploads.add(recording, content.encode())
            opened = opened_scenario(name, text.encode(), session.uploads)
            session.change(opened, None, origin=name[:60], selected=first_editable(opened))

    def _take_study(self, name: str, text: str) -> None:
        """Keep an uploaded study for the tab "Study", which shows it from now on."""
        session = self._session
        uploaded_study(name, text)
        session.study_file = name, text
        session.show(None, study=UPLOADED)
        session.on_change()
        line = Text("Open Study (tab Robustness) to run it.")
        notices.tell(self._client, Text("{name} is a study", name=name), [line], "info")

    def use_map(self, name: str, data: Mapping[str, Any] | None) -> None:
        """Read an uploaded table by a map, or by the guess, and run on it."""
        session = self._session
        title = Text("{name} cannot be read by these columns; nothing was changed", name=name)
        with session.lock, notices.told(self._client, title, self._refresh):
            upload = session.uploads.use_map(name, data)
            session.on_change()
            self._run_on(upload)

    def give_map(self, name: str, data: Mapping[str, Any]) -> None:
        """Let the browser save the map of an uploaded table."""
        from navcore.checks.map_guess import as_toml

        table = self._session.uploads.files[name].table
        if table is not None:
            content = as_toml(dict(data), table, name).encode()
            self._client.send_file_download(name + MAP_SUFFIX, content, save_immediately=True)
            self._client.flush()

    def _run_on(self, upload: Upload) -> None:
        """Tell what a file holds and run on it, or say what its columns still need."""
        name = upload.path.name
        if upload.faults:
            title = Text("{name} is kept, but not used yet: say what its columns mean in Files", name=name)
            notices.tell(self._client, title, [str(fault) for fault in upload.faults], "warning")
            self._refresh()
            return
        held = Text("It holds: {quantities}.", quantities=", ".join(sorted(upload.quantities)))
        self._run_on_files(Text("{name}: {kind}", name=name, kind=upload.kind), [held, *upload.warnings])

    def use_files(self) -> None:
        """Run on the uploaded recordings."""
        with self._session.lock:
            self._run_on_files(Text("Running on the uploaded recording"), [])

    def _run_on_files(self, title: str, lines: list[str]) -> None:
        """Run on the files if they suffice, and tell in one notification what was done."""
        session = self._session
        tone: notices.Tone = "info"
        try:
            changed, notes = recorded_scenario(session.scenario, session.uploads)
            session.change(changed, None, origin=UPLOADED)
        except InputError as error:
            notes, tone = [Text("Not run on the files yet:"), *notices.fault_lines(error)], "warning"
        notices.tell(self._client, title, [*lines, *notes], tone)
        self._refresh()

    def damp_ins(self, roles: Taken) -> None:
        """Run on the output of a ship's own INS and its log."""
        session = self._session
        title = Text("The INS cannot be damped on these files; nothing was changed")
        with session.lock, notices.told(self._client, title, self._refresh):
            changed, notes = own_scenario(session.uploads, roles)
            session.change(changed, None, origin=UPLOADED)
            notices.tell(self._client, Text("My ship's INS"), notes, "info")

    def sail_like(self) -> None:
        """Open a simulated voyage like the recorded one of the scenario."""
        from navcore.fitting.voyage import voyage_like

        session = self._session
        title = Text("No voyage can be made of these recordings; nothing was changed")
        with session.lock, notices.told(self._client, title, self._refresh):
            found = voyage_like(session.scenario)
            opened = found.scenario
            session.change(opened, None, origin=VOYAGE, selected=first_editable(opened))
            told = Text(
                "{legs} legs; at the end they are {end:.0f} m from the track. Choose an IMU in Sensors.",
                legs=found.legs,
                end=found.end_m,
            )
            notices.tell(self._client, Text("A voyage like mine"), [told], "info")

    def forget_files(self) -> None:
        """Remove the uploaded files, unless the scenario runs on them."""
        uploads = self._session.uploads
        with self._session.lock:
            used = {str(upload.path) for upload in uploads.files.values()}
            if used & edits.files_of(self._session.scenario):
                reason = Text("the scenario runs on them: choose another scenario first")
                notices.tell(self._client, Text("The files were kept"), [reason], "warning")
                return
            uploads.clear()
            self._session.on_change()
        self._refresh()

    def give_file(self, name: str) -> None:
        """Let the browser save the scenario or the metrics."""
        with self._session.lock:
            scenario, run = self._session.scenario, self._session.run
        if name == SCENARIO:
            content = to_toml(with_plain_names(scenario)).encode()
        elif run is not None:
            shares = self._session.searches.judge.shares(run.scenario)
            content = as_json(metrics(run, shares), indent=True)
        else:
            notices.tell(
                self._client, Text("No run yet"), [Text("there are no numbers to download")], "warning"
            )
            return
        self._client.send_file_download(name, content, save_immediately=True)
        self._client.flush()

    def give_damped(self, run: Run, method: MethodRun) -> None:
        """Let the browser save the files of an INS as a method would have damped it."""
        from navcore.engine.damped_recording import damped_files

        client = self._client
        with notices.told(client, Text("The damped output cannot be written"), lambda: None):
            for name, text in damped_files(run, method).items():
                client.send_file_download(f"damped-{name}", text.encode(), save_immediately=True)
            client.flush()

    def give_aside(self, number: int) -> None:
        """Let the browser save what was kept and cannot be read, as it is."""
        client = self._client
        with notices.told(client, Text("It cannot be downloaded at present"), lambda: None):
            one = self._session.keeping.aside[number]
            content = one.content()
            if content is None:
                notices.tell(client, Text("{name} is no longer there", name=one.name), [], "warning")
                return
            client.send_file_download(one.name, content, save_immediately=True)
            client.flush()


def as_json(document: Any, *, indent: bool = False) -> bytes:
    """JSON text of a document of plain values."""
    import orjson

    return orjson.dumps(document, option=orjson.OPT_INDENT_2 if indent else None)

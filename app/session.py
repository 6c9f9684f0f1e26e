"""One visitor's work - scenario, uploads, last good run - kept by session id over reloads. No viser here."""

from __future__ import annotations

import atexit
import logging
import shutil
import tempfile
import threading
from collections import OrderedDict
from collections.abc import Callable
from pathlib import Path
from typing import Protocol

from app.display import Display
from app.uploads import Uploads
from app.verifier import Verifier, Verify
from app.worker import Watch, Worker
from navcore.errors import InputError
from navcore.run import Run
from navcore.scenario import Scenario
from navcore.units import HOUR

MOST_SESSIONS = 64
"""Sessions kept without an open page; with one they are always kept."""
MOST_IDLE_RUNS = 8
"""Runs kept of sessions without an open page; the others are computed again on return."""
FIRST_PRESET = "sikuliaq-like"

MOST_SAMPLES = 2_500_000
"""IMU samples, all methods together, of a strapdown run that still follows every change: half a second."""

_REPORT_EVERY_S = 0.1
_log = logging.getLogger("schuler.session")

Simulate = Callable[[Scenario, Callable[[float], None], Callable[[], bool]], Run]


class View(Protocol):
    """An open page of a session. Called from the worker's thread or from that of another page."""

    def scenario_changed(self, by: object) -> None:
        """Show the session's scenario in all controls; ``by`` is who changed it."""
        ...

    def run_progressed(self, fraction: float, elapsed_s: float) -> None:
        """Show that a run is under way and the picture is an old one."""
        ...

    def run_ended(self) -> None:
        """Show the session's run."""
        ...

    def run_stopped(self) -> None:
        """Say that the picture is still the old one because the user stopped the run."""
        ...

    def run_refused(self, error: InputError) -> None:
        """Say why the scenario cannot run; the last good one is back."""
        ...

    def run_failed(self, error: Exception) -> None:
        """Say that something of ours went wrong; the last good picture stays."""
        ...

    def run_waits(self) -> None:
        """Say that the changed scenario runs only when the user asks for it."""
        ...

    def display_changed(self, by: object) -> None:
        """Draw the pictures anew as ``session.display`` says; ``by`` is who changed it."""
        ...

    def verification_changed(self) -> None:
        """Show how far the verification is, or what it gave."""
        ...


class Session:
    """State of one visitor.

    Parameters
    ----------
    id : str
        As in the page's address.
    scenario : Scenario
        To begin with.
    origin : str
        Name of the preset it came from.
    folder : Path
        For uploads; need not exist.
    simulate : callable, optional
        In place of `navcore.simulation.simulate`.
    verify : callable, optional
        In place of `navcore.verification.verify`.

    Attributes
    ----------
    scenario : Scenario
        As edited.
    origin : str
        Preset, or "uploaded".
    selected : int
        Method that the controls edit.
    run : Run or None
        The last good one.
    run_number : int
        Counts the runs shown.
    outdated : bool
        The scenario has changed since ``run``.
    display : Display
        What the pictures are shown with.
    verifier : Verifier
        Compares the scenario with the full strapdown when asked.
    """

    def __init__(
        self,
        id: str,
        scenario: Scenario,
        origin: str,
        folder: Path,
        simulate: Simulate | None = None,
        verify: Verify | None = None,
    ) -> None:
        self.id = id
        self.lock = threading.RLock()
        self.scenario = scenario
        self.origin = origin
        self.selected = first_editable(scenario)
        self.run: Run | None = None
        self.run_number = 0
        self.outdated = True
        self.display = Display()
        self.uploads = Uploads(folder)
        self._before: tuple[Scenario, str, int] = (scenario, origin, 0)
        self._views: list[View] = []
        self._simulate = simulate or _simulate
        self._worker: Worker[Scenario] = Worker(self._work, f"session-{id[:8]}")
        self.verifier = Verifier(
            lambda: self._tell(lambda view: view.verification_changed()), verify, f"verifier-{id[:8]}"
        )

    # ------------------------------------------------------------ pages

    def attach(self, view: View) -> None:
        """Add an open page; a run is begun if there is none to show."""
        with self.lock:
            self._views.append(view)
            if self.run is None:
                self._worker.submit(self.scenario)

    def detach(self, view: View) -> None:
        """Remove a closed page; without any page nothing runs on."""
        with self.lock:
            self._views = [other for other in self._views if other is not view]
            if not self._views:
                self._worker.cancel()
                self.verifier.cancel()

    @property
    def open_pages(self) -> int:
        """Number of open pages."""
        with self.lock:
            return len(self._views)

    # ------------------------------------------------------------ changes

    def change(
        self, scenario: Scenario, by: object, *, origin: str | None = None, selected: int | None = None
    ) -> bool:
        """Take over a checked scenario and run it; False when nothing changed.

        The single place where the scenario changes. One that `runs_on_demand` is run when it is opened
        (``origin``) and when the user asks for it, not with every move of a control.
        """
        with self.lock:
            same = scenario == self.scenario and origin in (None, self.origin)
            if selected is not None:
                self.selected = selected
            self.selected = min(self.selected, len(scenario.method) - 1)
            if same:
                return False
            if origin not in (None, self.origin):
                self.verifier.forget()
            self.scenario, self.origin, self.outdated = scenario, origin or self.origin, True
            self.verifier.follow(scenario)
            for view in list(self._views):
                view.scenario_changed(by)
            if origin is None and runs_on_demand(scenario):
                self._worker.cancel()
                self._tell(lambda view: view.run_waits())
            else:
                self._worker.submit(scenario)
            return True

    def select(self, index: int, by: object) -> None:
        """Choose the method that the controls edit."""
        with self.lock:
            self.selected = min(max(index, 0), len(self.scenario.method) - 1)
            for view in list(self._views):
                view.scenario_changed(by)

    def show(self, by: object, **changes: object) -> None:
        """Change how the pictures are shown; the single place where `display` changes.

        Raises
        ------
        pydantic.ValidationError
            A choice is not allowed.
        """
        with self.lock:
            display = self.display.with_(**changes)
            if display == self.display:
                return
            self.display = display
            for view in list(self._views):
                view.display_changed(by)

    @property
    def waits(self) -> bool:
        """Whether the scenario has changed and runs only when the user asks for it."""
        return self.outdated and runs_on_demand(self.scenario) and not self._worker.busy

    def redo_run(self) -> None:
        """Run the scenario: after a stop, or when it runs on demand."""
        with self.lock:
            self._worker.submit(self.scenario)

    def cancel_run(self) -> None:
        """Stop the running run; the last good picture stays."""
        self._worker.cancel()

    def close(self) -> None:
        """End the workers and remove the uploaded files."""
        self._worker.stop()
        self.verifier.stop()
        self.uploads.clear()

    def wait_idle(self, timeout_s: float | None = None) -> bool:
        """Block until no run is under way; False after the timeout."""
        return self._worker.wait_idle(timeout_s)

    # ------------------------------------------------------------ runs

    def _work(self, scenario: Scenario, watch: Watch) -> None:
        last_s = 0.0

        def progress(fraction: float) -> None:
            nonlocal last_s
            if watch.elapsed_s - last_s >= _REPORT_EVERY_S:
                last_s = watch.elapsed_s
                self._tell(lambda view: view.run_progressed(fraction, last_s))

        try:
            run = self._simulate(scenario, progress, watch.cancelled)
        except InputError as error:
            self._refuse(scenario, error)
            return
        except Exception as error:
            _log.exception("a run failed")
            failure = error
            self._tell(lambda view: view.run_failed(failure))
            return
        if run.status == "stopped":
            if runs_on_demand(self.scenario) and scenario != self.scenario:
                self._tell(lambda view: view.run_waits())
            elif not watch.superseded():
                self._tell(lambda view: view.run_stopped())
            return
        with self.lock:
            self.run, self.run_number = run, self.run_number + 1
            self.outdated = scenario != self.scenario
            self._before = (scenario, self.origin, self.selected)
        self._tell(lambda view: view.run_ended())

    def _refuse(self, scenario: Scenario, error: InputError) -> None:
        """Go back to the last scenario that ran, unless the user has gone on already."""
        with self.lock:
            if scenario == self.scenario and self._before[0] != scenario:
                self.scenario, self.origin, self.selected = self._before
                self.outdated = self.run is None or self.run.scenario != self.scenario
                self.verifier.follow(self.scenario)
                for view in list(self._views):
                    view.scenario_changed(self)
        self._tell(lambda view: view.run_refused(error))

    def _tell(self, message: Callable[[View], None]) -> None:
        with self.lock:
            views = list(self._views)
        for view in views:
            try:
                message(view)
            except Exception as error:
                _log.exception("a page could not be brought up to date")
                view.run_failed(error)


def _simulate(scenario: Scenario, progress: Callable[[float], None], cancelled: Callable[[], bool]) -> Run:
    from navcore.simulation import simulate

    return simulate(scenario, progress, cancelled)


class Sessions:
    """All sessions by id; without an open page the least recently used ones are dropped.

    Parameters
    ----------
    first : callable, optional
        Gives the scenario and the name to begin with.
    """

    def __init__(self, first: Callable[[], tuple[Scenario, str]] | None = None) -> None:
        self._first = first or first_scenario
        self._lock = threading.Lock()
        self._by_id: OrderedDict[str, Session] = OrderedDict()
        self._folder: Path | None = None
        atexit.register(self.close)

    def get(self, id: str) -> Session:
        """Return the session with that id, new or as it was left."""
        with self._lock:
            session = self._by_id.get(id)
            if session is None:
                scenario, origin = self._first()
                session = self._by_id[id] = Session(id, scenario, origin, self._upload_folder(id))
            self._by_id.move_to_end(id)
            self._trim(keep=session)
            return session

    def __len__(self) -> int:
        return len(self._by_id)

    def close(self) -> None:
        """End all sessions and remove every uploaded file."""
        with self._lock:
            for session in self._by_id.values():
                session.close()
            self._by_id.clear()
            if self._folder is not None:
                shutil.rmtree(self._folder, ignore_errors=True)
                self._folder = None

    def _upload_folder(self, id: str) -> Path:
        if self._folder is None:
            self._folder = Path(tempfile.mkdtemp(prefix="schuler-uploads-"))
        return self._folder / id

    def _trim(self, keep: Session) -> None:
        idle = [s for s in self._by_id.values() if s is not keep and s.open_pages == 0]
        for session in idle[: max(0, len(idle) - MOST_SESSIONS)]:
            del self._by_id[session.id]
            session.close()
        for session in idle[: max(0, len(idle) - MOST_IDLE_RUNS)]:
            session.run = None
            session.verifier.forget()


def runs_on_demand(scenario: Scenario) -> bool:
    """Whether a run takes so long that it should not follow every move of a slider."""
    run = scenario.run
    if run.fidelity != "strapdown":
        return False
    return run.duration_h * HOUR * run.rate_hz * len(scenario.method) > MOST_SAMPLES


def first_editable(scenario: Scenario) -> int:
    """Index of the first method with something to tune; 0 if there is none."""
    tunable = (
        i for i, m in enumerate(scenario.method) if not m.undamped and len(type(m.network).model_fields) > 1
    )
    return next(tunable, 0)


def first_scenario() -> tuple[Scenario, str]:
    """Preset that a new visitor sees."""
    from navcore.scenario_file import load, presets

    names = list(presets())
    name = FIRST_PRESET if FIRST_PRESET in names else next(iter(names), "")
    return (load(name), name) if name else (Scenario(), "")

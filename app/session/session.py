"""One visitor's work: scenario, its history, uploads, last good run. No viser here."""

import logging
import threading
import time
from collections.abc import Callable
from pathlib import Path

from navcore.engine.run import Run
from navcore.foundation.errors import InputError
from navcore.foundation.kernel_wait import KernelAwaited
from navcore.foundation.text import Text
from navcore.scenario.model import Scenario
from schuler_bench.http.ids import log_name
from schuler_bench.jobs.asking import Asker
from schuler_bench.jobs.envelopes import Envelopes, Simulate
from schuler_bench.jobs.load import refuse_too_large, run_load, runs_on_demand
from schuler_bench.jobs.long_runs import run_for
from schuler_bench.jobs.scheduler import scheduler
from schuler_bench.jobs.searches import Searches
from schuler_bench.jobs.words import for_a_page
from schuler_bench.jobs.worker import Watch, Worker
from schuler_bench.session.classroom import Classroom
from schuler_bench.session.display import Display
from schuler_bench.session.history import History, State, first_editable
from schuler_bench.session.keeping import OwnKeeping
from schuler_bench.session.pages import OpenPages
from schuler_bench.session.pins import Kept, Pins
from schuler_bench.session.uploads import Uploads
from schuler_bench.session.view import View

_REPORT_EVERY_S = 0.1
_log = logging.getLogger("schuler.session")


class Session:
    """State of one visitor.

    Parameters
    ----------
    id : str
    scenario : Scenario
        To begin with.
    origin : str
        Name of the preset it came from.
    folder : Path
        For uploads; need not exist.
    simulate : callable, optional
        In place of `navcore.engine.simulation.simulate`.

    Attributes
    ----------
    scenario, origin, opened, selected, taken
        As of the present `schuler_bench.session.history.State`.
    on_answer : callable
        ``on_answer(seconds)`` after every run that is shown: since it was asked for.
    on_change : callable
        ``on_change()`` after every change that is to outlive the server.
    share : callable
        ``share()`` makes a copy for others and gives its id; OSError when there is no room.
    shared_pins : callable
        ``shared_pins(address)`` gives those of a shared state, as of `Pins.to_json`; None: no such state.
    restored : bool
        It was kept, or is a copy of one that was: not a new visitor's.
    classroom : Classroom or None
        The class that the visitors of this server form.
    keeping : OwnKeeping
        Whether the session is kept.
    pages : OpenPages
        Those that show it.
    run : Run or None
        The last good one.
    prepared : Run or None
        Computed before anybody asked for it; what the first run has in common with it is taken from it.
    run_number : int
        Counts the runs shown.
    outdated : bool
        The scenario has changed since ``run``.
    display : Display
        What the pictures are shown with.
    pins : Pins
        Runs that were pinned.
    envelopes : Envelopes
        Bands behind the error curves.
    study_file : (str, str)
        Name and text of the uploaded study; empty: none.
    """

    def __init__(
        self,
        id: str,
        scenario: Scenario,
        origin: str,
        folder: Path,
        simulate: Simulate | None = None,
    ) -> None:
        self.id, self._name = id, (name := log_name(id))
        self.lock = threading.RLock()
        self.pages = OpenPages(self.lock)
        self.display = Display()
        self._take(State(scenario, origin, first_editable(scenario), scenario))
        self.history = History(self.state)
        self.on_change: Callable[[], None] = lambda: None
        self.on_answer: Callable[[float], None] = lambda _: None
        self.share: Callable[[], str] = lambda: self.id
        self.shared_pins: Callable[[str], Kept | None] = lambda _: None
        self.restored = False
        self.classroom: Classroom | None = None
        self.keeping = OwnKeeping(lambda: self.pages.tell(lambda view: view.keeping_changed()))
        self.run: Run | None = None
        self.prepared: Run | None = None
        self.run_number = 0
        self.uploads, self.study_file = Uploads(folder), ("", "")
        self._before = self.state
        self._after_run: list[Callable[[], None]] = []
        self._simulate = simulate or self._simulate_after
        self._worker: Worker[State] = Worker(
            self._work, visitor=name, load=lambda state: run_load(state.scenario)
        )
        self.searches = Searches(name)
        self.pins = Pins(self._pins_changed, self._simulate, name)
        self.envelopes = Envelopes(
            self._simulate,
            lambda: self.pages.tell(lambda view: view.envelope_progressed()),
            self._pictures_changed,
            name=name,
        )

    @property
    def verifier(self) -> Asker:
        """Compares the scenario with the full strapdown when asked."""
        return self.searches.asking["verify"]

    # ------------------------------------------------------------ pages

    def attach(self, view: View) -> None:
        """Add an open page; a run is begun if there is none to show, or only one of an earlier scenario."""
        scheduler().come_back(self._name)
        with self.lock:
            self.pages.add(view)
            if self.run is None or (self.outdated and not runs_on_demand(self.scenario)):
                if not self._worker.busy:
                    self._worker.submit(self.state)
            else:
                self.envelopes.follow(self.run.scenario, self.display.envelope)

    def detach(self, view: View) -> None:
        """Remove a closed page; without any, what was asked for goes on behind all others for a while."""
        with self.lock:
            presented = self.pages.remove(view)
            if not self.pages.all:
                scheduler().leave(self._name)
            if presented:
                self.present(None)

    @property
    def open_pages(self) -> int:
        """Number of open pages."""
        with self.lock:
            return len(self.pages.all)

    @property
    def expected(self) -> bool:
        """Whether its last page has gone so lately that it may come back for what was asked for."""
        return scheduler().expects(self._name)

    def present(self, view: View | None) -> bool:
        """Let one page drive alone, the 3D view large, or (None) all; False while another page drives."""
        with self.lock:
            if not self.pages.present(view):
                return False
            self.show(None, large="plots" if view is None else "view")
            return True

    # ------------------------------------------------------------ changes

    @property
    def state(self) -> State:
        """Return the state that undo brings back."""
        return State(self.scenario, self.origin, self.selected, self.opened, self.taken)

    def change(
        self,
        scenario: Scenario,
        by: object,
        *,
        origin: str | None = None,
        selected: int | None = None,
        name: str = "",
        gesture: str = "",
    ) -> bool:
        """Take over a checked scenario and run it; False when nothing changed.

        The single place where the scenario changes; each change can be undone. One that `runs_on_demand` is
        run when it is opened (``origin``) and when the user asks for it, not with every move of a control.
        ``name`` says what was done, if not "this field from here to there"; a ``gesture`` is one step.
        """
        with self.lock:
            same = scenario == self.scenario and origin in (None, self.origin)
            at = self.selected if selected is None else selected
            self.selected = min(at, len(scenario.method) - 1)
            if same:
                return False
            opened = self.opened if origin is None else scenario
            if origin is not None:
                name = name or Text("open {origin}", origin=origin)
            state = State(scenario, origin or self.origin, self.selected, opened, self.taken)
            self.history.push(state, name, gesture)
            # The history's own: it shares with the state before what has not changed.
            self._go_to(self.history.state, by, opens=origin is not None)
            return True

    def resume(self, history: History, display: Display) -> None:
        """Take over what was kept of this session, before any page is open."""
        with self.lock:
            self.history, self.display, self.restored = history, display, True
            self._before = history.state
            self._take(history.state)

    def undo(self) -> bool:
        """Take the last change back; False when there is none."""
        return self._walk(self.history.undo)

    def redo(self) -> bool:
        """Bring back what was undone last; False when nothing was."""
        return self._walk(self.history.redo)

    def reset(self, by: object) -> bool:
        """Go back to the scenario as it was opened; False when it is that already."""
        with self.lock:
            return self.change(self.opened, by, name=Text("reset to {origin}", origin=self.origin))

    def select(self, index: int, by: object) -> None:
        """Choose the method that the controls edit."""
        with self.lock:
            self.selected = min(max(index, 0), len(self.scenario.method) - 1)
            self.history.push(self.state)
            self.pages.tell(lambda view: view.scenario_changed(by))
            self.on_change()

    def _walk(self, step: Callable[[], State | None]) -> bool:
        with self.lock:
            origin, state = self.origin, step()
            if state is not None:
                self.pins.exchange(self.taken, state.taken)
                self._go_to(state, None, opens=state.origin != origin)
            return state is not None

    def _go_to(self, state: State, by: object, *, opens: bool) -> None:
        if state.origin != self.origin:
            self.verifier.forget()
        self._show_state(state, by)
        if opens or not runs_on_demand(state.scenario):
            self._worker.submit(state)
            return
        self._worker.cancel()
        self.outdated = self.run is None or self.run.scenario != state.scenario
        self.pages.tell(lambda view: view.run_waits() if self.outdated else view.run_ended())

    def _take(self, state: State) -> None:
        self.scenario, self.origin, self.selected = state.scenario, state.origin, state.selected
        self.opened, self.taken, self.outdated = state.opened, state.taken, True
        self.display = self.display.knowing(state.scenario)

    def _show_state(self, state: State, by: object) -> None:
        self._take(state)
        self.verifier.leave(state.scenario)
        self.searches.changed()
        self.pages.tell(lambda view: view.scenario_changed(by))
        self.on_change()

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
            if self.run is not None:
                self.envelopes.follow(self.run.scenario, display.envelope)
            self.pages.tell(lambda view: view.display_changed(by))
            self.on_change()

    def _pins_changed(self) -> None:
        self.on_change()
        self._pictures_changed()

    def _pictures_changed(self) -> None:
        self.pages.tell(lambda view: view.display_changed(None))

    @property
    def waits(self) -> bool:
        """Whether the scenario has changed and runs only when the user asks for it."""
        return self.outdated and runs_on_demand(self.scenario) and not self._worker.busy

    def redo_run(self) -> None:
        """Run the scenario: after a stop, or when it runs on demand."""
        with self.lock:
            self._worker.submit(self.state)

    def after_run(self, act: Callable[[], None]) -> None:
        """Do something once the run of the present scenario is there: at once if none is under way."""
        with self.lock:
            if waits := self.outdated and self._worker.busy:
                self._after_run.append(act)
        if not waits:
            act()

    def cancel_run(self) -> None:
        """Stop the running run; the last good picture stays."""
        self._worker.cancel()

    def close(self, *, keep_files: bool = False) -> None:
        """End the workers and remove the uploaded files, unless they are to be found again."""
        for working in (self._worker, self.searches, self.pins, self.envelopes):
            working.stop()
        scheduler().come_back(self._name)  # there is nothing left to count
        if not keep_files:
            self.uploads.clear()

    def wait_idle(self, timeout_s: float | None = None) -> bool:
        """Block until no run is under way; False after the timeout."""
        return self._worker.wait_idle(timeout_s)

    # ------------------------------------------------------------ runs

    def _work(self, state: State, watch: Watch) -> None:
        scenario, last_s = state.scenario, 0.0

        def progress(fraction: float) -> None:
            nonlocal last_s
            if watch.elapsed_s - last_s >= _REPORT_EVERY_S:
                last_s = watch.elapsed_s
                self.pages.tell(lambda view: view.run_progressed(fraction, last_s))

        try:
            refuse_too_large(scenario)
            run = run_for(self._name, self._simulate, scenario, progress, watch)
        except KernelAwaited:
            self.pages.tell(lambda view: view.run_awaits_kernels())
            raise
        except Exception as error:
            self._after_run = []
            if isinstance(error, InputError):
                self._refuse(state, error)
                return
            _log.exception("a run failed")
            failure = error
            self.pages.tell(lambda view: view.run_failed(failure))
            return
        if run is None or run.status == "stopped":
            if runs_on_demand(self.scenario) and scenario != self.scenario:
                self.pages.tell(lambda view: view.run_waits())
            elif not watch.superseded():
                self._after_run = []
                self.pages.tell(lambda view: view.run_stopped())
            return
        with self.lock:
            self.run, self.run_number = run, self.run_number + 1
            self.outdated = scenario != self.scenario
            self._before = state
            self.envelopes.follow(scenario, self.display.envelope)
            waiting = [] if self.outdated else self._after_run
            self._after_run = [act for act in self._after_run if act not in waiting]
        self.pages.tell(lambda view: view.run_ended())
        for act in waiting:
            act()
        self.on_answer(time.monotonic() - watch.asked_s)

    def _simulate_after(
        self, scenario: Scenario, progress: Callable[[float], None], cancelled: Callable[[], bool]
    ) -> Run:
        """Run a scenario; what the run that is shown has computed already is taken from it."""
        from navcore.engine.simulation import simulate

        return self.display.placed(simulate(scenario, progress, cancelled, self.run or self.prepared))

    def _refuse(self, state: State, error: InputError) -> None:
        """Go back to the last scenario that ran, unless the user has gone on already."""
        with self.lock:
            if state.scenario == self.scenario and self._before.scenario != state.scenario:
                self.history.take_back(self._before)
                self._show_state(self._before, self)
                self.outdated = self.run is None or self.run.scenario != self.scenario
        message = for_a_page(error)
        self.pages.tell(lambda view: view.run_refused(message))

"""One open page: builds the widgets, hands what the user does to the session, and shows what comes back.

For programs that watch the page: the element ``#sb-run`` carries ``data-run`` (the number of the run that is
shown), ``data-digest`` (of the run's arrays) and, as its text, the run's metrics as JSON. It is the last
thing sent for a run. A control is found by its label's exact text.
"""

from __future__ import annotations

import hashlib
import threading
import time
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING

from app.editing.actions import Actions, as_json
from app.editing.editor import Editor
from app.figures import style
from app.http.viser_insides import leaving_is_no_fault
from app.page import notices
from app.page.commands import Commands
from app.page.findings import Findings
from app.page.layout import layout_for, read_state
from app.page.palette import Palette
from app.page.presenter import PresenterLock
from app.page.reading import Figures, Reading
from app.panels.appearance import Appearance
from app.panels.control import Control
from app.panels.explain import ExplainPanel
from app.panels.files import FilesPanel
from app.panels.header import HeaderPanel
from app.panels.inputs import LogPanel, RunPanel, SensorPanel
from app.panels.lessons import COMMAND as LESSON
from app.panels.lessons import LEARN, LessonPanel
from app.panels.method import MethodPanel
from app.panels.reading import VIEW
from app.panels.results import MISPRINTS, PICTURED, TABS, ResultsPanel
from app.panels.verification import VerificationPanel
from app.panels.workbench import Placer, Tools
from app.scene.stage import Stage
from app.session.session import Session
from app.session.shown import Shown, shown
from navcore.errors import InputError
from navcore.measures import metrics
from navcore.run import Run

if TYPE_CHECKING:
    import viser

PAGE_STATE = "page state"
"""Label of the control through which the page reports its size and front tabs (static/page.js)."""

_STYLES = ("page", "commands", "learn")
_SIZE_WAIT_S = 1.5
_EDIT_TABS = ("Method", "Sensors", "Log", "Run", "Files", VIEW, LEARN)


class Page:
    """A browser page on a session: a view of it (`app.session.session.View`).

    Parameters
    ----------
    client : viser.ClientHandle
        The browser.
    session : Session
        Whose work is shown.
    """

    def __init__(self, client: viser.ClientHandle, session: Session) -> None:
        self.client, self.session = client, session
        self.gui = client.gui
        self._closed = self._built = False
        self._reported = threading.Event()
        self._window = (0, 0)
        self._front: tuple[str, ...] = ()
        self._stale = set(PICTURED)
        self._shown_result = session.verifier.result
        self._located = session.selected
        self._editor = Editor(client, session, self, self._controls, lambda: self.method.shown_network)
        self._actions = Actions(client, session, self._again)
        self._placer = Placer(client, session)
        self._tools = Tools(
            lambda **choices: session.show(None, **choices), self._placer.typed,
            lambda: session.scenario.method[session.selected],
        )  # fmt: skip
        self._build()

    # ------------------------------------------------------------ building

    def _build(self) -> None:
        gui, session = self.gui, self.session
        leaving_is_no_fault(self.client)
        self._state = gui.add_text(PAGE_STATE, "", order=1)
        self._state.on_update(lambda _: self._on_state())
        static = Path(__file__).parents[1] / "static"
        css = "".join((static / f"{name}.css").read_text(encoding="utf-8") for name in _STYLES)
        self.commands = Commands(gui, self._command_failed)
        css = css.replace("PAGE_STATE", self._state._impl.uuid).replace("PAGE_COMMAND", self.commands.box_id)
        gui.add_html(f"<style>{css}{style.UPLOT_CSS}</style>", order=0)
        self.client.flush()
        if not self._reported.wait(_SIZE_WAIT_S):
            # No word from the script: the view covers the window as long as nothing is docked, but its size
            # counts device pixels.
            camera = self.client.camera
            self._window = (max(camera.image_width, 1280), max(camera.image_height, 720))
        with session.lock, self.client.atomic():
            self._layout = layout_for(*self._window)
            gui.main_panel.dock_left()
            gui.main_panel.set_width(self._layout.left_px)
            self._make_left()
            self._results = self._make_results()
            self.findings = Findings(self.client, session, self._method_tab, lambda: self._results)
            self._stage = Stage(self.client, session, self.commands)
            self._run_element = gui.add_html("", order=2)
            self._heard = gui.add_html("", order=3)
            self.palette.offer_tabs((*_EDIT_TABS, *TABS))
            self.refresh()
            self.commands.register("place", self._placer.picked)
            self.commands.show()
        self.client.flush()
        self._built = True
        self._arrange()
        self._stage.fit(self._layout.view_aspect)
        session.attach(self)
        self.findings.begin()
        if session.run is not None:
            self.run_ended()
        if session.waits:
            self.run_waits()

    def _make_left(self) -> None:
        gui, session, actions, edit = self.gui, self.session, self._actions, self._editor.edit
        self.header = HeaderPanel(
            gui, actions.scenarios(), actions.choose_scenario, session.cancel_run, session.redo_run,
            self._exaggerate,
        )  # fmt: skip
        self.header.show_exaggeration(session.display.exaggeration)
        self.verification = VerificationPanel(gui, actions.verify, session.verifier.cancel, order=13.5)
        group = gui.add_tab_group(order=20)
        tabs = {name: group.add_tab(name) for name in _EDIT_TABS}
        self._method_tab = tabs["Method"]
        self.method = MethodPanel(gui, tabs["Method"], edit, actions.select, actions.arrange_methods)
        self.sensors = SensorPanel(gui, tabs["Sensors"], edit, self._again)
        self.log = LogPanel(gui, tabs["Log"], edit, self._again, actions.arrange_log)
        self.run_panel = RunPanel(gui, tabs["Run"], edit)
        self.files = FilesPanel(
            gui, tabs["Files"], actions.take_file, actions.use_files, actions.forget_files, actions.give_file
        )
        free = frozenset({self._state._impl.uuid, self.commands.box_id})
        lock = PresenterLock(self.client, session, self, self.commands, free)
        self.palette = Palette(
            self.client, session, self.commands, actions, self._editor, lock, self._controls
        )
        self.reading = Reading(self.client, session, self.commands, tabs[VIEW], self._figures)
        self.appearance = Appearance(gui, session, self.commands, tabs[VIEW])
        self.lessons = LessonPanel(gui, tabs[LEARN], session, edit)
        self.commands.register(LESSON, self.lessons.command)
        ExplainPanel(gui, session, self.commands, self._controls)

    def _controls(self) -> list[Control]:
        panels = (self.method, self.sensors, self.log, self.run_panel, self.lessons)
        sections = [section for panel in panels for section in panel.sections.values()]
        return [control for section in sections for control in section.controls.values()]

    def _make_results(self) -> ResultsPanel:
        return ResultsPanel(
            self.gui, self._layout, self.session.display, self._tools, self._choose_transfer,
            self._again_pictures, self.reading.comparing,
        )  # fmt: skip

    def _figures(self, found: Shown, tab: str) -> Figures:
        """Figures of one tab, to be saved."""
        pictures = self._results.make(found, {tab}, self.session.selected)
        if tab in pictures.plotly:
            return pictures.plotly[tab], []
        return None, list(pictures.switching or pictures.curves.values())

    def close(self) -> None:
        """The browser has gone."""
        with self.session.lock:
            self._closed = True
        self._editor.close()
        self.commands.close()
        self._stage.close()
        self.findings.close()
        self.session.detach(self)

    def _command_failed(self, error: Exception) -> None:
        fault = isinstance(error, InputError)
        lines = notices.fault_lines(error) if fault else [f"{type(error).__name__}: {error}"]
        notices.tell(self.client, "That did not work", lines)

    # ------------------------------------------------------------ what the pictures are of

    def _choose_transfer(self, id: str) -> None:
        self.session.show(self, transfer=id)

    def _exaggerate(self, factor: float | None) -> None:
        self.session.show(self, exaggeration=factor)

    def display_changed(self, by: object) -> None:
        """Draw the pictures in front and the map as the session's display says."""
        del by
        session = self.session
        with session.lock, self.client.atomic():
            if self._closed:
                return
            self.appearance.show(session.display)
            self.header.show_exaggeration(session.display.exaggeration)
            self._results.follow(session.display, session.scenario.method[session.selected])
            self.reading.show()
            found = shown(session)
            if found is not None:
                self._stage.draw(found)
        self.client.flush()
        self._again_pictures()

    # ------------------------------------------------------------ what the session says

    def scenario_changed(self, by: object) -> None:
        """Show the session's scenario in all controls."""
        if by is not self:
            self._editor.moved = None
        with self.client.atomic():
            self.refresh()
            self._stage.choose()
        if self._located != self.session.selected:
            # the root locus is that of the method in hand
            self._located = self.session.selected
            if self.session.display.locus:
                self._again_pictures()

    def refresh(self) -> None:
        """Let every control show the session's scenario; the one in hand stays as it is."""
        session = self.session
        scenario, index, moved = session.scenario, session.selected, self._editor.moved
        self.header.show_scenario(scenario, session.origin, self._actions.scenarios())
        self.method.show(scenario, index, moved)
        self.method.show_warnings(session.run, scenario, index)
        self.verification.show(session.verifier, scenario)
        for panel in (self.sensors, self.log, self.run_panel):
            panel.show(scenario, moved)
        self._results.follow(session.display, scenario.method[index])
        self.files.show(session.uploads)
        self.findings.show()
        self.lessons.show(scenario, session.run, moved)
        self.palette.show()

    def run_progressed(self, fraction: float, elapsed_s: float) -> None:
        """Mark the picture as old once a run takes its time."""
        if elapsed_s > 0.5 and not self._closed:
            self.header.show_progress(fraction, self.session.run_number)
            self.client.flush()

    def run_stopped(self) -> None:
        """The user stopped the run."""
        self.header.show_stopped(self.session.run_number)
        self.client.flush()

    def run_waits(self) -> None:
        """The changed scenario takes long: it runs when the user asks for it."""
        self.header.show_waiting(self.session.scenario, self.session.run_number)
        self.client.flush()

    def presenter_changed(self) -> None:
        """Another page drives now, or none."""
        with self.session.lock, self.client.atomic():
            if not self._closed:
                self.palette.show_presenter()
        self.client.flush()

    def verification_changed(self) -> None:
        """A verification has come further, or has ended."""
        session = self.session
        with session.lock, self.client.atomic():
            if self._closed:
                return
            self.verification.show(session.verifier, session.scenario)
            fresh = session.verifier.result is not self._shown_result
            self._shown_result = session.verifier.result
        self.client.flush()
        if fresh:
            self._again_pictures()

    def envelope_progressed(self) -> None:
        """The envelope of the error curves has come further, or cannot be made."""
        with self.session.lock, self.client.atomic():
            if not self._closed:
                self.reading.panel.show_progress()
        self.client.flush()

    def run_refused(self, error: InputError) -> None:
        """The scenario cannot run; the last good one is back."""
        title = "The scenario cannot run; the last good one is back"
        notices.tell(self.client, title, notices.fault_lines(error))
        if self.session.run is not None:
            self.run_ended()

    def run_failed(self, error: Exception) -> None:
        """Something of ours went wrong; the last good picture stays."""
        notices.tell(self.client, "Something went wrong", [f"{type(error).__name__}: {error}"])
        self.header.show_failed(self.session.run_number)
        self.client.flush()

    def run_ended(self) -> None:
        """Show the session's run: the figures of the tabs in front, the map, and last the run element."""
        began = time.perf_counter()
        session, found = self.session, shown(self.session)
        if found is None or session.run is None or self._closed:
            return
        run, number = session.run, found.number
        wanted = PICTURED.intersection(self._front) or set(PICTURED)
        pictures = self._results.make(found, wanted, session.selected)
        content = _run_element(run, number)
        with session.lock, self.client.atomic():
            self._stale = PICTURED - wanted
            self._results.show(pictures)
            self._stage.draw(found)
            self.findings.show()
            self.method.show_warnings(run, session.scenario, session.selected)
            self.lessons.show(session.scenario, run, self._editor.moved)
            frame_ms = 1e3 * (run.elapsed_s + time.perf_counter() - began)
            self.header.show_run(run, number, outdated=session.outdated, frame_ms=frame_ms)
            self._run_element.content = content
        self.client.flush()
        # A tab that came to the front meanwhile was not yet known to be stale.
        self._show_stale()

    def _again(self) -> None:
        with self.session.lock, self.client.atomic():
            self.refresh()

    def _again_pictures(self) -> None:
        """Make the figures in front anew, from the run there is."""
        self._stale = set(PICTURED)
        self._show_stale()

    def _show_stale(self) -> None:
        session = self.session
        with session.lock:
            found = shown(session)
            wanted = self._stale.intersection(self._front or PICTURED)
        if found is None or not wanted:
            return
        pictures = self._results.make(found, wanted, session.selected)
        with session.lock, self.client.atomic():
            if self._closed or session.run_number != found.number:
                return
            self._stale -= wanted
            self._results.show(pictures)
        self.client.flush()

    # ------------------------------------------------------------ size and tabs

    def _on_state(self) -> None:
        window, front = read_state(self._state.value)
        if window is None:
            return
        self._window = window
        if front:
            self._front = front
        self._reported.set()
        if self._built:
            heard = escape(self._state.value.strip())
            self._heard.content = f'<div id="sb-heard" hidden data-state="{heard}"></div>'
            self._arrange()
            self._show_stale()
            if MISPRINTS in self._front:
                self._results.laboratory.show()

    def _arrange(self) -> None:
        """Lay the results out anew if the window has another size now."""
        with self.session.lock, self.client.atomic():
            layout = layout_for(*self._window)
            if self._closed or layout == self._layout:
                return
            self._layout = layout
            self.gui.main_panel.set_width(layout.left_px)
            self._results.remove()
            self._results = self._make_results()
            self._front, self._stale = (), set(PICTURED)
        self._stage.fit(layout.view_aspect)
        self.client.flush()


def _run_element(run: Run, number: int) -> str:
    digest = hashlib.blake2b(digest_size=16)
    for method in run.methods:
        digest.update(method.plot.values.tobytes())
        digest.update(method.rows.tobytes())
    return (
        f'<div id="sb-run" hidden data-run="{number}" data-status="{run.status}" '
        f'data-digest="{digest.hexdigest()}">{escape(as_json(metrics(run)).decode())}</div>'
    )

"""One open page: makes its views, tells them what the session says, and shows the pictures in front.

For programs that watch the page: the element ``#sb-run`` carries ``data-run`` (the number of the run that is
shown), ``data-digest`` (of the run's arrays) and, as its text, the run's metrics as JSON. It is the last
thing sent for a run. A control is found by its label's exact text.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence, Set
from contextlib import nullcontext
from html import escape
from typing import TYPE_CHECKING

from navcore.foundation.errors import InputError
from navcore.foundation.text import Text
from schuler_bench.bridge.boxes import NumberBoxes
from schuler_bench.bridge.server import leaving_is_no_fault
from schuler_bench.bridge.texts import keep_names
from schuler_bench.jobs.words import what_failed
from schuler_bench.session.names import GivenNames
from schuler_bench.session.session import Session
from schuler_bench.session.shown import shown
from schuler_bench.shell import notices
from schuler_bench.shell.column import Column
from schuler_bench.shell.commands import Commands
from schuler_bench.shell.editor import Editor
from schuler_bench.shell.following import Following
from schuler_bench.shell.header import HeaderPanel
from schuler_bench.shell.keeping import KeepingPanel
from schuler_bench.shell.layout import Columns, Layout, Window, layout_for
from schuler_bench.shell.left import LeftColumn
from schuler_bench.shell.opening import Opening
from schuler_bench.shell.pace import Pace
from schuler_bench.shell.palette import Palette
from schuler_bench.shell.reports import Reports, run_element, views_element
from schuler_bench.shell.view import Frame, View, page_styles
from schuler_bench.shell.view_faults import ViewFaults

if TYPE_CHECKING:
    import viser

_SIZE_WAIT_S = 1.5


class Page:
    """A browser page on a session (`schuler_bench.session.session.View`).

    Parameters
    ----------
    client : viser.ClientHandle
        The browser.
    session : Session
        Whose work is shown.
    kinds : sequence of type
        The registered views, in the order of their tabs.
    """

    def __init__(self, client: viser.ClientHandle, session: Session, kinds: Sequence[type[View]]) -> None:
        self.client, self.session, self.gui = client, session, client.gui
        self._closed = self._built = self._tells = False
        self._window: Window = (0, 0, False, False, 1.0, Columns())
        self._selected = session.selected
        self._front: frozenset[str] = frozenset()
        self._views: list[View] = []
        self._faults = ViewFaults(client)
        self._pace = Pace(self._draw, self._refresh_late)
        self._build(kinds)

    # ------------------------------------------------------------ building

    def _build(self, kinds: Sequence[type[View]]) -> None:
        gui, session = self.gui, self.session
        leaving_is_no_fault(self.client)
        keep_names(self.client, GivenNames(session))
        self._reports = Reports(gui, self._on_window, self._pace.on_painted)
        self.commands = Commands(gui, self._command_failed)
        NumberBoxes(gui)
        css = page_styles(kinds, self._reports.window_id, self.commands.box_id)
        gui.add_html(f"<style>{css}</style>", order=0)
        self.client.flush()
        self._tells = self._reports.wait_for_window(_SIZE_WAIT_S)
        if self._tells:
            self._pace.expect_answers()
        else:
            # No word from the script: the view, in device pixels, covers the window while nothing is docked.
            camera = self.client.camera
            width, height = max(camera.image_width, 1280), max(camera.image_height, 720)
            self._window = (width, height, False, False, 1.0, Columns())
        with session.lock, self.client.atomic():
            self._layout = self.wanted_layout()
            gui.main_panel.dock_left()
            gui.main_panel.set_width(round(self._layout.left_px * self._layout.scale))
            self._make_views(kinds)
            gui.add_html(views_element(kinds), order=3)
            self._run_element = gui.add_html("", order=2)
            self._heard = gui.add_html("", order=3)
            self._picture = gui.add_html("", order=3)
            self.refresh()
            self._keeping.show()
            self._fold()
            for view in self._views:
                self._faults.call(view.follow_display)
            self.commands.show()
        self.client.flush()
        self._built = True
        self._arrange()
        for view in self._views:
            self._faults.call(view.resize)
        session.attach(self)
        session.searches.watch(self._searches_changed)
        if session.run is not None:
            self.run_ended()
        if session.waits:
            self.run_waits()

    def _make_views(self, kinds: Sequence[type[View]]) -> None:
        gui, session, client = self.gui, self.session, self.client
        opening = Opening(client, session, self._again)
        self.editor = Editor(client, session, self, lambda: frame.controls())
        bar = gui.add_folder("", order=4)
        frame = Frame(
            client, bar, session, self.commands, self.editor, opening, kinds, lambda: self._layout,
            lambda: self._views, self._again_pictures, self._again,
        )  # fmt: skip
        focus = {kind.focus: kind.title for kind in kinds if kind.focus}
        self.header = HeaderPanel(gui, bar, opening, session, focus)
        self._keeping = KeepingPanel(client, bar, session.keeping)
        self._views = [kind(frame) for kind in kinds]
        self._left = LeftColumn(gui, self._faults)
        for view in self._views:
            if view.place == "edit":
                self._left.build(view)
            elif view.place == "page":
                self._faults.call(view.build, nullcontext())
        self.column = Column(gui, [v for v in self._views if v.place in ("upper", "lower")], self._faults)
        self.column.build(self._layout)
        # One that could not be built has no widgets to show anything with: its fault stands in its tab.
        self._views = [view for view in self._views if not self._faults.failed(view)]
        self._following = Following(self._views, self.column, self._faults)
        free = frozenset({self._reports.window_id, self._reports.painted_id, self.commands.box_id})
        self.palette = Palette(frame, self, free)

    def close(self) -> None:
        """The browser has gone."""
        with self.session.lock:
            self._closed = True
        self.editor.close()
        self._pace.close()
        self.commands.close()
        for view in self._views:
            self._faults.call(view.close)
        self.session.searches.unwatch(self._searches_changed)
        self.session.detach(self)

    def _command_failed(self, error: Exception) -> None:
        notices.tell(self.client, Text("That did not work"), [what_failed(error)])

    # ------------------------------------------------------------ what the session says

    def scenario_changed(self, by: object) -> None:
        """Show the session's scenario in all controls."""
        if by is not self:
            self.editor.moved = None
        elif self.editor.by_slider:
            # The other controls follow with the picture: a slider gives twenty values in a second.
            self._pace.follow_later()
            return
        with self.client.atomic():
            self.refresh()
        if self._selected != self.session.selected:
            self._selected = self.session.selected
            self.column.mark_stale(self.column.of_selected)
            self._show_stale()

    def refresh(self) -> None:
        """Let every view in sight show the session's scenario; the control in use stays as it is."""
        self._pace.controls_wait = False
        self.editor.catch_up()
        self.header.show_scenario()
        self._following.follow(self._in_front)
        self._left.show(self.session.opened)
        self.palette.show()

    def display_changed(self, by: object) -> None:
        """Draw the pictures in front as the session's display says."""
        del by
        self._arrange()
        self._update(self._follow_display)
        self._again_pictures()

    def _follow_display(self) -> None:
        sources = shown(self.session)
        self._fold()
        for view in self._views:
            self._faults.call(view.follow_display)
            if sources is not None:
                self._faults.call(view.draw, sources)

    def _fold(self) -> None:
        self.header.fold(self.session.display.enlarged)

    def run_progressed(self, fraction: float, elapsed_s: float) -> None:
        """Mark the picture as old once a run takes its time."""
        if elapsed_s > 0.5 and not self._closed:
            self.header.show_progress(fraction, self.session.run_number)
            self.client.flush()

    def run_awaits_kernels(self) -> None:
        """Say how far the kernels are; told again and again."""
        if not self._closed:
            self.header.show_compiling(self.session.run_number)
            self.client.flush()

    def run_stopped(self) -> None:
        """The user stopped the run."""
        self.header.show_stopped(self.session.run_number)
        self.client.flush()

    def keeping_changed(self) -> None:
        """The work is not kept over a restart at present, or no longer so."""
        self._update(self._keeping.show)

    def run_waits(self) -> None:
        """The changed scenario takes long: it runs when the user asks for it."""
        self.palette.show()
        self.header.show_waiting(self.session.scenario, self.session.run_number)
        self.client.flush()

    def presenter_changed(self) -> None:
        """Another page drives now, or none."""
        self._update(self.palette.show_presenter)
        self.session.pages.tell_front(self, self._front)

    def front_changed(self, front: Set[str]) -> None:
        """Follow the tabs of the page that presents."""
        # All of them: what this page has told of its own tabs may be older than what it was asked last.
        if not self._closed:
            self.commands.ask_page("front", "|".join(sorted(front)))
            self.client.flush()

    def envelope_progressed(self) -> None:
        """The envelope of the error curves has come further, or cannot be made."""
        self._jobs_changed()

    def _searches_changed(self) -> None:
        self._jobs_changed()
        with self.session.lock:
            fresh = not self._closed and [view for view in self._views if self._faults.call(view.take_new)]
        if fresh:
            self._again_pictures()

    def _jobs_changed(self) -> None:
        self._update(self._follow_jobs)

    def _follow_jobs(self) -> None:
        self._following.follow(self._in_front, jobs_alone=True)

    def _update(self, act: Callable[[], None]) -> None:
        """Change the page in one piece, unless it has gone."""
        with self.session.lock, self.client.atomic():
            if self._closed:
                return
            act()
        self.client.flush()

    def run_refused(self, error: InputError) -> None:
        """The scenario cannot run; the last good one is back."""
        title = Text("The scenario cannot run; the last good one is back")
        notices.tell(self.client, title, notices.fault_lines(error))
        if self.session.run is not None:
            self.run_ended()

    def run_failed(self, error: Exception) -> None:
        """Something of ours went wrong; the last good picture stays."""
        notices.tell(self.client, Text("Something went wrong"), [what_failed(error)])
        self.header.show_failed(self.session.run_number)
        self.client.flush()

    def run_ended(self) -> None:
        """Show the session's run, once the page has painted what it was sent before."""
        self._pace.ended()

    def _draw(self, number: int, whole: bool) -> None:
        """Show the session's run: what is in front; if ``whole``, all other views and the run element too."""
        began = time.perf_counter()
        session, sources = self.session, shown(self.session)
        if sources is None or session.run is None or self._closed:
            return
        run, wanted = session.run, self.column.wanted(self._in_front)
        pictures = self.column.make(sources, wanted)
        content = run_element(run, sources.number) if whole else ""
        with session.lock, self.client.atomic():
            self.column.mark_stale()
            self.column.show(sources, pictures, wanted)
            self.editor.catch_up()
            if whole:
                for view in self._views:
                    self._faults.call(view.draw, sources)
                if self._pace.controls_wait:
                    self.refresh()
                else:
                    self.palette.show()
                    self._follow_jobs()
                frame_ms = 1e3 * (run.elapsed_s + time.perf_counter() - began)
                self.header.show_run(run, sources.number, outdated=session.outdated, frame_ms=frame_ms)
                self._run_element.content = content
            elif self._pace.moving:
                self.header.show_moving()
            attributes = f'data-number="{number}" data-answer="{self._reports.painted_id}"'
            self._picture.content = Text("<div id='sb-picture' hidden {told}></div>", told=attributes)
        self.client.flush()
        self._show_stale()  # a tab that came to the front meanwhile was not yet known to be out of date

    def _again(self) -> None:
        with self.session.lock, self.client.atomic():
            self.refresh()

    def _refresh_late(self) -> None:
        """Let the controls follow a slider whose picture takes its time; while it moves they wait for it."""
        if moving := self._pace.moving:
            self._pace.follow_later()
        if self._pace.controls_wait:
            self._update(self.editor.catch_up if moving else self.refresh)

    def _again_pictures(self) -> None:
        """Make the pictures in front anew, from the run there is."""
        self.column.mark_stale()
        self._show_stale()

    def _show_stale(self) -> None:
        session = self.session
        with session.lock:
            sources, wanted = shown(session), self.column.stale(self._in_front)
        if sources is None or not wanted:
            return
        pictures = self.column.make(sources, wanted)
        with session.lock, self.client.atomic():
            if self._closed or session.run_number != sources.number:
                return
            self.column.show(sources, pictures, wanted)
        self.client.flush()

    # ------------------------------------------------------------ size and tabs

    def _on_window(self, window: Window, rooms: dict[str, int], report: str) -> None:
        self._window, front = window, frozenset(rooms)
        if front:
            fresh, self._front = front - self._front, front
            self.session.pages.tell_front(self, fresh)
        if self._built:
            self._heard.content = f'<div id="sb-heard" hidden data-state="{escape(report)}"></div>'
            self._arrange()
            if self._following.is_late(front):
                self._update(lambda: self._following.catch_up(front))
            self.column.take_rooms(rooms)
            self._show_stale()
            self.column.tell_front(self._front)

    @property
    def _in_front(self) -> frozenset[str]:
        """Tabs in front: as the page tells them, until then the first ones; none where it never tells."""
        return self._front or (self.column.foremost if self._tells else frozenset())

    def wanted_layout(self) -> Layout:
        """Sizes for the window as it is, and as large as the session's display says."""
        return layout_for(*self._window, presentation=self.session.display.enlarged)

    def _arrange(self) -> None:
        """Lay the results out anew if the window, or what stands in it, has another size now.

        Panels that are made anew have their first tab in front: the page is asked for those that were.
        """
        with self.session.lock, self.client.atomic():
            layout = self.wanted_layout()
            if self._closed or layout == self._layout:
                return
            self._layout = layout
            self.gui.main_panel.set_width(round(layout.left_px * layout.scale))
            self.column.build(layout)
            front = [view.title for view in self._views if view.title in self._front]
            if front:
                self._heard.content = ""
                self.commands.ask_page("front-again", "|".join(front))
            for view in self._views:
                self._faults.call(view.follow_scenario)
                self._faults.call(view.follow_display)
                self._faults.call(view.follow_jobs)
        for view in self._views:
            self._faults.call(view.resize)
        self.client.flush()

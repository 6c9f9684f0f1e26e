"""In the top bar: name, scenario, state of the run, progress, cancel; below the controls its warnings."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from navcore.engine.run import ENDINGS, Run
from navcore.foundation.text import Text, quoted
from navcore.foundation.units import HOUR
from navcore.scenario.model import Scenario
from navcore.scenario.provenance import source_of
from schuler_bench.jobs import kernels
from schuler_bench.plots import style
from schuler_bench.plots.units import duration
from schuler_bench.session.session import Session
from schuler_bench.shell import notices
from schuler_bench.shell.opening import Opening
from schuler_bench.shell.view import Tab, if_user

if TYPE_CHECKING:
    import viser

RUN_AGAIN, RUN_STRAPDOWN = Text("Run again"), Text("Run the strapdown")
_NAME = '<div class="sb-topbar" data-sb-part="name"><h1>Schuler Bench</h1></div>'
WARNINGS = 30.0
"""Place in the left column of what is to be heeded: below the tabs, where it moves no control."""
_WAITS = "#B26A00"
"""Colour of a state that will not last."""
# While a picture is old it is dimmed.
_DIM = "<style>.js-plotly-plot,.uplot,.sb-table{opacity:.45}</style>"
# Over the frames of the pictures, empty before the first run; the bar would cut an element of its own.
_BEFORE_PICTURES = (
    '{state}<style>body::after{{content:"{title}\\a {rest}";position:fixed;left:70%;top:30%;z-index:20;'
    "transform:translateX(-50%);padding:14px 20px;border:1px solid #c9d2da;border-radius:8px;background:#fff;"
    "color:#33475b;font:15px var(--sb-font,sans-serif);text-align:center;white-space:pre;"
    "pointer-events:none}}</style>"
)


class HeaderPanel:
    """Scenario and run in the top bar.

    Parameters
    ----------
    gui : viser.GuiApi
        Of the client.
    bar : Tab
        The top bar.
    opening : Opening
        Scenarios to choose from.
    session : Session
        Whose scenario and run are shown.
    focus : mapping
        Name in a scenario's block ``view`` -> title of the tab in which such a scenario opens.
    """

    def __init__(
        self, gui: viser.GuiApi, bar: Tab, opening: Opening, session: Session, focus: Mapping[str, str]
    ) -> None:
        self._opening, self._session, self._focus = opening, session, focus
        with bar:
            gui.add_html(_NAME, order=0)
            self._scenario = gui.add_dropdown(
                "scenario",
                opening.scenarios(),
                hint=Text("A preset, or what was uploaded; choosing one starts from it anew."),
                order=1,
            )
            self._about = gui.add_html("", order=2)
            self._state = gui.add_html("", order=10)
            self._progress = gui.add_progress_bar(0.0, visible=False, order=11)
            self._stop = gui.add_button(Text("Stop the run"), color="orange", visible=False, order=12)
            self._again = gui.add_button(RUN_AGAIN, visible=False, order=13)
        self._note = gui.add_html("", visible=False, order=WARNINGS)
        self._scenario.on_update(if_user(lambda: opening.choose_scenario(self._scenario.value)))
        self._stop.on_click(lambda _: session.cancel_run())
        self._again.on_click(lambda _: session.redo_run())

    def show_scenario(self) -> None:
        """Show which scenario the session has."""
        scenario, origin, options = self._session.scenario, self._session.origin, self._opening.scenarios()
        offered = options if origin in options else (*options, origin)
        if self._scenario.options != offered:
            self._scenario.options = offered
        self._scenario.value = origin
        lines = [
            Text("<b>{title:html}</b>", title=scenario.title) if scenario.title else "",
            quoted(source_of(scenario)),
        ]
        tab = self._focus.get(scenario.view.focus, "")
        self._about.content = Text(
            '<div data-sb-part="about"><button class="sb-do sb-about" popovertarget="sb-focus" '
            'aria-label="About the scenario" title="{title:html}">i</button>'
            '<div id="sb-focus" popover data-scenario="{origin:html}" data-tab="{tab:html}">'
            "{line}</div></div>",
            origin=origin,
            tab=tab,
            title=scenario.title or origin,
            line=Text.joined("<br>", (line for line in lines if line)),
        )

    def fold(self, folded: bool) -> None:
        """Hide or show the chooser of the scenario."""
        if self._scenario.visible == folded:
            self._scenario.visible = not folded

    def show_run(self, run: Run, number: int, *, outdated: bool, frame_ms: float) -> None:
        """Say which run the pictures show."""
        count = len(run.methods)
        span = duration(float(run.t_s[-1])) if len(run.t_s) else "0 s"
        text = Text("Run {number}", number=number)
        if run.status != "ok":
            text = Text("{text}, {status}", text=text, status=ENDINGS[run.status])
        rest = Text.plural(
            "{span}, {count} method, {frame_ms:.0f} ms",
            "{span}, {count} methods, {frame_ms:.0f} ms",
            span=span,
            count=count,
            frame_ms=frame_ms,
        )
        if outdated:
            self._show_state(text, Text("a new run follows"), _WAITS)
        else:
            self._show_state(text, rest, "#2E7D32" if run.status == "ok" else style.DANGER)
        self._show_buttons(progress=False, again=False)
        self._note.content = notices.note(run.warnings, "info")
        self._note.visible = bool(run.warnings)

    def show_moving(self) -> None:
        """Say that only the pictures in front follow the slider; the rest is shown when it rests."""
        self._show_state(Text("The slider moves"), Text("3D view and numbers follow when it rests"), _WAITS)

    def show_progress(self, fraction: float, number: int) -> None:
        """Say that the pictures are old and a run is under way."""
        self._progress.value = round(100.0 * fraction, 1)
        if not self._progress.visible:
            self._show_state(Text("Computing"), _still(number), _WAITS, old=True)
            self._show_buttons(progress=True, again=False)

    def show_compiling(self, number: int) -> None:
        """Say that a run waits for its kernels: in the bar, and over the pictures that are not there yet."""
        title, rest, compiling = Text("Compiling the kernels, once: about a minute"), "", kernels.compiling()
        if compiling is not None and compiling.total:
            done, total = compiling.done, compiling.total
            rest = Text("{done} of {total}: {kernel}", done=done, total=total, kernel=compiling.name)
            self._progress.value = round(100.0 * done / total, 1)
        self._show_state(title, rest, _WAITS, old=number > 0)
        self._show_buttons(progress=True, again=False)
        if number == 0:
            self._state.content = Text(_BEFORE_PICTURES, state=self._state.content, title=title, rest=rest)

    def show_stopped(self, number: int) -> None:
        """Say that the pictures are old because the run was stopped."""
        self._show_old(Text("Stopped"), _still(number))

    def show_waiting(self, scenario: Scenario, number: int) -> None:
        """Say that the pictures are old until the user starts a run that would take long."""
        samples = scenario.run.duration_h * HOUR * scenario.run.rate_hz / 1e6
        rest = Text("{samples:.3g} million samples a method; {still}", samples=samples, still=_still(number))
        self._show_old(Text("Strapdown waits"), rest, again=RUN_STRAPDOWN)

    def show_failed(self, number: int) -> None:
        """Say that the pictures are the last good ones."""
        self._show_old(Text("The run failed"), _still(number), style.DANGER)

    def _show_old(self, text: str, rest: str, color: str = _WAITS, again: str = RUN_AGAIN) -> None:
        """Say why the pictures are old, beside a button that runs the scenario."""
        self._show_state(text, rest, color, old=True)
        self._again.label = again
        self._show_buttons(progress=False, again=True)

    def _show_buttons(self, *, progress: bool, again: bool) -> None:
        self._progress.visible = self._stop.visible = progress
        self._again.visible = again

    def _show_state(self, text: str, rest: str, color: str, *, old: bool = False) -> None:
        """Say something, and more where the bar has room for it."""
        self._state.content = Text(
            '<div id="sb-status" role="status" data-sb-part="status" title="{text:html}: {rest:html}">'
            '<span style="background:{color}"></span><b>{text:html}</b> '
            "<div data-sb-drops><span>{rest:html}</span></div></div>{dim}",
            color=color,
            text=text,
            rest=rest,
            dim=_DIM if old else "",
        )


def _still(number: int) -> str:
    return Text("the pictures still show run {number}", number=number)

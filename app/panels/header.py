"""Above the tabs: the state of the run, progress and cancel, the scenario chooser."""

from __future__ import annotations

from collections.abc import Callable
from html import escape
from typing import TYPE_CHECKING, Any

from app.figures import style
from app.figures.units import duration
from app.page import notices
from navcore.run import Run
from navcore.scenario import Scenario
from navcore.units import HOUR

if TYPE_CHECKING:
    import viser

UPLOADED = "uploaded"
RUN_AGAIN, RUN_STRAPDOWN = "Run again", "Run the strapdown"
FOCUS = {"errors": "Errors", "bode": "Frequency", "step": "Step"}
"""Tab in which a scenario opens, by its block ``view``."""
_AUTO = "fit"
_FACTORS: tuple[str, ...] = (
    _AUTO,
    "1",
    "2",
    "5",
    "10",
    "20",
    "50",
    "100",
    "200",
    "500",
    "1000",
    "2000",
    "5000",
)
# While a picture is old it is dimmed.
_DIM = "<style>.js-plotly-plot,.uplot,.sb-table{opacity:.45}</style>"


class HeaderPanel:
    """What is always in view at the left.

    Parameters
    ----------
    gui : viser.GuiApi
        Of the client.
    options : tuple of str
        Scenarios to choose from.
    choose : callable
        ``choose(name)``.
    stop, again : callable
        The user stops the run, or wants it after all.
    exaggerate : callable
        ``exaggerate(factor or None)``.
    """

    def __init__(
        self,
        gui: viser.GuiApi,
        options: tuple[str, ...],
        choose: Callable[[str], None],
        stop: Callable[[], None],
        again: Callable[[], None],
        exaggerate: Callable[[float | None], None],
    ) -> None:
        self._state = gui.add_html("", order=10)
        self._progress = gui.add_progress_bar(0.0, visible=False, order=11)
        self._stop = gui.add_button("Stop the run", color="orange", visible=False, order=12)
        self._again = gui.add_button(RUN_AGAIN, visible=False, order=13)
        self._scenario = gui.add_dropdown(
            "scenario",
            options,
            hint="A preset, or what was uploaded; choosing one starts from it anew.",
            order=14,
        )
        self._about = gui.add_html("", order=15)
        self._note = gui.add_html("", visible=False, order=16)
        self._factor = gui.add_dropdown(
            "errors in 3D drawn (x)", _FACTORS, order=18,
            hint="Factor by which the 3D view enlarges the position errors; fit: chosen so that they show.",
        )  # fmt: skip
        self._scenario.on_update(lambda event: _if_user(event, lambda: choose(self._scenario.value)))
        self._stop.on_click(lambda _: stop())
        self._again.on_click(lambda _: again())
        self._factor.on_update(lambda event: _if_user(event, lambda: exaggerate(self._chosen_factor)))

    @property
    def _chosen_factor(self) -> float | None:
        return None if self._factor.value == _AUTO else float(self._factor.value)

    def show_scenario(self, scenario: Scenario, origin: str, options: tuple[str, ...]) -> None:
        """Show which scenario this is."""
        offered = options if origin in options else (*options, origin)
        if self._scenario.options != offered:
            self._scenario.options = offered
        self._scenario.value = origin
        lines = [f"<b>{escape(scenario.title)}</b>" if scenario.title else "", escape(scenario.source)]
        self._about.content = (
            f'<div id="sb-focus" data-scenario="{escape(origin)}" data-tab="{FOCUS[scenario.view.focus]}" '
            f'style="margin:-2px 10px 8px;font-size:12.5px;line-height:1.35;color:{style.MUTED}">'
            f"{'<br>'.join(line for line in lines if line)}</div>"
        )

    def show_exaggeration(self, factor: float | None) -> None:
        """Show the chosen factor."""
        self._factor.value = _AUTO if factor is None else f"{factor:g}"

    def show_run(self, run: Run, number: int, *, outdated: bool, frame_ms: float) -> None:
        """Say which run the pictures show."""
        ended = {"ok": "", "diverged": ", diverged", "stopped": ", stopped"}[run.status]
        count = len(run.methods)
        span = duration(float(run.t_s[-1])) if len(run.t_s) else "0 s"
        text = f"Run {number}: {span}, {count} method{'s' * (count != 1)}, {frame_ms:.0f} ms{ended}"
        self._show_state(text, "#2E7D32" if run.status == "ok" else style.DANGER)
        if outdated:
            self._show_state(f"{text}; a new run follows", "#B26A00")
        self._hide_progress(again=False)
        self._say(notices.note(run.warnings, "info"))

    def show_progress(self, fraction: float, number: int) -> None:
        """Say that the pictures are old and a run is under way."""
        self._progress.value = round(100.0 * fraction, 1)
        if not self._progress.visible:
            self._show_state(f"Computing; the pictures still show run {number}", "#B26A00", old=True)
            self._progress.visible = self._stop.visible = True
            self._again.visible = False

    def show_stopped(self, number: int) -> None:
        """Say that the pictures are old because the run was stopped."""
        self._show_state(f"Stopped; the pictures still show run {number}", "#B26A00", old=True)
        self._hide_progress(again=True)

    def show_waiting(self, scenario: Scenario, number: int) -> None:
        """Say that the pictures are old until the user starts a run that would take long."""
        samples = scenario.run.duration_h * HOUR * scenario.run.rate_hz / 1e6
        text = f"{samples:.3g} million samples a method: run it when you are ready"
        self._show_state(f"Strapdown, {text}; the pictures still show run {number}", "#B26A00", old=True)
        self._hide_progress(again=True, label=RUN_STRAPDOWN)

    def show_failed(self, number: int) -> None:
        """Say that the pictures are the last good ones."""
        self._show_state(f"The run failed; the pictures show run {number}", style.DANGER, old=True)
        self._hide_progress(again=True)

    def _hide_progress(self, *, again: bool, label: str = RUN_AGAIN) -> None:
        self._progress.visible = self._stop.visible = False
        self._again.label = label
        self._again.visible = again

    def _say(self, html: str) -> None:
        self._note.content, self._note.visible = html, bool(html)

    def _show_state(self, text: str, color: str, *, old: bool = False) -> None:
        self._state.content = (
            '<div id="sb-status" role="status" style="margin:2px 10px 8px;font-size:12.5px;'
            f'color:{style.INK}"><span style="display:inline-block;width:9px;height:9px;border-radius:50%;'
            f'margin-right:7px;background:{color}"></span>{escape(text)}</div>{_DIM if old else ""}'
        )


def _if_user(event: viser.GuiEvent[Any], act: Callable[[], None]) -> None:
    if event.client is not None:
        act()

"""Above the tabs: verify the scenario with the full strapdown, progress, stop, and what came out."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from app.background.verifier import Verifier
from app.figures.table import verdict
from app.page import notices
from navcore.scenario import Scenario

if TYPE_CHECKING:
    import viser

VERIFY, STOP = "Verify with full strapdown", "Stop verifying"
_TOLD = (
    "Runs the scenario as full nonlinear strapdown, and the linear model on the same noise, and draws both: "
    "solid linear, dashed strapdown. Their differences stand in the tab Metrics."
)


class VerificationPanel:
    """Button, progress and verdict.

    Parameters
    ----------
    gui : viser.GuiApi
        Of the client.
    start, stop : callable
        The user wants a verification, or no more of it.
    order : float
        Place of the first widget.
    """

    def __init__(
        self, gui: viser.GuiApi, start: Callable[[], None], stop: Callable[[], None], order: float
    ) -> None:
        self._start = gui.add_button(VERIFY, color="gray", hint=_TOLD, order=order)
        self._progress = gui.add_progress_bar(0.0, visible=False, order=order + 0.1)
        self._stop = gui.add_button(STOP, color="orange", visible=False, order=order + 0.2)
        self._verdict = gui.add_html("", visible=False, order=order + 0.3)
        self._start.on_click(lambda _: start())
        self._stop.on_click(lambda _: stop())

    def show(self, verifier: Verifier, scenario: Scenario) -> None:
        """Show how far a verification is, or what the last one gave, and of which scenario."""
        fraction = verifier.fraction
        running = fraction is not None
        if fraction is not None:
            self._progress.value = round(100.0 * fraction, 1)
        for handle, wanted in ((self._start, not running), (self._progress, running), (self._stop, running)):
            if handle.visible != wanted:
                handle.visible = wanted
        html = _html(verifier, scenario)
        if self._verdict.content != html:
            self._verdict.content, self._verdict.visible = html, bool(html)


def _html(verifier: Verifier, scenario: Scenario) -> str:
    if verifier.fraction is not None:
        return notices.note(["Verifying: the full strapdown and the linear model on its noise."], "info")
    if verifier.words:
        return notices.note(verifier.words, "warning")
    result = verifier.result
    if result is None:
        return ""
    if verifier.scenario != scenario:
        return notices.note(["The verification is of an earlier scenario: verify again."], "warning")
    trusted = notices.note([f"Verified. {verdict(result)}"], "info")
    against = ["The linear model is not to be trusted here:", *result.statements] if result.statements else []
    return notices.note(against, "warning") + trusted

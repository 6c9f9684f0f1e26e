"""In the top bar: verify the scenario with the full strapdown, progress, stop, and what came out."""

from navcore.foundation.text import Text
from navcore.questions.verify import VerifyQuestion
from navcore.scenario.model import Scenario
from schuler_bench.jobs.asking import Asker
from schuler_bench.shell import notices
from schuler_bench.shell.header import WARNINGS
from schuler_bench.shell.searching import reveal, show_html
from schuler_bench.shell.view import Frame, Tab, View
from schuler_bench.views.metrics.table import verdict

VERIFY, STOP = Text("Verify with full strapdown"), Text("Stop verifying")
_ORDER = 35.0
"""Place in the top bar: before the buttons that share."""
_TOLD = Text(
    "Runs the scenario as full nonlinear strapdown, and the linear model on the same noise. The run's own "
    'curves stay. The tab Errors draws both models and their difference (curves "Verification"), and its '
    "mode Metrics shows the largest differences."
)
_WHERE = Text('Tab Errors, curves "Verification": both models and their difference.')


class VerificationView(View):
    """Button, progress and verdict."""

    asks = ("verify",)

    def __init__(self, frame: Frame) -> None:
        super().__init__(frame)
        self._shown = frame.session.verifier.result
        frame.commands.register("verify", lambda _: self._verify(), Text("Verify with the strapdown"))

    def build(self, tab: Tab) -> None:
        """Make the widgets."""
        gui = self.frame.gui
        with self.frame.bar:
            # A small one, as those beside it: it is not the first thing to press.
            self._start = gui.add_html(
                Text(
                    '<div class="sb-row" data-sb-part="row"><button class="sb-do" data-command="verify" '
                    'title="{told:html}" aria-label="{verify}">Verify</button></div>',
                    told=_TOLD,
                    verify=VERIFY,
                ),
                order=_ORDER,
            )
            self._progress = gui.add_progress_bar(0.0, visible=False, order=_ORDER + 0.1)
            self._stop = gui.add_button(STOP, color="orange", visible=False, order=_ORDER + 0.2)
        with tab:
            self._verdict = gui.add_html("", visible=False, order=WARNINGS + 1)
        self._stop.on_click(lambda _: self.session.verifier.cancel())

    def _verify(self) -> None:
        with self.session.lock:
            scenario = self.session.scenario
        self.session.verifier.begin(VerifyQuestion(scenario=scenario))

    def take_new(self) -> bool:
        """Whether a verification has just ended."""
        before, self._shown = self._shown, self.session.verifier.result
        return before is not self._shown

    def follow_jobs(self) -> None:
        """Show how far a verification is, or what the last one gave, and of which scenario."""
        verifier = self.session.verifier
        fraction = verifier.fraction
        running = fraction is not None
        if fraction is not None:
            self._progress.value = round(100.0 * fraction, 1)
        reveal((self._start, not running), (self._progress, running), (self._stop, running))
        show_html(self._verdict, _html(verifier, self.session.scenario))


def _html(verifier: Asker, scenario: Scenario) -> str:
    if verifier.fraction is not None:
        progress = notices.note(
            [Text("Verifying: the full strapdown and the linear model on its noise.")], "info"
        )
        return progress + notices.note(verifier.words, "warning")
    if verifier.words:
        return notices.note(verifier.words, "warning")
    result = verifier.result
    if result is None:
        return ""
    if verifier.asked is None or verifier.asked.scenario != scenario:
        return notices.note([Text("The verification is of an earlier scenario: verify again.")], "warning")
    trusted = notices.note([Text("Verified. {verdict}", verdict=verdict(result)), _WHERE], "info")
    against = (
        [Text("The linear model is not to be trusted here:"), *result.statements] if result.statements else []
    )
    return notices.note(against, "warning") + trusted


VIEW = VerificationView

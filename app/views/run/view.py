"""Fold "Run" of the tab "Setup": duration, site, initial errors, seed, strapdown settings."""

from navcore.foundation.text import Text
from navcore.scenario.blocks import Alignment, RunSettings, SiteSettings
from navcore.scenario.initial_error import InitialError
from navcore.scenario.model import Scenario
from schuler_bench.editing import form
from schuler_bench.editing.form import FieldSpec, Path
from schuler_bench.shell import notices
from schuler_bench.shell.view import FieldsView, Tab

_RATE, _STRAPDOWN_ONLY = "rate_hz", ("vertical", "compensation")
_STRAPDOWN_TOLD = Text(
    'Used by "Verify with full strapdown", and where the fidelity is strapdown. A long strapdown run does '
    "not follow every move of a control: it is started by a button at the top."
)


class RunView(FieldsView):
    """Duration, site, initial errors, seed."""

    title = Text("Run")
    place = "edit"
    tab = Text("Setup")
    places = {"run": 1.0, "site": 20.0, "initial": 71.0, "strapdown": 92.0}

    def build(self, tab: Tab) -> None:
        """Make the widgets."""
        super().build(tab)
        gui = self.frame.gui
        with tab:
            gui.add_html(notices.heading(Text("Errors at the start")), order=70)
            gui.add_html(notices.heading(Text("Full strapdown")), order=90)
            gui.add_html(notices.small(_STRAPDOWN_TOLD), order=91)

    def follow_scenario(self) -> None:
        """Show the scenario's values."""
        scenario, settings = self.session.scenario, form.fields(RunSettings, ("run",))
        self.show_fields(
            {
                "run": [spec for spec in settings if spec.path[-1] not in (_RATE, *_STRAPDOWN_ONLY)],
                "site": form.fields(SiteSettings, ("site",)),
                "initial": form.fields(InitialError, ("initial_error",)),
                "strapdown": [
                    *(spec for spec in settings if spec.path[-1] == _RATE),
                    *_strapdown_only(scenario),
                ],
            }
        )


def _strapdown_only(scenario: Scenario) -> list[FieldSpec]:
    """Fields that other fidelities refuse, and the alignment record from which averaging forecasts."""
    path: Path = ("alignment",)
    more = form.fields(Alignment, path, "alignment")
    record = [spec for spec in more if spec.path[-1] == "duration_s"]
    averaged = any(method.kind.carrying == "copies" for method in scenario.method)
    if not scenario.strapdown:
        return record if averaged else []
    settings = [spec for spec in form.fields(RunSettings, ("run",)) if spec.path[-1] in _STRAPDOWN_ONLY]
    fields = more if scenario.alignment.kind != "none" else record if averaged else []
    return [*settings, form.choice(Alignment, "kind", path, label=Text("alignment")), *fields]


VIEW = RunView

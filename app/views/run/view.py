"""Tab "Run": duration, site, motion, initial errors, seed, strapdown settings."""

from navcore.foundation.registry import blocks_of
from navcore.foundation.text import Text
from navcore.motion import MOTIONS
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
    """Duration, site, motion, initial errors, seed."""

    title = Text("Run")
    place = "edit"
    places = {"run": 1.0, "site": 20.0, "motion": 31.0, "initial": 71.0, "strapdown": 92.0}

    def build(self, tab: Tab) -> None:
        """Make the widgets."""
        super().build(tab)
        gui = self.frame.gui
        with tab:
            gui.add_html(notices.heading(Text("Run and site")), order=0)
            gui.add_html(notices.heading(Text("Motion")), order=30)
            self._about = gui.add_html("", order=69, visible=False)
            gui.add_html(notices.heading(Text("Errors at the start")), order=70)
            gui.add_html(notices.heading(Text("Full strapdown")), order=90)
            gui.add_html(notices.small(_STRAPDOWN_TOLD), order=91)

    def follow_scenario(self) -> None:
        """Show the scenario's values."""
        scenario, settings = self.session.scenario, form.fields(RunSettings, ("run",))
        motion = scenario.motion
        about = Text.joined(
            "; ",
            (
                Text("{key}: {summary}", key=key, summary=(m.__doc__ or "").strip().splitlines()[0])
                for key, m in MOTIONS.items()
            ),
        )
        kind = FieldSpec(("motion", "kind"), "motion", about, "choice", "static", tuple(MOTIONS))
        self.show_fields(
            {
                "run": [spec for spec in settings if spec.path[-1] not in (_RATE, *_STRAPDOWN_ONLY)],
                "site": form.fields(SiteSettings, ("site",)),
                "motion": [kind, *form.fields(type(motion), ("motion",)), *_inner_blocks(scenario)],
                "initial": form.fields(InitialError, ("initial_error",)),
                "strapdown": [
                    *(spec for spec in settings if spec.path[-1] == _RATE),
                    *_strapdown_only(scenario),
                ],
            }
        )
        legs = len(getattr(motion, "leg", ()))
        text = Text("{legs} legs, as the scenario file gives them.", legs=legs) if legs else ""
        self._about.content, self._about.visible = notices.small(text), bool(text)


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


def _inner_blocks(scenario: Scenario) -> list[FieldSpec]:
    """Fields of the blocks inside a motion, such as one swing an angle; lists of blocks have no controls."""
    return [
        spec
        for block, fields in blocks_of(type(scenario.motion)).items()
        for name, many in fields
        if not many
        for spec in form.fields(block, ("motion", name), prefix=name)
    ]


VIEW = RunView

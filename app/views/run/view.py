"""Tab "Run": duration, site, motion, initial errors, seed, strapdown settings."""

from __future__ import annotations

from app.editing import edits, form
from app.editing.form import FieldSpec, Path
from app.shell import notices
from app.shell.control import Control
from app.shell.section import Section, controls_of
from app.shell.view import Tab, View
from navcore.foundation.registry import blocks_of
from navcore.motion import MOTIONS
from navcore.scenario.model import Alignment, InitialError, RunSettings, Scenario, SiteSettings

_RATE, _STRAPDOWN_ONLY = "rate_hz", ("vertical", "compensation")
_STRAPDOWN_TOLD = (
    'Used by "Verify with full strapdown", and where the fidelity is strapdown. A long strapdown run does '
    "not follow every move of a control: it is started by a button at the top."
)


class RunView(View):
    """Duration, site, motion, initial errors, seed."""

    title = "Run"
    place = "edit"

    def build(self, tab: Tab) -> None:
        """Make the widgets."""
        gui, edit = self.frame.gui, self.frame.editor.edit
        with tab:
            gui.add_html(notices.heading("Run and site"), order=0)
            gui.add_html(notices.heading("Motion"), order=30)
            self._about = gui.add_html("", order=69, visible=False)
            gui.add_html(notices.heading("Errors at the start"), order=70)
            gui.add_html(notices.heading("Full strapdown"), order=90)
            gui.add_html(notices.small(_STRAPDOWN_TOLD), order=91)
        places = {"run": 1.0, "site": 20.0, "motion": 31.0, "initial": 71.0, "strapdown": 92.0}
        self.sections = {name: Section(gui, tab, edit, order) for name, order in places.items()}

    @property
    def controls(self) -> list[Control]:
        """Controls of the run's fields."""
        return controls_of(self.sections)

    def follow_scenario(self) -> None:
        """Show the scenario's values."""
        scenario, moved = self.session.scenario, self.frame.editor.moved
        motion, settings = scenario.motion, form.fields(RunSettings, ("run",))
        kind = FieldSpec(("motion", "kind"), "motion", _told(MOTIONS), "choice", "static", tuple(MOTIONS))
        listed = {
            "run": [spec for spec in settings if spec.path[-1] not in (_RATE, *_STRAPDOWN_ONLY)],
            "site": form.fields(SiteSettings, ("site",)),
            "motion": [kind, *form.fields(type(motion), ("motion",)), *_inner_blocks(scenario)],
            "initial": form.fields(InitialError, ("initial_error",)),
            "strapdown": [*(spec for spec in settings if spec.path[-1] == _RATE), *_strapdown_only(scenario)],
        }
        for name, specs in listed.items():
            self.sections[name].show(specs, edits.values_at(scenario, [spec.path for spec in specs]), moved)
        legs = len(getattr(motion, "leg", ()))
        text = f"{legs} legs, as the scenario file gives them." if legs else ""
        self._about.content, self._about.visible = notices.small(text), bool(text)


def _strapdown_only(scenario: Scenario) -> list[FieldSpec]:
    """What other fidelities refuse, and the alignment record that averaging forecasts from in all of them."""
    path: Path = ("alignment",)
    more = form.fields(Alignment, path, "alignment")
    record = [spec for spec in more if spec.path[-1] == "duration_s"]
    averaged = any(method.damping == "averaging" for method in scenario.method)
    if not scenario.strapdown:
        return record if averaged else []
    settings = [spec for spec in form.fields(RunSettings, ("run",)) if spec.path[-1] in _STRAPDOWN_ONLY]
    shown = more if scenario.alignment.kind != "none" else record if averaged else []
    return [*settings, form.choice(Alignment, "kind", path, label="alignment"), *shown]


def _inner_blocks(scenario: Scenario) -> list[FieldSpec]:
    """Fields of the blocks inside a motion, such as one swing an angle; lists of blocks have no controls."""
    return [
        spec
        for block, fields in blocks_of(type(scenario.motion)).items()
        for name, many in fields
        if not many
        for spec in form.fields(block, ("motion", name), prefix=f"{name} {scenario.motion.kind}")
    ]


def _told(members: dict[str, type]) -> str:
    return "; ".join(f"{key}: {(m.__doc__ or '').strip().splitlines()[0]}" for key, m in members.items())


VIEW = RunView

"""Tab "Run": duration, site, motion and its route, initial errors, seed, strapdown settings."""

from functools import cache
from typing import Any

from navcore.foundation.offered import when_changed
from navcore.foundation.registry import blocks_of
from navcore.foundation.text import Text
from navcore.motion import MOTIONS
from navcore.scenario.blocks import Alignment, RunSettings, SiteSettings
from navcore.scenario.initial_error import InitialError
from navcore.scenario.model import Scenario
from schuler_bench.editing import form
from schuler_bench.editing.form import FieldSpec, Path
from schuler_bench.shell import notices
from schuler_bench.shell.view import FieldsView, Tab, if_user
from schuler_bench.views.run.route import count_of, fields_of, route_html, with_one_more, without_one

EDIT, ADD, REMOVE = Text("edit"), Text("add behind"), Text("take out")
_RATE, _STRAPDOWN_ONLY = "rate_hz", ("vertical", "compensation")
_STRAPDOWN_TOLD = Text(
    'Used by "Verify with full strapdown", and where the fidelity is strapdown. A long strapdown run does '
    "not follow every move of a control: it is started by a button at the top."
)


class RunView(FieldsView):
    """Duration, site, motion, initial errors, seed."""

    title = Text("Run")
    place = "edit"
    places = {"run": 1.0, "site": 20.0, "motion": 31.0, "route": 66.0, "initial": 71.0, "strapdown": 92.0}

    def build(self, tab: Tab) -> None:
        """Make the widgets."""
        super().build(tab)
        self._routed: object = None
        gui = self.frame.gui
        with tab:
            gui.add_html(notices.heading(Text("Run and site")), order=0)
            gui.add_html(notices.heading(Text("Motion")), order=30)
            self._route = gui.add_html("", order=63, visible=False)
            self._which: Any = gui.add_dropdown(
                EDIT, ("1",), hint=Text("Which leg or point of the route the boxes below edit."), order=64,
                visible=False,
            )  # fmt: skip
            self._arrange: Any = gui.add_button_group(
                Text("route"), (ADD, REMOVE), order=65, visible=False,
                hint=Text("Add one like it behind the one that is edited, or take it out."),
            )  # fmt: skip
            gui.add_html(notices.heading(Text("Errors at the start")), order=70)
            gui.add_html(notices.heading(Text("Full strapdown")), order=90)
            gui.add_html(notices.small(_STRAPDOWN_TOLD), order=91)
        self._which.on_update(if_user(self.follow_scenario))
        self._arrange.on_click(if_user(self._change_route))

    @property
    def _place(self) -> int:
        """Place of the leg or point that is edited."""
        value = str(self._which.value)
        return min(int(value) - 1 if value.isdecimal() else 0, max(count_of(self.session.scenario) - 1, 0))

    def _change_route(self) -> None:
        """Add a leg or point behind the edited one, or remove that."""
        session, add = self.session, self._arrange.value == ADD
        with session.lock, notices.told(self.frame.client, Text("Not possible"), self.frame.refresh):
            place = self._place
            session.change((with_one_more if add else without_one)(session.scenario, place), None)
            self._show_route(place + 1 if add else place)
            self.frame.refresh()

    def _show_route(self, place: int) -> None:
        """Show the table of the route, and which of it is edited."""
        scenario = self.session.scenario
        count = count_of(scenario)
        self._route.visible = self._which.visible = self._arrange.visible = count > 0
        options = tuple(str(number) for number in range(1, max(count, 1) + 1))
        if tuple(self._which.options) != options:
            self._which.options = options
        self._which.value = options[min(place, len(options) - 1)]
        routed = scenario.motion, self._place
        if routed != self._routed:
            self._routed, self._route.content = routed, route_html(scenario, self._place)

    def follow_scenario(self) -> None:
        """Show the scenario's values."""
        scenario, settings = self.session.scenario, form.fields(RunSettings, ("run",))
        self._show_route(self._place)
        motion = scenario.motion
        self.show_fields(
            {
                "run": [spec for spec in settings if spec.path[-1] not in (_RATE, *_STRAPDOWN_ONLY)],
                "site": form.fields(SiteSettings, ("site",)),
                "motion": [_kinds(), *form.fields(type(motion), ("motion",)), *_inner_blocks(scenario)],
                "route": fields_of(scenario, self._place),
                "initial": form.fields(InitialError, ("initial_error",)),
                "strapdown": [
                    *(spec for spec in settings if spec.path[-1] == _RATE),
                    *_strapdown_only(scenario),
                ],
            }
        )


@cache
def _kinds() -> FieldSpec:
    """Choice of the motion."""
    about = Text.joined(
        "; ",
        (
            Text("{key}: {summary}", key=key, summary=(kind.__doc__ or "").strip().splitlines()[0])
            for key, kind in MOTIONS.items()
        ),
    )
    return FieldSpec(("motion", "kind"), "motion", about, "choice", "static", tuple(MOTIONS))


when_changed(_kinds.cache_clear)


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
    """Fields of the blocks inside a motion, such as one swing an angle; those of a list are the route's."""
    return [
        spec
        for block, fields in blocks_of(type(scenario.motion)).items()
        for name, many in fields
        if not many
        for spec in form.fields(block, ("motion", name), prefix=name)
    ]


VIEW = RunView

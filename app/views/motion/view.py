"""Fold "Motion" of the tab "Setup": the ship's motion, and its route by hand."""

from functools import cache
from typing import Any

from navcore.foundation.offered import when_changed
from navcore.foundation.registry import blocks_of
from navcore.foundation.text import Text
from navcore.motion import MOTIONS
from navcore.scenario.model import Scenario
from schuler_bench.editing import form
from schuler_bench.editing.form import FieldSpec
from schuler_bench.shell import notices
from schuler_bench.shell.view import FieldsView, Tab, if_user
from schuler_bench.views.motion.route import count_of, fields_of, route_html, with_one_more, without_one

EDIT, ADD, REMOVE = Text("edit"), Text("add behind"), Text("take out")


class MotionView(FieldsView):
    """Kind of motion, its parameters, and the legs or points of its route."""

    title = Text("Motion")
    place = "edit"
    tab = Text("Setup")
    places = {"motion": 31.0, "route": 66.0}

    def build(self, tab: Tab) -> None:
        """Make the widgets."""
        super().build(tab)
        self._routed: object = None
        gui = self.frame.gui
        with tab:
            self._route = gui.add_html("", order=63, visible=False)
            self._which: Any = gui.add_dropdown(
                EDIT, ("1",), hint=Text("Which leg or point of the route the boxes below edit."), order=64,
                visible=False,
            )  # fmt: skip
            self._arrange: Any = gui.add_button_group(
                Text("route"), (ADD, REMOVE), order=65, visible=False,
                hint=Text("Add one like it behind the one that is edited, or take it out."),
            )  # fmt: skip
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
        """Show the scenario's motion."""
        scenario = self.session.scenario
        self._show_route(self._place)
        motion = scenario.motion
        self.show_fields(
            {
                "motion": [_kinds(), *form.fields(type(motion), ("motion",)), *_inner_blocks(scenario)],
                "route": fields_of(scenario, self._place),
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


def _inner_blocks(scenario: Scenario) -> list[FieldSpec]:
    """Fields of the blocks inside a motion, such as one swing an angle; those of a list are the route's."""
    return [
        spec
        for block, fields in blocks_of(type(scenario.motion)).items()
        for name, many in fields
        if not many
        for spec in form.fields(block, ("motion", name), prefix=name)
    ]


VIEW = MotionView

"""Tab "Diagram": the selected method's loop as blocks, at the time that the 3D view shows."""

from navcore.engine.run import MethodRun, Run
from navcore.foundation.text import Text
from navcore.law.policy.variation import Variation
from navcore.mechanization.recorder import DAMPED_COLUMN, XI_COLUMN
from schuler_bench.plots import style
from schuler_bench.session.shown import Shown
from schuler_bench.shell.view import Frame, PictureView, Tab
from schuler_bench.views.diagram.blocks import diagram
from schuler_bench.views.diagram.flow import flow_svg
from schuler_bench.views.diagram.forecast import forecast_svg
from schuler_bench.views.diagram.membership import membership_svg
from schuler_bench.views.diagram.parts import State
from schuler_bench.views.diagram.svg import diagram_svg

_LOOK_PX = 60
"""Height of the line above the picture, with its margins."""


class DiagramView(PictureView[str]):
    """The picture alone."""

    title = Text("Diagram")
    place = "upper"
    tab = Text("Frequency")
    look_for = Text(
        "Where the log enters and what the network does with it. A click on a block opens its tab."
    )

    def __init__(self, frame: Frame) -> None:
        super().__init__(frame)
        self._time_s = 0.0
        self._state: State | None = None

    def build(self, tab: Tab) -> None:
        """Make the place of the picture."""
        with tab:
            self._picture = self.frame.gui.add_html("")

    @property
    def of_selected(self) -> bool:
        """It is that of the selected method."""
        return True

    def picture(self, found: Shown) -> str:
        """Draw the loop of the selected method."""
        index = min(found.selected, len(found.run.methods) - 1)
        self._state = state_at(found.run.methods[index], self._time_s)
        return self._html(found.run, index, self._state)

    def show(self, picture: str) -> None:
        """Show the picture."""
        self._picture.content = picture

    def follow_time(self, t_s: float) -> None:
        """Turn the switch to what it is at the time that is shown."""
        self._time_s = t_s
        run, index = self.session.run, self.session.selected
        if self._state is None or run is None or index >= len(run.methods):
            return
        state = state_at(run.methods[index], t_s)
        if state != self._state:
            self._state = state
            self.show(self._html(run, index, state))

    def _html(self, run: Run, index: int, state: State) -> str:
        """Loop of a method in a state, and beneath it what its figure is in the paper.

        It is as wide as its panel, unless the azimuth channel or the paper's figure would then have no room.
        """
        found, paper = diagram(run.scenario, index, state), beneath(run, index)
        room = (self.frame.layout().room_px - _LOOK_PX) / (2 if paper else 1)
        return Text(
            '<div class="sb-diagram" style="--room:{room:.0f}px">{svg}{beneath}</div>',
            room=max(room, found.height),
            svg=diagram_svg(found, style.method_color(run.methods[index].place), state),
            beneath=paper,
        )


def state_at(method: MethodRun, t_s: float) -> State:
    """State of a method's law at a time: that of the output row at or before it."""
    if not method.method.kind.uses_network or not len(method.t_s):
        return State()
    row = method.rows[max(int(method.t_s.searchsorted(t_s, "right")) - 1, 0)]
    coefficient = float(row[XI_COLUMN]) if method.method.policy.tunes else None
    return State(bool(row[DAMPED_COLUMN] > 0.5), coefficient)


def beneath(run: Run, index: int) -> str:
    """Forecast of an averaging method; membership functions and flow chart of what a paper draws."""
    method = run.scenario.method[index]
    if method.kind.carrying == "copies":
        return forecast_svg(run, index)
    if method.undamped:
        return ""
    functions = membership_svg(method.policy) if isinstance(method.policy, Variation) else ""
    return Text.joined("", [functions, flow_svg(method)])


VIEW = DiagramView

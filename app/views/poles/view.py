"""Tab "Poles": the pole map of one channel with locus and placement, or the modes of the whole system."""

from collections.abc import Callable
from typing import Any

from navcore.engine.run import Run
from navcore.foundation.errors import InputError
from navcore.foundation.text import Text
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario
from schuler_bench.editing.limits import with_limit
from schuler_bench.editing.placing import COMMAND, Block, pair_at, read_point, typed_pair, with_pair
from schuler_bench.plots.plotly_data import PlotlyFigure
from schuler_bench.session.display import Display
from schuler_bench.session.requirements import limits_of
from schuler_bench.session.shown import Shown
from schuler_bench.shell import notices
from schuler_bench.shell.layout import CHOOSER_PX, TOOLS
from schuler_bench.shell.number_box import NumberBox
from schuler_bench.shell.pair_handle import PairHandle
from schuler_bench.shell.plotly_view import PlotlyView
from schuler_bench.shell.view import Frame, if_user
from schuler_bench.views.poles.azimuth import azimuth_loops
from schuler_bench.views.poles.figure import PANELS, poles
from schuler_bench.views.poles.grid import NO_LOCUS, locus_fields
from schuler_bench.views.poles.whole import whole_system_figure

LOCUS = Text("locus")
DECAYS = "H'(0) ≤ 0"
PAIR_XI, PAIR_OMEGA, PLACE = Text("pair ζ"), Text("pair ω/ωₛ"), Text("Place")
POLES_OF = Text("poles of")
SYSTEMS = {"channel": "channel", Text("azimuth"): "azimuth", "system": "whole"}
_NONE = Text("nothing")


class PolesView(PlotlyView):
    """Chooser of the locus and boxes of the pair, above the pole map."""

    title = Text("Poles")
    place = "upper"
    look_for = Text(
        "The farther left a pole, the faster it dies away; the steeper, the more it swings. "
        "Drag the handle to move it."
    )
    plots = (title,)
    above_px = CHOOSER_PX + 10

    def __init__(self, frame: Frame) -> None:
        super().__init__(frame)
        self._handle = PairHandle(frame, "poles", PANELS, lambda: self._block)
        frame.commands.register(COMMAND, lambda text: self._place(lambda: pair_at(read_point(text))))

    def build_tools(self) -> None:
        """Make the chooser, the boxes and the button."""
        gui, display = self.frame.gui, self.session.display
        self._fields = _offered(self._method, self._block)
        gui.add_html(TOOLS)
        self._handle.build()
        self._system: Any = gui.add_dropdown(
            POLES_OF,
            tuple(SYSTEMS),
            initial_value=_system(display),
            hint=Text(
                "Channel: the closed loop of one level channel. Azimuth: that of the slow oscillation with "
                "the azimuth network, in units of the Earth's rate Ω. System: the whole one, both channels "
                "with heading and latitude, whose 24 h mode most networks let grow, and its growth over "
                "latitude."
            ),
        )
        self._system.on_update(if_user(lambda: self.frame.show(poles=SYSTEMS[self._system.value])))
        self._locus: Any = gui.add_dropdown(
            LOCUS,
            tuple(self._fields),
            initial_value=_chosen(self._fields, display),
            hint=Text(
                "Draws how the poles of the selected method move while one parameter of "
                "its network goes "
                "through the range of its slider; the crosses are at the present value."
            ),
        )
        self._xi = NumberBox(
            self.frame.client,
            PAIR_XI,
            0.5,
            step=0.01,
            hint=Text(
                "Damping ratio (no unit, 0.01 to 1) wanted of the selected method's "
                "closed-loop pair. Or "
                "click into the pole map."
            ),
        )
        self._ratio = NumberBox(
            self.frame.client, PAIR_OMEGA, 1.2, step=0.1,
            hint=Text("Frequency wanted of the pair, in units of the Schuler frequency (above 0)."),
        )  # fmt: skip
        self._decays: Any = gui.add_checkbox(
            DECAYS,
            _decays(self.session.scenario),
            hint=Text(
                "A pair is only placed when H(0) = 1 and the slope H'(0) is at most 0, so "
                "that the 24 h mode of the whole system does not grow. The same limit as H'(0) in "
                "Requirements (tab Limits)."
            ),
        )
        self._decays.on_update(if_user(self._limit_slope))
        button = gui.add_button(
            PLACE,
            hint=Text(
                "Sets the parameters of the selected method's network that give this pair, where it can."
            ),
        )
        self._locus.on_update(
            if_user(lambda: self.frame.show(locus=self._fields.get(self._locus.value, NO_LOCUS)))
        )
        self._placing = self._xi, self._ratio, button
        button.on_click(if_user(lambda: self._place(lambda: typed_pair(self._xi.value, self._ratio.value))))

    def _place(self, wanted: Callable[[], tuple[float, float]]) -> None:
        """Place the selected method's pair; one change of the session, with a word about what was done."""
        session, client = self.session, self.frame.client
        with session.lock:
            try:
                limit = limits_of(session.scenario.requirement).get("h_slope_s")
                placed = with_pair(session.scenario, session.selected, *wanted(), limit, self._block)
            except InputError as error:
                notices.tell(client, Text("The pair was not placed"), notices.fault_lines(error), "warning")
                return
            name = session.scenario.method[session.selected].name
            session.change(placed.scenario, None, name=Text("placing the pair of {name}", name=name))
        if placed.note:
            notices.tell(client, Text("Placed in part"), [placed.words, placed.note], "warning")
        else:
            notices.tell(client, Text("Placed"), [placed.words], "info")

    @property
    def _block(self) -> Block:
        return _block_of(self.session.display)

    @property
    def _method(self) -> Method:
        return self.session.scenario.method[self.session.selected]

    def _limit_slope(self) -> None:
        session = self.session
        with session.lock:
            changed = with_limit(session.scenario, "h_slope_s", "0" if self._decays.value else "")
            session.change(changed, None)

    def follow_scenario(self) -> None:
        """Offer the parameters of the selected method's network, and show which is chosen, and the limit."""
        self._decays.value = _decays(self.session.scenario)
        offered = _offered(self._method, self._block)
        if offered != self._fields:
            self._fields, self._locus.options = offered, tuple(offered)
        chosen = _chosen(offered, self.session.display)
        if self._locus.value != chosen:
            self._locus.value = chosen

    def follow_display(self) -> None:
        """Show whose poles and which parameter are chosen."""
        self._system.value = _system(self.session.display)
        # A click or a tap into the map places a pair, too: where there is little room, that is enough.
        room = self.session.display.size == "normal" and not self.frame.layout().touch
        for tool in self._placing:
            tool.visible = room
        self.follow_scenario()

    @property
    def of_selected(self) -> bool:
        """Locus and handle are those of the selected method."""
        return self.session.display.poles != "whole" or bool(self.session.display.locus)

    def figure(self, both: Run, found: Shown) -> PlotlyFigure:
        """Pole map, or the modes of the whole system."""
        if found.display.poles == "whole":
            return whole_system_figure(both, self.aspect, width_px=self.width_px)
        block = _block_of(found.display)
        slow = block == "azimuth"
        plot = poles(
            azimuth_loops(both) if slow else both,
            self.aspect,
            width_px=self.width_px,
            selected=found.selected,
            locus=found.display.locus,
            limits={} if slow else limits_of(found.run.scenario.requirement),
            block=block,
        )
        plot["layout"]["meta"] |= self._handle.meta(found)
        return plot


def _offered(method: Method, block: Block) -> dict[str, str]:
    """Choices of the locus: label -> field."""
    return {_NONE: NO_LOCUS} | {label: name for name, label in locus_fields(method, block).items()}


def _block_of(display: Display) -> Block:
    """Which network's pair the map shows."""
    return "azimuth" if display.poles == "azimuth" else "network"


def _system(display: Display) -> str:
    return next(label for label, name in SYSTEMS.items() if name == display.poles)


def _decays(scenario: Scenario) -> bool:
    """A limit of H'(0) above 0 lets the 24 h mode grow."""
    limit = limits_of(scenario.requirement).get("h_slope_s")
    return limit is not None and limit <= 0.0


def _chosen(offered: dict[str, str], display: Display) -> str:
    return next((label for label, name in offered.items() if name == display.locus), _NONE)


VIEW = PolesView

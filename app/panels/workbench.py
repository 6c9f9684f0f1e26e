"""Tools above the frequency plots and the pole map: measured filter, root locus, placement by numbers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from app.editing.placing import pair_at, read_point, typed_pair, with_pair
from app.figures.locus import NO_LOCUS, locus_fields
from app.page import notices
from app.session.display import Display
from app.session.session import Session
from navcore.errors import InputError
from navcore.scenario import Method

if TYPE_CHECKING:
    import viser

DISCRETE = "measured filter"
LOCUS = "locus over"
PAIR_XI, PAIR_OMEGA, PLACE = "pair ξ", "pair ω/ωs", "Place"
_NONE = "nothing"
ROW = '<div class="sb-tools"></div>'
"""Lets the controls of a tab stand in one row (static/page.css)."""


@dataclass(frozen=True)
class Tools:
    """What the workbench's controls do.

    Attributes
    ----------
    show : callable
        ``show(**choices)`` of the display.
    place : callable
        ``place(damping_ratio, ratio)`` of the selected method's pair.
    method : callable
        Gives the method that the controls edit.
    """

    show: Callable[..., None]
    place: Callable[[float, float], None]
    method: Callable[[], Method]


class Placer:
    """Places the selected method's pair; one change of the session, with a word about what was done.

    Parameters
    ----------
    client : viser.ClientHandle
        The browser, for notices.
    session : Session
        Whose scenario is changed.
    """

    def __init__(self, client: viser.ClientHandle, session: Session) -> None:
        self._client, self._session = client, session

    def picked(self, text: str) -> None:
        """Take a point of the pole map, ``re im`` in units of omega_s."""
        self._place(lambda: pair_at(read_point(text)))

    def typed(self, damping_ratio: float, ratio: float) -> None:
        """Take a pair as typed."""
        self._place(lambda: typed_pair(damping_ratio, ratio))

    def _place(self, wanted: Callable[[], tuple[float, float]]) -> None:
        session = self._session
        with session.lock:
            try:
                placed = with_pair(session.scenario, session.selected, *wanted())
            except InputError as error:
                notices.tell(self._client, "The pair was not placed", notices.fault_lines(error), "warning")
                return
            name = session.scenario.method[session.selected].name
            session.change(placed.scenario, None, name=f"placing the pair of {name}")
        if placed.note:
            notices.tell(self._client, "Placed in part", [placed.words, placed.note], "warning")
        else:
            notices.tell(self._client, "Placed", [placed.words], "info")


class FrequencyTools:
    """Switch for the measured filter, beside the chooser of the transfer."""

    def __init__(self, gui: viser.GuiApi, tools: Tools, display: Display) -> None:
        gui.add_html(ROW)
        self._discrete = gui.add_checkbox(
            DISCRETE, display.discrete,
            hint="Dots on H: gain (dB) and phase (deg) of the filter that runs, at the step of the run, "
            "measured by driving it with sines. Gains that act as velocity feedback have no filter.",
        )  # fmt: skip
        self._discrete.on_update(
            lambda event: tools.show(discrete=self._discrete.value) if event.client else None
        )

    def follow(self, display: Display) -> None:
        """Show the display's choice."""
        self._discrete.value = display.discrete


class PoleTools:
    """Chooser of the locus and boxes of the pair, above the pole map."""

    def __init__(self, gui: viser.GuiApi, tools: Tools, display: Display) -> None:
        self._tools = tools
        self._fields = _offered(tools.method())
        gui.add_html(ROW)
        self._locus: Any = gui.add_dropdown(
            LOCUS, tuple(self._fields), initial_value=_chosen(self._fields, display),
            hint="Draws how the poles of the selected method move while one parameter of its network goes "
            "through the range of its slider; the crosses are at the present value.",
        )  # fmt: skip
        self._xi = gui.add_number(
            PAIR_XI, 0.5, step=0.01,
            hint="Damping ratio (no unit, 0.01 to 1) wanted of the selected method's closed-loop pair. Or "
            "click into the pole map.",
        )  # fmt: skip
        self._ratio = gui.add_number(
            PAIR_OMEGA, 1.2, step=0.1,
            hint="Frequency wanted of the pair, in units of the Schuler frequency (above 0).",
        )  # fmt: skip
        button = gui.add_button(
            PLACE,
            hint="Sets the parameters of the selected method's network that give this pair, where it can.",
        )
        self._locus.on_update(lambda event: self._choose() if event.client else None)
        button.on_click(
            lambda event: tools.place(self._xi.value, self._ratio.value) if event.client else None
        )

    def _choose(self) -> None:
        self._tools.show(locus=self._fields.get(self._locus.value, NO_LOCUS))

    def follow(self, display: Display, method: Method) -> None:
        """Offer the parameters of the selected method's network, and show which is chosen."""
        offered = _offered(method)
        if offered != self._fields:
            self._fields = offered
            self._locus.options = tuple(offered)
        chosen = _chosen(offered, display)
        if self._locus.value != chosen:
            self._locus.value = chosen


def _offered(method: Method) -> dict[str, str]:
    """Choices of the locus: label -> field."""
    fields = {} if method.undamped else locus_fields(method.network)
    return {_NONE: NO_LOCUS} | {label: name for name, label in fields.items()}


def _chosen(offered: dict[str, str], display: Display) -> str:
    return next((label for label, name in offered.items() if name == display.locus), _NONE)

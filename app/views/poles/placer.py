"""Places the closed-loop pair of the method in hand, where a click or two numbers want it."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from app.editing.placing import pair_at, read_point, typed_pair, with_pair
from app.session.session import Session
from app.shell import notices
from navcore.foundation.errors import InputError

if TYPE_CHECKING:
    import viser


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
                limit = session.display.requirements.h_slope_s
                placed = with_pair(session.scenario, session.selected, *wanted(), limit)
            except InputError as error:
                notices.tell(self._client, "The pair was not placed", notices.fault_lines(error), "warning")
                return
            name = session.scenario.method[session.selected].name
            session.change(placed.scenario, None, name=f"placing the pair of {name}")
        if placed.note:
            notices.tell(self._client, "Placed in part", [placed.words, placed.note], "warning")
        else:
            notices.tell(self._client, "Placed", [placed.words], "info")

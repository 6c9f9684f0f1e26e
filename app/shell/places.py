"""Chooser of where a search must hold: in the scenario, or at every point of what Study varies."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from navcore.foundation.text import Text
from schuler_bench.session.studying import study_of_points
from schuler_bench.shell.searching import reveal
from schuler_bench.shell.view import Frame, if_user

if TYPE_CHECKING:
    from navcore.study.model import Study

OVER = Text("over")
PLACES = {"scenario": Text("this scenario"), "study": Text("every point of Study (tab Robustness)")}


class PlacesChooser:
    """Shows and changes where the session's searches must hold.

    Parameters
    ----------
    frame : Frame
        Of the page; the chooser goes into the present container of its controls.
    """

    def __init__(self, frame: Frame) -> None:
        self._session = frame.session
        values = {words: place for place, words in PLACES.items()}
        self._box: Any = frame.gui.add_dropdown(
            OVER,
            tuple(values),
            hint=Text(
                "Where settings must hold: in this scenario, or at the worst point of what Study "
                "(tab Robustness) varies."
            ),
        )
        self._box.on_update(if_user(lambda: frame.show(search_over=values[self._box.value])))

    def follow(self, visible: bool) -> None:
        """Show the session's choice where it is of use."""
        words = PLACES[self._session.display.search_over]
        if self._box.value != words:
            self._box.value = words
        reveal((self._box, visible))

    @property
    def study(self) -> Study | None:
        """Study over whose points a search must hold; None: the scenario alone. May raise `InputError`."""
        return study_of_points(self._session) if self._session.display.search_over == "study" else None

"""Tab "Misprints": the papers' printed errors, each computed as printed and corrected."""

import threading
from functools import lru_cache
from typing import Any

from navcore.foundation.text import Text
from schuler_bench.misprints import MISPRINTS, Comparison, Misprint
from schuler_bench.plots.plotly_data import enlarged
from schuler_bench.shell.layout import CHOOSER_PX
from schuler_bench.shell.view import MENU, Frame, Tab, View, if_user
from schuler_bench.views.misprints.figure import SHOWN, Shown, comparison_plot, words_html

_WORDS_PX = {True: 96, False: 186}
"""Height of the words and numbers above the plot, in a wide window and in a narrow one: a first estimate."""
_BETWEEN_PX = 8
_MISPRINT, _SWITCH = Text("misprint"), Text("form shown")


def misprint_title(found: Misprint) -> str:
    """Entry of the chooser; what is no error says so."""
    parts = {"paper": found.paper, "where": found.where, "consequence": found.consequence}
    if found.remark:
        return Text("{paper}, {where} (no misprint): {consequence}", **parts)
    return Text("{paper}, {where}: {consequence}", **parts)


_TITLES = {misprint_title(m): id for id, m in MISPRINTS.items()}


@lru_cache(maxsize=32)
def _computed(id: str) -> Comparison:
    """Both forms of a misprint: they depend on nothing else, so they are computed once."""
    return MISPRINTS[id].compute()


class MisprintsView(View):
    """Choose a misprint, and which of its forms is drawn."""

    title = Text("Misprints")
    place = "upper"
    tab = MENU
    look_for = Text("What a paper prints beside what its text and figures say: look where the curves part.")

    def __init__(self, frame: Frame) -> None:
        super().__init__(frame)
        self._lock = threading.Lock()

    def build(self, tab: Tab) -> None:
        """Make the choosers; nothing is computed before the tab is in front."""
        gui = self.frame.gui
        with self._lock, tab:
            self._tab = tab
            self._plot: Any = None
            self._drawn: tuple[str, Shown] | None = None
            self._chooser: Any = gui.add_dropdown(
                _MISPRINT,
                tuple(_TITLES),
                order=0,
                hint=Text(
                    "Errors in the papers that change a result, and two that are none but cost much where "
                    "they are taken over; both forms are computed by the same code."
                ),
            )
            self._switch: Any = gui.add_dropdown(
                _SWITCH, SHOWN, order=1, hint=Text("Draw the form as printed, the corrected one, or both.")
            )
            self._words = gui.add_html("", order=2)
        for handle in (self._chooser, self._switch):
            handle.on_update(if_user(self.to_front))

    def to_front(self) -> None:
        """Draw what is chosen."""
        with self._lock:
            chosen = _TITLES[self._chooser.value], self._switch.value
            if chosen != self._drawn:
                self._drawn = chosen
                self._draw(*chosen)

    def _draw(self, id: str, form: Shown) -> None:
        layout, comparison = self.frame.layout(), _computed(id)
        words = _WORDS_PX[layout.wide]
        html = words_html(MISPRINTS[id], comparison)
        self._words.content = Text('<div style="max-height:26vh;overflow-y:auto">{html}</div>', html=html)
        aspect = layout.aspect(2 * CHOOSER_PX + words + _BETWEEN_PX)
        figure = comparison_plot(comparison, form, aspect, width_px=layout.text_px)
        figure["layout"]["meta"] |= {"misprint": id, "shown": form}
        plot: Any = enlarged(figure, layout.scale)
        if self._plot is not None:
            self._plot.figure = plot
            return
        with self._tab:
            self._plot = self.frame.gui.add_plotly(plot, aspect=aspect / layout.letter, order=3)


VIEW = MisprintsView

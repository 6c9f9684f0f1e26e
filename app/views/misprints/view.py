"""Tab "Misprints": the papers' printed errors, each computed as printed and corrected."""

from __future__ import annotations

import threading
from functools import lru_cache
from typing import TYPE_CHECKING, Any, cast

from app.plots.enlarged import enlarged
from app.shell.layout import CHOOSER_PX
from app.shell.view import Frame, Tab, View, if_user

if TYPE_CHECKING:
    from app.misprints import Comparison
    from app.views.misprints.figure import Shown

_WORDS_PX = {True: 96, False: 186}
"""Room for the words and numbers above the plot, in a wide window and in a narrow one."""
_BETWEEN_PX = 8
_MISPRINT, _SWITCH = "misprint", "form shown"


@lru_cache(maxsize=32)
def _computed(id: str) -> Comparison:
    """Both forms of a misprint: they depend on nothing else, so they are computed once."""
    from app.misprints import MISPRINTS

    return MISPRINTS[id].compute()


class MisprintsView(View):
    """Choose a misprint, and which of its forms is drawn."""

    title = "Misprints"
    place = "upper"
    look_for = "What a paper prints beside what its text and figures say: look where the curves part."

    def __init__(self, frame: Frame) -> None:
        super().__init__(frame)
        self._lock = threading.Lock()
        self._chooser: Any
        self._switch: Any
        self._words: Any

    def build(self, tab: Tab) -> None:
        """Remember the tab: nothing is made or computed before it is in front."""
        with self._lock:
            self._tab = tab
            self._drawn: tuple[str, str] | None = None
            self._plot: Any = None
            self._titles: dict[str, str] = {}

    def to_front(self) -> None:
        """Draw what is chosen."""
        with self._lock:
            if not self._titles:
                self._make()
            id, shown = self._titles[self._chooser.value], self._switch.value
            if (id, shown) == self._drawn:
                return
            self._drawn = id, shown
            self._draw(id, shown)

    def _make(self) -> None:
        from app.misprints import MISPRINTS
        from app.views.misprints.figure import SHOWN

        self._titles = {f"{m.paper}, {m.where}: {m.consequence}": id for id, m in MISPRINTS.items()}
        with self._tab:
            self._chooser = self.frame.gui.add_dropdown(
                _MISPRINT, tuple(self._titles), order=0,
                hint="Errors in the papers that change a result; both forms are computed by the same code.",
            )  # fmt: skip
            self._switch = self.frame.gui.add_dropdown(
                _SWITCH, SHOWN, order=1, hint="Draw the form as printed, the corrected one, or both."
            )
            self._words = self.frame.gui.add_html("", order=2)
        for handle in (self._chooser, self._switch):
            handle.on_update(if_user(self.to_front))

    def _draw(self, id: str, shown: Shown) -> None:
        from app.misprints import MISPRINTS
        from app.views.misprints.figure import comparison_plot, words_html

        layout = self.frame.layout()
        comparison, words = _computed(id), _WORDS_PX[layout.wide]
        self._words.content = (
            f'<div style="height:{words}px;overflow-y:auto">{words_html(MISPRINTS[id], comparison)}</div>'
        )
        aspect = layout.aspect(2 * CHOOSER_PX + words + _BETWEEN_PX)
        made = comparison_plot(comparison, shown, aspect, width_px=float(layout.plot_px))
        made["layout"]["meta"] |= {"misprint": id, "shown": shown}
        made = enlarged(made, layout.scale)
        if self._plot is not None:
            self._plot.figure = cast(Any, made)
            return
        with self._tab:
            self._plot = self.frame.gui.add_plotly(cast(Any, made), aspect=aspect, order=3)


VIEW = MisprintsView

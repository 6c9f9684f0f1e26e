"""Tab "Misprints": the papers' printed errors, each computed as printed and corrected."""

from __future__ import annotations

import threading
from functools import lru_cache
from typing import TYPE_CHECKING, Any, cast

from app.page.layout import CHOOSER_PX, Layout

if TYPE_CHECKING:
    import viser

    from app.figures.misprints import Shown
    from navcore.misprints import Comparison

_WORDS_PX = {True: 96, False: 186}
"""Room for the words and numbers above the plot, in a wide window and in a narrow one."""
_BETWEEN_PX = 8
_MISPRINT, _SWITCH = "misprint", "form shown"


@lru_cache(maxsize=32)
def _computed(id: str) -> Comparison:
    """Both forms of a misprint: they depend on nothing else, so they are computed once."""
    from navcore.misprints import MISPRINTS

    return MISPRINTS[id].compute()


class Laboratory:
    """Choose a misprint, and which of its forms is drawn.

    Parameters
    ----------
    gui : viser.GuiApi
        Of the client.
    tab : viser.GuiTabHandle
        Where it stands.
    layout : Layout
        Sizes.
    """

    def __init__(self, gui: viser.GuiApi, tab: viser.GuiTabHandle, layout: Layout) -> None:
        self._gui, self._tab, self._layout = gui, tab, layout
        self._lock = threading.Lock()
        self._drawn: tuple[str, str] | None = None
        self._plot: viser.GuiPlotlyHandle | None = None
        self._titles: dict[str, str] = {}
        self._chooser: Any
        self._switch: Any
        self._words: Any

    def show(self) -> None:
        """Draw what is chosen; nothing is computed before the tab is looked at."""
        with self._lock:
            if not self._titles:
                self._build()
            id, shown = self._titles[self._chooser.value], self._switch.value
            if (id, shown) == self._drawn:
                return
            self._drawn = id, shown
            self._draw(id, shown)

    def _build(self) -> None:
        from app.figures.misprints import SHOWN
        from navcore.misprints import MISPRINTS

        self._titles = {f"{m.paper}, {m.where}: {m.consequence}": id for id, m in MISPRINTS.items()}
        with self._tab:
            self._chooser = self._gui.add_dropdown(
                _MISPRINT, tuple(self._titles), order=0,
                hint="Errors in the papers that change a result; both forms are computed by the same code.",
            )  # fmt: skip
            self._switch = self._gui.add_dropdown(
                _SWITCH, SHOWN, order=1, hint="Draw the form as printed, the corrected one, or both."
            )
            self._words = self._gui.add_html("", order=2)
        for handle in (self._chooser, self._switch):
            handle.on_update(lambda event: self.show() if event.client is not None else None)

    def _draw(self, id: str, shown: Shown) -> None:
        from app.figures.misprints import comparison_plot, words_html
        from navcore.misprints import MISPRINTS

        comparison, words = _computed(id), _WORDS_PX[self._layout.wide]
        self._words.content = (
            f'<div style="height:{words}px;overflow-y:auto">{words_html(MISPRINTS[id], comparison)}</div>'
        )
        aspect = self._layout.aspect(2 * CHOOSER_PX + words + _BETWEEN_PX)
        made = comparison_plot(comparison, shown, aspect, width_px=float(self._layout.plot_px))
        made["layout"]["meta"] |= {"misprint": id, "shown": shown}
        if self._plot is not None:
            self._plot.figure = cast(Any, made)
            return
        with self._tab:
            self._plot = self._gui.add_plotly(cast(Any, made), aspect=aspect, order=3)

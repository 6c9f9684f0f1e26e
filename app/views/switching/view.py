"""Tab "Switching": an error curve, and on the same time axis when and why each method damps."""

from dataclasses import dataclass
from typing import Any

from navcore.engine.run import Run
from navcore.foundation.text import Text
from schuler_bench.plots.uplot import UplotFigure, stack_heights
from schuler_bench.session.shown import Shown
from schuler_bench.shell.layout import TOOLS
from schuler_bench.shell.stack import Stack, room_px
from schuler_bench.shell.view import Figures, Frame, PictureView, Tab, if_user
from schuler_bench.views.errors.view import error_curves
from schuler_bench.views.switching.figure import switched_methods, switching_legend, switching_plots

_FIRST_ABOVE = "dve"
_LEAST_PX = 64


@dataclass(frozen=True)
class Switching:
    """Plots of the methods that switch.

    Attributes
    ----------
    errors : dict
        Key -> error curves, of which one stands above.
    plots : tuple of UplotFigure
        Measures, states and xi.
    run : Run
        Whose they are.
    """

    errors: dict[str, UplotFigure]
    plots: tuple[UplotFigure, ...]
    run: Run


class SwitchingView(PictureView[Switching]):
    """Chooser of the error curve, legend and plots; the tab is there while a method switches."""

    title = Text("Switching")
    place = "lower"
    tab = Text("Errors")
    look_for = Text("When each method damps, and what its measure says; look for jumps of the error above.")
    plots = (title,)
    always = False

    def __init__(self, frame: Frame) -> None:
        super().__init__(frame)
        self._titles: dict[str, str] = {}

    def build(self, tab: Tab) -> None:
        """Make chooser and legend."""
        gui = self.frame.gui
        self._stack = Stack(gui, tab)
        self._titles = {}
        with tab:
            self._above: Any = gui.add_dropdown(
                Text("curve above"), ("",), order=0, hint=Text("Error curve over the states and thresholds.")
            )
            gui.add_html(TOOLS, order=0)
            self._legend = gui.add_html("", order=1)
        self._above.on_update(if_user(self.frame.redraw))

    def stands(self, run: Run) -> bool:
        """Whether a method switches."""
        return bool(switched_methods(run))

    def picture(self, found: Shown) -> Switching:
        """Make the error curves and the plots below."""
        plots = switching_plots(found.run, found.display.time)
        return Switching(error_curves(found).plots, plots, found.run)

    def show(self, picture: Switching) -> None:
        """Show one error curve above the other plots."""
        titles = {plot.title: key for key, plot in picture.errors.items()}
        if titles != self._titles:
            self._titles = titles
            self._above.options = tuple(titles)
            self._above.value = picture.errors[_FIRST_ABOVE].title
        figures = [picture.errors[titles[self._above.value]], *picture.plots]
        self._legend.content = switching_legend(picture.run)
        layout = self.frame.layout()
        heights = stack_heights(room_px(layout), len(figures), _LEAST_PX)
        self._stack.show(figures, heights, labelled=1, scale=layout.scale)

    def figures(self, found: Shown, plot: str) -> Figures:
        """Make the plots below the error curve."""
        del plot
        if not self.stands(found.run):
            raise LookupError(Text("No method of this scenario switches."))
        return None, list(self.picture(found).plots)


VIEW = SwitchingView

"""A view whose picture is one plotly figure, which fills the tab below a chooser."""

from typing import Any, ClassVar

from navcore.engine.run import Run
from schuler_bench.plots import style
from schuler_bench.plots.pinned import restyled, together, without_hidden
from schuler_bench.plots.plotly_data import PlotlyFigure, enlarged
from schuler_bench.session.shown import Shown
from schuler_bench.shell.layout import CHOOSER_PX
from schuler_bench.shell.view import Figures, Frame, PictureView, Tab


class PlotlyView(PictureView[PlotlyFigure]):
    """Gives `figure`, and in `build_tools` what stands above the plot.

    Attributes
    ----------
    above_px : int
        Height of what stands above the plot.
    """

    above_px: ClassVar[int] = CHOOSER_PX

    def __init__(self, frame: Frame) -> None:
        super().__init__(frame)
        self._tab: Tab | None = None
        self._plot: Any = None
        self._room_px = 0

    def build(self, tab: Tab) -> None:
        """Make the tools; the plot is made with its first figure."""
        self._tab, self._plot, self._room_px = tab, None, 0
        with tab:
            self.build_tools()

    def build_tools(self) -> None:
        """Make what stands above the plot."""

    def figure(self, both: Run, found: Shown) -> PlotlyFigure:
        """Make the figure.

        Parameters
        ----------
        both : Run
            The run together with the methods of the pinned ones.
        found : Shown
            What the pictures show.
        """
        raise NotImplementedError

    @property
    def aspect(self) -> float:
        """Height of the plot over `width_px`."""
        layout = self.frame.layout()
        if self._room_px:
            return self._room_px / layout.scale / layout.text_px
        # of a view alone the choosers are hidden (static/page.css)
        return layout.aspect(max(self.above_px - CHOOSER_PX, 0) if layout.alone else self.above_px)

    def take_room(self, px: int) -> bool:
        """Let the next picture be as high as the page shows the plot."""
        far = abs(px - self._room_px) > 0.03 * px
        if far:
            self._room_px = px
        return far

    @property
    def _on_screen(self) -> float:
        """Height over width of the plot as it is seen."""
        return self.aspect / self.frame.layout().letter

    @property
    def width_px(self) -> float:
        """Width of the plot for its texts."""
        return self.frame.layout().text_px

    def picture(self, found: Shown) -> PlotlyFigure:
        """Make the figure; it carries its proportions, the run's number and the tab's title.

        The strip of results names the run's methods in their colours: their legend goes, but in a view alone.
        """
        figure = self._complete(found)
        if not self.frame.layout().alone:
            style.without_legend(figure, [method.method.name for method in found.run.lines], self.width_px)
        return self._carrying(figure, found)

    def _complete(self, found: Shown) -> PlotlyFigure:
        both = together(found.run, found.pins)
        figure = self.figure(both, found)
        restyled(figure, found.pins)
        state_of = found.display.state_of
        without_hidden(figure, (one.place for one in both.methods if state_of(one.method.name) == "hidden"))
        return figure

    def _carrying(self, figure: PlotlyFigure, found: Shown) -> PlotlyFigure:
        carried = {"aspect": self._on_screen, "run": found.number, "view": self.title}
        figure["layout"]["meta"] = figure["layout"]["meta"] | carried
        return enlarged(figure, self.frame.layout().scale)

    def show(self, picture: PlotlyFigure) -> None:
        """Send the figure, or hide the plot where there is none."""
        if self._plot is None and picture and self._tab is not None:
            plot: Any = picture
            with self._tab:
                self._plot = self.frame.gui.add_plotly(plot, aspect=self._on_screen)
        elif self._plot is not None:
            if picture:
                self._plot.figure = picture
            if self._plot.visible != bool(picture):
                self._plot.visible = bool(picture)

    def figures(self, found: Shown, plot: str) -> Figures:
        """Make the figure to be saved."""
        del plot
        return self._carrying(self._complete(found), found), []

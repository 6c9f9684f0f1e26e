"""Saves a plot of any view as numbers or as a picture."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from typing import Any

from app.bridge.texts import figure_said, text_said
from app.plots.plotly_data import PlotlyFigure
from app.plots.saved import plotly_csv, time_csv
from app.plots.time_figure import WIDTH_PX, time_figure
from app.session.shown import Shown, shown
from app.shell import notices
from app.shell.view import Figures, Frame
from navcore.foundation.text import Text

FORMATS = ("CSV", "SVG", "PNG")


@dataclass(frozen=True)
class Picture:
    """A picture that the page's script draws.

    Attributes
    ----------
    title : str
        What is shown.
    figure : PlotlyFigure or None
        As plotly reads it; None: the 3D view, as it is seen.
    width_px : float
        Width of the picture; its height follows from the figure.
    """

    title: str
    figure: PlotlyFigure | None
    width_px: float

    def job(self, client: Any) -> dict[str, Any]:
        """Make the script's task, in the page's language."""
        import orjson

        title = text_said(client, self.title)
        if self.figure is None:
            return {"title": title}
        return {
            "title": title,
            "view": self.figure["layout"]["meta"].get("view", ""),
            "width": round(self.width_px),
            "height": round(self.width_px * self.figure.aspect),
            "figure": orjson.Fragment(figure_said(client, self.figure.to_json())),
        }


def picture_of(title: str, figures: Figures, width_px: float) -> Picture:
    """Picture of what a view gives to be saved; a plotly figure was made for ``width_px``."""
    plotly, plots = figures
    return (
        Picture(title, time_figure(plots), WIDTH_PX) if plotly is None else Picture(title, plotly, width_px)
    )


class Export:
    """Saves the plots that the views of a page offer.

    Parameters
    ----------
    frame : Frame
        Of the page.

    Attributes
    ----------
    plots : tuple of str
        Titles of the plots that can be saved.
    """

    def __init__(self, frame: Frame) -> None:
        self._frame, self._client, self._session = frame, frame.client, frame.session
        self.plots = tuple(plot for kind in frame.kinds for plot in kind.plots)
        frame.commands.register("exported", self._exported, watcher=True)
        self._wanted = frame.gui.add_html("", order=40)
        self._count = 0

    def save(self, title: str, format: str) -> None:
        """Save a plot: its numbers from here, its picture by the page, which draws it."""
        now = shown(self._session)
        view = next((view for view in self._frame.views() if title in view.plots), None)
        if now is None or view is None:
            self.tell_no_run()
            return
        try:
            figures = view.figures(now, title)
        except LookupError as error:
            notices.tell(self._client, "Nothing to save", [str(error)], "warning")
            return
        name = title.split(": ")[-1].split(" (")[0].replace(" ", "-").lower()
        if format == "CSV":
            numbers = _numbers(figures, now, title)
            self._client.send_file_download(f"{name}.csv", numbers, save_immediately=True)
            self._client.flush()
            return
        layout = self._frame.layout()
        picture = picture_of(title, figures, layout.plot_px * layout.scale)
        self.draw(format.lower(), f"{name}.{format.lower()}", [picture])

    def draw(
        self, format: str, name: str, pictures: Sequence[Picture], page: str = "", title: str = ""
    ) -> None:
        """Let the page draw pictures and save them as one file (export.js).

        Parameters
        ----------
        format : {"svg", "png", "html", "overview"}
            Of the file; "html": a page of ours with the pictures in it; "overview": PNG of all pictures.
        name : str
            Of the file.
        pictures : sequence of Picture
            One of them for a single plot.
        page : str
            HTML in which ``<img data-picture="2">`` stands for the third picture.
        title : str
            Above the overview.
        """
        import orjson

        self._count += 1
        drawn = [picture.job(self._client) for picture in pictures]
        job = {"format": format, "name": name, "pictures": drawn, "page": page, "title": title}
        text = escape(orjson.dumps(job).decode())
        self._wanted.content = (
            f'<div id="sb-export" hidden data-count="{self._count}" data-job="{text}"></div>'
        )
        self._client.flush()

    def tell_no_run(self) -> None:
        """There is nothing to save yet."""
        notices.tell(self._client, "Nothing to save", ["there is no run yet"], "warning")

    def _exported(self, fault: str) -> None:
        """The page has saved its file, or says why not."""
        self._wanted.content = ""
        if fault:
            notices.tell(self._client, "Not saved", [fault[:200]], "warning")
        self._client.flush()


def _numbers(figures: Figures, now: Shown, title: str) -> bytes:
    about = (Text("Schuler Bench: {title}", title=title), f"scenario_sha256 {now.run.scenario_sha256}")
    plotly, plots = figures
    return time_csv(plots, about) if plotly is None else plotly_csv(plotly, about)

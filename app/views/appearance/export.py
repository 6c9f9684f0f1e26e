"""Saves a plot of any view as numbers or as a picture."""

from __future__ import annotations

from html import escape

from app.bridge.texts import figure_said
from app.plots.saved import plotly_csv, time_csv, time_picture
from app.session.shown import Shown, shown
from app.shell import notices
from app.shell.plotly_view import PlotlyView
from app.shell.view import Frame, View
from navcore.scenario.file import scenario_hash

FORMATS = ("CSV", "SVG", "PNG")


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
        frame.commands.register("unsaved", self._unsaved, watcher=True)
        self._wanted = frame.gui.add_html("", order=40)
        self._count = 0

    def save(self, title: str, format: str) -> None:
        """Save a plot: made here, or by the page where plotly draws it (export.js)."""
        found = shown(self._session)
        view = next((view for view in self._frame.views() if title in view.plots), None)
        if found is None or view is None:
            notices.tell(self._client, "Nothing to save", ["there is no run yet"], "warning")
            return
        name = f"{title.split(': ')[-1].split(' (')[0]}".replace(" ", "-").lower()
        if isinstance(view, PlotlyView) and format != "CSV":
            try:
                figure = view.picture(found)
            except LookupError as error:
                notices.tell(self._client, "Nothing to save", [str(error)], "warning")
                return
            self._count += 1
            layout = self._frame.layout()
            self._wanted.content = (
                f'<div id="sb-export" hidden data-count="{self._count}" data-view="{escape(title)}" '
                f'data-format="{format.lower()}" data-name="{escape(name)}" '
                f'data-figure="{escape(figure_said(self._client, figure.to_json()))}" '
                f'data-width="{layout.plot_px * layout.scale:.0f}" data-aspect="{figure.aspect:.4f}"></div>'
            )
            self._client.flush()
            return
        try:
            content = _content(view, found, title, format)
        except LookupError as error:
            notices.tell(self._client, "Nothing to save", [str(error)], "warning")
            return
        self._client.send_file_download(f"{name}.{format.lower()}", content, save_immediately=True)
        self._client.flush()

    def _unsaved(self, view: str) -> None:
        """The page cannot draw a picture yet."""
        lines = [f"Bring the tab {view[:20]} to the front, and save it again."]
        notices.tell(self._client, "Not saved", lines, "warning")


def _content(view: View, found: Shown, title: str, format: str) -> bytes:
    about = (f"Schuler Bench: {title}", f"scenario_sha256 {scenario_hash(found.run.scenario)}")
    plotly, plots = view.figures(found, title)
    if plotly is not None:
        return plotly_csv(plotly, about)
    if format == "CSV":
        return time_csv(plots, about)
    return time_picture(plots, format.lower(), f"{title}, {about[1][:26]}")

"""The whole session in one file: a page to keep and print (HTML), or all plots in one picture (PNG)."""

from __future__ import annotations

from copy import copy
from dataclasses import replace
from datetime import UTC, datetime
from functools import partial

from app.bridge.texts import language_of, text_said
from app.session.shown import Shown, shown
from app.shell.layout import layout_for
from app.shell.plotly_view import PlotlyView
from app.shell.view import Frame, PictureView
from app.views.appearance.document import Session, document
from app.views.appearance.export import Export, Picture, picture_of

PAGE, OVERVIEW = "session.html", "overview.png"
_WINDOW = (1600, 940)
"""Window for which plots are laid out: on A4 their type is legible, and three stand on a page."""


class Sheet:
    """Gathers what the session shows, and lets the page draw and save it.

    Parameters
    ----------
    frame : Frame
        Of the page.
    export : Export
        Draws the plots.
    """

    def __init__(self, frame: Frame, export: Export) -> None:
        self._frame, self._export = frame, export
        add = frame.commands.register
        add("save-page", lambda _: self.save(PAGE), "Save the session as one page (HTML)", watcher=True)
        overview = "Save all plots in one picture (PNG)"
        add("save-overview", lambda _: self.save(OVERVIEW), overview, watcher=True)

    def save(self, name: str) -> None:
        """Save `PAGE` or `OVERVIEW`."""
        frame, client = self._frame, self._frame.client
        now = shown(frame.session)
        if now is None:
            self._export.tell_no_run()
            return
        session = Session(now, frame.session.pins.all, frame.session.origin, datetime.now(UTC))
        pictures, say = pictures_of(frame, now), partial(text_said, client)
        if name == OVERVIEW:
            self._export.draw("overview", name, pictures, title=say(f"Schuler Bench: {session.title}"))
            return
        page = document(session, [picture.title for picture in pictures], language_of(client), say)
        self._export.draw("html", name, pictures, page=page)


def pictures_of(frame: Frame, now: Shown) -> list[Picture]:
    """3D view and plots of all views, in the order of their tabs, laid out alike whatever the window is."""
    layout = layout_for(*_WINDOW)
    pictures = [Picture("Trajectory in 3D", None, 0.0)]
    for view in frame.views():
        if isinstance(view, PictureView) and not view.stands(now.run):
            continue
        if isinstance(view, PlotlyView):  # the same one, its plot for another place
            view = copy(view)
            view.frame = replace(frame, layout=lambda: layout)
        pictures += [picture_of(title, figures, layout.plot_px) for title, figures in view.sheet(now)]
    return pictures

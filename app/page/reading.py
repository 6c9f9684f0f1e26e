"""How a page reads its plots: units, pins, the cursor that moves the ship, and what is saved of them."""

from __future__ import annotations

from collections.abc import Callable
from html import escape
from typing import TYPE_CHECKING

from app.figures.errors import QUANTITIES
from app.figures.plotly_data import PlotlyFigure
from app.figures.saved import plotly_csv, time_csv, time_picture
from app.figures.uplot import UplotFigure
from app.page import notices
from app.panels.compare import Comparing
from app.panels.reading import ReadingPanel
from app.session.session import Session
from app.session.shown import Shown, shown
from navcore.scenario_file import scenario_hash

if TYPE_CHECKING:
    import viser

    from app.page.commands import Commands

ERRORS, SWITCHING = "Errors", "Switching"
_PICTURES = ("Frequency", "Poles", "Step", "Spectrum")
_TIMES = {f"Errors: {title}": key for key, title in QUANTITIES.items()}
PLOTS = (*_PICTURES, *_TIMES, SWITCHING)
"""Plots that can be saved."""

Figures = tuple[PlotlyFigure | None, list[UplotFigure]]
Make = Callable[[Shown, str], Figures]
"""``make(found, tab)``: the plotly figure or the time plots of a tab."""


class Reading:
    """What one page offers to read its plots.

    Parameters
    ----------
    client : viser.ClientHandle
        The browser.
    session : Session
        Whose plots are read.
    commands : Commands
        Of the page.
    tab : viser.GuiTabHandle
        Where the choices stand.
    make : callable
        Makes the figures of a tab.
    """

    def __init__(
        self,
        client: viser.ClientHandle,
        session: Session,
        commands: Commands,
        tab: viser.GuiTabHandle,
        make: Make,
    ) -> None:
        self._client, self._session, self._make = client, session, make
        self.comparing = Comparing(client, session)
        self.comparing.register(commands)
        self.panel = ReadingPanel(client.gui, tab, session, PLOTS, self._export)
        commands.register("unsaved", self._unsaved, watcher=True)
        self._wanted = client.gui.add_html("", order=4)
        self._count = 0

    def show(self) -> None:
        """Show the session's choices and which run is drawn."""
        self.panel.show()
        found = shown(self._session)
        self.comparing.mark(None if found is None else found.flipped)

    def _export(self, title: str, format: str) -> None:
        """Save a plot: made here, or by the page where plotly draws it."""
        found = shown(self._session)
        if found is None or title not in PLOTS:
            notices.tell(self._client, "Nothing to save", ["there is no run yet"], "warning")
            return
        name = f"{title.split(': ')[-1].split(' (')[0]}".replace(" ", "-").lower()
        if title in _PICTURES and format != "CSV":
            self._count += 1
            self._wanted.content = (
                f'<div id="sb-export" hidden data-count="{self._count}" data-view="{escape(title)}" '
                f'data-format="{format.lower()}" data-name="{escape(name)}"></div>'
            )
            self._client.flush()
            return
        content = self._content(found, title, format)
        if content is None:
            lines = ["No method of this scenario switches."]
            notices.tell(self._client, "Nothing to save", lines, "warning")
            return
        self._client.send_file_download(f"{name}.{format.lower()}", content, save_immediately=True)
        self._client.flush()

    def _unsaved(self, view: str) -> None:
        """The page cannot draw a picture of what it does not show."""
        lines = [f"Bring the tab {view[:20]} to the front, and save it again."]
        notices.tell(self._client, "Not saved", lines, "warning")

    def _content(self, found: Shown, title: str, format: str) -> bytes | None:
        about = (f"Schuler Bench: {title}", f"scenario_sha256 {scenario_hash(found.run.scenario)}")
        tab = title if title in (*_PICTURES, SWITCHING) else ERRORS
        plotly, plots = self._make(found, tab)
        if plotly is not None:
            return plotly_csv(plotly, about)
        if title in _TIMES:
            plots = [plot for plot in plots if plot.key == _TIMES[title]]
        if not plots:
            return None
        if format == "CSV":
            return time_csv(plots, about)
        return time_picture(plots, format.lower(), f"{title}, {about[1][:26]}")

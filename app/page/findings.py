"""On a page: what a session's searches have found - what dominates the result, and a damping table."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from app.page import notices
from app.panels.results import ResultsPanel
from app.panels.tuning import TuningPanel
from app.panels.why import why_html
from app.session.session import Session
from navcore.errors import InputError
from navcore.tuning.settings import TuningSettings

if TYPE_CHECKING:
    import viser


class Findings:
    """The searches of a session as one page shows them.

    Parameters
    ----------
    client : viser.ClientHandle
        The browser.
    session : Session
        Whose searches they are.
    tab : viser.GuiTabHandle
        "Method".
    results : callable
        Gives the right column.
    """

    def __init__(
        self,
        client: viser.ClientHandle,
        session: Session,
        tab: viser.GuiTabHandle,
        results: Callable[[], ResultsPanel],
    ) -> None:
        self._client, self._session, self._results = client, session, results
        self._closed = False
        tuner = session.searches.tuner
        self._tuning = TuningPanel(client.gui, tab, self._find, tuner.cancel, self._use, order=95.0)

    def begin(self) -> None:
        """Follow the searches from now on."""
        self._session.searches.watch(self._changed, self._session.run)

    def show(self) -> None:
        """Show what is known now; the caller holds the session's lock."""
        session = self._session
        self._tuning.show(session.searches.tuner, session.scenario, session.selected)
        if session.run is not None:
            results = self._results()
            html = why_html(
                session.searches.explainer, session.run, session.selected, folded=not results.layout.wide
            )
            results.show_why(html)

    def close(self) -> None:
        """The browser has gone."""
        self._closed = True
        self._session.searches.unwatch(self._changed)

    def _changed(self) -> None:
        with self._session.lock, self._client.atomic():
            if self._closed:
                return
            self.show()
        self._client.flush()

    def _find(self, settings: TuningSettings) -> None:
        with self._session.lock:
            scenario = self._session.scenario
        self._session.searches.tuner.start(scenario, settings)

    def _use(self) -> None:
        from navcore.tuning import with_table

        session = self._session
        with session.lock:
            result = session.searches.tuner.result
            if result is None:
                return
            try:
                changed = with_table(session.scenario, result, session.selected)
                session.change(changed, None, name="damping table found")
            except InputError as error:
                notices.tell(self._client, "The table cannot be used", notices.fault_lines(error))

"""Controls of a search in the background: begin, progress and stop, each shown while it is of use."""

from collections.abc import Callable
from typing import Any

from schuler_bench.jobs.search import Search
from schuler_bench.shell.view import if_user


def reveal(*wanted: tuple[Any, bool]) -> None:
    """Show or hide each handle, where that changes."""
    for handle, visible in wanted:
        if handle.visible != visible:
            handle.visible = visible


def show_html(handle: Any, html: str) -> None:
    """Show a piece of HTML where it changes; nothing of it where it is empty."""
    if handle.content != html:
        handle.content = html
    reveal((handle, bool(html)))


class SearchControls:
    """Button that begins a search, its progress bar, and the button that stops it.

    Parameters
    ----------
    gui : object
        Of the frame.
    search : Search
        Of the session.
    begin : callable
        Begins it.
    words : (str, str)
        Of the two buttons.
    hint : str
        Of the first.
    order : float, optional
        Place of the first in its container; by default in the order of making.
    """

    def __init__(
        self,
        gui: Any,
        search: Search[Any, Any],
        begin: Callable[[], None],
        words: tuple[str, str],
        hint: str,
        order: float | None = None,
    ) -> None:
        self._search = search
        start, stop, progress = (None, None, None) if order is None else (order, order + 2.0, order + 1.0)
        self._start = gui.add_button(words[0], hint=hint, order=start)
        self._stop = gui.add_button(words[1], color="orange", visible=False, order=stop)
        self._progress = gui.add_progress_bar(0.0, visible=False, order=progress)
        self._start.on_click(if_user(begin))
        self._stop.on_click(if_user(search.halt))

    def follow(self, visible: bool = True) -> bool:
        """Show how far the search is, nothing where not ``visible``; return whether it is under way."""
        fraction = self._search.fraction
        running = fraction is not None
        if fraction is not None:
            self._progress.value = round(100.0 * fraction, 1)
        reveal(
            (self._start, visible and not running),
            (self._stop, visible and running),
            (self._progress, visible and running),
        )
        return running

"""What a page says of the keeping of its work: a word in the top bar, a note below, once a notification."""

from __future__ import annotations

from typing import TYPE_CHECKING

from navcore.foundation.text import Text
from schuler_bench.session.keeping import OwnKeeping
from schuler_bench.shell import notices
from schuler_bench.shell.header import WARNINGS
from schuler_bench.shell.view import Tab

if TYPE_CHECKING:
    import viser

_TITLE, _WORD = Text("Your work is not saved at present"), Text("Not saved")


class KeepingPanel:
    """Says that the work is not kept over a restart, as long as it is so, and what of it could not be read.

    Parameters
    ----------
    client : viser.ClientHandle
        The browser.
    bar : Tab
        The top bar.
    keeping : OwnKeeping
        Of the session.
    """

    def __init__(self, client: viser.ClientHandle, bar: Tab, keeping: OwnKeeping) -> None:
        self._client, self._keeping = client, keeping
        self._notified = False
        with bar:
            self._word = client.gui.add_html("", order=9)
        self._note = client.gui.add_html("", visible=False, order=WARNINGS - 1)

    def show(self) -> None:
        """Say how it is; a notification is given when the work ceases to be kept."""
        fault, lines, word = self._keeping.fault, list[str](), ""
        if fault is not None:
            values = {"title": _TITLE, "reason": fault.reason, "remedy": fault.remedy}
            told = Text("{title}: {reason:sentence} {remedy}", **values)
            lines.append(told)
            word = Text(
                '<div class="sb-unkept" data-sb-part="unkept" role="status" title="{told:html}">{word}</div>',
                told=told,
                word=_WORD,
            )
        if self._keeping.unreadable:
            lines.append(self._keeping.unreadable)
            if self._keeping.aside:
                lines.append(Text("Files (menu) offers it for download."))
        self._word.content = word
        self._note.content = notices.note(lines, "warning")
        self._note.visible = bool(lines)
        if fault is not None and not self._notified:
            more = [Text("{reason:sentence}", reason=fault.reason), fault.remedy]
            more.append(Text("A download keeps the scenario."))
            notices.tell(self._client, _TITLE, more, "warning")
        self._notified = fault is not None

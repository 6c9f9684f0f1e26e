"""What the user does with pins, by button or key, and the mark while one is shown in place of the run."""

from __future__ import annotations

import re
from html import escape
from typing import TYPE_CHECKING

from app.plots import style
from app.session.pins import MOST_PINS, Pin
from app.session.session import Session, first_editable
from app.shell import notices
from navcore.foundation.errors import InputError

if TYPE_CHECKING:
    import viser

    from app.shell.commands import Commands


class Comparing:
    """What the user does with pins, by button or key.

    Parameters
    ----------
    client : viser.ClientHandle
        The browser, for notices.
    session : Session
        Whose pins they are.
    """

    def __init__(self, client: viser.ClientHandle, session: Session) -> None:
        self._client, self.session = client, session
        self._mark = client.gui.add_html("", order=4)

    def register(self, commands: Commands) -> None:
        """Add the commands."""
        commands.register("pin", lambda _: self.pin(), "Pin the present run", "P")
        commands.register("flip", lambda _: self.flip(), "Flip between this run and the baseline", "B")

    def pin(self) -> None:
        """Pin the present run; one that is still under way as soon as it is there."""
        self.session.after_run(self._pin)

    def _pin(self) -> None:
        session = self.session
        with session.lock:
            run, origin, place = session.run, session.origin, session.selected
        if run is None:
            notices.tell(self._client, "Nothing to pin", ["there is no run yet"], "warning")
            return
        try:
            edited = run.methods[min(place, len(run.methods) - 1)].method.name
            session.pins.add(run, origin, method=edited)
        except InputError:
            lines = [f"There are {MOST_PINS} pins, which is the most. Remove one in the tab Compare."]
            notices.tell(self._client, "Not pinned", lines, "warning")

    def flip(self) -> None:
        """Show the baseline in the place of the present run, or the present run again."""
        session = self.session
        if not session.display.flipped and session.pins.baseline(session.display.baseline) is None:
            notices.tell(self._client, "Nothing to flip to", ["Pin a run first (key P)."], "warning")
            return
        session.show(None, flipped=not session.display.flipped)

    def go_back(self, pin: Pin) -> None:
        """Make the pinned scenario the present one."""
        session = self.session
        if session.display.flipped:
            session.show(None, flipped=False)
        session.change(pin.scenario, None, origin=pin.origin, selected=first_editable(pin.scenario))

    def mark(self, flipped: Pin | None) -> None:
        """Frame all plots, and say at the window's top which pin they show; nothing for the present run."""
        content = ""
        if flipped is not None:
            text = f"Showing the pin \u201c{flipped.name}\u201d, not the present run. Key B flips back."
            said = f'<div id="sb-flip" role="status" hidden>{escape(text)}</div>'
            content = f"{said}<style>{_frame(text, flipped.hex)}</style>"
        if self._mark.content != content:
            self._mark.content = content


def _frame(text: str, color: str) -> str:
    """Style that shows a text over the page; everything but plain letters is escaped, for it is a user's."""
    safe = re.sub(r"[^A-Za-z0-9 .,]", lambda found: f"\\{ord(found[0]):06x}", text)
    return (
        f'body::after{{content:"{safe}";position:fixed;z-index:9999;top:0;left:50%;transform:translateX(-50%);'
        f"padding:7px 18px;border-radius:0 0 6px 6px;background:{color};color:#fff;font:600 15px "
        f"{style.FONT_FAMILY};pointer-events:none}}"
        f".js-plotly-plot,.uplot,.sb-table{{outline:3px solid {color};outline-offset:-3px}}"
    )

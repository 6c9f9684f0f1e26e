"""At the very top: buttons for undo, redo, reset, share, present, commands; what differs; who presents."""

from __future__ import annotations

from html import escape
from typing import TYPE_CHECKING

from app.shell.reset import RESET_FIELD
from navcore.foundation.text import Text

if TYPE_CHECKING:
    import viser

    from app.session.history import History

UNDO, REDO, RESET_ALL, SHARE, PRESENT = "undo", "redo", "reset-all", "share", "present"
"""Names of the commands behind the buttons."""
_ICONS = {
    UNDO: "M9 14 4 9l5-5M4 9h10a6 6 0 0 1 0 12h-3",
    REDO: "m15 14 5-5-5-5M20 9H10a6 6 0 0 0 0 12h3",
    RESET_ALL: "M4 4v6h6M4.6 10A8 8 0 1 1 4 14",
}


class Toolbar:
    """The buttons, as HTML of ours: small enough to stand in one row, each a command.

    Parameters
    ----------
    gui : viser.GuiApi
        Of the client.
    order : float
        Place in the left column.
    """

    def __init__(self, gui: viser.GuiApi, order: float) -> None:
        self._buttons = gui.add_html("", order=order)
        self._changed = gui.add_html("", order=order + 0.1)
        self._banner = gui.add_html("", order=order + 0.2)

    def show(self, history: History, origin: str, changed: int, presents: bool, watches: bool) -> None:
        """Show what each button would do now.

        Parameters
        ----------
        history : History
            What can be undone and redone.
        origin : str
            To what reset goes back.
        changed : int
            Fields that differ from it.
        presents, watches : bool
            The page drives alone; it watches another one.
        """
        undo, redo = history.undo_name, history.redo_name
        free = not watches
        undoes, redoes = undo is not None and free, redo is not None and free
        buttons = [
            _icon(UNDO, "Undo", undo or "nothing to undo", "Ctrl+Z", undoes),
            _icon(REDO, "Redo", redo or "nothing to redo", "Ctrl+Shift+Z", redoes),
            _icon(
                RESET_ALL,
                "Reset all",
                Text("back to {origin} as opened", origin=origin),
                "",
                changed > 0 and free,
            ),
            _button(SHARE, "Share", "A link that opens this state", free),
            _button(PRESENT, "Present", _PRESENTING if presents else _PRESENT, free, presents),
            _COMMANDS,
        ]
        content = f'<div class="sb-row" role="toolbar" aria-label="Commands">{"".join(buttons)}</div>'
        if self._buttons.content != content:
            self._buttons.content = content

    def show_changed(self, origin: str, changed: int, last: tuple[str, str, str] | None) -> None:
        """Say how many fields differ from the opened scenario, and offer to reset the one in hand.

        Parameters
        ----------
        origin : str
            The opened scenario.
        changed : int
            Number of fields that differ.
        last : tuple of str or None
            Dotted path and label of the field in hand, and the value to which it goes back.
        """
        text, button = Text("Unchanged since {origin} was opened", origin=origin), ""
        if changed:
            text = Text.plural(
                "{changed} field changed from {origin}",
                "{changed} fields changed from {origin}",
                count=not changed,
                changed=changed,
                origin=origin,
            )
        if last is not None:
            name, label, value = last
            text = Text("{label} was {value}", label=label, value=value)
            hint = Text("Reset {label} to {value}", label=label, value=value)
            button = _button(f"{RESET_FIELD} {name}", "Reset", hint, True)
        content = f'<div class="sb-changed"><span title="{escape(text)}">{escape(text)}</span>{button}</div>'
        if self._changed.content != content:
            self._changed.content = content

    def show_banner(self, text: str, drives: bool) -> None:
        """Say who presents; nothing for an empty text."""
        mine, style = (" sb-drives", "") if drives else ("", _WATCHING)
        content = f'{style}<div class="sb-banner{mine}" role="status">{escape(text)}</div>' if text else ""
        if self._banner.content != content:
            self._banner.content = content


_WATCHING = "<style>.sb-handle, .sb-handle-scale, .sb-handle-told { display: none; }</style>"
"""For a page that watches: it sees no handle (static/handle.js), for one would do nothing."""
_PRESENT = "Drive alone: other pages of this session watch until you press it again or leave"
_COMMANDS = (
    '<button class="sb-do" data-palette title="All commands (Ctrl+K); their keys: ?">Commands</button>'
)
_PRESENTING = "You present; press to let the other pages take part again"


def _icon(command: str, label: str, what: str, key: str, able: bool) -> str:
    shape = f'<svg viewBox="0 0 24 24" aria-hidden="true"><path d="{_ICONS[command]}"/></svg>'
    hint = f"{label}: {what}" + (f" ({key})" if key else "")
    state = "" if able else ' aria-disabled="true"'
    named = f'title="{escape(hint)}" aria-label="{label}"{state}'
    return f'<button class="sb-do" data-command="{command}" {named}>{shape}</button>'


def _button(command: str, label: str, hint: str, able: bool, pressed: bool | None = None) -> str:
    state = "" if able else ' aria-disabled="true"'
    state += "" if pressed is None else f' aria-pressed="{str(pressed).lower()}"'
    return (
        f'<button class="sb-do" data-command="{escape(command)}" title="{escape(hint)}"{state}>'
        f"{escape(label)}</button>"
    )

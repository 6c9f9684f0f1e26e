"""The buttons of the top bar: undo, redo, reset, search, share, present; what has changed; who presents."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from navcore.foundation.text import Text
from schuler_bench.session.history import History
from schuler_bench.shell.reset import RESET_FIELD

if TYPE_CHECKING:
    import viser

    from schuler_bench.shell.view import Tab

UNDO, REDO, RESET_ALL, SHARE, PRESENT = "undo", "redo", "reset-all", "share", "present"
"""Names of the commands behind the buttons."""
_ICONS = {
    UNDO: "M9 14 4 9l5-5M4 9h10a6 6 0 0 1 0 12h-3",
    REDO: "m15 14 5-5-5-5M20 9H10a6 6 0 0 0 0 12h3",
    RESET_ALL: "M4 4v6h6M4.6 10A8 8 0 1 1 4 14",
}
_WATCHING = (
    "<style>.sb-handle, .sb-handle-scale, .sb-handle-told, .sb-plus, .sb-menu { display: none; }"
    ".sb-limit { pointer-events: none; }</style>"
)
"""For a page that watches: what would do nothing is out of its sight, or cannot be clicked."""
_PRESENT = Text("Drive alone: other pages of this session watch until you press it again or leave")
_SEARCH = Text(
    '<div data-sb-part="search"><button class="sb-do" data-palette '
    'title="All commands (Ctrl+K); their keys: ?">'
    "<span data-sb-drops><kbd>Ctrl+K</kbd><span>Find a command</span></span></button></div>"
)
_PRESENTING = Text("You present; press to let the other pages take part again")


class Toolbar:
    """The buttons, as HTML of ours: small enough to stand in one row, each a command.

    Parameters
    ----------
    gui : viser.GuiApi
        Of the client.
    bar : Tab
        The top bar.
    """

    def __init__(self, gui: viser.GuiApi, bar: Tab) -> None:
        with bar:
            self._buttons = gui.add_html("", order=5)
            self._changed = gui.add_html("", order=20)
            self._banner = gui.add_html("", order=21)
            gui.add_html(_SEARCH, order=30)
            self._shared = gui.add_html("", order=40)

    def show(
        self,
        history: History,
        origin: str,
        changed: int,
        last: tuple[str, str, str] | None,
        presents: bool,
        watches: bool,
    ) -> None:
        """Show what each button would do now, and what differs from the opened scenario.

        Parameters
        ----------
        history : History
            What can be undone and redone.
        origin : str
            To what reset goes back.
        changed : int
            Fields that differ from it.
        last : tuple of str or None
            Dotted path and label of the edited field, and the value to which it goes back.
        presents, watches : bool
            The page drives alone; it watches another one.
        """
        undo, redo, free = history.undo_name, history.redo_name, not watches
        back = Text("back to {origin} as opened", origin=origin)
        buttons = [
            _icon(UNDO, Text("Undo"), undo or Text("nothing to undo"), "Ctrl+Z", undo is not None and free),
            _icon(
                REDO, Text("Redo"), redo or Text("nothing to redo"), "Ctrl+Shift+Z", redo is not None and free
            ),
            _icon(RESET_ALL, Text("Reset all"), back, "", changed > 0 and free),
        ]
        shared = [
            _button(SHARE, Text("Share"), Text("A link that opens this state"), free),
            _button(PRESENT, Text("Present"), _PRESENTING if presents else _PRESENT, free, presents),
        ]
        for handle, name, each in (
            (self._buttons, Text("Undo and reset"), buttons),
            (self._shared, Text("Sharing"), shared),
        ):
            row = Text(
                '<div class="sb-row" data-sb-part="row" role="toolbar" aria-label="{name}">{buttons}</div>',
                name=name,
                buttons=Text.joined("", each),
            )
            _put(handle, row)
        text, button = Text("Unchanged"), ""
        told = Text("Unchanged since {origin} was opened", origin=origin)
        if changed:
            text = Text.plural(
                "{changed} field changed", "{changed} fields changed", count=changed, changed=changed
            )
            told = Text("{text} from {origin}", text=text, origin=origin)
        if last is not None:
            name, label, value = last
            text = told = Text("{label} was {value}", label=label, value=value)
            hint = Text("Reset {label} to {value}", label=label, value=value)
            button = _button(f"{RESET_FIELD} {name}", Text("Reset"), hint, True)
        words = Text('<span title="{told:html}">{text:html}</span>', told=told, text=text)
        _put(
            self._changed,
            Text(
                '<div class="sb-changed" data-sb-part="changed" data-sb-drops>{words}{button}</div>',
                words=words,
                button=button,
            ),
        )

    def show_banner(self, text: str, drives: bool) -> None:
        """Say who presents; nothing for an empty text."""
        mine, style = (" sb-drives", "") if drives else ("", _WATCHING)
        banner = Text(
            '<div class="sb-banner{mine}" data-sb-part="banner" role="status">{text:html}{style}</div>',
            style=style,
            mine=mine,
            text=text,
        )
        _put(self._banner, banner if text else "")


def _put(handle: Any, html: str) -> None:
    if handle.content != html:
        handle.content = html


def _icon(command: str, label: str, what: str, key: str, able: bool) -> str:
    shape = f'<svg viewBox="0 0 24 24" aria-hidden="true"><path d="{_ICONS[command]}"/></svg>'
    hint = Text("{label}: {what}", label=label, what=what) + (Text(" ({key})", key=key) if key else "")
    state = "" if able else ' aria-disabled="true"'
    return Text(
        '<button class="sb-do" data-command="{command}" title="{hint:html}" aria-label="{label}"{state}>'
        "{shape}</button>",
        command=command,
        hint=hint,
        label=label,
        state=state,
        shape=shape,
    )


def _button(command: str, label: str, hint: str, able: bool, pressed: bool | None = None) -> str:
    state = "" if able else ' aria-disabled="true"'
    state += "" if pressed is None else f' aria-pressed="{str(pressed).lower()}"'
    return Text(
        '<button class="sb-do" data-command="{command:html}" title="{hint:html}"{state}>'
        "{label:html}</button>",
        command=command,
        hint=hint,
        state=state,
        label=label,
    )

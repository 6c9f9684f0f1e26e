"""The commands that every page has, and the row of buttons that stands for some of them."""

from __future__ import annotations

import operator
from functools import lru_cache
from html import escape
from typing import TYPE_CHECKING, Any

from app.bridge.controls import lock_controls
from app.editing.edits import disturbances_toml, method_toml, paste
from app.editing.typed import read_typed, unit_of
from app.jobs.words import without_folders
from app.session.history import History, changed_fields
from app.session.view import View
from app.shell import notices
from app.shell.commands import LONGEST_TEXT, Command
from app.shell.control import Control
from app.shell.opening import Opening
from app.shell.reports import view_names
from app.shell.reset import RESET_FIELD, Resets
from app.shell.view import Frame
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.scenario.file import load, presets

if TYPE_CHECKING:
    import viser

UNDO, REDO, RESET_ALL, SHARE, PRESENT = "undo", "redo", "reset-all", "share", "present"
"""Names of the commands behind the buttons."""
_ICONS = {
    UNDO: "M9 14 4 9l5-5M4 9h10a6 6 0 0 1 0 12h-3",
    REDO: "m15 14 5-5-5-5M20 9H10a6 6 0 0 0 0 12h3",
    RESET_ALL: "M4 4v6h6M4.6 10A8 8 0 1 1 4 14",
}
COPY_METHOD, COPY_LOG, PASTE = "copy-method-text", "copy-log-text", "paste-text"
_LONGEST_UNDO = 48


class Palette:
    """Registers the commands and keeps their titles, the buttons and the banner up to date.

    Parameters
    ----------
    frame : Frame
        Of the page.
    page : View
        The page, as its session knows it.
    free : frozenset of str
        Ids of the controls that a watcher may use: those through which the page reports.
    """

    def __init__(self, frame: Frame, page: View, free: frozenset[str]) -> None:
        self._client, self._session, self._commands = frame.client, frame.session, frame.commands
        self._frame, self._page, self._free = frame, page, free
        self._toolbar = Toolbar(frame.gui, order=5)
        self._register(frame.opening)
        self._shown: tuple[object, ...] = ()
        self._values: list[Any] = []
        self._resets = Resets(self._commands, frame.editor.put)

    def _register(self, opening: Opening) -> None:
        session, ask, tell = self._session, self._commands.ask_page, self._if
        tabs = [kind.title for kind in self._frame.kinds if kind.title and kind.always]
        commands = [
            Command(UNDO, lambda _: tell(session.undo(), "Nothing to undo"), "Undo", ("Ctrl+Z",)),
            Command(
                REDO, lambda _: tell(session.redo(), "Nothing to redo"), "Redo", ("Ctrl+Shift+Z", "Ctrl+Y")
            ),
            Command(RESET_ALL, lambda _: tell(session.reset(None), "Nothing has been changed"), "Reset all"),
            Command(SHARE, lambda _: self._share(), "Share: a link that opens this state"),
            Command(
                "share-view",
                lambda _: self._share("link-view"),
                "Share this view: a link that opens these tabs",
            ),
            Command("no-tab", self._tell_no_tab, watcher=True),
            Command("no-view", self._tell_no_view, watcher=True),
            Command(PRESENT, lambda _: self._present(), "Present: drive alone, others watch"),
            Command("run", lambda _: session.redo_run(), "Run again"),
            Command("stop", lambda _: session.cancel_run(), "Stop the run"),
            Command("keys", lambda _: ask("keys", ""), "Keys: what they do", ("?",), watcher=True),
            Command("tab", lambda name: ask("tab", name), watcher=True),
            Command("typed", self._typed),
            Command("reset-named", self._reset_named),
            Command(
                COPY_METHOD,
                lambda _: ask("copy", method_toml(session.scenario, session.selected)),
                "Copy the method as TOML",
                watcher=True,
            ),
            Command(
                COPY_LOG,
                lambda _: ask("copy", disturbances_toml(session.scenario)),
                "Copy the log's events and outages as TOML",
                watcher=True,
            ),
            Command(
                PASTE,
                self._paste,
                "Paste a method, or the log's events and outages (TOML)",
                longest=LONGEST_TEXT,
            ),
            *(
                Command(
                    f"preset-{name}",
                    lambda _, name=name: opening.choose_scenario(name),
                    Text("Open {name}: {title}", name=name, title=title),
                )
                for name, title in _preset_titles()
            ),
            *(
                Command(
                    f"tab-{''.join(filter(str.isalnum, name.lower()))}",
                    lambda _, name=name: ask("tab", name),
                    Text("Show {name}", name=name),
                    watcher=True,
                )
                for name in tabs
            ),
        ]
        for c in commands:
            self._commands.register(c.name, c.act, c.title, c.keys, watcher=c.watcher, longest=c.longest)

    # ------------------------------------------------------------ showing

    def show(self) -> None:
        """Show what can be undone and reset now."""
        self._lock()
        session, history = self._session, self._session.history
        controls = list(self._frame.controls())
        values = [control.value for control in controls]
        state = (
            session.opened, session.scenario, session.origin, history.undo_name, history.redo_name,
            self._frame.editor.moved, self._drives, self._watches, *controls,
        )  # fmt: skip
        same = len(state) == len(self._shown) and all(map(operator.is_, state, self._shown))
        if same and values == self._values:
            return
        self._shown, self._values = state, values
        self._resets.show(session.opened, session.scenario, controls)
        changed = len(changed_fields(session.opened, session.scenario))
        control = None if self._watches else self._frame.editor.moved
        last = self._resets.of(control)
        found = None if control is None or last is None else (last[0], control.spec.label, last[1])
        self._toolbar.show(history, session.origin, changed, found, self._drives, self._watches)
        self._commands.rename(UNDO, _titled("Undo", history.undo_name))
        self._commands.rename(REDO, _titled("Redo", history.redo_name))
        self._commands.rename(RESET_ALL, Text("Reset all: back to {origin} as opened", origin=session.origin))

    def show_presenter(self) -> None:
        """Show who presents."""
        self._lock()
        self._toolbar.show_banner(self._banner, self._drives)
        self.show()

    # ------------------------------------------------------------ presenting

    @property
    def _drives(self) -> bool:
        return self._session.presenter is self._page

    @property
    def _watches(self) -> bool:
        return self._session.presenter not in (None, self._page)

    def _lock(self) -> None:
        """Lock or free the controls as the session says now; those that were made meanwhile too."""
        watches, watched = self._watches, self._commands.watching
        self._commands.watching = watches
        if watches or watched:
            lock_controls(self._client, self._free if watches else None)

    @property
    def _banner(self) -> str:
        """Who presents; empty while nobody does."""
        if self._watches:
            return "Another page presents: you watch"
        if not self._drives:
            return ""
        watching = self._session.open_pages - 1
        pages = (
            "no other page is open"
            if watching == 0
            else Text.plural("{watching} watch", "{watching} watches", count=not watching, watching=watching)
        )
        return Text("You present: {pages}", pages=pages)

    # ------------------------------------------------------------ one control, by its id (static/boxes.js)

    def _control(self, id: str) -> Control | None:
        return next((control for control in self._frame.controls() if id.strip() in control.ids), None)

    def _typed(self, argument: str) -> None:
        """Take over a number typed with a unit: ``ID TAB TEXT``."""
        id, _, text = argument.partition("\t")
        control = self._control(id)
        if control is None or control.spec.kind not in ("number", "integer"):
            return
        name = control.spec.label
        try:
            value = read_typed(text.strip(), unit_of(name))
        except ValueError as error:
            raise InputError(Fault("", name, text.strip()[:40], str(error))) from None
        if control.spec.kind == "integer":
            if value != int(value):
                raise InputError(Fault("", name, text.strip()[:40], "must be a whole number"))
            value = int(value)
        self._frame.editor.put(control, value, "")

    def _reset_named(self, id: str) -> None:
        control = self._control(id)
        if control is not None:
            self._resets.take_back(control)

    # ------------------------------------------------------------ doing

    def _paste(self, text: str) -> None:
        """Take over a part of a scenario as TOML, one step of undo; ask the page where there is none."""
        if not text.strip():
            self._commands.ask_page("paste", "")
            return
        session = self._session
        with session.lock:
            pasted = paste(session.scenario, session.selected, text)
            session.change(
                pasted.scenario,
                None,
                selected=pasted.selected,
                name=Text("paste {words}", words=pasted.words),
            )
        notices.tell(self._client, "Pasted", [pasted.words], "info")

    def _if(self, done: bool, otherwise: str) -> None:
        if not done:
            notices.tell(self._client, otherwise, [], "info")

    def _share(self, what: str = "link") -> None:
        try:
            link = self._session.share()
        except OSError as error:
            why = f"{error.strerror or without_folders(str(error))}."
            notices.tell(self._client, "No link was made", [why[:1].upper() + why[1:]], "warning")
            return
        self._commands.ask_page(what, link)

    def _tell_no_tab(self, names: str) -> None:
        """Tell that the address names tabs that the page does not have (static/front.js)."""
        titles = [kind.title for kind in self._frame.kinds if kind.title]
        empty = {kind.title.lower(): kind.title for kind in self._frame.kinds if not kind.always}
        lines = [
            Text("The tab {empty} has nothing to show for this scenario.", empty=empty[name.lower()])
            if name.lower() in empty
            else Text("The address names the tab {name!r}, which this page does not have.", name=name[:40])
            for name in names.split("|")[:5]
        ]
        lines.append(Text("The tabs are: {titles}.", titles=", ".join(titles)))
        notices.tell(self._client, "Not all tabs of the address are here", lines, "warning")

    def _tell_no_view(self, name: str) -> None:
        """Tell that the address names a view that the page does not have, or not now (static/alone.js)."""
        views = view_names(self._frame.kinds)
        if name in views:
            lines = [
                Text("The view {views} has nothing to show for this scenario.", views=views[name] or name)
            ]
            notices.tell(self._client, "Nothing to show", lines, "warning")
            return
        lines = [
            Text("The address names the view {name!r}, which this page does not have.", name=name[:40]),
            Text("The views are: {views}.", views=", ".join(views)),
        ]
        notices.tell(self._client, "No such view", lines, "warning")

    def _present(self) -> None:
        if not self._session.present(None if self._drives else self._page):
            notices.tell(self._client, "Another page presents", ["It must end first."], "warning")


@lru_cache(maxsize=1)
def _preset_titles() -> tuple[tuple[str, str], ...]:
    return tuple((name, load(name).title) for name in presets())


def _titled(what: str, name: str | None) -> str:
    if name is None:
        return what
    return f"{what} {name}" if len(name) <= _LONGEST_UNDO else f"{what} {name[: _LONGEST_UNDO - 1]}…"


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
            _icon(UNDO, "Undo", undo or "nothing to undo", "Ctrl+Z", undo is not None and free),
            _icon(REDO, "Redo", redo or "nothing to redo", "Ctrl+Shift+Z", redo is not None and free),
            _icon(RESET_ALL, "Reset all", back, "", changed > 0 and free),
            _button(SHARE, "Share", "A link that opens this state", free),
            _button(PRESENT, "Present", _PRESENTING if presents else _PRESENT, free, presents),
            _COMMANDS,
        ]
        row = f'<div class="sb-row" role="toolbar" aria-label="Commands">{"".join(buttons)}</div>'
        _put(self._buttons, row)
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
        words = f'<span title="{escape(text)}">{escape(text)}</span>'
        _put(self._changed, f'<div class="sb-changed">{words}{button}</div>')

    def show_banner(self, text: str, drives: bool) -> None:
        """Say who presents; nothing for an empty text."""
        mine, style = (" sb-drives", "") if drives else ("", _WATCHING)
        banner = f'{style}<div class="sb-banner{mine}" role="status">{escape(text)}</div>'
        _put(self._banner, banner if text else "")


def _put(handle: Any, html: str) -> None:
    if handle.content != html:
        handle.content = html


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

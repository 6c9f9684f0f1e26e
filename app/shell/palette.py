"""The commands that every page has, and the row of buttons that stands for some of them."""

from __future__ import annotations

import operator
from functools import lru_cache
from typing import Any

from navcore.foundation.text import Text
from navcore.scenario.file import load, presets
from schuler_bench.bridge.controls import lock_controls
from schuler_bench.editing.pasting import disturbances_toml, method_toml, paste
from schuler_bench.jobs.words import without_folders
from schuler_bench.session.history import changed_fields
from schuler_bench.session.view import View
from schuler_bench.shell import notices
from schuler_bench.shell.commands import LONGEST_TEXT, Command
from schuler_bench.shell.control import Control
from schuler_bench.shell.finding import Finder
from schuler_bench.shell.opening import Opening
from schuler_bench.shell.reports import view_names
from schuler_bench.shell.reset import Resets
from schuler_bench.shell.tabs import tabs
from schuler_bench.shell.toolbar import PRESENT, REDO, RESET_ALL, SHARE, UNDO, Toolbar
from schuler_bench.shell.view import Frame

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
        self._toolbar = Toolbar(frame.gui, frame.bar)
        self._register(frame.opening)
        self._state: tuple[object, ...] = ()
        self._values: list[Any] = []
        self._resets = Resets(self._commands, frame.editor.put)
        self._finder = Finder(frame)

    def _register(self, opening: Opening) -> None:
        session, ask, tell = self._session, self._commands.ask_page, self._if
        kinds = self._frame.kinds
        names = [*tabs(kinds), *(kind.title for kind in kinds if kind.title and kind.always)]
        commands = [
            Command(UNDO, lambda _: tell(session.undo(), Text("Nothing to undo")), Text("Undo"), ("Ctrl+Z",)),
            Command(
                REDO,
                lambda _: tell(session.redo(), Text("Nothing to redo")),
                Text("Redo"),
                ("Ctrl+Shift+Z", "Ctrl+Y"),
            ),
            Command(
                RESET_ALL,
                lambda _: tell(session.reset(None), Text("Nothing has been changed")),
                Text("Reset all"),
            ),
            Command(SHARE, lambda _: self._share(), Text("Share: a link that opens this state")),
            Command(
                "share-view",
                lambda _: self._share("link-view"),
                Text("Share this view: a link that opens these tabs"),
            ),
            Command("share-embed", lambda _: self._share("embed")),
            Command("no-tab", self._tell_no_tab, watcher=True),
            Command("no-view", self._tell_no_view, watcher=True),
            Command(PRESENT, lambda _: self._present(), Text("Present: drive alone, others watch")),
            Command("run", lambda _: session.redo_run(), Text("Run again")),
            Command("stop", lambda _: session.cancel_run(), Text("Stop the run")),
            Command("keys", lambda _: ask("keys", ""), Text("Keys: what they do"), ("?",), watcher=True),
            Command("tab", lambda name: ask("tab", name), watcher=True),
            Command("reset-named", self._reset_named),
            Command(
                COPY_METHOD,
                lambda _: ask("copy", method_toml(session.scenario, session.selected)),
                Text("Copy the method as TOML"),
                watcher=True,
            ),
            Command(
                COPY_LOG,
                lambda _: ask("copy", disturbances_toml(session.scenario)),
                Text("Copy the log's events and outages as TOML"),
                watcher=True,
            ),
            Command(
                PASTE,
                self._paste,
                Text("Paste a method, or the log's events and outages (TOML)"),
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
                for name in dict.fromkeys(names)
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
        same = len(state) == len(self._state) and all(map(operator.is_, state, self._state))
        if same and values == self._values:
            return
        self._state, self._values = state, values
        self._resets.show(session.opened, session.scenario, controls)
        self._finder.show()
        changed = len(changed_fields(session.opened, session.scenario))
        control = None if self._watches else self._frame.editor.moved
        last = self._resets.of(control)
        last_edit = None if control is None or last is None else (last[0], control.spec.label, last[1])
        self._toolbar.show(history, session.origin, changed, last_edit, self._drives, self._watches)
        self._commands.rename(UNDO, _titled(Text("Undo"), history.undo_name))
        self._commands.rename(REDO, _titled(Text("Redo"), history.redo_name))
        self._commands.rename(RESET_ALL, Text("Reset all: back to {origin} as opened", origin=session.origin))

    def show_presenter(self) -> None:
        """Show who presents."""
        self._lock()
        self._toolbar.show_banner(self._banner, self._drives)
        self.show()

    # ------------------------------------------------------------ presenting

    @property
    def _drives(self) -> bool:
        return self._session.pages.presenter is self._page

    @property
    def _watches(self) -> bool:
        return self._session.pages.presenter not in (None, self._page)

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
            return Text("Another page presents: you watch")
        if not self._drives:
            return ""
        watching = self._session.open_pages - 1
        pages = (
            Text("no other page is open")
            if watching == 0
            else Text.plural("{watching} watch", "{watching} watches", count=not watching, watching=watching)
        )
        return Text("You present: {pages}", pages=pages)

    # ------------------------------------------------------------ one control, by its id (static/boxes.js)

    def _control(self, id: str) -> Control | None:
        return next((control for control in self._frame.controls() if id.strip() in control.ids), None)

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
        notices.tell(self._client, Text("Pasted"), [pasted.words], "info")

    def _if(self, done: bool, otherwise: str) -> None:
        if not done:
            notices.tell(self._client, otherwise, [], "info")

    def _share(self, what: str = "link") -> None:
        try:
            link = self._session.share()
        except OSError as error:
            why = f"{error.strerror or without_folders(str(error))}."
            notices.tell(self._client, Text("No link was made"), [why[:1].upper() + why[1:]], "warning")
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
        lines.append(Text("The tabs are: {titles}.", titles=Text.joined(", ", titles)))
        notices.tell(self._client, Text("Not all tabs of the address are here"), lines, "warning")

    def _tell_no_view(self, name: str) -> None:
        """Tell that the address names a view that the page does not have, or not now (static/alone.js)."""
        views = view_names(self._frame.kinds)
        if name in views:
            lines = [
                Text("The view {views} has nothing to show for this scenario.", views=views[name] or name)
            ]
            notices.tell(self._client, Text("Nothing to show"), lines, "warning")
            return
        lines = [
            Text("The address names the view {name!r}, which this page does not have.", name=name[:40]),
            Text("The views are: {views}.", views=Text.joined(", ", views)),
        ]
        notices.tell(self._client, Text("No such view"), lines, "warning")

    def _present(self) -> None:
        if not self._session.present(None if self._drives else self._page):
            notices.tell(self._client, Text("Another page presents"), [Text("It must end first.")], "warning")


@lru_cache(maxsize=1)
def _preset_titles() -> tuple[tuple[str, str], ...]:
    return tuple((name, load(name).title) for name in presets())


def _titled(what: str, name: str | None) -> str:
    if name is None:
        return what
    short = name if len(name) <= _LONGEST_UNDO else f"{name[: _LONGEST_UNDO - 1]}…"
    return Text("{what} {name}", what=what, name=short)

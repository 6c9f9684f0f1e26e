"""The commands that every page has, and the row of buttons that stands for some of them."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import lru_cache
from typing import TYPE_CHECKING

from app.editing.actions import Actions
from app.editing.editor import Editor
from app.editing.reset import Resets
from app.page import notices
from app.page.commands import Commands
from app.page.presenter import PresenterLock
from app.panels.control import Control
from app.panels.files import METRICS, SCENARIO
from app.panels.method import ADD, COPY, REMOVE
from app.panels.toolbar import PRESENT, REDO, RESET_ALL, SHARE, UNDO, Toolbar
from app.session.history import changed_fields
from app.session.session import Session
from navcore.scenario_file import load, presets

if TYPE_CHECKING:
    import viser

_LONGEST_UNDO = 48


class Palette:
    """Registers the commands and keeps their titles, the buttons and the banner up to date.

    Parameters
    ----------
    client : viser.ClientHandle
        The browser.
    session : Session
        Whose work it is.
    commands : Commands
        Of the page.
    actions : Actions
        What has no control of its own.
    editor : Editor
        Knows the control in hand.
    lock : PresenterLock
        Of the page.
    controls : callable
        Gives all controls of the page.
    """

    def __init__(
        self,
        client: viser.ClientHandle,
        session: Session,
        commands: Commands,
        actions: Actions,
        editor: Editor,
        lock: PresenterLock,
        controls: Callable[[], Iterable[Control]],
    ) -> None:
        self._client, self._session, self._commands = client, session, commands
        self._actions, self._editor, self._lock, self._controls = actions, editor, lock, controls
        self._toolbar = Toolbar(client.gui, order=5)
        self._register()
        self._resets = Resets(commands, editor.put)

    def _register(self) -> None:
        add, session, actions = self._commands.register, self._session, self._actions
        add(UNDO, lambda _: self._if(session.undo(), "Nothing to undo"), "Undo", "Ctrl+Z")
        add(REDO, lambda _: self._if(session.redo(), "Nothing to redo"), "Redo", ("Ctrl+Shift+Z", "Ctrl+Y"))
        add(RESET_ALL, lambda _: self._if(session.reset(None), "Nothing has been changed"), "Reset all")
        add(SHARE, lambda _: self._share(), "Share: a link that opens this state")
        add("save", lambda _: actions.give_file(SCENARIO), "Save the scenario (TOML)", "Ctrl+S")
        add("save-numbers", lambda _: actions.give_file(METRICS), "Save the numbers (JSON)")
        add(
            "open",
            lambda _: self._commands.ask_page("upload", ""),
            "Open a scenario or a recording",
            "Ctrl+O",
        )
        add(PRESENT, lambda _: self._present(), "Present: drive alone, others watch")
        add("run", lambda _: session.redo_run(), "Run again")
        add("stop", lambda _: session.cancel_run(), "Stop the run")
        add("verify", lambda _: actions.verify(), "Verify with the strapdown")
        add("method-add", lambda _: actions.arrange_methods(ADD), "Add a method")
        add("method-copy", lambda _: actions.arrange_methods(COPY), "Copy the method")
        add("method-remove", lambda _: actions.arrange_methods(REMOVE), "Remove the method")
        keys = "Keys: what they do"
        add("keys", lambda _: self._commands.ask_page("keys", ""), keys, "?", watcher=True)
        add("tab", lambda name: self._commands.ask_page("tab", name), watcher=True)
        for name, title in _preset_titles():
            add(f"preset-{name}", lambda _, name=name: actions.choose_scenario(name), f"Open {name}: {title}")

    def offer_tabs(self, names: Iterable[str]) -> None:
        """Let each of these tabs be brought to the front by a command."""
        for name in names:
            slug = "".join(letter for letter in name.lower() if letter.isalnum())
            self._commands.register(
                f"tab-{slug}",
                lambda _, name=name: self._commands.ask_page("tab", name),
                f"Show {name}",
                watcher=True,
            )

    # ------------------------------------------------------------ showing

    def show(self) -> None:
        """Show what can be undone and reset now."""
        session, history = self._session, self._session.history
        self._resets.show(session.opened, session.scenario, self._controls())
        changed = len(changed_fields(session.opened, session.scenario))
        self._toolbar.show(history, session.origin, changed, self._lock.drives, self._lock.watches)
        control = None if self._lock.watches else self._editor.moved
        last = self._resets.of(control)
        found = None if control is None or last is None else (last[0], control.spec.label, last[1])
        self._toolbar.show_changed(session.origin, changed, found)
        self._commands.rename(UNDO, _titled("Undo", history.undo_name))
        self._commands.rename(REDO, _titled("Redo", history.redo_name))
        self._commands.rename(RESET_ALL, f"Reset all: back to {session.origin} as opened")
        self._lock.apply()

    def show_presenter(self) -> None:
        """Show who presents."""
        self._lock.apply()
        self._toolbar.show_banner(self._lock.banner, self._lock.drives)
        self.show()

    # ------------------------------------------------------------ doing

    def _if(self, done: bool, otherwise: str) -> None:
        if not done:
            notices.tell(self._client, otherwise, [], "info")

    def _share(self) -> None:
        self._commands.ask_page("link", self._session.share())

    def _present(self) -> None:
        if not self._lock.toggle():
            notices.tell(self._client, "Another page presents", ["It must end first."], "warning")


@lru_cache(maxsize=1)
def _preset_titles() -> tuple[tuple[str, str], ...]:
    return tuple((name, load(name).title) for name in presets())


def _titled(what: str, name: str | None) -> str:
    if name is None:
        return what
    return f"{what} {name}" if len(name) <= _LONGEST_UNDO else f"{what} {name[: _LONGEST_UNDO - 1]}…"

"""Commands of a page by name: one list for scripts, keys, buttons in our HTML and the palette.

viser has no event for a key, a click in a plot or a click in HTML, and of a control's values its page sends
the newest only: static/commands.js writes what it asks for, with a running number, into one hidden control,
and repeats what has not been heard.
"""

from __future__ import annotations

import json
import logging
import re
import threading
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from html import escape
from typing import TYPE_CHECKING, Any

import msgspec

from schuler_bench.bridge.controls import id_of

if TYPE_CHECKING:
    import viser

PAGE_COMMAND = "page command"
"""Label of the control through which the page asks (static/commands.js)."""
LONGEST_ARGUMENT = 2000
"""Characters of an argument, where a command does not allow more."""
LONGEST_TEXT = 9000
"""Characters of any argument: with its line ends written as two it fits into the hidden control."""
MOST_AT_ONCE = 50
_MOST_LOGGED = 20
_NAME = re.compile(r"[a-z][a-z0-9-]{0,79}")
_log = logging.getLogger("schuler.commands")

Act = Callable[[str], None]
"""``act(argument)``: the text after the command's name, "" for none. Hostile input: check before use."""


@dataclass(frozen=True)
class Command:
    """Something a page can be asked for.

    Attributes
    ----------
    name : str
        Lower-case letters, digits and hyphens.
    act : callable
        Does it.
    title : str
        In the palette and in the list of keys; "": not shown there.
    keys : tuple of str
        Such as "Ctrl+Z", "Space", "B", "?"; none of them acts while the user types in a text box.
    watcher : bool
        Also for a page that only watches a presenter: it changes nothing that others see.
    longest : int
        Characters that the argument may have: `LONGEST_TEXT` at most.
    """

    name: str
    act: Act
    title: str = ""
    keys: tuple[str, ...] = ()
    watcher: bool = False
    longest: int = LONGEST_ARGUMENT


class Commands:
    """The commands of one page.

    Parameters
    ----------
    gui : viser.GuiApi
        Of the client.
    failed : callable
        ``failed(error)``: a command could not be carried out.
    """

    def __init__(self, gui: viser.GuiApi, failed: Callable[[Exception], None]) -> None:
        self._gui, self._failed = gui, failed
        self._lock = threading.RLock()
        # Not the same: a command may wait for a session whose holder shows a title here.
        self._one_by_one = threading.Lock()
        self._by_name: dict[str, Command] = {}
        self._titles: dict[str, str] = {}
        self._entries: dict[str, viser.CommandHandle] = {}
        self._done, self._logged = 0, 0
        self._open = self._closed = False
        self.watching = False
        """Only the commands for watchers are carried out."""
        self._box = gui.add_text(PAGE_COMMAND, "", order=1)
        self._box.on_update(lambda _: self.take(self._box.value))
        self.box_id = id_of(self._box)
        """Of the hidden control, in viser and in the page."""
        self._heard = gui.add_html("", order=3)
        self._keys = gui.add_html("", order=3)
        self._asks = gui.add_html("", order=3)
        self._asked: list[tuple[int, str, str]] = []

    def register(
        self,
        name: str,
        act: Act,
        title: str = "",
        keys: Sequence[str] | str = (),
        *,
        watcher: bool = False,
        longest: int = LONGEST_ARGUMENT,
    ) -> None:
        """Add a command, or replace the one of that name.

        Parameters
        ----------
        name, act, title, keys, watcher, longest
            See `Command`; one key may be given as it is.

        Raises
        ------
        ValueError
            The name is malformed, or another command has one of the keys.
        """
        if _NAME.fullmatch(name) is None:
            raise ValueError(f"{name!r} is no name of a command")
        keys = (keys,) if isinstance(keys, str) else tuple(keys)
        with self._lock:
            for other in self._by_name.values():
                if other.name != name and {as_pressed(k) for k in keys} & {as_pressed(k) for k in other.keys}:
                    raise ValueError(f"{other.name} and {name} have the same key")
            self._by_name[name] = Command(name, act, title, keys, watcher, longest)
            if self._open:
                self._show_entry(name)
                self._show_keys()

    def rename(self, name: str, title: str) -> None:
        """Say in the palette what a command would do now; the list of keys keeps its title."""
        with self._lock:
            if self._titles.get(name) != title:
                self._titles[name] = title
                if self._open:
                    self._show_entry(name)

    def remove(self, name: str) -> None:
        """Take a command away, if there is one of that name."""
        with self._lock:
            self._by_name.pop(name, None)
            self._titles.pop(name, None)
            entry = self._entries.pop(name, None)
            if entry is not None:
                entry.remove()

    # ------------------------------------------------------------ on the page

    def show(self) -> None:
        """Put the palette and the keys on the page; what is registered later follows by itself."""
        with self._lock:
            self._open = True
            for name in self._by_name:
                self._show_entry(name)
            self._show_keys()

    def ask_page(self, what: str, text: str) -> None:
        """Let the page's script do what the server cannot.

        Parameters
        ----------
        what : str
            "tab": bring the tab of that name to the front; "field": the same, and the focus to the control
            of that id, both as JSON; "link": show a link to another session; "keys":
            list the keys; "upload": let the user choose a file; "front": bring the tabs of these names,
            parted by "|", to the front without giving them the focus; "front-again": the same, but for
            what the user has chosen since the page last told of its tabs; "copy", "copy-latex",
            "copy-plain": put a text on the clipboard that is TOML, LaTeX, plain; "paste": ask for a text
            (static/paste.js). A view's script may add more
            (``schuler.act``).
        text : str
            What it is about.
        """
        with self._lock:
            # A page that comes back after a break has its own memory of what it was asked: numbers only grow.
            number = max(time.time_ns() // 1_000_000, self._asked[-1][0] + 1 if self._asked else 0)
            self._asked = [*self._asked[-4:], (number, what, text)]
            content = escape(json.dumps(self._asked))
            self._asks.content = f'<div id="sb-asked" hidden data-asked="{content}"></div>'

    def close(self) -> None:
        """Carry nothing out any more."""
        self._closed = True

    def _show_entry(self, name: str) -> None:
        command, entry = self._by_name[name], self._entries.get(name)
        title = self._titles.get(name, command.title)
        if not title:
            return
        if entry is None:
            entry = self._gui.add_command(title, description=" / ".join(command.keys) or None)
            entry.on_trigger(lambda _: self.run(name))
            self._entries[name] = entry
        elif entry.label != title:
            entry.label = title

    def _show_keys(self) -> None:
        named = [(key, command) for command in self._by_name.values() for key in command.keys]
        pressed = json.dumps({as_pressed(key): command.name for key, command in named})
        labels = json.dumps(
            [[" / ".join(c.keys), c.title] for c in self._by_name.values() if c.keys and c.title]
        )
        self._keys.content = (
            f'<div id="sb-commands" hidden data-keys="{escape(pressed)}" data-told="{escape(labels)}"></div>'
        )

    # ------------------------------------------------------------ carrying out

    def take(self, text: str) -> None:
        """Carry out what the hidden control holds and has not been carried out yet, in order."""
        with self._one_by_one:
            before = self._done
            for number, name, argument in read_commands(text):
                if number > self._done:
                    self._done = number
                    self.run(name, argument)
            if self._done != before and not self._closed:
                self._heard.content = f'<div id="sb-told" hidden data-count="{self._done}"></div>'

    def run(self, name: str, argument: str = "") -> None:
        """Carry out one command; an unknown one is ignored, a fault is shown to the user."""
        command = self._by_name.get(name)
        if command is None:
            self._logged += 1
            if self._logged <= _MOST_LOGGED:
                _log.warning("a page asked for the unknown command %.60r", name)
            return
        if self._closed or (self.watching and not command.watcher) or len(argument) > command.longest:
            return
        try:
            command.act(argument)
        except Exception as error:
            self._failed(error)


def as_pressed(key: str) -> str:
    """Write a key as the page's script compares it.

    Examples
    --------
    >>> as_pressed("Ctrl+Shift+Z"), as_pressed("Space"), as_pressed("?")
    ('ctrl+shift+z', 'space', '?')
    """
    return key.lower()


def read_commands(text: str) -> list[tuple[int, str, str]]:
    """Numbers, names and arguments that the hidden control holds; nothing for anything else.

    Examples
    --------
    >>> read_commands('[[3,"undo",""],[4,"place","0.5 1"]]')
    [(3, 'undo', ''), (4, 'place', '0.5 1')]
    >>> read_commands("[[1]]"), read_commands('[[-1,"undo",""]]')
    ([], [])
    """
    try:
        calls: Any = msgspec.json.decode(text, type=list[tuple[int, str, str]])
    except (msgspec.MsgspecError, UnicodeError, RecursionError):
        return []
    fitting = [
        (number, name, argument)
        for number, name, argument in calls[:MOST_AT_ONCE]
        if 0 < number < 10**9 and len(argument) <= LONGEST_TEXT
    ]
    return sorted(fitting)

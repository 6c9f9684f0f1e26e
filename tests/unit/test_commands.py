"""Commands of a page: what its hidden control may hold, and what is done with it."""

from __future__ import annotations

import json
import logging
from types import SimpleNamespace
from typing import Any

import pytest

from app.shell.commands import LONGEST_ARGUMENT, LONGEST_TEXT, MOST_AT_ONCE, Commands, read_commands


class Gui:
    """What `Commands` needs of viser's."""

    def __init__(self) -> None:
        self.entries: list[Any] = []
        self.changed: Any = None

    def add_text(self, label: str, value: str, order: float) -> Any:
        self.box = SimpleNamespace(
            value=value, _impl=SimpleNamespace(uuid="id"), on_update=lambda act: setattr(self, "changed", act)
        )
        return self.box

    def add_html(self, content: str, order: float) -> Any:
        return SimpleNamespace(content=content)

    def add_command(self, label: str, description: str | None) -> Any:
        entry = SimpleNamespace(label=label, description=description, removed=False)
        entry.on_trigger = lambda act: setattr(entry, "act", act)
        entry.remove = lambda: setattr(entry, "removed", True)
        self.entries.append(entry)
        return entry

    def ask(self, *asked: Any) -> None:
        self.box.value = json.dumps(asked)
        self.changed(None)


@pytest.fixture
def gui() -> Gui:
    return Gui()


@pytest.fixture
def failed() -> list[Exception]:
    return []


@pytest.fixture
def commands(gui: Gui, failed: list[Exception]) -> Commands:
    return Commands(gui, failed.append)


def test_commands_are_carried_out_once_and_in_order(commands: Commands, gui: Gui) -> None:
    done: list[str] = []
    commands.register("one", lambda text: done.append(f"one({text})"))
    commands.register("two", lambda text: done.append(f"two({text})"))
    gui.ask([1, "one", "a b"])
    gui.ask([2, "two", ""], [1, "one", "a b"], [3, "one", ""])
    gui.ask([3, "one", ""])
    assert done == ["one(a b)", "two()", "one()"]
    assert 'data-count="3"' in commands._heard.content


def test_only_a_command_that_takes_a_long_text_is_given_one(commands: Commands, gui: Gui) -> None:
    done: list[str] = []
    commands.register("short", lambda text: done.append(f"short {len(text)}"))
    commands.register("long", lambda text: done.append(f"long {len(text)}"), longest=LONGEST_TEXT)
    long = "x" * (LONGEST_ARGUMENT + 1)
    gui.ask([1, "short", long], [2, "long", long], [3, "short", long[1:]])
    assert done == [f"long {len(long)}", f"short {LONGEST_ARGUMENT}"]
    assert 'data-count="3"' in commands._heard.content


def test_an_unknown_command_is_ignored_with_a_log_line(
    commands: Commands, gui: Gui, caplog: pytest.LogCaptureFixture, failed: list[Exception]
) -> None:
    with caplog.at_level(logging.WARNING, "schuler.commands"):
        gui.ask([1, "rm" * 500, "x"])
        assert "unknown command" in caplog.text
        assert len(caplog.records[0].getMessage()) < 120
        for number in range(2, 200):
            gui.ask([number, "nothing", ""])
    assert len(caplog.records) <= 20
    assert failed == []


def test_a_fault_is_told_and_the_next_command_is_carried_out(
    commands: Commands, gui: Gui, failed: list[Exception]
) -> None:
    done: list[str] = []
    commands.register("bad", lambda _: 1 / 0)
    commands.register("good", done.append)
    gui.ask([1, "bad", ""], [2, "good", "x"])
    assert done == ["x"]
    assert [type(error) for error in failed] == [ZeroDivisionError]


@pytest.mark.parametrize(
    "text",
    [
        "",
        "undo",
        "[",
        "{}",
        '[["1","undo",""]]',
        '[[1,"undo"]]',
        '[[1.5,"undo",""]]',
        '[[true,"undo",""]]',
        '[[0,"undo",""]]',
        '[[1000000000,"undo",""]]',
        '[[1,"undo",null]]',
        "[" * 10_000,
        json.dumps([[1, "undo", "x" * (LONGEST_TEXT + 1)]]),
    ],
)
def test_anything_else_is_nothing(text: str) -> None:
    assert read_commands(text) == []


def test_only_so_many_at_once() -> None:
    assert len(read_commands(json.dumps([[n, "a", ""] for n in range(1, 500)]))) == MOST_AT_ONCE


def test_palette_and_keys_are_the_registered_ones(commands: Commands, gui: Gui) -> None:
    done: list[str] = []
    commands.register("undo", lambda _: done.append("undo"), "Undo", "Ctrl+Z")
    commands.register("place", lambda _: None)
    assert gui.entries == []
    commands.show()
    commands.register("redo", lambda _: None, "Redo", ("Ctrl+Y", "Ctrl+Shift+Z"))
    labels = [(entry.label, entry.description) for entry in gui.entries]
    assert labels == [("Undo", "Ctrl+Z"), ("Redo", "Ctrl+Y or Ctrl+Shift+Z")]
    assert "ctrl+shift+z&quot;: &quot;redo" in commands._keys.content
    gui.entries[0].act(None)
    assert done == ["undo"]
    commands.rename("undo", "Undo xi: 1 → 2")
    assert gui.entries[0].label == "Undo xi: 1 → 2"
    commands.remove("redo")
    assert gui.entries[1].removed


def test_a_watcher_may_only_what_is_for_watchers(commands: Commands, gui: Gui) -> None:
    done: list[str] = []
    commands.register("undo", lambda _: done.append("undo"), "Undo")
    commands.register("keys", lambda _: done.append("keys"), "Keys", watcher=True)
    commands.show()
    commands.watching = True
    gui.ask([1, "undo", ""], [2, "keys", ""])
    gui.entries[0].act(None)
    assert done == ["keys"]
    commands.watching = False
    gui.entries[0].act(None)
    assert done == ["keys", "undo"]


@pytest.mark.parametrize("name", ["", "Undo", "a b", "1", "x" * 81])
def test_a_malformed_name_is_refused(commands: Commands, name: str) -> None:
    with pytest.raises(ValueError, match="no name"):
        commands.register(name, print)


def test_two_commands_cannot_have_the_same_key(commands: Commands) -> None:
    commands.register("undo", print, "Undo", "Ctrl+Z")
    commands.register("undo", print, "Undo", "Ctrl+Z")
    with pytest.raises(ValueError, match="same key"):
        commands.register("other", print, "Other", ("A", "ctrl+z"))

"""Commands of a page: what its hidden control may hold, and what is done with it."""

import json
import logging
from types import SimpleNamespace
from typing import Any

import pytest

from schuler_bench.shell.commands import LONGEST_ARGUMENT, LONGEST_TEXT, MOST_AT_ONCE, Commands, read_commands


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


@pytest.fixture
def done(commands: Commands) -> list[tuple[str, str]]:
    """What the registered commands were asked to do, in order."""
    done: list[tuple[str, str]] = []
    for name, more in {
        "place": {},
        "undo": {"title": "Undo", "keys": "Ctrl+Z"},
        "redo": {"title": "Redo", "keys": ("Ctrl+Y", "Ctrl+Shift+Z")},
        "keys": {"title": "Keys", "watcher": True},
        "long": {"longest": LONGEST_TEXT},
    }.items():
        commands.register(name, lambda text, name=name: done.append((name, text)), **more)
    return done


LONG, MOST = "x" * (LONGEST_ARGUMENT + 1), "x" * LONGEST_ARGUMENT


@pytest.mark.parametrize(
    ("asked", "expected", "count"),
    [
        ([[[1, "place", "a b"]]], [("place", "a b")], 1),
        ([[[2, "undo", ""], [1, "place", ""], [3, "place", ""]], [[3, "place", ""]]],
         [("place", ""), ("undo", ""), ("place", "")], 3),
        ([[[1, "place", LONG], [2, "long", LONG], [3, "place", MOST]]], [("long", LONG), ("place", MOST)], 3),
    ],
    ids=["asked", "in order and once", "only a command that takes a long text is given one"],
)  # fmt: skip
def test_commands_are_carried_out(
    commands: Commands,
    gui: Gui,
    done: list[tuple[str, str]],
    asked: list[list[Any]],
    expected: list[tuple[str, str]],
    count: int,
) -> None:
    for together in asked:
        gui.ask(*together)
    assert done == expected and f'data-count="{count}"' in commands._heard.content


def test_an_unknown_command_is_ignored_with_a_log_line(
    commands: Commands, gui: Gui, caplog: pytest.LogCaptureFixture, failed: list[Exception]
) -> None:
    with caplog.at_level(logging.WARNING, "schuler.commands"):
        for number in range(1, 200):
            gui.ask([number, "rm" * 500, "x"])
    assert "unknown command" in caplog.messages[0] and len(caplog.messages[0]) < 120
    assert len(caplog.messages) <= 20 and failed == []


def test_a_fault_is_told_and_the_next_command_is_carried_out(
    commands: Commands, gui: Gui, failed: list[Exception], done: list[tuple[str, str]]
) -> None:
    commands.register("bad", lambda _: 1 / 0)
    gui.ask([1, "bad", ""], [2, "place", "x"])
    assert done == [("place", "x")] and list(map(type, failed)) == [ZeroDivisionError]


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


def test_palette_and_keys_are_the_registered_ones(
    commands: Commands, gui: Gui, done: list[tuple[str, str]]
) -> None:
    assert gui.entries == []
    commands.show()
    undo, redo, keys = gui.entries
    told = [(entry.label, entry.description) for entry in gui.entries]
    assert told == [("Undo", "Ctrl+Z"), ("Redo", "Ctrl+Y / Ctrl+Shift+Z"), ("Keys", None)]
    assert "ctrl+shift+z&quot;: &quot;redo" in commands._keys.content
    undo.act(None)
    commands.rename("undo", "Undo xi: 1 → 2")
    commands.remove("redo")
    assert (undo.label, redo.removed) == ("Undo xi: 1 → 2", True)
    commands.watching = True  # only what is for watchers
    gui.ask([1, "undo", ""], [2, "keys", ""])
    undo.act(None)
    commands.watching = False
    undo.act(None)
    assert [name for name, _ in done] == ["undo", "keys", "undo"]


@pytest.mark.parametrize("name", ["", "Undo", "a b", "1", "x" * 81])
def test_a_malformed_name_is_refused(commands: Commands, name: str) -> None:
    with pytest.raises(ValueError, match="no name"):
        commands.register(name, print)


def test_two_commands_cannot_have_the_same_key(commands: Commands) -> None:
    for _ in range(2):
        commands.register("undo", print, "Undo", "Ctrl+Z")
    with pytest.raises(ValueError, match="same key"):
        commands.register("other", print, "Other", ("A", "ctrl+z"))

"""A look of the whole page that is on or off: its switch, its key, and the style that the page gets."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import ClassVar

from app.session.display import Display
from app.shell.view import Frame, if_user


class Look(ABC):
    """Switch, key and style of one choice of `app.session.display.Display` with two values.

    Parameters
    ----------
    frame : Frame
        Of the page.
    """

    label: ClassVar[str]
    """Of the switch."""
    hint: ClassVar[str]
    """What it is for, with the key."""
    order: ClassVar[int]
    """Place of the switch in its container."""
    command: ClassVar[tuple[str, str, str]]
    """Name of the command that turns it over, its title, and its key."""
    field: ClassVar[str]
    """Field of the display that holds the choice."""
    values: ClassVar[tuple[str, str]]
    """Its values: off, on."""

    def __init__(self, frame: Frame) -> None:
        self._frame = frame
        # Outside all tabs: what stands in a tab is on the page only while the tab is in front.
        self._style = frame.gui.add_html("", order=4)
        name, title, key = self.command
        frame.commands.register(name, lambda _: self._choose(not self.on(frame.session.display)), title, key)

    def build(self) -> None:
        """Make the switch, in the present container."""
        self._switch = self._frame.gui.add_checkbox(self.label, False, hint=self.hint, order=self.order)
        self._switch.on_update(if_user(lambda: self._choose(self._switch.value)))

    def show(self, display: Display) -> None:
        """Give the page the look that the display asks for."""
        content = self.style(display)
        if self._style.content != content:
            self._style.content = content
        self._switch.value = self.on(display)

    def on(self, display: Display) -> bool:
        """Whether the display asks for it."""
        return getattr(display, self.field) == self.values[1]

    @abstractmethod
    def style(self, display: Display) -> str:
        """HTML that gives the page its look."""

    def _choose(self, on: bool) -> None:
        self._frame.show(**{self.field: self.values[on]})

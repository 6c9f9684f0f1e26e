"""A viser widget, and what the server must know of it so as not to overwrite what a user gives."""

from __future__ import annotations

from typing import Any


class Widget:
    """A viser widget, and the value in it that has been dealt with.

    viser stores what a browser sends before it calls back, and calls back concurrently: a value other than
    the known one belongs to an event that is still to come, and must not be overwritten by an older one.
    """

    def __init__(self, handle: Any) -> None:
        self.handle = handle
        self.known = handle.value

    def take(self) -> Any:
        """Value the user has given; it counts as dealt with."""
        self.known = self.handle.value
        return self.known

    @property
    def awaited(self) -> bool:
        """Whether the user has given another value that is still to be dealt with."""
        return self.handle.value != self.known

    def show(self, value: Any) -> None:
        """Show a value, unless the user has just given another one."""
        if not self.awaited:
            self.handle.value = value
            self.known = self.handle.value

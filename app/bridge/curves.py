"""A page is not sent again those curves of its plots over time that it has.

A slider changes one of several methods, but viser sends a plot whole: the time and the curves of all methods.
Here a curve that the page has is left out, and `curves.js` puts the page's own one in its place.

What is left out is decided when a message is taken from the page's queue, not when it is put into it. In the
queue a plot's newer numbers replace those that have not been sent yet, so a message shortened there could
refer to curves that the page never gets. What is taken from the queue is sent next, over one connection,
which keeps the order. When the connection is lost, the page that comes back is another client with a queue of
its own, and is sent all plots whole.
"""

from __future__ import annotations

import dataclasses
from collections.abc import AsyncGenerator, Sequence
from pathlib import Path

import numpy as np
from viser import _messages as messages
from viser.infra import Message

CURVES_SCRIPT = Path(__file__).parent / "curves.js"
"""Script for the page that puts in what `Curves.shortened` leaves out."""


class Curves:
    """The curves that one connection has been sent."""

    def __init__(self) -> None:
        self._sent: dict[str, tuple[np.ndarray, ...]] = {}

    def shortened(self, message: Message) -> Message:
        """Return a message as it is to be sent now: None in the place of each curve that the page has.

        The message itself stays as it is.
        """
        if isinstance(message, messages.GuiUplotMessage):
            # The handle and its message share these, and the handle goes on changing them.
            props = dataclasses.replace(message.props)
            self._sent[message.uuid] = props.data
            return dataclasses.replace(message, props=props)
        if isinstance(message, messages.GuiRemoveMessage):
            self._sent.pop(message.uuid, None)
        elif isinstance(message, messages.GuiUpdateMessage) and "data" in message.updates:
            had, data = self._sent.get(message.uuid), message.updates["data"]
            if had is not None:
                self._sent[message.uuid] = data
                if len(had) == len(data):
                    curves = tuple(
                        None if same_numbers(*pair) else pair[1] for pair in zip(had, data, strict=True)
                    )
                    return dataclasses.replace(message, updates={**message.updates, "data": curves})
        return message


async def shortened(
    windows: AsyncGenerator[Sequence[Message], None],
) -> AsyncGenerator[Sequence[Message], None]:
    """Shorten the messages that are taken from one page's queue (`AsyncMessageBuffer.window_generator`)."""
    curves = Curves()
    try:
        async for window in windows:
            yield [curves.shortened(message) for message in window]
    finally:
        await windows.aclose()


def same_numbers(one: np.ndarray, other: np.ndarray) -> bool:
    """Whether two curves are equal, NaN counted as equal to NaN."""
    return one is other or np.array_equal(one, other, equal_nan=True)

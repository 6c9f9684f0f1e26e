"""A page is sent a curve only when it does not have it, and always has all of them."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncGenerator, Sequence
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from viser import _messages as messages

from app.bridge.mends import MendedBuffer

Data = tuple[np.ndarray, ...]


def plot(data: Data, uuid: str = "plot") -> messages.GuiUplotMessage:
    names = messages.GuiUplotProps.__dataclass_fields__
    props: Any = messages.GuiUplotProps(**dict.fromkeys(names) | {"data": data})
    return messages.GuiUplotMessage(uuid, "root", props)


def numbers(data: Data, uuid: str = "plot") -> messages.GuiUpdateMessage:
    return messages.GuiUpdateMessage(uuid, {"data": data})


def curve(number: float) -> np.ndarray:
    return np.array([number, np.nan, 2.0], dtype=np.float32)


class Queue:
    """A page's queue, and the page at its end."""

    def __init__(self, persistent: bool = False) -> None:
        self.loop = asyncio.new_event_loop()
        self.buffer = MendedBuffer(self.loop, persistent_messages=persistent)
        self.windows = self.connect(0)

    def connect(self, client: int) -> AsyncGenerator[Sequence[Any], None]:
        return self.buffer.window_generator(client)

    def sent(self, windows: AsyncGenerator[Sequence[Any], None] | None = None) -> list[Any]:
        """All that waits."""
        first = asyncio.wait_for(anext(windows or self.windows), 5.0)
        return list(self.loop.run_until_complete(first))

    def close(self) -> None:
        self.loop.run_until_complete(self.windows.aclose())
        self.loop.run_until_complete(asyncio.sleep(0.0))  # the last task is cancelled
        self.loop.close()


@pytest.fixture
def queue() -> Any:
    made = Queue()
    yield made
    made.close()


def test_only_the_curve_that_has_changed_is_sent(queue: Queue) -> None:
    first = curve(0.0), curve(1.0), curve(2.0)
    queue.buffer.push(plot(first))
    (made,) = queue.sent()
    assert made.props.data == first
    message = numbers((curve(0.0), curve(1.5), curve(2.0)))
    queue.buffer.push(message)
    (update,) = queue.sent()
    time, changed, other = update.updates["data"]
    assert time is None and other is None and changed[0] == 1.5
    assert all(values is not None for values in message.updates["data"]), "viser's handles hold this message"


def test_what_is_noted_of_a_new_plot_is_what_is_sent(queue: Queue) -> None:
    message = plot((curve(0.0), curve(1.0)))
    queue.buffer.push(message)
    (made,) = queue.sent()
    message.props.data = curve(0.0), curve(3.0)  # as viser's handle does, in another thread
    assert made.props.data[1][0] == 1.0
    queue.buffer.push(numbers(message.props.data))
    (update,) = queue.sent()
    assert update.updates["data"][1][0] == 3.0


def test_a_connection_is_told_nothing_of_what_another_one_has(queue: Queue) -> None:
    data = curve(0.0), curve(1.0)
    queue.buffer.push(plot(data))
    queue.sent()
    again = Queue()
    again.buffer.push(plot(data))
    assert again.sent()[0].props.data == data
    again.close()


def test_messages_for_all_pages_stay_whole() -> None:
    shared = Queue(persistent=True)
    shared.buffer.push(plot((curve(0.0), curve(1.0))))
    shared.sent()
    shared.buffer.push(numbers((curve(0.0), curve(2.0))))
    (update,) = shared.sent()
    assert all(values is not None for values in update.updates["data"])
    late = shared.connect(1)
    assert all(values is not None for values in shared.sent(late)[-1].updates["data"])
    shared.loop.run_until_complete(late.aclose())
    shared.close()


class Shown:
    """What `curves.js` does."""

    def __init__(self) -> None:
        self.data: dict[str, list[np.ndarray]] = {}

    def take(self, message: Any) -> None:
        if isinstance(message, messages.GuiUplotMessage):
            self.data[message.uuid] = list(message.props.data)
        elif isinstance(message, messages.GuiRemoveMessage):
            self.data.pop(message.uuid, None)
        else:
            had = self.data[message.uuid]
            data = message.updates["data"]
            self.data[message.uuid] = [had[i] if new is None else new for i, new in enumerate(data)]


_STEPS = st.lists(
    st.one_of(
        st.tuples(st.sampled_from("ab"), st.lists(st.integers(0, 2), min_size=2, max_size=4)),
        st.tuples(st.sampled_from("ab"), st.none()),
        st.just("send"),
    ),
    max_size=30,
)


@given(_STEPS)
def test_the_page_has_at_each_time_what_the_server_has_sent(steps: list[Any]) -> None:
    queue = Queue()
    try:
        _take_steps(queue, steps)
    finally:
        queue.close()


def _take_steps(queue: Queue, steps: list[Any]) -> None:
    page = Shown()
    held: dict[str, Data] = {}
    waits = False
    for step in [*steps, "send"]:
        if step == "send":
            for message in queue.sent() if waits else ():
                page.take(message)
            waits = False
            assert page.data.keys() == held.keys()
            for uuid, data in held.items():
                np.testing.assert_equal(page.data[uuid], list(data))
            continue
        uuid, values = step
        if values is None and uuid not in held:
            continue
        waits = True
        if values is None:
            del held[uuid]
            queue.buffer.push(messages.GuiRemoveMessage(uuid))
            continue
        data = tuple(curve(float(value)) for value in values)
        queue.buffer.push(numbers(data, uuid) if uuid in held else plot(data, uuid))
        held[uuid] = data

"""A page is sent a curve only when it does not have it, and always has all of them."""

import asyncio
from collections.abc import AsyncGenerator, Iterator, Sequence
from contextlib import closing
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from viser import _messages as messages

from schuler_bench.bridge.mends import MendedBuffer

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
def queue() -> Iterator[Queue]:
    with closing(Queue()) as queue:
        yield queue


def test_only_the_curve_that_has_changed_is_sent(queue: Queue) -> None:
    message = plot((curve(0.0), curve(1.0), curve(2.0)))
    queue.buffer.push(message)
    (whole,) = queue.sent()
    message.props.data = curve(0.0), curve(1.5), curve(2.0)  # as viser's handle does, in another thread
    assert [values[0] for values in whole.props.data] == [0.0, 1.0, 2.0]
    change = numbers(message.props.data)
    queue.buffer.push(change)
    (update,) = queue.sent()
    time, changed, other = update.updates["data"]
    assert time is other is None and changed[0] == 1.5
    assert all(values is not None for values in change.updates["data"]), "viser's handles hold this message"


def test_messages_for_all_pages_stay_whole() -> None:
    shared = Queue(persistent=True)
    for message in (plot((curve(0.0), curve(1.0))), numbers((curve(0.0), curve(2.0)))):
        shared.buffer.push(message)
        assert all(values is not None for values in data_of(shared.sent()[-1]))
    late = shared.connect(1)
    assert all(values is not None for values in data_of(shared.sent(late)[-1]))
    shared.loop.run_until_complete(late.aclose())
    shared.close()


def data_of(message: Any) -> Sequence[np.ndarray | None]:
    return message.props.data if isinstance(message, messages.GuiUplotMessage) else message.updates["data"]


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
    """The page puts its own curve in the place of one that was left out, as `curves.js` does."""
    with closing(Queue()) as queue:
        page: dict[str, list[np.ndarray]] = {}
        held: dict[str, Data] = {}
        waits = False
        for step in [*steps, "send"]:
            if step == "send":
                for message in queue.sent() if waits else ():
                    had = page.pop(message.uuid, [])
                    if not isinstance(message, messages.GuiRemoveMessage):
                        data = enumerate(data_of(message))
                        page[message.uuid] = [had[i] if new is None else new for i, new in data]
                waits = False
                np.testing.assert_equal(page, {uuid: list(data) for uuid, data in held.items()})
                continue
            uuid, values = step
            if values is not None:
                data = tuple(curve(float(value)) for value in values)
                queue.buffer.push(numbers(data, uuid) if uuid in held else plot(data, uuid))
                held[uuid] = data
            elif held.pop(uuid, None) is not None:
                queue.buffer.push(messages.GuiRemoveMessage(uuid))
            else:
                continue
            waits = True

"""Each inside of viser that is used: fails when it is no longer what it was read to be."""

import asyncio
import dataclasses
import importlib.util
import inspect
import json
import re
import threading
import types
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from pathlib import Path
from typing import get_type_hints

import msgspec
import numpy as np
import pytest
import viser
from viser import _messages, infra
from viser._assignable_props_api import AssignablePropsBase
from viser.infra import _infra
from viser.infra._async_message_buffer import AsyncMessageBuffer

from navcore.foundation.errors import InputError
from schuler_bench.bridge import controls, mends, program, server, texts
from schuler_bench.bridge.pool import FairPool
from schuler_bench.http.page import FIRST_SCRIPTS, PLOTLY, build_page
from tests.attack.conftest import Bench, eventually
from tests.attack.wire import Visitor, visit

pytestmark = pytest.mark.attack


@pytest.mark.parametrize(
    ("version", "known"),
    [
        ("1.1.1", True),
        ("1.1.2", True),
        ("1.12.0rc1", True),
        ("1.1.0", False),
        ("2.0.0", False),
    ],
)
def test_versions_of_viser(monkeypatch: pytest.MonkeyPatch, version: str, known: bool) -> None:
    monkeypatch.setattr(viser, "__version__", version)
    with nullcontext() if known else pytest.raises(InputError, match="must be >= 1.1.1 and < 2"):
        server.require_known_version()


def test_page_is_unpacked_as_its_own_loader_does_it() -> None:
    page = (Path(viser.__file__).parent / "client" / "build" / "index.html").read_text(encoding="utf-8")
    ((attributes, _),) = re.findall(r"<script ([^>]*)>(.*?)</script>", page, re.DOTALL)
    data = dict(re.findall(r'data-(\w+)="([^"]*)"', attributes))
    last = data["p"][len(data["p"]) // 5 * 5 - 4000 :]
    assert program.unpack(last) == unpacked_slowly(last)
    found = program.viser_program()
    longer = sum(len(mend.after) - len(mend.before) for mend in program.MENDS)
    assert (len(found.style), len(found.program)) == (int(data["ss"]), int(data["cs"]) + longer)
    assert found.style.decode() and found.program.decode()
    assert found.zstd[:4] == b"\0asm" and b"ZSTD_decompress" in found.zstd
    # What socket.js says to the worker that holds viser's websocket, and how it knows it.
    assert b"type:`set_server`" in found.program and b"type:`send`" in found.program
    # What the worker says to the page, which curves.js hears before viser's program listens.
    assert b"{type:`message_batch`,messages:c}" in found.program and b"i({type:`connected`})" in found.program
    assert b"s.type===`message_batch`&&h7(t,s.messages)" in found.program
    assert b"globalThis.__viserZstdWasm" in found.program


def unpacked_slowly(text: str) -> bytes:
    """The packing of viser's page: five characters to the base 88 are four bytes."""
    digits = [chr(code) for code in range(0x21, 0x7F) if chr(code) not in "\"&<>'`"]
    out = bytearray()
    for start in range(0, len(text), 5):
        group, number = text[start : start + 5], 0
        for character in group:
            number = number * 88 + digits.index(character)
        out += number.to_bytes(len(group) - 1, "big")
    return bytes(out)


def test_a_mend_that_does_not_fit_is_left_out_and_logged_once(caplog: pytest.LogCaptureFixture) -> None:
    before, after = ([mend[place] for mend in program.MENDS] for place in (1, 2))
    assert program.mended("\n".join(before).encode()) == "\n".join(after).encode()
    assert not caplog.messages
    mends.left_out.cache_clear()
    for other in ([*before[1:]], [*before, before[0]]):
        kept = [text for text in other if text == before[0]]
        for _ in range(2):
            mended = program.mended("\n".join(other).encode()).decode().split("\n")
            assert sorted(mended) == sorted([*after[1:], *kept])
    assert [program.MENDS[0].name in message for message in caplog.messages] == [True]


@pytest.mark.parametrize(
    ("act", "owner", "name"),
    [
        (mends.mend_queues, _infra, "AsyncMessageBuffer"),
        (mends.share_hints, AssignablePropsBase, "_prop_hints"),
        (mends.share_hints, AssignablePropsBase, "_cast_value_recursive"),
    ],
)
def test_a_mend_whose_place_is_missing_is_left_out(
    monkeypatch: pytest.MonkeyPatch,
    caplog: pytest.LogCaptureFixture,
    act: Callable[[], None],
    owner: object,
    name: str,
) -> None:
    mends.left_out.cache_clear()
    monkeypatch.delattr(owner, name)
    act()
    assert not hasattr(owner, name) and len(caplog.messages) == 1


@contextmanager
def visited(bench: Bench, session: str) -> Iterator[tuple[Visitor, viser.ClientHandle]]:
    """The only visitor, whose page stands, and viser's handle of it."""
    with visit(bench.port, session) as visitor:
        visitor.control("last")
        (client,) = bench.server.viser.get_clients().values()
        yield visitor, client


def test_numbers_of_a_plot_are_sent_once_and_in_single_precision(bench: Bench) -> None:
    with visited(bench, "the-watcher") as (visitor, client):
        time = np.linspace(0.0, 1.0, 5)
        plot = client.gui.add_uplot((time, time), ({}, {}))
        visitor.wait_for(lambda message: message["type"] == "GuiUplotMessage")
        controls.show_numbers(plot, (time, 2.0 * time))
        sent = visitor.wait_for(lambda message: "data" in (message.get("updates") or {}))
        time_again, curve = sent["updates"]["data"]
        assert time_again is None and curve["dtype"] == "<f4"
        count = len(visitor.received)
        controls.show_numbers(plot, (time, 2.0 * time))
        client.gui.add_markdown("after it")
        visitor.wait_for(lambda message: message["type"] == "GuiMarkdownMessage")
        assert not any("data" in (message.get("updates") or {}) for message in visitor.received[count:])


def test_page_has_one_title_and_our_scripts_come_first() -> None:
    assert program.viser_program().html.count("<title>Viser</title>") == 1
    page = build_page(FIRST_SCRIPTS, [PLOTLY], "Bench")
    html = page.html.plain.decode()
    assert 0 < html.index("../../static/bench") < html.index("../../static/start")
    assert re.search(r'<link [^>]*data-later href="../../static/plotly-basic.min[^"]*">', html)
    # The same version as the plotly of Python, against whose figures and insides the tests were written.
    (plotly,) = (file for name, file in page.files.items() if name.startswith("plotly-basic.min"))
    whole = Path(importlib.util.find_spec("plotly").origin).parent / "package_data" / "plotly.min.js"
    version = re.search(rb"plotly\.js v([0-9.]+)", whole.read_bytes()[:200])[1]
    assert b"plotly.js (basic - minified) v" + version in plotly.plain[:200]


def test_messages_a_browser_sends_are_all_known() -> None:
    """Those viser handles are those we pass on or ignore; a new one must be judged first."""
    handled = set()
    for module in ("_viser", "_gui_api", "_scene_api"):
        source = inspect.getsource(getattr(viser, module))
        # Messages named in a registration, or in the scene's table of owner-scoped ones.
        handled |= set(re.findall(r"register_handler\(\s*_messages\.(\w+)", source))
        handled |= set(re.findall(r"\(\s*_messages\.(\w+Message),\s*self\._handle", source))
    known = server.FRAME_TYPES.keys() | server.IGNORED_FRAMES
    assert handled and handled <= known
    for name in known:
        assert issubclass(getattr(_messages, name), infra.Message)
    assert msgspec.convert({"uuid": "u", "updates": {"value": 1}}, _messages.GuiUpdateMessage).uuid == "u"


def test_serve_is_called_once_and_as_expected() -> None:
    source = inspect.getsource(_infra)
    assert source.count("websockets.asyncio.server.serve(") == 1
    used = set(
        re.findall(
            r"(?<![\w.\"`])websockets\.(\w+)", re.sub(r"import websockets.*|from websockets.*", "", source)
        )
    )
    assert used == {"asyncio", "datastructures", "exceptions"}


def test_replacement_is_undone_even_after_a_failure() -> None:
    original = vars(_infra)["websockets"]
    with pytest.raises(RuntimeError), server._serve_replaced(lambda: None):
        assert isinstance(vars(_infra)["websockets"], types.SimpleNamespace)
        raise RuntimeError
    assert vars(_infra)["websockets"] is original


def test_tunnel_handlers_are_gone(bench: Bench) -> None:
    handlers = bench.server.viser._websock_server._incoming_handlers
    assert _messages.ShareUrlRequest not in handlers and _messages.ShareUrlDisconnect not in handlers
    assert _messages.GuiUpdateMessage in handlers, "the table is still the one that is used"


@dataclasses.dataclass
class Figure:
    title: str = ""

    def to_json(self) -> str:
        return json.dumps({"data": [], "layout": {"title": {"text": self.title}}})


def test_plotly_is_not_sent_through_the_socket(bench: Bench) -> None:
    with visited(bench, "the-plotter") as (visitor, client):
        client.gui.add_plotly(Figure())
        visitor.wait_for(lambda message: message["type"] == "GuiPlotlyMessage")
        assert "RunJavascriptMessage" not in {message["type"] for message in visitor.received}
        client.gui._setup_plotly_js = False
        client.gui.add_plotly(Figure())
        visitor.wait_for(lambda message: message["type"] == "RunJavascriptMessage")


def test_controls_are_found_with_all_that_is_judged(bench: Bench) -> None:
    with visited(bench, "the-looker") as (visitor, client):
        guest = controls.Guest(bench.server.viser, client.client_id)
        ids = {label: visitor.control(label) for label in ("gain", "network", "frozen", "log", "last")}
        found = {label: guest.control(uuid) for label, uuid in ids.items()}
        assert guest.control("nobody's") is None
        assert controls.Guest(bench.server.viser, 10_000).control(ids["gain"]) is None
    assert (found["gain"].label, found["gain"].value, found["gain"].bounds) == ("gain", 0.5, (0.0, 1.0))
    assert found["network"].options == ("compass", "pole2")
    assert [label for label in found if found[label].disabled] == ["frozen"]
    assert [label for label in found if found[label].takes_files] == ["log"]


def test_held_value_is_sent_even_when_nothing_changed(bench: Bench) -> None:
    with visited(bench, "restored") as (visitor, client):
        uuid = visitor.control("gain")
        controls.Guest(bench.server.viser, client.client_id).restore(uuid)
        sent = visitor.wait_for(lambda message: message["type"] == "GuiUpdateMessage")
        assert (sent["uuid"], sent["updates"]) == (uuid, {"value": 0.5})


class _Loud:
    """A language in which every text is written in capitals."""

    name = "loud"

    def text(self, text: str, names: frozenset[str] = frozenset()) -> str:
        del names
        return text.upper()


def test_texts_stand_in_the_fields_that_are_translated() -> None:
    kinds = [kind for kind in vars(_messages).values() if dataclasses.is_dataclass(kind)]
    fields = {entry.name for kind in kinds for entry in dataclasses.fields(kind)}
    assert texts._TEXTS | texts._LISTS | texts._UPLOT | {texts._PLOTLY} <= fields


def test_a_page_is_sent_its_language_and_its_choice_is_read_back(bench: Bench) -> None:
    """What becomes of each kind of message stands in test_language_messages.py."""
    with visited(bench, "the-reader") as (visitor, client):
        viser_server, page = bench.server.viser, client.client_id
        assert texts.language_of(client) == "en"
        texts.speak(viser_server, page, _Loud())
        assert texts.language_of(client) == "loud"
        chooser = client.gui.add_dropdown("policy", ("calm", "rough"))
        uuid = controls.id_of(chooser)
        sent = visitor.wait_for(lambda m: m["type"] == "GuiDropdownMessage" and m["uuid"] == uuid)
        assert [sent["props"]["label"], sent["props"]["options"], sent["value"]] == [
            "POLICY",
            ["CALM", "ROUGH"],
            "CALM",
        ]
        assert chooser.options == ("calm", "rough") and chooser.value == "calm"
        assert texts.meant(viser_server, page, uuid, "ROUGH") == "rough"
        chooser.value = "rough"
        changed = visitor.wait_for(lambda m: "value" in (m.get("updates") or {}))
        assert changed["updates"] == {"value": "ROUGH"}
        client.gui.add_plotly(Figure("tilt"))
        # viser makes the plot empty, and then sends its figure
        visitor.wait_for(lambda m: '"TILT"' in (m.get("updates") or {}).get("_plotly_json_str", ""))
        texts.speak(viser_server, page, None)
        assert texts.language_of(client) == "en"
        assert [texts.meant(viser_server, who, uuid, "ROUGH") for who in (page, 10_000)] == ["ROUGH", "ROUGH"]


class _Interleaved(deque):
    """Waiters of an event that is set by another thread just before the waiter is entered."""

    def __init__(self, push: Callable[[], None]) -> None:
        super().__init__()
        self._push = push

    def append(self, waiter: object) -> None:
        thread = threading.Thread(target=self._push)
        thread.start()
        thread.join()
        super().append(waiter)


def _in_a_loop_of_its_own(push: Callable[[], None]) -> None:
    async def pushing() -> None:
        push()

    asyncio.run(pushing())


@pytest.mark.parametrize("mended", [False, True])
@pytest.mark.parametrize("pushing", [lambda push: push(), _in_a_loop_of_its_own], ids=["thread", "loop"])
def test_a_message_pushed_while_the_loop_begins_to_wait_is_sent(
    mended: bool, pushing: Callable[[Callable[[], None]], None]
) -> None:
    """viser alone loses the wake-up in this order of events; should it no longer, `MendedBuffer` can go."""
    kind = mends.MendedBuffer if mended else AsyncMessageBuffer

    async def first_window() -> bool:
        buffer = kind(asyncio.get_running_loop(), persistent_messages=False)
        message = _messages.GuiUpdateMessage("u", {"value": 1})
        buffer.message_event._waiters = _Interleaved(lambda: pushing(lambda: buffer.push(message)))
        windows = buffer.window_generator(0)
        try:
            return len(await asyncio.wait_for(anext(windows), 1.0)) == 1
        except TimeoutError:
            return False
        finally:
            await windows.aclose()

    assert asyncio.run(first_window()) is mended


def test_mended_queue_and_fair_pool_are_the_ones_in_use(bench: Bench) -> None:
    with visited(bench, "mended-1") as (_, client):
        buffer = client._websock_connection.get_message_buffer()
        assert isinstance(buffer, mends.MendedBuffer) and isinstance(buffer.message_event, mends._LoopEvent)
        apis = (client.gui, client.scene, bench.server.viser.gui, bench.server.viser)
        assert {type(api._thread_executor) for api in apis} == {FairPool}


def test_handles_of_a_kind_share_their_types_and_convert_as_viser_does(bench: Bench) -> None:
    with visit(bench.port, "shared-types") as visitor:
        visitor.control("last")
        handles = bench.of("shared-types")
        gain, frozen = handles["gain"], handles["frozen"]
        assert gain._prop_hints is frozen._prop_hints
        assert gain._prop_hints == get_type_hints(type(gain._impl.props))
        assert "_prop_hints" not in vars(gain), "nothing is kept with the handle"
        own = getattr(AssignablePropsBase, mends._CAST)
        for name, value in (("label", "text"), ("visible", False), ("order", 3.0), ("min", 0.25)):
            hint = gain._prop_hints[name]
            assert gain._cast_value_recursive(hint, value, name) == own(gain, hint, value, name)


def test_slider_messages_that_wait_are_read_once(bench: Bench) -> None:
    release, seen = threading.Event(), []
    with visit(bench.port, "coalesced-1") as visitor:
        uuid = visitor.control("gain")
        gain = bench.of("coalesced-1")["gain"]

        @gain.on_update
        def _(event: viser.GuiEvent) -> None:
            seen.append(event.target.value)
            release.wait(5.0)

        for number in range(30):
            visitor.set(uuid, number / 100)
        eventually(lambda: gain.value == 0.29)
        release.set()
        eventually(lambda: seen[-1:] == [0.29])
        assert len(seen) <= 3


def test_nothing_of_a_visitor_stays_behind(bench: Bench) -> None:
    inner = bench.server.viser._websock_server
    with visited(bench, "short-stay"):
        assert len(inner._live_connections) == 1
    eventually(lambda: not inner._live_connections and not inner._client_state_from_id)
    assert bench.server.viser.get_clients() == {}

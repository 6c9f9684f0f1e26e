"""Each inside of viser that is used: fails when it is no longer what it was read to be."""

from __future__ import annotations

import base64
import hashlib
import inspect
import re
import types

import msgspec
import pytest
import viser
import zstandard
from viser import _messages, infra
from viser.infra import _infra

from app.http import viser_insides
from app.http.page import build_page, plotly_script
from navcore.errors import InputError
from tests.attack.conftest import Bench, eventually
from tests.attack.wire import visit

pytestmark = pytest.mark.attack

BASE_88 = "".join(chr(code) for code in range(0x21, 0x7F) if chr(code) not in "\"&<>'`")


def unpack(text: str) -> bytes:
    """The packing of viser's page: five characters to the base 88 are four bytes."""
    digits = {character: value for value, character in enumerate(BASE_88)}
    out = bytearray()
    for start in range(0, len(text), 5):
        group, number = text[start : start + 5], 0
        for character in group:
            number = number * 88 + digits[character]
        out += number.to_bytes(len(group) - 1, "big")
    return bytes(out)


def digest(content: bytes) -> str:
    return "sha256-" + base64.b64encode(hashlib.sha256(content).digest()).decode()


def test_pinned_version(monkeypatch: pytest.MonkeyPatch) -> None:
    viser_insides.require_pinned_version()
    monkeypatch.setattr(viser, "__version__", "1.1.2")
    with pytest.raises(InputError, match="must be 1.1.1"):
        viser_insides.require_pinned_version()


def test_hashes_are_those_of_the_scripts_in_the_page() -> None:
    page = viser_insides.page_html()
    ((attributes, loader),) = re.findall(r"<script ([^>]*)>(.*?)</script>", page, re.DOTALL)
    data = dict(re.findall(r'data-(\w+)="([^"]*)"', attributes))
    whole = zstandard.ZstdDecompressor().decompress(unpack(data["p"]), max_output_size=1 << 25)
    style = int(data["ss"])
    program = whole[style : style + int(data["cs"])]
    assert viser_insides.PAGE_SCRIPT_HASHES == (digest(loader.encode()), digest(program))


def test_page_has_one_title_and_our_scripts_come_first() -> None:
    assert viser_insides.page_html().count("<title>Viser</title>") == 1
    page = build_page([plotly_script()], "Bench")
    html = page.html.plain.decode()
    assert 0 < html.index("../../static/plotly") < html.index("data-p=")
    (script,) = page.scripts.values()
    assert b"plotly.js v" in script.plain[:200]


def test_messages_a_browser_sends_are_all_known() -> None:
    """Those viser handles are those we pass on or ignore; a new one must be judged first."""
    handled = set()
    for module in ("_viser", "_gui_api", "_scene_api"):
        source = inspect.getsource(getattr(viser, module))
        # Messages named in a registration, or in the scene's table of owner-scoped ones.
        handled |= set(re.findall(r"register_handler\(\s*_messages\.(\w+)", source))
        handled |= set(re.findall(r"\(\s*_messages\.(\w+Message),\s*self\._handle", source))
    known = viser_insides.FRAME_TYPES.keys() | viser_insides.IGNORED_FRAMES
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
    with pytest.raises(RuntimeError), viser_insides._serve_replaced(lambda: None):
        assert isinstance(vars(_infra)["websockets"], types.SimpleNamespace)
        raise RuntimeError
    assert vars(_infra)["websockets"] is original


def test_tunnel_handlers_are_gone(bench: Bench) -> None:
    handlers = bench.server.viser._websock_server._incoming_handlers
    assert _messages.ShareUrlRequest not in handlers and _messages.ShareUrlDisconnect not in handlers
    assert _messages.GuiUpdateMessage in handlers, "the table is still the one that is used"


def test_plotly_is_not_sent_through_the_socket(bench: Bench) -> None:
    class Figure:
        def to_json(self) -> str:
            return '{"data": [], "layout": {}}'

    with visit(bench.port, "the-plotter") as visitor:
        visitor.control("last")
        (client,) = bench.server.viser.get_clients().values()
        client.gui.add_plotly(Figure())
        visitor.wait_for(lambda message: message["type"] == "GuiPlotlyMessage")
        assert "RunJavascriptMessage" not in {message["type"] for message in visitor.received}
        client.gui._setup_plotly_js = False
        client.gui.add_plotly(Figure())
        visitor.wait_for(lambda message: message["type"] == "RunJavascriptMessage")


def test_controls_are_found_with_all_that_is_judged(bench: Bench) -> None:
    with visit(bench.port, "the-looker") as visitor:
        ids = {label: visitor.control(label) for label in ("gain", "network", "frozen", "log", "last")}
        (client_id,) = bench.server.viser.get_clients()
        found = {
            label: viser_insides.find_control(bench.server.viser, client_id, uuid)
            for label, uuid in ids.items()
        }
        assert viser_insides.find_control(bench.server.viser, client_id, "nobody's") is None
        assert viser_insides.find_control(bench.server.viser, 10_000, ids["gain"]) is None
    assert (found["gain"].label, found["gain"].value, found["gain"].bounds) == ("gain", 0.5, (0.0, 1.0))
    assert found["network"].options == ("compass", "pole2")
    assert found["frozen"].disabled and not found["gain"].disabled
    assert found["log"].takes_files and not found["last"].takes_files


def test_held_value_is_sent_even_when_nothing_changed(bench: Bench) -> None:
    with visit(bench.port, "restored") as visitor:
        uuid = visitor.control("gain")
        (client_id,) = bench.server.viser.get_clients()
        viser_insides.show_held_value(bench.server.viser, client_id, uuid)
        sent = visitor.wait_for(lambda message: message["type"] == "GuiUpdateMessage")
        assert (sent["uuid"], sent["updates"]) == (uuid, {"value": 0.5})


def test_nothing_of_a_visitor_stays_behind(bench: Bench) -> None:
    inner = bench.server.viser._websock_server
    with visit(bench.port, "short-stay") as visitor:
        visitor.control("last")
        assert len(inner._live_connections) == 1
    eventually(lambda: not inner._live_connections and not inner._client_state_from_id)
    assert bench.server.viser.get_clients() == {}

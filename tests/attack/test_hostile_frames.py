"""serving 6-9, 11, 13: messages no page sends, against a running server."""

import contextlib
import math
import threading
import time
from collections.abc import Callable
from typing import Any

import msgspec
import pytest
import viser._viser
from websockets.exceptions import ConnectionClosed

from schuler_bench.bridge.controls import lock_controls
from schuler_bench.http.limits import MIB
from tests.attack.conftest import Bench, eventually
from tests.attack.wire import CAMERA, raw, upload, visit

pytestmark = pytest.mark.attack


def pressed(bench: Bench) -> bool:
    """Whether the button ``last`` was pressed: all that was sent before it has been read."""
    return ("last", True) in bench.events


def still_served(bench: Bench) -> None:
    """A well-behaved visitor finds everything as it should be."""
    with visit(bench.port, "well-behaved") as visitor:
        visitor.set(visitor.control("gain"), 0.7)
        eventually(lambda: bench.of("well-behaved")["gain"].value == 0.7)


def test_a_good_value_arrives(bench: Bench) -> None:
    sent = {"gain": 0.9, "count": 8, "network": "pole2", "on": False, "title": "new", "triple": [3, 2, 1]}
    with visit(bench.port, "good-values") as visitor:
        for label, value in [*sent.items(), ("last", True)]:
            visitor.set(visitor.control(label), value)
        eventually(lambda: pressed(bench))
        held = {label: bench.of("good-values")[label].value for label in sent}
    assert held == sent | {"triple": (3.0, 2.0, 1.0)}


@pytest.mark.parametrize(
    ("label", "values"),
    [
        ("gain", [1e9, math.nan, -5, "wide", True, None, [1], math.inf, {}]),
        ("count", [2.5, math.nan, "7", b"7"]),
        ("network", ["no such network", 1, None]),
        ("on", [1, "yes", None]),
        ("title", [1, b"x", "x" * 30_000]),
        ("triple", [[1, 2], [1, 2, math.nan], "123", 4]),
        ("frozen", [0.7]),
        ("log", ["x", {"name": "x", "content": b"x"}]),
    ],
)
def test_bad_values_are_not_stored(bench: Bench, label: str, values: list[Any]) -> None:
    session = f"bad-{label}-values"
    bench.events.clear()
    with visit(bench.port, session) as visitor:
        uuid = visitor.control(label)
        before = bench.of(session)[label].value
        for value in values:
            visitor.set(uuid, value)
        visitor.set(visitor.control("last"), True)
        eventually(lambda: pressed(bench))
        assert bench.of(session)[label].value == before
        assert label not in {event[0] for event in bench.events}
        if label not in ("frozen", "log"):
            assert visitor.notice().startswith(f"{label} must ")
            back = visitor.wait_for(lambda m: m["type"] == "GuiUpdateMessage" and m["uuid"] == uuid)
            assert back["updates"] == {"value": list(before) if isinstance(before, tuple) else before}


@pytest.mark.parametrize("name", ["update_cb", "props", "removed", "sync_cb", "gui_api", "no_such_name"])
def test_nothing_but_the_value_can_be_overwritten(bench: Bench, name: str) -> None:
    with visit(bench.port, "overwriter") as visitor:
        uuid = visitor.control("gain")
        state = bench.of("overwriter")["gain"]._impl
        before = getattr(state, name, None)
        visitor.set(uuid, 0.6, **{name: []})
        assert visitor.closed_with() == 1008
        assert getattr(state, name, None) is before and state.value == 0.5
    still_served(bench)


@pytest.mark.parametrize(
    ("frame", "code"),
    [
        (b"", 1008),
        (b"\xc1\xc1", 1008),
        (b"\x91" * 50_000, 1008),
        ("text", 1008),
        (msgspec.msgpack.encode({"type": "NoSuchMessage"}), 1008),
        (msgspec.msgpack.encode({"type": "RunJavascriptMessage", "source": "alert(1)"}), 1008),
        (msgspec.msgpack.encode({**CAMERA, "wxyz": "north"}), 1008),
        (msgspec.msgpack.encode({"type": "GuiUpdateMessage", "uuid": ["x"], "updates": {}}), 1008),
        (b"\x00" * (9 * MIB), 1009),
    ],
    ids=[
        "empty",
        "no msgpack",
        "deep",
        "text",
        "unknown",
        "of the server",
        "wrong field",
        "wrong id",
        "huge",
    ],
)
def test_malformed_frames_end_that_connection_only(
    bench: Bench, frame: bytes | str, code: int, capfd: pytest.CaptureFixture[str]
) -> None:
    with visit(bench.port, "bystander") as bystander, visit(bench.port, "offender") as offender:
        bystander.control("last")
        offender.control("last")
        with contextlib.suppress(ConnectionClosed):  # a huge one is still being sent
            offender.socket.send(frame)
            offender.set(offender.control("gain"), 0.9)
        assert offender.closed_with() == code
        assert bench.of("offender")["gain"].value == 0.5, "nothing after it is obeyed"
        bystander.set(bystander.control("gain"), 0.8)
        eventually(lambda: bench.of("bystander")["gain"].value == 0.8)
    eventually(lambda: len(bench.server.viser.get_clients()) == 0)
    assert "".join(capfd.readouterr()) == ""


def test_share_tunnel_request_opens_nothing(bench: Bench, monkeypatch: pytest.MonkeyPatch) -> None:
    opened = []
    monkeypatch.setattr(viser._viser, "ViserTunnel", lambda *arguments: opened.append(arguments))
    before = threading.active_count()
    with visit(bench.port, "the-sharer") as visitor:
        last = visitor.control("last")
        visitor.send(type="ShareUrlRequest")
        visitor.send(type="ShareUrlDisconnect")
        bench.events.clear()
        visitor.set(last, True)
        eventually(lambda: pressed(bench))
    assert opened == [] and bench.server.viser._share_tunnel is None
    assert threading.active_count() <= before + 8, "no tunnel thread; a few pool threads may be new"


def test_controls_of_another_visitor_are_out_of_reach(bench: Bench) -> None:
    with visit(bench.port, "visitor-a") as a, visit(bench.port, "visitor-b") as b:
        of_b, own = b.control("gain"), a.control("last")
        bench.events.clear()
        a.set(of_b, 0.9)
        a.send(type="GuiButtonHoldMessage", uuid=b.control("last"), frequency=10.0)
        a.set(b.control("last"), True)
        a.set(own, True)
        eventually(lambda: pressed(bench))
        assert bench.of("visitor-b")["gain"].value == 0.5
        assert bench.events.count(("last", True)) == 1


def test_controls_of_a_page_that_only_watches_take_nothing_until_it_is_freed(bench: Bench) -> None:
    with visit(bench.port, "the-watched") as visitor:
        ids = {label: visitor.control(label) for label in ("gain", "on", "title", "frozen", "last")}
        handles = bench.of("the-watched")
        client = next(iter(bench.server.viser.get_clients().values()))
        bench.events.clear()
        lock_controls(client, frozenset({ids["title"]}))
        disabled = {label: handles[label].disabled for label in ids}
        assert disabled == {"gain": True, "on": True, "title": False, "frozen": True, "last": True}
        for label, value in (("gain", 0.7), ("on", False), ("last", True)):
            visitor.set(ids[label], value)
        late = client.gui.add_number("late", 1)  # made after the lock
        visitor.set(visitor.control("late"), 5)
        visitor.set(ids["title"], "said")
        eventually(lambda: ("title", "said") in bench.events)
        assert bench.events == [("title", "said")]
        assert (handles["gain"].value, handles["on"].value, late.value) == (0.5, True, 1)
        lock_controls(client, None)
        assert [handles[label].disabled for label in ("gain", "frozen")] == [False, True]
        visitor.set(ids["gain"], 0.7)
        eventually(lambda: ("gain", 0.7) in bench.events)


class TestUpload:
    def test_arrives_with_a_clean_name(self, bench: Bench) -> None:
        with visit(bench.port, "uploader") as visitor:
            upload(visitor, "log", "../../etc/passwd", [b"abc", b"def"])
            handle = bench.of("uploader")["log"]
            eventually(lambda: handle.value.content == b"abcdef")
            assert handle.value.name == "passwd"

    def test_of_64_mib_is_refused_before_it_is_sent(self, bench: Bench) -> None:
        with visit(bench.port, "heavy-uploader") as visitor:
            upload(visitor, "log", "log.txt", [], size=64 * MIB)
            assert "at most 16 MiB" in visitor.notice()
            done = visitor.wait_for(lambda m: m["type"] == "FileTransferPartAck")
            assert done["transferred_bytes"] == done["total_bytes"], "the page's progress bar ends"
            client = next(iter(bench.server.viser.get_clients().values()))
            assert client.gui._current_file_upload_states == {}

    def test_cannot_be_written_into_another_control(self, bench: Bench) -> None:
        with visit(bench.port, "cross-writer") as visitor:
            upload(visitor, "log", "t", [b"abc"], size=6)
            other = {"source_component_uuid": visitor.control("gain"), "transfer_uuid": "t"}
            visitor.send(type="FileTransferPart", **other, part_index=1, content=b"def")
            assert visitor.closed_with() == 1008
            assert bench.of("cross-writer")["gain"].value == 0.5


# ---------------------------------------------------------------- frames beneath the messages

MASKED = b"\x80\x00\x00\x00\x00"
"""Length 0 and a mask of zeros."""
FLOODS = {
    "empty fragments that never end": (b"\x02" + MASKED, b"\x00" + MASKED),
    "fragments of a byte": (b"\x02" + MASKED, b"\x00\x81\x00\x00\x00\x00x"),
    "pings": (b"", b"\x89" + MASKED),
    "pongs": (b"", b"\x8a" + MASKED),
}


@pytest.mark.parametrize("flood", FLOODS)
def test_a_flood_of_fragments_or_pings_ends_its_connection_within_a_second(
    bench: Bench, flood: str, record_property: Callable[[str, object], None]
) -> None:
    first, frame = FLOODS[flood]
    name = f"flood-of-{flood.replace(' ', '-')}"
    with visit(bench.port, "beside-the-flood") as other, raw(bench.port, name) as attacker:
        gain = other.control("gain")
        attacker.sendall(first)
        began, ended = time.monotonic(), threading.Event()

        def attack() -> None:
            with contextlib.suppress(OSError):
                while time.monotonic() < began + 10.0:
                    attacker.sendall(frame * 10_000)
            ended.set()

        thread = threading.Thread(target=attack)
        thread.start()
        other.set(gain, 0.8)
        eventually(lambda: bench.of("beside-the-flood")["gain"].value == 0.8)
        thread.join()
        assert ended.is_set()
        took_s = time.monotonic() - began
        record_property("flood_ended_s", took_s)
        assert took_s < 1.0
        eventually(lambda: len(bench.server.viser._websock_server._live_connections) == 1, 1.0)
    still_served(bench)


def test_a_large_message_may_come_in_parts_and_pages_may_ping(
    bench: Bench, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As browsers send it: in parts of 64 KiB."""
    content = [b"x" * (512 << 10)] * 8
    with visit(bench.port, "in-parts") as visitor:
        whole = visitor.socket.send

        def in_parts(message: bytes) -> None:
            whole(message[start : start + (64 << 10)] for start in range(0, len(message), 64 << 10))

        monkeypatch.setattr(visitor.socket, "send", in_parts)
        upload(visitor, "log", "large", content)
        for _ in range(20):
            visitor.socket.ping()
        eventually(lambda: getattr(bench.of("in-parts")["log"].value, "content", b"") == b"".join(content))


def test_an_unfinished_message_in_very_many_parts_is_not_collected(bench: Bench) -> None:
    """However slowly they come."""
    with raw(bench.port, "in-many-parts") as attacker:
        attacker.sendall(b"\x02" + MASKED)
        with pytest.raises(OSError):
            for _ in range(400):
                attacker.sendall(b"\x00" + MASKED)
                time.sleep(0.003)
            time.sleep(0.5)
            attacker.sendall(b"\x00" + MASKED)
            time.sleep(0.1)
            attacker.sendall(b"\x00" + MASKED)

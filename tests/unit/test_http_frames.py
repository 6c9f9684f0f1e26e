"""The gate, apart from any connection: what is passed on, dropped, or ends the connection."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.bridge.controls import Control
from app.bridge.server import FRAME_TYPES
from app.http.frames import BadFrame, Gate, safe_file_name
from app.http.limits import MIB, Limits
from tests.attack.wire import CAMERA


def control(value: object, **changes: object) -> Control:
    given = {"disabled": False, "options": None, "bounds": None, "takes_files": False} | changes
    return Control(label="Gain", value=value, **given)


@dataclass
class Guest:
    controls: dict[str, Control]
    restored: list[str] = field(default_factory=list)
    ended: list[str] = field(default_factory=list)
    told: list[str] = field(default_factory=list)

    def control(self, uuid: str) -> Control | None:
        return self.controls.get(uuid)

    def meant(self, uuid: str, value: object) -> object:
        return "east" if value == "东" else value

    def restore(self, uuid: str) -> None:
        self.restored.append(uuid)

    def end_upload(self, component: str, transfer: str, size: int) -> None:
        self.ended.append(transfer)

    def tell(self, text: str) -> None:
        self.told.append(text)


@pytest.fixture
def guest() -> Guest:
    return Guest(
        {
            "gain": control(0.5, bounds=(0.0, 1.0)),
            "frozen": control(0.5, disabled=True),
            "log": control(None, takes_files=True),
        }
    )


@pytest.fixture
def gate(guest: Guest) -> Gate:
    return Gate(guest, Limits(upload_bytes=MIB, uploads_at_once=2))


def judge(gate: Gate, **message: Any) -> bytes | None:
    return gate.judge(msgspec.msgpack.encode(message))


def update(gate: Gate, uuid: str, **updates: Any) -> bytes | None:
    return judge(gate, type="GuiUpdateMessage", uuid=uuid, updates=updates)


def begin(gate: Gate, **changes: Any) -> bytes | None:
    message = {
        "source_component_uuid": "log",
        "transfer_uuid": "t",
        "filename": "a.txt",
        "mime_type": "text/plain",
    }
    message |= {"type": "FileTransferStartUpload", "part_count": 2, "size_bytes": 6}
    return judge(gate, **(message | changes))


def part(gate: Gate, index: int, content: Any = b"abc", **changes: Any) -> bytes | None:
    message = {"source_component_uuid": "log", "transfer_uuid": "t", "part_index": index, "content": content}
    return judge(gate, **({"type": "FileTransferPart"} | message | changes))


def test_a_good_message_passes_unchanged(gate: Gate) -> None:
    for message in (CAMERA, {"type": "GuiUpdateMessage", "uuid": "gain", "updates": {"value": 1}}):
        frame = msgspec.msgpack.encode(message)
        assert gate.judge(frame) == frame


def test_a_value_that_does_not_fit_is_dropped_and_told(gate: Gate, guest: Guest) -> None:
    for value in (1e9, -5, math.nan, "x"):
        assert update(gate, "gain", value=value) is None
    assert guest.restored == ["gain"] * 4
    assert guest.told[0] == "Gain must be from 0 to 1; 1000000000.0 was not taken over."


@pytest.mark.parametrize("updates", [{"update_cb": []}, {"value": 0.1, "removed": True}, {}, {"props": 1}])
def test_only_values_may_be_set(gate: Gate, updates: dict[str, Any]) -> None:
    with pytest.raises(BadFrame):
        update(gate, "gain", **updates)


def test_disabled_and_unknown_controls_take_nothing(gate: Gate, guest: Guest) -> None:
    assert update(gate, "frozen", value=0.7) is None
    assert update(gate, "of somebody else", value=0.7) is None
    assert judge(gate, type="GuiButtonHoldMessage", uuid="frozen", frequency=10.0) is None
    assert guest.restored == ["frozen"]


@pytest.mark.parametrize("kind", ["ShareUrlRequest", "ShareUrlDisconnect"])
def test_tunnel_requests_are_ignored(gate: Gate, kind: str) -> None:
    assert judge(gate, type=kind) is None


@pytest.mark.parametrize(
    "frame",
    [
        b"",
        b"\xc1",
        b"\x81" * 100_000,
        "text",
        msgspec.msgpack.encode([1, 2]),
        msgspec.msgpack.encode({"type": ["x"]}),
        msgspec.msgpack.encode({"uuid": "x"}),
        msgspec.msgpack.encode({"type": "Nonsense"}),
        msgspec.msgpack.encode({"type": "RunJavascriptMessage", "source": "1"}),
        msgspec.msgpack.encode({**CAMERA, "fov": "wide"}),
        msgspec.msgpack.encode({**CAMERA, "wxyz": [1, 0, 0]}),
        msgspec.msgpack.encode({**CAMERA, "more": 1}),
        msgspec.msgpack.encode({"type": "GuiUpdateMessage", "uuid": 3, "updates": {}}),
        msgspec.msgpack.encode({"type": "GuiUpdateMessage", "uuid": "gain", "updates": [1]}),
        msgspec.msgpack.encode({"type": "GuiUpdateMessage"}) + b"trailing",
        msgspec.msgpack.encode({"type": "ViewerCameraMessage"}),
    ],
)
def test_what_no_page_sends_ends_the_connection(gate: Gate, frame: bytes | str) -> None:
    with pytest.raises(BadFrame):
        gate.judge(frame)


def test_a_camera_out_of_this_world_is_dropped(gate: Gate) -> None:
    assert judge(gate, **{**CAMERA, "position": [math.nan, 0.0, 0.0]}) is None
    assert judge(gate, **{**CAMERA, "far": math.inf}) is None


@given(frame=st.one_of(st.binary(max_size=200), st.sampled_from(sorted(FRAME_TYPES))))
def test_nothing_else_is_ever_raised(frame: bytes | str) -> None:
    gate = Gate(Guest({}), Limits())
    raw = frame if isinstance(frame, bytes) else msgspec.msgpack.encode({"type": frame, "uuid": "x"})
    try:
        gate.judge(raw)
    except BadFrame:
        pass


class TestUpload:
    def test_passes_with_its_name_cleaned(self, gate: Gate) -> None:
        passed = begin(gate, filename="../../etc/passwd")
        assert msgspec.msgpack.decode(passed)["filename"] == "passwd"
        assert part(gate, 0) is not None and part(gate, 1) is not None
        assert part(gate, 1) is None, "the transfer has ended"
        assert begin(gate) is not None, "its place is free again"

    def test_too_large_is_refused_before_it_is_sent(self, gate: Gate, guest: Guest) -> None:
        assert begin(gate, size_bytes=64 * MIB, part_count=128) is None
        assert guest.told == ["a.txt has 64.0 MiB; at most 1 MiB are accepted."]
        assert guest.ended == ["t"]
        assert part(gate, 0) is None

    def test_too_many_or_too_much_at_once(self, gate: Gate, guest: Guest) -> None:
        assert begin(gate, transfer_uuid="1", size_bytes=MIB // 2) is not None
        assert begin(gate, transfer_uuid="2", size_bytes=MIB // 2 + 1) is None
        assert begin(gate, transfer_uuid="3") is not None
        assert begin(gate, transfer_uuid="4") is None
        assert guest.ended == ["2", "4"]

    def test_only_upload_buttons_take_files(self, gate: Gate) -> None:
        assert begin(gate, source_component_uuid="gain") is None
        assert begin(gate, source_component_uuid="unknown") is None

    @pytest.mark.parametrize(
        "changes",
        [
            {"size_bytes": -1},
            {"part_count": -1},
            {"part_count": 7},
            {"part_count": 0},
            {"size_bytes": 0},
            {"size_bytes": 1.5},
            {"filename": b"x"},
        ],
    )
    def test_impossible_announcements(self, gate: Gate, changes: dict[str, Any]) -> None:
        with pytest.raises(BadFrame):
            begin(gate, **changes)

    @pytest.mark.parametrize(
        "changes",
        [
            {"index": 0},
            {"index": 2},
            {"index": -1},
            {"index": 1, "content": b"abcd"},
            {"index": 1, "content": b""},
            {"index": 1, "content": "YWJj"},
            {"index": 1, "source_component_uuid": "gain"},
            {"index": 1, "source_component_uuid": None},
        ],
    )
    def test_parts_that_were_not_announced(self, gate: Gate, changes: dict[str, Any]) -> None:
        begin(gate)
        part(gate, 0)
        with pytest.raises(BadFrame):
            part(gate, **changes)

    def test_the_same_transfer_twice(self, gate: Gate) -> None:
        begin(gate)
        with pytest.raises(BadFrame):
            begin(gate)

    def test_empty_file(self, gate: Gate) -> None:
        assert begin(gate, size_bytes=0, part_count=0) is not None


@pytest.mark.parametrize(
    ("given", "safe"),
    [
        ("log.txt", "log.txt"),
        ("../../etc/passwd", "passwd"),
        ("..\\..\\boot.ini", "boot.ini"),
        ("/", "upload"),
        ("..", "upload"),
        ("", "upload"),
        ("a\x00b\n\u202ec.csv", "abc.csv"),
        ("x" * 500 + ".nmea", "x" * 115 + ".nmea"),
        ("<img onerror=1>.txt", "<img onerror=1>.txt"),
        ("Schiff \u00fc 1.txt", "Schiff \u00fc 1.txt"),
    ],
)
def test_file_names(given: str, safe: str) -> None:
    assert safe_file_name(given) == safe

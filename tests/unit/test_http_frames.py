"""The gate, apart from any connection: values that fit; what is passed on, dropped, or closes it."""

import math
from typing import Any

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from schuler_bench.bridge.controls import Control, Guest
from schuler_bench.bridge.server import FRAME_TYPES
from schuler_bench.http.frames import BadFrame, Gate, Uploading, excerpt, safe_file_name, why_not
from schuler_bench.http.limits import MIB, Limits
from tests.attack.wire import CAMERA

# ------------------------------------------------------------ values of controls


def control(held: object, **changes: Any) -> Control:
    given = {"disabled": False, "options": None, "bounds": None, "takes_files": False} | changes
    return Control(label="Gain", value=held, **given)


SLIDER = control(0.5, bounds=(0.0, 1.0))
CHOICE = control("a", options=("a", "b"))
RANGE, A_NUMBER = "be from 0 to 1", "be a number"


@pytest.mark.parametrize(
    ("held", "value", "reason"),
    [
        (SLIDER, 0, None),
        (SLIDER, 1.0, None),
        (SLIDER, 1.0 + 1e-12, None),
        (SLIDER, 1.001, RANGE),
        (SLIDER, 1e9, RANGE),
        (SLIDER, -5, RANGE),
        (SLIDER, math.nan, A_NUMBER),
        (control(0.5), 1e300, None),
        (control(0.5), -5, None),
        (control(0.5), math.inf, A_NUMBER),
        (control(0.5), "0.5", A_NUMBER),
        (control(0.5), True, A_NUMBER),
        (control(0.5), None, A_NUMBER),
        (control(0.5), [0.5], A_NUMBER),
        (control(3), 7, None),
        (control(3), 7.0, None),
        (control(3), 7.5, "be a whole number"),
        (control(3), 2**70, None),
        (CHOICE, "b", None),
        (CHOICE, "c", "be one of the choices offered"),
        (CHOICE, 1, "be text"),
        (control("t"), "<img onerror=1>", None),
        (control("t"), "x" * 101, "have at most 100 characters"),
        (control(True), False, None),
        (control(True), 1, "be on or off"),
        (control(True), "yes", "be on or off"),
        (control((1.0, 2.0)), [3, 4.5], None),
        (control((1.0, 2.0)), [1.0], "have 2 values"),
        (control((1.0, 2.0)), "12", "have 2 values"),
        (control((1.0, 2.0)), [1.0, math.nan], A_NUMBER),
        (control(b"file"), b"file", "not be set in this way"),
    ],
)
def test_whether_a_value_fits_its_control(held: Control, value: object, reason: str | None) -> None:
    assert why_not(held, value, 100) == reason


def test_long_values_are_shown_short() -> None:
    assert (len(excerpt("x" * 1000)), excerpt(math.nan)) == (60, "nan")


# ------------------------------------------------------------ the gate


class Page(Guest):
    """A visitor who only notes what is done."""

    def __init__(self, controls: dict[str, Control]) -> None:
        self.controls = controls
        self.restored: list[str] = []
        self.ended: list[str] = []
        self.notices: list[str] = []

    def control(self, uuid: str) -> Control | None:
        return self.controls.get(uuid)

    def meant(self, uuid: str, value: object) -> object:
        return "east" if value == "东" else value

    def restore(self, uuid: str) -> None:
        self.restored.append(uuid)

    def end_upload(self, component: str, transfer: str, size: int) -> None:
        self.ended.append(transfer)

    def tell(self, title: str, text: str) -> None:
        self.notices.append(text)


@pytest.fixture
def guest() -> Page:
    return Page(
        {"gain": SLIDER, "frozen": control(0.5, disabled=True), "log": control(None, takes_files=True)}
    )


@pytest.fixture
def gate(guest: Page) -> Gate:
    return Uploading(Limits(upload_bytes=MIB, uploads_at_once=2)).gate(guest)


def judge(gate: Gate, **message: Any) -> bytes | None:
    return gate.judge(msgspec.msgpack.encode(message))


def update(uuid: Any, updates: Any) -> dict[str, Any]:
    return {"type": "GuiUpdateMessage", "uuid": uuid, "updates": updates}


@pytest.mark.parametrize("message", [CAMERA, update("gain", {"value": 1})])
def test_a_good_message_passes_unchanged(gate: Gate, message: dict[str, Any]) -> None:
    assert judge(gate, **message) == msgspec.msgpack.encode(message)


def test_a_value_that_does_not_fit_is_dropped_and_told(gate: Gate, guest: Page) -> None:
    values = [1e9, -5, math.nan, "x"]
    assert [judge(gate, **update("gain", {"value": value})) for value in values] == [None] * 4
    assert guest.restored == ["gain"] * 4
    assert guest.notices[0] == "Gain must be from 0 to 1; 1000000000.0 was refused."


@pytest.mark.parametrize(
    ("message", "restored"),
    [
        (update("frozen", {"value": 0.7}), ["frozen"]),
        (update("of somebody else", {"value": 0.7}), []),
        ({"type": "GuiButtonHoldMessage", "uuid": "frozen", "frequency": 10.0}, []),
        ({"type": "ShareUrlRequest"}, []),
        ({"type": "ShareUrlDisconnect"}, []),
        ({**CAMERA, "position": [math.nan, 0.0, 0.0]}, []),
        ({**CAMERA, "far": math.inf}, []),
    ],
)
def test_what_has_no_effect_is_dropped(
    gate: Gate, guest: Page, message: dict[str, Any], restored: list[str]
) -> None:
    assert judge(gate, **message) is None
    assert (guest.restored, guest.notices) == (restored, [])


@pytest.mark.parametrize("frame", [b"", b"\xc1", b"\x81" * 100_000, "text", msgspec.msgpack.encode([1, 2]),
                                   msgspec.msgpack.encode({"type": "GuiUpdateMessage"}) + b"trailing"],
                         ids=range(6))  # fmt: skip
def test_what_is_no_message_ends_the_connection(gate: Gate, frame: bytes | str) -> None:
    with pytest.raises(BadFrame):
        gate.judge(frame)


@pytest.mark.parametrize(
    "message",
    [
        {"type": ["x"]},
        {"uuid": "x"},
        {"type": "Nonsense"},
        {"type": "RunJavascriptMessage", "source": "1"},
        {**CAMERA, "fov": "wide"},
        {**CAMERA, "wxyz": [1, 0, 0]},
        {**CAMERA, "more": 1},
        {"type": "ViewerCameraMessage"},
        update(3, {}),
        update("gain", [1]),
        update("gain", {"update_cb": []}),
        update("gain", {"value": 0.1, "removed": True}),
        update("gain", {}),
        update("gain", {"props": 1}),
    ],
)
def test_what_no_page_sends_ends_the_connection(gate: Gate, message: dict[str, Any]) -> None:
    with pytest.raises(BadFrame):
        judge(gate, **message)


@given(frame=st.one_of(st.binary(max_size=200), st.sampled_from(sorted(FRAME_TYPES))))
def test_nothing_else_is_ever_raised(frame: bytes | str) -> None:
    raw = frame if isinstance(frame, bytes) else msgspec.msgpack.encode({"type": frame, "uuid": "x"})
    try:
        Uploading(Limits()).gate(Page({})).judge(raw)
    except BadFrame:
        pass


# ------------------------------------------------------------ uploads


def begin(gate: Gate, **changes: Any) -> bytes | None:
    message = {
        "type": "FileTransferStartUpload", "source_component_uuid": "log", "transfer_uuid": "t",
        "filename": "a.txt", "mime_type": "text/plain", "part_count": 2, "size_bytes": 6,
    }  # fmt: skip
    return judge(gate, **(message | changes))


def part(gate: Gate, index: int, content: Any = b"abc", **changes: Any) -> bytes | None:
    message = {"source_component_uuid": "log", "transfer_uuid": "t", "part_index": index, "content": content}
    return judge(gate, **({"type": "FileTransferPart"} | message | changes))


def test_an_upload_passes_with_its_name_cleaned(gate: Gate) -> None:
    passed = begin(gate, filename="../../etc/passwd")
    assert passed is not None and msgspec.msgpack.decode(passed)["filename"] == "passwd"
    assert [part(gate, index) is not None for index in (0, 1, 1)] == [True, True, False]  # it has ended
    assert begin(gate) is not None, "its place is free again"


def test_a_large_upload_is_refused_before_it_is_sent(gate: Gate, guest: Page) -> None:
    assert begin(gate, size_bytes=64 * MIB, part_count=128) is None
    assert guest.notices == ["a.txt has 64.0 MiB; at most 1 MiB are accepted."]
    assert guest.ended == ["t"] and part(gate, 0) is None


def test_too_many_uploads_or_too_much_at_once(gate: Gate, guest: Page) -> None:
    sizes = {"1": MIB // 2, "2": MIB // 2 + 1, "3": 6, "4": 6}
    passed = [begin(gate, transfer_uuid=id, size_bytes=size) is not None for id, size in sizes.items()]
    assert (passed, guest.ended) == ([True, False, True, False], ["2", "4"])


def test_only_upload_buttons_take_files_and_a_file_may_be_empty(gate: Gate) -> None:
    assert begin(gate, source_component_uuid="gain") is begin(gate, source_component_uuid="unknown") is None
    assert begin(gate, size_bytes=0, part_count=0) is not None


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
        {"transfer_uuid": "another"},
    ],
)
def test_impossible_announcements(gate: Gate, changes: dict[str, Any]) -> None:
    begin(gate, transfer_uuid="another")
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
def test_parts_that_were_not_announced(gate: Gate, changes: dict[str, Any]) -> None:
    begin(gate)
    part(gate, 0)
    with pytest.raises(BadFrame):
        part(gate, **changes)


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

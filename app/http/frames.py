"""The gate every message from a browser passes before viser sees it.

viser writes whatever a message names into its control, calls included; here a message is decoded against
viser's own message types, judged, and passed on, dropped with a notice, or answered by closing that
one connection.
"""

from __future__ import annotations

import dataclasses
import math
import time
import unicodedata
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import PurePosixPath
from typing import Any

import msgspec

from navcore.foundation.text import Text
from schuler_bench.bridge.controls import Control, Guest
from schuler_bench.bridge.server import FRAME_TYPES, IGNORED_FRAMES
from schuler_bench.http.limits import MIB, Limits

_LONGEST_FILE_NAME = 120


class BadFrame(Exception):
    """The message is none that a page sends: its connection is to be closed."""


@dataclass
class _Upload:
    component: str
    size: int
    bytes_left: int
    part_count: int
    came_s: float
    seen: set[int] = field(default_factory=set)


@dataclass
class Uploading:
    """The unfinished uploads of all visitors: they wait in memory, so together they are bounded.

    Attributes
    ----------
    limits : Limits
        Sizes.
    clock : callable
        Seconds, monotonic.
    """

    limits: Limits
    clock: Callable[[], float] = time.monotonic
    _gates: list[Gate] = field(default_factory=list)

    def has_room(self, size: int) -> bool:
        """Whether an upload of this size may begin; those that have stalled are given up for it."""
        if self._bytes() + size > self.limits.all_uploads_bytes:
            for gate in list(self._gates):
                gate.give_up_stalled(self.clock() - self.limits.upload_stall_s)
        return self._bytes() + size <= self.limits.all_uploads_bytes

    def _bytes(self) -> int:
        return sum(gate.uploading_bytes for gate in self._gates)

    def gate(self, visitor: Guest) -> Gate:
        """Make the gate of a page, whose uploads are counted from now on."""
        self._gates.append(Gate(visitor, self))
        return self._gates[-1]

    def end(self, gate: Gate) -> None:
        """Forget the uploads of a closed page."""
        self._gates = [other for other in self._gates if other is not gate]


@dataclass
class Gate:
    """Judge of one connection's messages.

    Attributes
    ----------
    visitor : Guest
        Whose messages these are.
    others : Uploading
        Uploads of all visitors.
    """

    visitor: Guest
    others: Uploading
    _uploads: dict[str, _Upload] = field(default_factory=dict)

    @property
    def uploading_bytes(self) -> int:
        """Size of the unfinished uploads."""
        return sum(upload.size for upload in self._uploads.values())

    def give_up_stalled(self, before_s: float) -> None:
        """Give up the uploads of which nothing has come since."""
        for transfer, upload in list(self._uploads.items()):
            if upload.came_s < before_s:
                del self._uploads[transfer]
                self.visitor.forget_upload(transfer)
                self.visitor.end_upload(upload.component, transfer, upload.size)

    def judge(self, frame: bytes | str) -> bytes | None:
        """Return the message to pass on, or None to drop it.

        Parameters
        ----------
        frame : bytes or str
            As received; a page of viser only sends msgpack in binary frames.

        Raises
        ------
        BadFrame
            Not msgpack, not a message of a page, or with fields of the wrong kind.
        """
        kind, fields = _decode(frame)
        if kind in IGNORED_FRAMES:
            return None
        _check_fields(kind, fields)
        judge = _JUDGES.get(kind)
        if judge is not None:
            return judge(self, frame, fields)
        return frame if _all_finite(fields) else None  # pyright: ignore[reportReturnType]

    def _judge_update(self, frame: bytes, fields: dict[str, Any]) -> bytes | None:
        uuid, updates = fields["uuid"], fields["updates"]
        if set(updates) != {"value"}:
            raise BadFrame("only the value of a control may be set")
        control = self.visitor.control(uuid)
        if control is None:
            return None
        given = updates["value"]
        value = self.visitor.meant(uuid, given)
        reason = why_not(control, value, self.others.limits.text_characters)
        if not control.disabled and reason is None:
            changed = {**fields, "type": "GuiUpdateMessage", "updates": {"value": value}}
            return frame if value is given else msgspec.msgpack.encode(changed)
        self.visitor.restore(uuid)
        if not control.disabled:
            name = control.label or Text("The control")
            refusal = Text(
                "{name} must {reason}; {value} was refused.", name=name, reason=reason, value=excerpt(given)
            )
            self.visitor.tell(Text("Not accepted"), refusal)
        return None

    def _judge_hold(self, frame: bytes, fields: dict[str, Any]) -> bytes | None:
        control = self.visitor.control(fields["uuid"])
        return None if control is None or control.disabled else frame

    def _judge_upload(self, frame: bytes, fields: dict[str, Any]) -> bytes | None:
        size, parts, transfer = fields["size_bytes"], fields["part_count"], fields["transfer_uuid"]
        # viser keeps an entry per part: with no empty parts, their number is bounded by the size.
        if size < 0 or not 0 <= parts <= size or (parts == 0) != (size == 0) or transfer in self._uploads:
            raise BadFrame("an upload that cannot be")
        component = fields["source_component_uuid"]
        control = self.visitor.control(component)
        if control is None or control.disabled or not control.takes_files:
            return None
        name = safe_file_name(fields["filename"])
        refusal = self._why_not_upload(size)
        if refusal is not None:
            self.visitor.end_upload(component, transfer, size)
            self.visitor.tell(Text("Not accepted"), f"{name} {refusal}.")
            return None
        if parts:
            self._uploads[transfer] = _Upload(component, size, size, parts, time.monotonic())
        return msgspec.msgpack.encode({**fields, "type": "FileTransferStartUpload", "filename": name})

    def _why_not_upload(self, size: int) -> str | None:
        limits = self.others.limits
        if size > limits.upload_bytes:
            return Text(
                "has {size:.1f} MiB; at most {largest:.0f} MiB are accepted",
                size=size / MIB,
                largest=limits.upload_bytes / MIB,
            )
        many = len(self._uploads) >= limits.uploads_at_once
        if many or self.uploading_bytes + size > limits.upload_bytes:
            return Text("must wait until the other uploads have ended")
        if not self.others.has_room(size):
            return Text("must wait until the uploads of other visitors have ended")
        return None

    def _judge_part(self, frame: bytes, fields: dict[str, Any]) -> bytes | None:
        upload = self._uploads.get(fields["transfer_uuid"])
        if upload is None:
            return None
        index, content = fields["part_index"], fields["content"]
        upload.bytes_left -= len(content)
        upload.came_s = time.monotonic()
        # viser writes the file into whatever control the last part names.
        strange = fields["source_component_uuid"] != upload.component or index in upload.seen
        if strange or not 0 <= index < upload.part_count or not content or upload.bytes_left < 0:
            raise BadFrame("a part that was not announced")
        upload.seen.add(index)
        if len(upload.seen) == upload.part_count:
            del self._uploads[fields["transfer_uuid"]]
        return frame


_JUDGES: Mapping[str, Callable[[Gate, Any, dict[str, Any]], bytes | None]] = {
    "GuiUpdateMessage": Gate._judge_update,
    "GuiButtonHoldMessage": Gate._judge_hold,
    "FileTransferStartUpload": Gate._judge_upload,
    "FileTransferPart": Gate._judge_part,
}


def safe_file_name(name: str) -> str:
    """Return the last part of a path, without control characters, as a name to show and to store under."""
    last = PurePosixPath(name.replace("\\", "/")).name
    kept = "".join(c for c in last if unicodedata.category(c)[0] != "C").strip(" .")
    return kept[-_LONGEST_FILE_NAME:] or "upload"


def _decode(frame: bytes | str) -> tuple[str, dict[str, Any]]:
    if not isinstance(frame, bytes):
        raise BadFrame("text instead of a message")
    try:
        fields = msgspec.msgpack.decode(frame)
    except (msgspec.DecodeError, RecursionError, ValueError):
        raise BadFrame("not a message") from None
    kind = fields.pop("type", None) if isinstance(fields, dict) else None
    if not isinstance(kind, str) or kind not in FRAME_TYPES.keys() | IGNORED_FRAMES:
        raise BadFrame("no message of a page")
    return kind, fields


def _check_fields(kind: str, fields: dict[str, Any]) -> None:
    expected = FRAME_TYPES[kind]
    try:
        # Bytes stay bytes: by default text would be taken for base64.
        msgspec.convert(fields, expected, builtin_types=(bytes,))
    except (msgspec.ValidationError, RecursionError):
        raise BadFrame(f"a {kind} with wrong fields") from None
    if not fields.keys() <= {entry.name for entry in dataclasses.fields(expected)}:
        raise BadFrame(f"a {kind} with unknown fields")


def _all_finite(value: object) -> bool:
    if isinstance(value, float):
        return math.isfinite(value)
    if isinstance(value, dict):
        return all(_all_finite(item) for item in value.values())
    return all(_all_finite(item) for item in value) if isinstance(value, (list, tuple)) else True


_LONGEST_SHOWN = 60


def why_not(control: Control, value: object, longest_text: int) -> str | None:
    """Say what is wrong with a value; None when it fits.

    viser casts with the type of the held value, so that 7.9 would become 7 in a whole-number control and any
    text would become True in a checkbox: types are compared before that.

    Parameters
    ----------
    control : Control
        The control and the value it holds.
    value : object
        As decoded from the message.
    longest_text : int
        Characters a text may have.

    Returns
    -------
    str or None
        A phrase that follows "must": ``be from 0 to 1``.
    """
    held = control.value
    if not isinstance(held, tuple):
        return _why_not_scalar(control, held, value, longest_text)
    if not isinstance(value, (list, tuple)) or len(value) != len(held):
        return Text("have {held} values", held=len(held))
    reasons = (_why_not_scalar(control, old, new, longest_text) for old, new in zip(held, value, strict=True))
    return next((reason for reason in reasons if reason is not None), None)


def excerpt(value: object) -> str:
    """Return a value for a message to the visitor, shortened."""
    text = value if isinstance(value, str) else repr(value)
    return text if len(text) <= _LONGEST_SHOWN else text[: _LONGEST_SHOWN - 3] + "..."


def _why_not_scalar(control: Control, held: object, value: object, longest_text: int) -> str | None:
    if isinstance(held, bool):
        return None if isinstance(value, bool) else Text("be on or off")
    if isinstance(held, (int, float)):
        return _why_not_number(control, isinstance(held, int), value)
    if not isinstance(held, str):
        return Text("not be set in this way")
    if not isinstance(value, str):
        return Text("be text")
    if control.options is not None and value not in control.options:
        return Text("be one of the choices offered")
    if len(value) > longest_text:
        return Text("have at most {longest_text} characters", longest_text=longest_text)
    return None


def _why_not_number(control: Control, whole: bool, value: object) -> str | None:
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        return Text("be a number")
    if whole and value != math.floor(value):
        return Text("be a whole number")
    if control.bounds is not None:
        low, high = control.bounds
        # Browsers compute min + k * step in binary: the last step may lie a rounding error beyond the end.
        slack = 1e-9 * (abs(low) + abs(high))
        if not low - slack <= value <= high + slack:
            return Text("be from {low:g} to {high:g}", low=low, high=high)
    return None

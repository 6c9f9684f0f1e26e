"""The gate every message from a browser passes before viser sees it.

viser writes whatever a message names into its control, calls included; here a message is decoded against
viser's own message types, judged, and passed on, dropped (the visitor is told) or answered by closing that
one connection.
"""

from __future__ import annotations

import dataclasses
import math
import unicodedata
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import PurePosixPath
from typing import Any, Protocol

import msgspec

from app.http.limits import MIB, Limits
from app.http.values import shown, why_not
from app.http.viser_insides import FRAME_TYPES, IGNORED_FRAMES, Control

_LONGEST_FILE_NAME = 120


class BadFrame(Exception):
    """The message is none that a page sends: its connection is to be closed."""


class Visitor(Protocol):
    """What the gate needs of the visitor behind a connection."""

    def control(self, uuid: str) -> Control | None:
        """Return the control with that id, if the visitor has it."""
        ...

    def restore(self, uuid: str) -> None:
        """Show the server's value of a control again."""
        ...

    def end_upload(self, component: str, transfer: str, size: int) -> None:
        """Let the page's progress bar end."""
        ...

    def tell(self, text: str) -> None:
        """Show a short notice."""
        ...


@dataclass
class _Upload:
    component: str
    size: int
    bytes_left: int
    part_count: int
    seen: set[int] = field(default_factory=set)


@dataclass
class Gate:
    """Judge of one connection's messages.

    Attributes
    ----------
    visitor : Visitor
        Whose messages these are.
    limits : Limits
        Sizes.
    """

    visitor: Visitor
    limits: Limits
    _uploads: dict[str, _Upload] = field(default_factory=dict)

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
        updates = fields["updates"]
        if set(updates) != {"value"}:
            raise BadFrame("only the value of a control may be set")
        control = self.visitor.control(fields["uuid"])
        if control is None:
            return None
        if control.disabled:
            self.visitor.restore(fields["uuid"])
            return None
        reason = why_not(control, updates["value"], self.limits.text_characters)
        if reason is None:
            return frame
        self.visitor.restore(fields["uuid"])
        name = control.label or "The control"
        self.visitor.tell(f"{name} must {reason}; {shown(updates['value'])} was not taken over.")
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
            self.visitor.tell(f"{name} {refusal}.")
            return None
        if parts:
            self._uploads[transfer] = _Upload(component, size, size, parts)
        return msgspec.msgpack.encode({**fields, "type": "FileTransferStartUpload", "filename": name})

    def _why_not_upload(self, size: int) -> str | None:
        largest = self.limits.upload_bytes
        if size > largest:
            return f"has {size / MIB:.1f} MiB; at most {largest / MIB:.0f} MiB are accepted"
        waiting = sum(upload.size for upload in self._uploads.values())
        if len(self._uploads) >= self.limits.uploads_at_once or waiting + size > largest:
            return "must wait until the other uploads have ended"
        return None

    def _judge_part(self, frame: bytes, fields: dict[str, Any]) -> bytes | None:
        upload = self._uploads.get(fields["transfer_uuid"])
        if upload is None:
            return None
        index, content = fields["part_index"], fields["content"]
        upload.bytes_left -= len(content)
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

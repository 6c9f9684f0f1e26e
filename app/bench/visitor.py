"""A visitor without a browser: opens the page's websocket, moves controls, waits for the figures."""

import json
import re
import time
from collections.abc import Callable
from html import unescape
from typing import Any, Self

import msgspec
import viser
import zstandard
from websockets.sync.client import connect
from websockets.typing import Origin, Subprotocol

_RUN = re.compile(r'data-run="(\d+)"')
_PICTURE = re.compile(r'data-number="(\d+)"')
_PIECE = 512 * 1024
CAMERA = {
    "type": "ViewerCameraMessage",
    "wxyz": [1, 0, 0, 0],
    "position": [3, 3, 3],
    "fov": 1.3,
    "near": 0.01,
    "far": 1000,
    "image_height": 1080,
    "image_width": 1920,
    "look_at": [0, 0, 0],
    "up_direction": [0, 0, 1],
}
PAGE_PAINTED, PAGE_COMMAND = "page painted", "page command"
PAGE_STATE = "page state"
"""Label of the control through which a browser reports its size and front tabs (schuler_bench.shell.page)."""


class Visitor:
    """One page's websocket, used as a context.

    Parameters
    ----------
    port : int
        Of a server on this machine.
    session : str
        Part of the page's address.
    """

    def __init__(self, port: int, session: str = "bench-session") -> None:
        self._address = f"ws://127.0.0.1:{port}/s/{session}"
        self._origin = f"http://127.0.0.1:{port}"
        self.controls: dict[str, dict[str, Any]] = {}
        """Newest control of each label, as the server described it."""
        self._held: dict[str, Any] = {}
        self.run_number = self.picture_number = self._asked = 0
        self._run_element = ""
        self.notices: list[tuple[str, str]] = []
        """Title and text of every notification that came."""
        self.text = ""
        """Newest text with a scenario in it, from the tab Scenario."""
        self.arrived_s = 0.0
        """When the last byte of the newest run had come, by `time.perf_counter`."""

    def __enter__(self) -> Self:
        self._socket = connect(
            self._address,
            origin=Origin(self._origin),
            subprotocols=[Subprotocol(f"viser-v{viser.__version__}")],
            compression=None,
            max_size=None,
            close_timeout=1,
        )
        self._send(CAMERA)
        return self

    def __exit__(self, *_: object) -> None:
        self._socket.close()

    def set(self, label: str, value: Any) -> float:
        """Set the control with this label; return when that was, by `time.perf_counter`."""
        uuid = self.control(label)["uuid"]
        self._held[uuid] = value
        self._send({"type": "GuiUpdateMessage", "uuid": uuid, "updates": {"value": value}})
        return time.perf_counter()

    def ask(self, command: str, argument: str = "") -> None:
        """Let the server carry out a command of the page."""
        self._asked += 1
        self.set(PAGE_COMMAND, json.dumps([[self._asked, command, argument]]))

    def upload(self, label: str, name: str, content: bytes) -> None:
        """Send a file to the upload button with this label, in pieces, as the page does."""
        component, transfer = self.control(label)["uuid"], f"{name}-{time.monotonic_ns()}"
        parts = [content[at : at + _PIECE] for at in range(0, len(content), _PIECE)]
        shared = {"source_component_uuid": component, "transfer_uuid": transfer}
        start = {"filename": name, "mime_type": "application/octet-stream", "part_count": len(parts)}
        size = {"size_bytes": len(content)}
        self._send({"type": "FileTransferStartUpload", **shared, **start, **size})
        for index, part in enumerate(parts):
            self._send({"type": "FileTransferPart", **shared, "part_index": index, "content": part})

    def control(self, label: str) -> dict[str, Any]:
        """Wait for a control; return the message that made it."""
        self.wait(lambda: label in self.controls, f"a control labelled {label!r}")
        return self.controls[label]

    def held(self, label: str) -> Any:
        """Value that the server last showed in a control."""
        return self._held.get(self.control(label)["uuid"])

    @property
    def metrics(self) -> dict[str, Any]:
        """Metrics that came with the newest run."""
        return json.loads(unescape(self._run_element.partition(">")[2].removesuffix("</div>")))

    def wait_for_run(self, number: int) -> float:
        """Wait until the figures of this or a later run are there; return when their last byte came."""
        self.wait(lambda: self.run_number >= number, f"run {number}")
        return self.arrived_s

    def wait(self, done: Callable[[], bool], what: str, seconds: float = 30.0) -> None:
        """Read until something is so.

        Raises
        ------
        TimeoutError
            It did not happen in time.
        """
        until = time.monotonic() + seconds
        while not done():
            left = until - time.monotonic()
            if left <= 0.0:
                raise TimeoutError(f"the dashboard did not send {what} within {seconds:g} s")
            try:
                self._read(left)
            except TimeoutError:
                continue

    def rest(self, seconds: float) -> None:
        """Keep reading for a while, as a browser does."""
        until = time.monotonic() + seconds
        while (left := until - time.monotonic()) > 0.0:
            try:
                self._read(left)
            except TimeoutError:
                return

    def heard(self, content: str) -> None:
        """Take a piece of HTML or Markdown that came; nothing unless a subclass wants it."""

    def _send(self, message: dict[str, Any]) -> None:
        self._socket.send(msgspec.msgpack.encode(message))

    def _read(self, seconds: float) -> None:
        raw = self._socket.recv(timeout=seconds)
        came = time.perf_counter()
        for message in decoded(bytes(raw)):  # pyright: ignore[reportArgumentType]
            props = message.get("props") or message.get("updates") or {}
            if "label" in props and "uuid" in message and "props" in message:
                self.controls[props["label"]] = message
                self._held[message["uuid"]] = message.get("value")
            elif "value" in props:
                self._held[message["uuid"]] = props["value"]
            if message.get("type") == "NotificationShowMessage":
                self.notices.append((str(props.get("title")), str(props.get("body"))))
            if "content" in props:
                self.heard(str(props["content"]))
            if "[[method]]" in (content := str(props.get("content", ""))):
                self.text = content
            number = _RUN.search(content[:200])
            if number is not None and int(number[1]) > self.run_number:
                self.run_number, self.arrived_s, self._run_element = int(number[1]), came, content
            elif "sb-picture" in content[:40] and (number := _PICTURE.search(content)) is not None:
                self.picture_number = int(number[1])


def decoded(raw: bytes) -> list[dict[str, Any]]:
    """Messages of a frame in viser's wire format: two lengths, then zstd-compressed msgpack."""
    packed = int.from_bytes(raw[8:16], "little")
    inner = zstandard.ZstdDecompressor().decompress(
        raw[16 : 16 + packed], max_output_size=int.from_bytes(raw[:8], "little")
    )
    return msgspec.msgpack.decode(inner)["messages"]

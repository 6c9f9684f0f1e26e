"""How much one visitor, and all of them together, may take."""

from __future__ import annotations

from dataclasses import dataclass

MIB = 1 << 20


@dataclass(frozen=True)
class Limits:
    """Bounds of the server.

    Attributes
    ----------
    visitors : int
        Open pages (websockets); the next one is told that the bench is full.
    sockets : int
        TCP connections of any kind.
    frame_bytes : int
        Largest single message from a browser. viser's page sends uploads in pieces of 512 KiB.
    upload_bytes : int
        Largest uploaded file.
    uploads_at_once : int
        Unfinished uploads of one visitor.
    text_characters : int
        Longest text a control accepts.
    frames_per_second : int
        A browser that sends more is read more slowly; nothing is lost.
    ping_s : float
        A page that answers no ping for twice this long is dropped, and with it all that waits to be sent.
    close_s : float
        How long a closing handshake may take; bounds the time to stop.
    """

    visitors: int = 64
    sockets: int = 256
    frame_bytes: int = 8 * MIB
    upload_bytes: int = 32 * MIB
    uploads_at_once: int = 4
    text_characters: int = 20_000
    frames_per_second: int = 1000
    ping_s: float = 20.0
    close_s: float = 1.0

"""The key that signs the ids of sessions, kept beside them so that a restarted server knows its visitors."""

from __future__ import annotations

import contextlib
import os
import secrets
import stat
from pathlib import Path

_NAME = "session.key"
_BYTES = 32


def session_key(folder: Path | None) -> bytes:
    """Read the key of a state folder, or make one there.

    Parameters
    ----------
    folder : Path or None
        Made if need be. Where nothing can be kept, the key is that of this process alone.
    """
    made = secrets.token_bytes(_BYTES)
    if folder is None:
        return made
    path = folder / _NAME
    with contextlib.suppress(OSError):
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        if not path.exists():
            _place(made, path)
        # A FIFO of that name must not hold up the start.
        handle = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_NOFOLLOW", 0))
        with os.fdopen(handle, "rb") as file:
            kept = file.read(_BYTES + 1) if stat.S_ISREG(os.fstat(handle).st_mode) else b""
        if len(kept) == _BYTES:
            return kept
    return made


def _place(key: bytes, path: Path) -> None:
    """Link a key into its place whole; when two servers start at once, the first one's stays."""
    fresh = path.with_name(f".{secrets.token_hex(8)}.tmp")
    try:
        with os.fdopen(os.open(fresh, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "wb") as file:
            file.write(key)
        with contextlib.suppress(FileExistsError):
            os.link(fresh, path)
    finally:
        fresh.unlink(missing_ok=True)

"""Files that a user names: regular ones only, and of each no more than is allowed.

A pipe would wait for a writer, a device such as ``/dev/zero`` has no end, and a folder holds no text. Every
reader of a scenario, study, map or recording asks here first. What is wrong is an `OSError`, as of `open`.
"""

import errno
import os
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from io import BufferedReader

from navcore.foundation.text import Text

_KINDS = (
    (stat.S_ISDIR, Text("is a folder, not a file")),
    (stat.S_ISFIFO, Text("is a pipe, not a file: write its content to a file first")),
    (stat.S_ISSOCK, Text("is a socket, not a file")),
)
_noted: ContextVar[list[str] | None] = ContextVar("files that are looked at", default=None)
_DEVICE = Text("is a device, not a file")
_MIB = 1 << 20


class NotRegularError(OSError):
    """A folder, pipe, socket or device stands where a file was asked for."""

    @property
    def reason(self) -> str:
        """What it is."""
        return self.strerror or ""


class TooLargeError(OSError):
    """A file holds more than is read."""


@contextmanager
def noting() -> Iterator[list[str]]:
    """Give a list of the files that are read here meanwhile, by their real paths."""
    noted: list[str] = []
    before = _noted.set(noted)
    try:
        yield noted
    finally:
        _noted.reset(before)


def regular(path: str | os.PathLike[str]) -> os.stat_result:
    """Look at a file without opening it.

    Parameters
    ----------
    path : path
        Links are followed.

    Returns
    -------
    os.stat_result
        Of a regular file.

    Raises
    ------
    OSError
        There is none, links lead in a circle, the path is no path, or it is no regular file
        (`NotRegularError`).
    """
    try:
        held = os.stat(path)
    except ValueError:  # a NUL in the path
        raise OSError(errno.EINVAL, os.strerror(errno.EINVAL), str(path)) from None
    _require_regular(held, path)
    if (noted := _noted.get()) is not None:
        noted.append(os.path.realpath(path))
    return held


def opened(path: str | os.PathLike[str]) -> BufferedReader:
    """Open a regular file for reading; never waits, whatever takes its place meanwhile.

    Raises
    ------
    OSError
        See `regular`; or it may not be read.
    """
    regular(path)  # opening alone moves a tape
    handle = os.open(path, os.O_RDONLY | os.O_CLOEXEC | os.O_NONBLOCK)
    try:
        _require_regular(os.fstat(handle), path)
        return os.fdopen(handle, "rb")
    except BaseException:
        os.close(handle)
        raise


def read_bytes(path: str | os.PathLike[str], most: int) -> bytes:
    """Read a regular file.

    Parameters
    ----------
    path : path
        The file.
    most : int
        Bytes that it may hold.

    Raises
    ------
    OSError
        See `opened`; `TooLargeError` for a file of more bytes.
    """
    with opened(path) as stream:
        size = os.fstat(stream.fileno()).st_size
        # Files of the kernel give no size and may wait for events: they count as empty.
        content = stream.read(most + 1) if 0 < size <= most else b""
    if max(size, len(content)) > most:
        raise TooLargeError(errno.EFBIG, _too_large(most), str(path))
    return content


def _require_regular(held: os.stat_result, path: str | os.PathLike[str]) -> None:
    if not stat.S_ISREG(held.st_mode):
        kind = next((text for is_kind, text in _KINDS if is_kind(held.st_mode)), _DEVICE)
        raise NotRegularError(errno.EINVAL, kind, str(path))


def _too_large(most: int) -> str:
    if most >= _MIB:
        return Text("is larger than {most} MiB", most=most // _MIB)
    return Text("is larger than {most} bytes", most=most)

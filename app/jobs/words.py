"""The words in which a page reports a fault: file names, never a place on the server."""

import re
from dataclasses import replace

from navcore.foundation.errors import InputError

_FOLDERS = re.compile(r"(?<![\w./])/(?>(?:[^/\s'\":]++/)+)")


def without_folders(text: str) -> str:
    """The text with each absolute path shortened to its last part.

    Examples
    --------
    >>> without_folders("reference.file = '/var/lib/x/log.csv': no such file, 3 m/s")
    "reference.file = 'log.csv': no such file, 3 m/s"
    """
    return text if _FOLDERS.search(text) is None else _FOLDERS.sub("", text)


def what_failed(error: BaseException) -> str:
    """An exception in words, without the folders of the server.

    Examples
    --------
    >>> what_failed(PermissionError(13, "Permission denied", "/opt/kernels/digests"))
    'PermissionError: Permission denied'
    """
    if isinstance(error, InputError):
        return "\n".join(str(fault) for fault in for_a_page(error).faults)
    words = error.strerror if isinstance(error, OSError) else None
    return f"{type(error).__name__}: {without_folders(words or str(error))}"


def for_a_page(error: InputError) -> InputError:
    """The same faults without the folders of the server."""

    def plain(value: object) -> object:
        if isinstance(value, str):
            return without_folders(value)
        return [plain(item) for item in value] if isinstance(value, (list, tuple)) else value

    return InputError(
        replace(fault, **{name: plain(getattr(fault, name)) for name in ("where", "value", "allowed")})
        for fault in error.faults
    )

"""Faults of ``--out``: a path that cannot be used."""

from collections.abc import Collection, Iterator
from contextlib import contextmanager
from pathlib import Path

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text


def refused(path: Path, reason: str) -> InputError:
    """Return the fault of a file or folder that is not written to."""
    return InputError(Fault("--out", "", str(path), reason))


def require_own(folder: Path, names: Collection[str]) -> None:
    """Refuse a folder with files of other names; raises `InputError`."""
    try:
        foreign = sorted(path.name for path in folder.iterdir() if path.name not in names)
    except FileNotFoundError:
        return
    except OSError as error:
        raise refused(folder, Text("cannot be read: {strerror}", strerror=error.strerror or error)) from None
    if foreign:
        raise refused(
            folder, Text("holds what this command did not write: {names}", names=", ".join(foreign[:3]))
        )


@contextmanager
def writing(path: Path) -> Iterator[None]:
    """Tell what keeps a file or folder from being written, as a fault of ``--out``."""
    try:
        yield
    except OSError as error:
        raise refused(path, Text("cannot be written: {strerror}", strerror=error.strerror or error)) from None

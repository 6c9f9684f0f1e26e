"""Faults of ``--out``: a path that cannot be used."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text


def refused(path: Path, reason: str) -> InputError:
    """Return the fault of a file or folder that is not written to."""
    return InputError(Fault("--out", "", str(path), reason))


@contextmanager
def writing(path: Path) -> Iterator[None]:
    """Tell what keeps a file or folder from being written, as a fault of ``--out``."""
    try:
        yield
    except OSError as error:
        raise refused(path, Text("cannot be written: {strerror}", strerror=error.strerror or error)) from None

"""CSV files out: replaced without ``--force`` only where they begin with the heading of the new one."""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path

from navcore.foundation.inputs import read_bytes
from navcore.foundation.out import (
    OUT,
    PathLike,
    identities,
    refused,
    require_replaceable,
    require_writable,
    utf8,
    whole,
    writing,
)
from navcore.foundation.text import Text

_MOST_BYTES = 1 << 28


def require_table(
    target: PathLike,
    heading: str,
    reads: Iterable[PathLike] = (),
    *,
    force: bool = False,
    option: str = OUT,
) -> None:
    """Refuse a CSV file that cannot be written or must not be replaced: one that begins otherwise.

    Parameters
    ----------
    target : path
        May be missing; its folder must be there.
    heading : str
        First line, by which a file is known: a comment in front would be read as a row.
    reads, force, option
        See `require_file`.

    Raises
    ------
    InputError
        See `require_file`.
    """
    target = Path(target)
    with writing(target, option):
        if os.path.lexists(target):
            require_replaceable(target, identities(reads), option, force=force)
            if not force and read_bytes(target, _MOST_BYTES).split(b"\n")[0].strip() != heading.encode():
                allowed = Text(
                    "is there already, and is not such a table: give another name, or --force to replace it"
                )
                raise refused(target, allowed, option)
        elif not target.parent.exists():
            raise refused(target, Text("cannot be written: there is no such folder"), option)
        require_writable(target.parent, option, target)


def write_table(
    target: PathLike,
    text: str,
    heading: str,
    reads: Iterable[PathLike] = (),
    *,
    force: bool = False,
    option: str = OUT,
) -> None:
    """Write a CSV file that begins with its heading; see `require_table`."""
    require_table(target, heading, reads, force=force, option=option)
    with writing(target, option), whole(Path(target)) as stream:
        stream.write(utf8(text, option))

"""CSV files out: replaced without ``--force`` only where they begin with the heading of the new one."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from navcore.foundation.inputs import read_bytes
from navcore.foundation.out import OUT, PathLike, require_own, utf8, whole, writing
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
    allowed = Text("is there already, and is not such a table: give another name, or --force to replace it")

    def own(path: Path) -> bool:
        return read_bytes(path, _MOST_BYTES).split(b"\n")[0].strip() == heading.encode()

    require_own(target, own, allowed, reads, force=force, option=option)


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

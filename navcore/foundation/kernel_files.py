"""Files and folders of machine code: all may read them, their owner alone may write to them.

What lies there is loaded as code. Another ordinary user's files, and whatever others can write to, are
therefore never used; modes are set here, whatever the umask.
"""

import os
import stat
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO

_FOLDER, _FILE = 0o755, 0o644
_WRITABLE_BY_OTHERS = 0o022


def distrust(path: Path, *, shared: bool = False) -> str:
    """Say why a file or folder is not used; empty for one that only this user or root can write to.

    Parameters
    ----------
    path : Path
        File or folder.
    shared : bool
        A folder in which others may write, but not rename what is mine (as in ``/tmp``), will do.

    Raises
    ------
    OSError
        It is missing, or lies in a folder that cannot be searched.
    """
    held = path.stat()
    if held.st_uid not in (0, os.getuid()):
        return "belongs to another user"
    if held.st_mode & _WRITABLE_BY_OTHERS and not (shared and held.st_mode & stat.S_ISVTX):
        return "can be written to by others"
    return ""


def make_folder(folder: Path) -> None:
    """Make a folder that everyone may read, and its parent likewise, unless they are there.

    Raises
    ------
    OSError
        It cannot be made.
    """
    for path in (folder.parent, folder):
        try:
            path.mkdir(_FOLDER, parents=True)
        except FileExistsError:
            continue
        path.chmod(_FOLDER)


def refusal(folder: Path) -> str:
    """Make a folder if need be, and say why machine code cannot be kept in it; empty when it can."""
    try:
        make_folder(folder)
        if reason := distrust(folder.parent, shared=True) or distrust(folder):
            return reason
        if folder.stat().st_uid != os.getuid():
            return "belongs to another user"
        with tempfile.TemporaryFile(dir=folder):
            return ""
    except OSError as error:
        return f"cannot be written to ({error.strerror})"


@contextmanager
def replacing(path: Path) -> Iterator[IO[bytes]]:
    """Give a file that takes the place of another once it is complete.

    Raises
    ------
    OSError
        It cannot be written; what was there before stays.
    """
    with tempfile.NamedTemporaryFile(dir=path.parent, prefix=".", delete=False) as file:
        try:
            yield file
            file.flush()
            os.chmod(file.name, _FILE)
            os.replace(file.name, path)
        except BaseException:
            os.unlink(file.name)
            raise


def untrusted(folder: Path) -> str:
    """Say why a folder with all its files is not used; empty when it can be.

    Raises
    ------
    OSError
        See `distrust`.
    """
    parts = (distrust(path) for path in (folder, *folder.rglob("*")))
    return distrust(folder.parent, shared=True) or next(filter(None, parts), "")

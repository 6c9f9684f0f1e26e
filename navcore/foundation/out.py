"""Files out: a command replaces files of its own names alone, whole or not at all, and none that it reads.

A command asks before it computes (`require_folder`, `require_file`), with the files that it reads, and writes
by `placing` or `write_file`, which look again. A folder may hold whatever else it likes. A single file is
replaced without ``--force`` only where its first lines show that the same command wrote it and that nobody
has edited it since.
"""

from __future__ import annotations

import fcntl
import hashlib
import os
import re
import secrets
import shutil
import stat
from collections.abc import Callable, Collection, Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.inputs import read_bytes
from navcore.foundation.text import Text

HIDDEN = ".schuler-"
"""Begins the names of files and folders that are not complete."""
OUT = "--out"
_SIGNED = re.compile(rb"Written by schuler (\S+); digest ([0-9a-f]{16})")
_MOST_SIGNED_BYTES = 1 << 28
_FIRST_LINES = 3
_WRITABLE = stat.S_IWUSR | stat.S_IWGRP | stat.S_IWOTH

PathLike = str | os.PathLike[str]


def refused(path: PathLike, reason: str, option: str = OUT) -> InputError:
    """Return the fault of a file or folder that is not written to."""
    return InputError(Fault(option, "", str(path), reason))


@contextmanager
def writing(path: PathLike, option: str = OUT) -> Iterator[None]:
    """Tell what keeps a file or folder from being written, as a fault of the option that names it."""
    try:
        yield
    except OSError as error:
        reason = Text("cannot be written: {strerror}", strerror=error.strerror or error)
        raise refused(path, reason, option) from None


# ---------------------------------------------------------------- folders


def require_folder(folder: PathLike, names: Iterable[str], reads: Iterable[PathLike] = ()) -> None:
    """Refuse a folder in which files of these names cannot be written or must not be replaced.

    Parameters
    ----------
    folder : path
        May be missing; files of other names in it do not matter.
    names : iterable of str
        Of the files that will be written.
    reads : iterable of path
        Files that the command reads.

    Raises
    ------
    InputError
        It is no folder, it cannot be written, or at one of the names lies a folder, a link, a pipe, a
        write-protected file or a file that the command reads.
    """
    folder = Path(folder)
    with writing(folder):
        if os.path.lexists(folder):
            if not folder.exists():
                raise refused(folder, Text("is a link that leads nowhere"))
            if not folder.is_dir():
                raise refused(folder, Text("exists and is not a folder"))
            known = identities(reads)
            for name in names:
                require_replaceable(folder / name, known)
        require_writable(folder)


@contextmanager
def placing(folder: PathLike, names: Collection[str], reads: Collection[PathLike] = ()) -> Iterator[Path]:
    """Give a hidden folder whose files get their place in ``folder`` once all of them are complete.

    Parameters
    ----------
    folder : path
        Made with its parents when missing.
    names, reads
        See `require_folder`; only files of these names may be made.

    Raises
    ------
    InputError
        See `require_folder`, or it cannot be written (disk full, read-only); what was there then stays.
    """
    require_folder(folder, names, reads)
    target = Path(os.path.realpath(folder))
    with writing(folder):
        made = not target.exists()
        target.mkdir(parents=True, exist_ok=True)
        try:
            with _hidden_folder(target) as hidden:
                yield hidden
                complete = sorted(os.listdir(hidden))
                assert set(complete) <= set(names)
                require_folder(target, complete, reads)
                _replace_all(hidden, target, complete)
        except BaseException:
            if made:
                with suppress(OSError):
                    target.rmdir()
            raise


@contextmanager
def _hidden_folder(target: Path) -> Iterator[Path]:
    """Make a folder that is locked while it is in use, and remove those that a kill has left."""
    for left in target.glob(f"{HIDDEN}*"):
        if left.is_dir() and not left.is_symlink():
            with suppress(OSError), _locked(left):
                shutil.rmtree(left, ignore_errors=True)
    hidden = target / f"{HIDDEN}{secrets.token_hex(4)}"
    hidden.mkdir()
    try:
        with _locked(hidden):
            yield hidden
    finally:
        shutil.rmtree(hidden, ignore_errors=True)


@contextmanager
def _locked(folder: Path) -> Iterator[None]:
    """Hold a lock on a folder; raises OSError where another process holds it."""
    handle = os.open(folder, os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW)
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        yield
    finally:
        os.close(handle)


def _replace_all(hidden: Path, target: Path, names: list[str]) -> None:
    """Give complete files their names; where that fails for one, the earlier ones come back."""
    earlier = hidden / "earlier"
    earlier.mkdir()
    for name in names:
        _flush(hidden / name)
        with suppress(OSError):  # nothing there, or a file system without hard links
            os.link(target / name, earlier / name, follow_symlinks=False)
    placed: list[str] = []
    try:
        for name in names:
            os.replace(hidden / name, target / name)
            placed.append(name)
    except BaseException:
        for name in placed:
            with suppress(OSError):
                if (earlier / name).exists():
                    os.replace(earlier / name, target / name)
        raise


# ---------------------------------------------------------------- single files


def require_file(
    target: PathLike,
    command: str,
    reads: Iterable[PathLike] = (),
    *,
    force: bool = False,
    option: str = OUT,
) -> None:
    """Refuse a file that cannot be written or must not be replaced.

    Parameters
    ----------
    target : path
        May be missing; its folder must be there.
    command : str
        Name of the command that will write it.
    reads : iterable of path
        Files that the command reads.
    force : bool
        Replace a file that the command has not written, too.
    option : str
        Named in faults.

    Raises
    ------
    InputError
        No file can be written there; a folder, a link or a pipe lies there; the command reads the file; or,
        without ``force``, the file is write-protected, or is none that the command wrote and that was not
        edited since.
    """
    allowed = Text(
        "is there already, and is not what schuler {command} wrote (or was edited since): give "
        "another name, or --force to replace it",
        command=command,
    )
    require_own(target, lambda path: written_by(command, path), allowed, reads, force=force, option=option)


def require_own(
    target: PathLike,
    own: Callable[[Path], bool],
    allowed: str,
    reads: Iterable[PathLike] = (),
    *,
    force: bool = False,
    option: str = OUT,
) -> None:
    """Refuse a file that cannot be written, or that is there and is not one's own.

    Parameters
    ----------
    own : callable
        Whether a file that is there may be replaced without ``force``.
    allowed : str
        Said of one that may not.
    target, reads, force, option
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
            if not force and not own(target):
                raise refused(target, allowed, option)
        elif not target.parent.exists():
            raise refused(target, Text("cannot be written: there is no such folder"), option)
        require_writable(target.parent, option, target)


def write_file(
    target: PathLike,
    text: str,
    command: str,
    reads: Iterable[PathLike] = (),
    *,
    force: bool = False,
    option: str = OUT,
    comment: str = "# {}",
) -> None:
    """Write a text file, with a comment by which the command knows it again.

    Parameters
    ----------
    text : str
        Content.
    comment : str
        How the format writes a comment: ``"<!-- {} -->"`` for HTML, say.
    target, command, reads, force, option
        See `require_file`.

    Raises
    ------
    InputError
        See `require_file`; what was there before stays.
    """
    require_file(target, command, reads, force=force, option=option)
    utf8(text, option)
    with writing(target, option), whole(Path(target)) as stream:
        stream.write(signed(text, command, comment).encode())


def utf8(text: str, option: str = OUT) -> bytes:
    """Return a text as it is written.

    Raises
    ------
    InputError
        It quotes a path that is no UTF-8, as old disks have them; its line is named.
    """
    try:
        return text.encode()
    except UnicodeEncodeError as error:
        line = text[: error.start].rpartition("\n")[2] + text[error.start :].partition("\n")[0]
        allowed = Text("is no UTF-8 text and cannot be written: rename the file or folder")
        raise InputError(Fault(option, "", line, allowed)) from None


def signed(text: str, command: str, comment: str = "# {}") -> str:
    """Put a comment in front of a text that names the command, and the digest of the text.

    Examples
    --------
    >>> signed("title = 1", "tune").splitlines()
    ['# Written by schuler tune; digest 18eedd0d53ee53b1', 'title = 1']
    """
    return f"{comment.format(f'Written by schuler {command}; digest {_digest(text.encode())}')}\n{text}"


def written_by(command: str, path: PathLike) -> bool:
    """Whether a file is what a command wrote by `signed`, unchanged."""
    try:
        lines = read_bytes(path, _MOST_SIGNED_BYTES).splitlines(keepends=True)
    except OSError:
        return False
    for place, line in enumerate(lines[:_FIRST_LINES]):
        if found := _SIGNED.search(line):
            rest = b"".join(lines[:place] + lines[place + 1 :])
            return found.groups() == (command.encode(), _digest(rest).encode())
    return False


@contextmanager
def whole(path: Path, within: Path | None = None) -> Iterator[IO[bytes]]:
    """Give a file that takes its name, and the place of another, once it is complete.

    Parameters
    ----------
    path : Path
        Its place.
    within : Path, optional
        Folder in which it lies until then, on the same file system; by default that of ``path``.

    Raises
    ------
    OSError
        It cannot be written; what was there before stays.
    """
    hidden = (within or path.parent) / f"{HIDDEN}{secrets.token_hex(4)}"
    try:
        with hidden.open("xb") as stream:
            yield stream
            stream.flush()
            os.fsync(stream.fileno())
        os.replace(hidden, path)
    except BaseException:
        hidden.unlink(missing_ok=True)
        raise


# ---------------------------------------------------------------- both


def identities(paths: Iterable[PathLike]) -> frozenset[tuple[int, int]]:
    """Device and number of files, by which the system knows them whatever their paths, links and letters."""
    found: set[tuple[int, int]] = set()
    for path in paths:
        with suppress(OSError, ValueError):
            held = os.stat(path)
            found.add((held.st_dev, held.st_ino))
    return frozenset(found)


def require_replaceable(
    path: Path, known: frozenset[tuple[int, int]], option: str = OUT, *, force: bool = False
) -> None:
    """Refuse to replace what is no file, write-protected, or read by the command."""
    try:
        held = os.lstat(path)
    except FileNotFoundError:
        return
    if stat.S_ISLNK(held.st_mode):
        raise refused(path, Text("is a link, which is not replaced"), option)
    if stat.S_ISDIR(held.st_mode):
        raise refused(path, Text("is a folder, and a file is to be written there"), option)
    if not stat.S_ISREG(held.st_mode):
        raise refused(path, Text("is not a file, and is not replaced"), option)
    if (held.st_dev, held.st_ino) in known:
        raise refused(path, Text("is read by this command, which does not replace it"), option)
    if not force and not held.st_mode & _WRITABLE:
        raise refused(path, Text("is write-protected"), option)


def require_writable(folder: Path, option: str = OUT, named: Path | None = None) -> None:
    """Refuse a folder in which nothing can be made; of a missing one, that in which it will be made."""
    there = Path(os.path.abspath(folder))
    while not os.path.lexists(there):
        there = there.parent
    if not there.is_dir():
        raise refused(named or folder, Text("{place} is not a folder", place=there), option)
    if not os.access(there, os.W_OK | os.X_OK):
        denied = Text("cannot be written: {place} is write-protected", place=there)
        raise refused(named or folder, denied, option)


def _flush(path: Path) -> None:
    """Have a file on the disk before it gets its name."""
    with path.open("rb") as stream:
        os.fsync(stream.fileno())


def _digest(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()[:16]

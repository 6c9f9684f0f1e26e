"""Folders of the state, reached by handles: no link is followed, and only what is ours is changed."""

import errno
import logging
import os
import re
import secrets
import shutil
import stat
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from io import BufferedReader, BufferedWriter
from pathlib import Path

from navcore.foundation.errors import Fault, InputError
from schuler_bench.http.ids import log_name

_FOLDER = os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW
TEMPORARY = re.compile(r"\.[0-9a-f]{16}\.tmp")
CONTENT = re.compile(r"[0-9a-f]{64}")
FILES = re.compile(r"[A-Za-z0-9_-]{1,64}\.files")
STUDY = re.compile(r"[A-Za-z0-9_-]{1,64}\.study")
PUT_ASIDE = re.compile(r"sessions\.(broken|newer)-\d+")
_FILES_OF_STATE = re.compile(
    rf"lock|session\.key|(sessions\.sqlite|{PUT_ASIDE.pattern})(-wal|-shm|-journal)?|{TEMPORARY.pattern}"
)
_FOLDERS_OF_STATE = re.compile("|".join(("content", FILES.pattern, STUDY.pattern)))
OF_A_SESSION = re.compile(f"{FILES.pattern}|{STUDY.pattern}")
_ELSEWHERE = "or set XDG_STATE_HOME to another folder"
_log = logging.getLogger("schuler.store")


def temporary_name() -> str:
    """Name for a file that is not in its place yet."""
    return f".{secrets.token_hex(8)}.tmp"


class Folder:
    """An open folder: everything in it is reached by its handle, and no link is followed.

    Parameters
    ----------
    handle : int
        Of the folder.
    """

    def __init__(self, handle: int) -> None:
        self.handle = handle

    def names(self) -> list[str]:
        """Names of all entries."""
        return os.listdir(self.handle)

    def state(self, name: str) -> os.stat_result | None:
        """State of an entry, of a link that of the link; None when there is none."""
        with suppress(FileNotFoundError):
            return os.stat(name, dir_fd=self.handle, follow_symlinks=False)
        return None

    def file(self, name: str) -> os.stat_result | None:
        """State of a file of ours; None when there is none of that name."""
        state = self.state(name)
        return state if state is not None and _is_ours(state) else None

    def files(self, named: Callable[[str], object] = bool) -> dict[str, os.stat_result]:
        """States of the files of ours whose name is accepted."""
        states = ((name, self.file(name)) for name in self.names() if named(name))
        return {name: state for name, state in states if state is not None}

    def open(self, name: str, flags: int = os.O_RDONLY) -> int:
        """Open a file of ours; its handle.

        Raises
        ------
        OSError
            There is none, or something else is in its place.
        """
        # Without O_NONBLOCK a FIFO would hold this up for ever.
        handle = os.open(name, flags | os.O_NOFOLLOW | os.O_NONBLOCK, 0o600, dir_fd=self.handle)
        if not _is_ours(os.fstat(handle)):
            os.close(handle)
            raise _not_ours()
        return handle

    def read(self, name: str) -> BufferedReader:
        """Open a file of ours to read it; raises OSError as `open`."""
        return os.fdopen(self.open(name), "rb")

    def create(self, name: str) -> BufferedWriter:
        """Make a file to write it; raises OSError where something has that name."""
        return os.fdopen(self.open(name, os.O_WRONLY | os.O_CREAT | os.O_EXCL), "wb")

    def link(self, name: str, target: "Folder", new: str) -> None:
        """Give a file of ours a further name in another folder; raises OSError where something has it."""
        options = {"src_dir_fd": self.handle, "dst_dir_fd": target.handle, "follow_symlinks": False}
        os.link(name, new, **options)

    def place(self, name: str, new: str) -> None:
        """Rename a file, in place of a file of ours if there is one.

        Raises
        ------
        OSError
            Something that is not ours is in its place.
        """
        before = self.state(new)
        if before is not None and not _is_ours(before):
            raise _not_ours()
        os.replace(name, new, src_dir_fd=self.handle, dst_dir_fd=self.handle)
        self.discard(name)  # two names of one content: to replace one by the other does nothing

    def discard(self, name: str) -> None:
        """Remove a file that this process has made a moment ago, if it is still there."""
        with suppress(FileNotFoundError):
            os.unlink(name, dir_fd=self.handle)

    def remove(self, name: str, what: str) -> None:
        """Remove a file of ours, with a line in the log that says what it was."""
        os.unlink(name, dir_fd=self.handle)
        _log.info("removed %s", what)


@contextmanager
def opened(path: Path, *, make: bool = False) -> Iterator[Folder]:
    """Open a folder of ours; neither it nor the one that it stands in may be a link.

    Parameters
    ----------
    path : Path
        The folder.
    make : bool
        Make it if it is not there, for this user alone.

    Raises
    ------
    OSError
        There is none, it is a link or belongs to another user.
    """
    above = os.open(path.parent, _FOLDER)
    try:
        if make:
            with suppress(FileExistsError):
                os.mkdir(path.name, 0o700, dir_fd=above)
        handle = os.open(path.name, _FOLDER, dir_fd=above)
    finally:
        os.close(above)
    try:
        if os.fstat(handle).st_uid != os.getuid():
            raise PermissionError(errno.EPERM, "it belongs to another user")
        yield Folder(handle)
    finally:
        os.close(handle)


@contextmanager
def alone(folder: Folder) -> Iterator[None]:
    """Wait until no other process is within this for the same folder."""
    try:
        import fcntl
    except ImportError:  # not on this platform
        yield
        return
    fcntl.flock(folder.handle, fcntl.LOCK_EX)
    try:
        yield
    finally:
        fcntl.flock(folder.handle, fcntl.LOCK_UN)


def link_files(source: Path, target: Path) -> None:
    """Give a session the files of another one without copying their contents, where the system can.

    Raises
    ------
    OSError
        There is no room, or something that is not ours is in the place of a folder or a file.
    """
    with suppress(FileNotFoundError), opened(source) as own, opened(target, make=True) as other:
        for name, state in own.files(lambda name: not name.startswith(".")).items():
            there, fresh = other.file(name), temporary_name()
            if there is not None and (there.st_size, there.st_mtime_ns) == (state.st_size, state.st_mtime_ns):
                continue
            try:
                own.link(name, other, fresh)
            except OSError:  # other file systems, or no links on this one
                with own.read(name) as original, other.create(fresh) as copy:
                    shutil.copyfileobj(original, copy)
                    os.utime(copy.fileno(), ns=(state.st_atime_ns, state.st_mtime_ns))
            other.place(fresh, name)


def remove_files(path: Path) -> None:
    """Remove a session's folder with the files in it; what is not ours stays, and the folder with it."""
    name = f"files of session {log_name(path.stem)}"
    try:
        with opened(path) as folder:
            ours = folder.files()
            for file in ours:
                folder.discard(file)
            _log.info("removed %d %s", len(ours), name)
            os.rmdir(path)
    except FileNotFoundError:
        return
    except OSError as error:
        _log.warning("%s cannot be removed: %s", name, error.strerror)


def remove_study(path: Path) -> None:
    """Remove a kept study; what is not ours stays, and the folder with it."""
    try:
        with opened(path) as folder:
            empty_study(folder, path)
        os.rmdir(path)
        _log.info("removed study of session %s", log_name(path.stem))
    except FileNotFoundError:
        return
    except OSError as error:
        _log.warning("study of session %s cannot be removed: %s", log_name(path.stem), error.strerror)


def empty_study(folder: Folder, path: Path) -> None:
    """Remove the files of a kept study from its open folder."""
    from navcore.study.results import PARTS

    for name in folder.files():
        folder.discard(name)
    with suppress(FileNotFoundError):
        with opened(path / PARTS) as parts:
            for name in parts.files():
                parts.discard(name)
        os.rmdir(PARTS, dir_fd=folder.handle)


def bytes_of(path: Path) -> int:
    """Room that a kept study takes."""
    from navcore.study.results import PARTS

    total = 0
    for place in (path, path / PARTS):
        with suppress(OSError), opened(place) as folder:
            total += sum(state.st_size for state in folder.files().values())
    return total


def refuse_others(path: Path) -> None:
    """Refuse a state folder in which something else is in the place of something of ours.

    Parameters
    ----------
    path : Path
        Need not exist.

    Raises
    ------
    InputError
        One fault for each link, entry of another kind or of another user, with its path and what to do.
    """
    faults = _faults(path.parent, stat.S_ISDIR, any_owner=True) or _faults(path, stat.S_ISDIR)
    with suppress(OSError):  # whoever may not read it may not write it: `open_store` says so
        for name in [] if faults else sorted(os.listdir(path)):
            if _FILES_OF_STATE.fullmatch(name) or _FOLDERS_OF_STATE.fullmatch(name):
                fits = stat.S_ISREG if _FILES_OF_STATE.fullmatch(name) else stat.S_ISDIR
                faults += _faults(path / name, fits)
        content = path / "content"
        for name in [] if faults else sorted(filter(CONTENT.fullmatch, os.listdir(content))):
            faults += _faults(content / name, stat.S_ISREG)
    if faults:
        raise InputError(faults)


def _faults(path: Path, fits: Callable[[int], bool], *, any_owner: bool = False) -> list[Fault]:
    """Say what is wrong with an entry that bears a name of ours."""
    try:
        state = path.lstat()
    except OSError:
        return []
    # The name of a session's folder opens the session: its beginning is enough to find it.
    shown = path.with_name(f"{path.stem[:6]}*{path.suffix}") if OF_A_SESSION.fullmatch(path.name) else path
    wanted = "file" if fits is stat.S_ISREG else "folder"
    if stat.S_ISLNK(state.st_mode):
        how = f"is a link, which is not followed: put the {wanted} itself there, {_ELSEWHERE}"
    elif not fits(state.st_mode):
        how = f"is no {wanted}: move it away, {_ELSEWHERE}"
    elif state.st_uid != os.getuid() and not any_owner:
        ids = f"user {state.st_uid}, the server runs as user {os.getuid()}"
        how = f"belongs to {ids}: change its owner, {_ELSEWHERE}"
    else:
        return []
    return [Fault(str(shown), "", None, how)]


def _is_ours(state: os.stat_result) -> bool:
    return stat.S_ISREG(state.st_mode) and state.st_uid == os.getuid()


def _not_ours() -> OSError:
    return OSError(errno.EEXIST, "something that is not ours is in the place of a file")

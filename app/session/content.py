"""Contents of uploaded files: each kept once, however many sessions link to it."""

import hashlib
import os
import re
import shutil
import stat
import time
from pathlib import Path

_UNLINKED_S = 3600.0
_CONTENT = re.compile(r"[0-9a-f]{64}")


class Contents:
    """A folder of contents, named after their hash.

    A file in a session's folder is a hard link to its content: it has a name and a place of its own, takes no
    room of its own, and the content stays as long as anybody links to it.

    Parameters
    ----------
    folder : Path
        Made when the first content comes; on one file system with the sessions' folders.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def keep_once(self, path: Path) -> None:
        """Let a file share its content with every equal one; where links cannot be made it stays as it is."""
        with path.open("rb") as file:
            content = self.folder / hashlib.file_digest(file, "sha256").hexdigest()
        try:
            self.folder.mkdir(mode=0o700, exist_ok=True)
            if not content.exists():
                os.link(path, content)
                return
            if os.path.samefile(path, content):
                return
            fresh = path.with_name(f".{path.name}.link")
            fresh.unlink(missing_ok=True)
            os.link(content, fresh)
            fresh.replace(path)
        except OSError:
            return

    def bytes(self) -> int:
        """Room that all contents take."""
        try:
            return sum(entry.stat().st_size for entry in os.scandir(self.folder) if entry.is_file())
        except FileNotFoundError:
            return 0

    def remove_unused(self) -> None:
        """Remove the contents that no session links to any more; nothing of another name, or elsewhere.

        Raises
        ------
        OSError
            The folder is a link, or cannot be read.
        """
        try:
            folder = os.open(self.folder, os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW)
        except FileNotFoundError:
            return
        try:
            for name in filter(_CONTENT.fullmatch, os.listdir(folder)):
                state = os.stat(name, dir_fd=folder, follow_symlinks=False)
                unused = stat.S_ISREG(state.st_mode) and state.st_nlink == 1
                if unused and time.time() - state.st_ctime > _UNLINKED_S:
                    os.unlink(name, dir_fd=folder)
        finally:
            os.close(folder)


def link_files(source: Path, target: Path) -> None:
    """Give a session the files of another one without copying their contents, where the system can."""
    if not source.is_dir():
        return
    target.mkdir(mode=0o700, parents=True, exist_ok=True)
    for path in source.iterdir():
        if path.name.startswith(".") or path.is_symlink() or not path.is_file():
            continue
        there = target / path.name
        there.unlink(missing_ok=True)
        try:
            os.link(path, there)
        except OSError:
            shutil.copy2(path, there)

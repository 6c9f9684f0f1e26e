"""Contents of uploaded files: each kept once, however many sessions link to it."""

import hashlib
import os
import time
from pathlib import Path

from schuler_bench.session.folder import CONTENT, opened, temporary_name

_UNLINKED_S = 3600.0


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
        try:
            with opened(path.parent) as own, opened(self.folder, make=True) as kept:
                with own.read(path.name) as file:
                    content, state = hashlib.file_digest(file, "sha256").hexdigest(), os.fstat(file.fileno())
                there = kept.file(content)
                if there is None:
                    own.link(path.name, kept, content)
                elif not os.path.samestat(state, there):
                    fresh = temporary_name()
                    kept.link(content, own, fresh)
                    own.place(fresh, path.name)
        except OSError:
            return

    def bytes(self) -> int:
        """Room that all contents take."""
        try:
            with opened(self.folder) as kept:
                return sum(state.st_size for state in kept.files().values())
        except OSError:
            return 0

    def remove_unused(self) -> None:
        """Remove the contents that no session links to any more; nothing of another name, or elsewhere.

        Raises
        ------
        OSError
            The folder is a link, or cannot be read.
        """
        try:
            with opened(self.folder) as kept:
                for name, state in kept.files(CONTENT.fullmatch).items():
                    if state.st_nlink == 1 and time.time() - state.st_ctime > _UNLINKED_S:
                        kept.remove(name, f"content {name}, which no session uses any more")
        except FileNotFoundError:
            return

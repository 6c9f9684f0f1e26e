"""Contents of uploaded files: each kept once, however many sessions link to it."""

import hashlib
import os
from collections.abc import Iterable
from pathlib import Path

from schuler_bench.session.folder import CONTENT, opened, temporary_name

UNLINKED_S = 3600.0
"""So long a server must have served since no session links to a content."""


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

    def unused(self) -> set[str]:
        """Names of the contents that no session links to; nothing of another name, or elsewhere.

        Raises
        ------
        OSError
            The folder is a link, or cannot be read.
        """
        try:
            with opened(self.folder) as kept:
                return {name for name, state in kept.files(CONTENT.fullmatch).items() if state.st_nlink == 1}
        except FileNotFoundError:
            return set()

    def remove(self, names: Iterable[str]) -> None:
        """Remove contents that still no session links to; raises OSError as `unused`."""
        names = list(names)
        if not names:
            return
        with opened(self.folder) as kept:
            for name in names:
                state = kept.file(name)
                if state is not None and state.st_nlink == 1:
                    kept.remove(name, f"content {name}, which no session uses any more")

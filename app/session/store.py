"""Documents of sessions on disk: a file each, in the user's own folder, written soon after a change."""

from __future__ import annotations

import contextlib
import json
import logging
import os
import re
import shutil
import sys
import tempfile
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from app.http.ids import SHARED_PREFIX

WRITE_AFTER_S = 0.5
"""Between a change and the file: changes that follow each other are written once."""
MOST_KEPT = 400
OLDEST_S = 60 * 86_400.0
"""Number and age of the files that are kept; of a link that was shared, ten times that age."""
LARGEST_FILE = 16 << 20
LARGEST_FOLDER = 2 << 30
_ORPHAN_S = 86_400.0
_ID = re.compile(r"[A-Za-z0-9_-]{1,64}")
_log = logging.getLogger("schuler.store")


def default_folder() -> Path:
    """Where the user's sessions are kept: under ``XDG_STATE_HOME``, else where the platform keeps such."""
    chosen = os.environ.get("XDG_STATE_HOME")
    if chosen and Path(chosen).is_absolute():
        base = Path(chosen)
    elif sys.platform == "darwin":
        base = Path.home() / "Library" / "Application Support"
    else:
        base = Path.home() / ".local" / "state"
    return base / "schuler-bench" / "sessions"


def open_store(folder: Path) -> Store | None:
    """Open a folder of documents, made if need be; None, with a line in the log, if it cannot be used."""
    try:
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        if hasattr(os, "getuid") and folder.stat().st_uid != os.getuid():
            raise PermissionError("it belongs to another user")
        folder.chmod(0o700)
        with tempfile.TemporaryFile(dir=folder):
            pass
    except OSError as error:
        _log.warning("sessions are not kept over a restart: %s: %s", folder, error.strerror or error)
        return None
    return Store(folder)


class Store:
    """A folder of documents, and the thread that writes them.

    Parameters
    ----------
    folder : Path
        Exists, can be written to, and is ours alone.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._changed = threading.Condition()
        self._due: dict[str, tuple[float, Callable[[], Any]]] = {}
        self._writing = 0
        self._closed = self._complained = False
        self._thread = threading.Thread(target=self._loop, name="store", daemon=True)
        self._thread.start()

    # ------------------------------------------------------------ reading

    def read(self, id: str) -> dict[str, Any] | None:
        """Document of that id; None, with a line in the log if it is broken, when there is none."""
        path = self._path(id)
        try:
            if path.stat().st_size > LARGEST_FILE:
                raise ValueError("is too large")
            document = json.loads(path.read_bytes())
            if not isinstance(document, dict) or document.get("id") != id:
                raise ValueError("is of another session")
            os.utime(path)
        except FileNotFoundError:
            return None
        except (OSError, ValueError, RecursionError) as error:
            _log.warning("a kept session cannot be read: %s: %.200s", path.name, error)
            return None
        return document

    def files_folder(self, id: str) -> Path:
        """Where the uploaded files of a session are kept; need not exist."""
        return self.folder / f"{_checked(id)}.files"

    # ------------------------------------------------------------ writing

    def soon(self, id: str, make: Callable[[], dict[str, Any]]) -> None:
        """Let a document be made and written in a moment, in another thread; the first request counts."""
        with self._changed:
            if not self._closed and id not in self._due:
                self._due[_checked(id)] = (time.monotonic() + WRITE_AFTER_S, make)
                self._changed.notify_all()

    def write(self, id: str, document: dict[str, Any]) -> None:
        """Write a document now: whole or not at all.

        Raises
        ------
        OSError
            There is no room, or the folder is gone.
        """
        import orjson

        content = orjson.dumps(document, option=orjson.OPT_NON_STR_KEYS)
        handle, name = tempfile.mkstemp(prefix=".", suffix=".tmp", dir=self.folder)  # 0600
        try:
            with os.fdopen(handle, "wb") as file:
                file.write(content)
                file.flush()
                os.fsync(file.fileno())
            os.replace(name, self._path(id))
        except BaseException:
            with contextlib.suppress(OSError):
                os.unlink(name)
            raise

    def flush(self, timeout_s: float = 5.0) -> bool:
        """Write at once what waits; False if that takes longer."""
        with self._changed:
            self._due = {id: (0.0, make) for id, (_, make) in self._due.items()}
            self._changed.notify_all()
            return self._changed.wait_for(lambda: not self._due and not self._writing, timeout_s)

    def close(self) -> None:
        """Write what waits and end the thread."""
        self.flush()
        with self._changed:
            self._closed = True
            self._changed.notify_all()

    def _loop(self) -> None:
        self.remove_old()
        while True:
            with self._changed:
                while not self._closed and not self._ready():
                    dues = [due for due, _ in self._due.values()]
                    self._changed.wait(max(0.0, min(dues) - time.monotonic()) if dues else None)
                if self._closed:
                    return
                ready = self._ready()
                makes = {id: self._due.pop(id)[1] for id in ready}
                self._writing += 1
            try:
                for id, make in makes.items():
                    self._try_to_write(id, make)
            finally:
                with self._changed:
                    self._writing -= 1
                    self._changed.notify_all()

    def _ready(self) -> list[str]:
        now = time.monotonic()
        return [id for id, (due, _) in self._due.items() if due <= now]

    def _try_to_write(self, id: str, make: Callable[[], dict[str, Any]]) -> None:
        try:
            self.write(id, make())
            self._complained = False
        except OSError as error:
            if not self._complained:
                _log.warning("sessions cannot be kept at present: %s", error.strerror or error)
            self._complained = True
        except Exception:  # the thread must outlive a document that cannot be made
            _log.exception("a session cannot be kept")

    # ------------------------------------------------------------ upkeep

    def remove_old(self) -> None:
        """Remove what is too old, then the oldest of what is too many or too much."""
        now, kept_bytes = time.time(), 0
        try:
            found = sorted(self.folder.glob("*.json"), key=lambda path: path.stat().st_mtime, reverse=True)
            for number, path in enumerate(found):
                age_s = now - path.stat().st_mtime
                oldest_s = OLDEST_S * (10.0 if path.name.startswith(SHARED_PREFIX) else 1.0)
                kept_bytes += path.stat().st_size + _size(self._files_of(path))
                if age_s > oldest_s or number >= MOST_KEPT or kept_bytes > LARGEST_FOLDER:
                    path.unlink(missing_ok=True)
                    shutil.rmtree(self._files_of(path), ignore_errors=True)
            self._remove_orphans(now)
        except OSError as error:
            _log.warning("old sessions cannot be removed: %s", error.strerror or error)

    def _remove_orphans(self, now: float) -> None:
        for path in self.folder.iterdir():
            if now - path.stat().st_mtime < _ORPHAN_S:
                continue
            if path.suffix == ".tmp" and path.name.startswith("."):
                path.unlink(missing_ok=True)
            elif path.suffix == ".files" and not path.with_suffix(".json").exists():
                shutil.rmtree(path, ignore_errors=True)

    def _files_of(self, path: Path) -> Path:
        return path.with_suffix(".files")

    def _path(self, id: str) -> Path:
        return self.folder / f"{_checked(id)}.json"


def _checked(id: str) -> str:
    if _ID.fullmatch(id) is None:
        raise ValueError(f"{id!r} is no id of a session")
    return id


def _size(folder: Path) -> int:
    return sum(path.stat().st_size for path in folder.rglob("*") if path.is_file()) if folder.is_dir() else 0

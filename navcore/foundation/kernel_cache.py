"""Where the machine code of the kernels is kept, under a name that only the compiled text decides.

The folder is named after the digest of `navcore.foundation.kernel_digest` and lies under
``SCHULER_CACHE_DIR``, else the user's cache folder, else (read-only home) a temporary folder; a cache that
was shipped read-only is copied to a writable place first: numba refuses a folder that it cannot write to.
Forming that digest takes some 150 ms, so it is kept beside the folders under the digest of the raw sources.
Folders that nothing has used for a month are removed when kernels are compiled.
"""

from __future__ import annotations

import os
import re
import shutil
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import Any

from numba.core.caching import _CacheLocator

from navcore.foundation.kernel_digest import PACKAGE, kernel_digest, source_digest

UNUSED_S = 30.0 * 86400.0
"""A folder of kernels that nothing has used for so long is removed, s."""
_A_DAY_S = 86400.0
_KNOWN = "digests"
_COMPLETE = "complete"


@cache
def kernel_hash() -> str:
    """Digest that names the machine code; taken from where it was kept when the sources are the same."""
    known = source_digest()
    places = [base / _KNOWN / known for base in _bases()]
    for place in places:
        try:
            text = place.read_text("ascii")
        except (OSError, UnicodeDecodeError):
            continue
        if re.fullmatch("[0-9a-f]{16}", text) and place.stat().st_uid == os.getuid():
            _used(place)
            return text
    digest = kernel_digest()
    for place in places:
        if _writable(place.parent):
            _write_whole(place, digest)
            break
    return digest


class KernelLocator(_CacheLocator):
    """Tells numba where a kernel's machine code lies: by its module and name, under `cache_folder`."""

    def __init__(self, module: str) -> None:
        self._path = str(cache_folder() / module)

    def get_cache_path(self) -> str:  # pyright: ignore[reportIncompatibleMethodOverride]
        """Folder of the kernels of one module."""
        return self._path

    def get_source_stamp(self) -> str:  # pyright: ignore[reportIncompatibleMethodOverride]
        """Stand for the source: the folder is named after its digest already."""
        return kernel_hash()

    def get_disambiguator(self) -> str:  # pyright: ignore[reportIncompatibleMethodOverride]
        """Tell kernels of one name in one module apart: there are none."""
        return "0"

    @classmethod
    def from_function(cls, py_func: Any, py_file: str) -> KernelLocator | None:
        """Locator of a function, None for one that is not ours."""
        del py_file
        module = str(py_func.__module__)
        if not module.startswith(f"{PACKAGE.name}."):
            return None
        locator = cls(module)
        locator.ensure_cache_path()
        return locator


def _user_cache() -> Path:
    if sys.platform == "darwin":
        return Path.home() / "Library" / "Caches"
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")


def _writable(folder: Path) -> bool:
    try:
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        if folder.stat().st_uid != os.getuid():  # what lies there is loaded as code
            return False
        with tempfile.TemporaryFile(dir=folder):
            return True
    except OSError:
        return False


def _bases() -> list[Path]:
    """Folders that may hold the machine code, the first that can be written to is taken."""
    shipped = os.environ.get("SCHULER_CACHE_DIR")
    own = [_user_cache() / "schuler-bench", Path(tempfile.gettempdir()) / f"schuler-bench-{os.getuid()}"]
    return [Path(shipped), *own] if shipped else own


@cache
def cache_folder() -> Path:
    """Folder of the machine code of exactly these kernels; writable, made when missing."""
    name = f"kernels-{kernel_hash()}"
    shipped = os.environ.get("SCHULER_CACHE_DIR")
    for base in _bases():
        if shipped and not (base / name).exists() and (Path(shipped) / name).is_dir() and _writable(base):
            _copy_writable(Path(shipped) / name, base / name)
        if _writable(base / name):
            _used(base / name)
            return base / name
    raise OSError("no folder for compiled kernels can be written to: name one in SCHULER_CACHE_DIR")


def _used(path: Path) -> None:
    """Note the use of a file or folder, at most once a day."""
    try:
        if time.time() - path.stat().st_mtime > _A_DAY_S:
            os.utime(path)
    except OSError:
        pass  # of a shipped cache that cannot be written to, nothing is removed either


def prune(now: float | None = None) -> list[Path]:
    """Remove kernels and digests that nothing has used for a month; return what was removed.

    Several trees of one machine share the place: what another of them used lately stays.

    Parameters
    ----------
    now : float, optional
        Time from which a month is counted back, s since the epoch.
    """
    here, removed = cache_folder(), []
    oldest = (time.time() if now is None else now) - UNUSED_S
    for path in (*here.parent.glob("kernels-*"), *(here.parent / _KNOWN).glob("*")):
        try:
            if path == here or path.stat().st_mtime >= oldest:
                continue
            shutil.rmtree(path) if path.is_dir() else path.unlink()
        except OSError:
            continue  # another process was quicker, or it is not ours
        removed.append(path)
    return removed


def complete() -> bool:
    """Whether every kernel has been compiled into the folder."""
    return (cache_folder() / _COMPLETE).is_file()


@contextmanager
def compiling() -> Iterator[bool]:
    """Hold the right to compile every kernel; the body does so when given True.

    While another process has it, wait: it compiles the same. False when nothing is left to do. The folder
    counts as complete once the body has ended without an exception.
    """
    if complete():
        yield False
        return
    folder = cache_folder()
    with open(folder / "lock", "a") as lock:
        _lock(lock.fileno())
        if complete():
            yield False
            return
        yield True
        (folder / _COMPLETE).touch()
        prune()


def _lock(file: int) -> None:
    try:
        import fcntl
    except ImportError:  # no such thing: two processes then compile the same, which is only slower
        return
    fcntl.flock(file, fcntl.LOCK_EX)


def _write_whole(path: Path, text: str) -> None:
    with tempfile.NamedTemporaryFile("w", dir=path.parent, delete=False) as file:
        file.write(text)
    os.replace(file.name, path)


def _copy_writable(source: Path, target: Path) -> None:
    # Renamed into place, so that a process that starts at the same time never sees half a copy.
    with tempfile.TemporaryDirectory(dir=target.parent) as folder:
        copy = Path(folder) / "copy"
        shutil.copytree(source, copy)
        for path in (copy, *copy.rglob("*")):
            path.chmod(path.stat().st_mode | 0o200)
        try:
            copy.rename(target)
        except OSError:
            if not target.is_dir():
                raise

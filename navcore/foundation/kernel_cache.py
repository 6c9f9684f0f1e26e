"""Where the machine code of the kernels is kept, under a name that only the compiled text decides.

The folder is named after the digest of `navcore.foundation.kernel_digest` and lies under
``SCHULER_CACHE_DIR``, the user's cache folder or a temporary folder. Of these the first that is complete is
used where it lies, read-only or not; where none is complete, the first that can be written to.
A wheel may hold kernels for a family of processors (`SHIPPED`): a kernel that is not in the folder is taken
from there.
Forming that digest takes some 150 ms, so it is kept beside the folders under the digest of the raw sources.
Folders that nothing has used for a month are removed when kernels are compiled.
"""

from __future__ import annotations

import logging
import os
import platform
import re
import shutil
import sys
import tempfile
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from functools import cache
from pathlib import Path
from typing import IO, Any

from numba.core.caching import FunctionCache, IndexDataCacheFile, _CacheLocator
from numba.core.codegen import get_host_cpu_features

from navcore.foundation import kernel_files, kernel_wait
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.kernel_digest import PACKAGE, kernel_digest, number_of_kernels, source_digest

UNUSED_S = 30.0 * 86400.0
"""A folder of kernels that nothing has used for so long is removed, s."""
ROOM_BYTES = 64 << 20
"""All kernels of one version take 40 MiB."""
SHIPPED = PACKAGE / "_kernels"
"""Kernels that came with the wheel. They are code of the package, and trusted as its other files are."""
PORTABLE = "x86-64-v3" if platform.machine() in ("x86_64", "AMD64") else "generic"
"""Processor, as LLVM names it, that the shipped kernels are compiled for."""
_NEEDED = ("avx2", "bmi2", "fma", "lzcnt", "movbe") if PORTABLE == "x86-64-v3" else ()
_A_DAY_S = 86400.0
_forming = threading.Lock()
_KNOWN = "digests"
_COMPLETE = "complete"
_LOCK = "lock"
_log = logging.getLogger("schuler.kernels")


@cache
def kernel_hash() -> str:
    """Digest that names the machine code; taken from where it was kept when the sources are the same."""
    with _forming:  # threads that form it side by side would each read some of the sources twice
        return _kernel_hash()


def _kernel_hash() -> str:
    known = source_digest()
    places = [base / _KNOWN / known for base in _bases()]
    for place in places:
        try:
            text = place.read_text("ascii")
            distrust = kernel_files.distrust(place)
        except (OSError, UnicodeDecodeError):
            continue
        if re.fullmatch("[0-9a-f]{16}", text) and not distrust:
            _used(place)
            return text
    digest = kernel_digest()
    for place in places:
        if not kernel_files.refusal(place.parent):
            with suppress(OSError), kernel_files.replacing(place) as file:
                file.write(digest.encode())
            break
    return digest


class KernelLocator(_CacheLocator):
    """Tells numba where a kernel's machine code lies: by its module and name, under `cache_folder`."""

    def __init__(self, module: str) -> None:
        self._path = str(any_folder() / module)

    def get_cache_path(self) -> str:  # pyright: ignore[reportIncompatibleMethodOverride]
        """Folder of the kernels of one module."""
        return self._path

    def get_source_stamp(self) -> str:  # pyright: ignore[reportIncompatibleMethodOverride]
        """Stand for the source: the folder is named after its digest already."""
        return kernel_hash()

    def get_disambiguator(self) -> str:  # pyright: ignore[reportIncompatibleMethodOverride]
        """Tell kernels of one name in one module apart: there are none."""
        return "0"

    def ensure_cache_path(self) -> None:
        """Make the folder where that can be done: what is not kept is compiled again."""
        with suppress(OSError):
            kernel_files.make_folder(Path(self._path))

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


class _Files(IndexDataCacheFile):
    """Machine code of one kernel on disk, of which nobody sees a half or can write to it."""

    @contextmanager
    def _open_for_write(self, filepath: str) -> Iterator[IO[bytes]]:  # pyright: ignore[reportIncompatibleMethodOverride]
        with kernel_files.replacing(Path(filepath)) as file:
            yield file


class KernelCache(FunctionCache):
    """Machine code of one kernel; what cannot be read is compiled, what cannot be written is not kept."""

    def __init__(self, function: Any) -> None:
        super().__init__(function)
        name, folder = self._impl.filename_base, str(SHIPPED / _name() / function.__module__)
        self._cache_file = _Files(self._cache_path, name, kernel_hash())
        self._shipped = IndexDataCacheFile(folder, name, kernel_hash())

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """Load the machine code for a signature; None when there is none that can be read.

        Raises
        ------
        InputError
            See `cache_folder`: only now, so that a program without kernels can be imported and say so.
        KernelAwaited
            See `navcore.foundation.kernel_wait.wait_once`.
        """
        while True:
            if (found := self._found(sig, target_context)) is not None:
                return found
            lock = cache_folder() / _LOCK
            if not kernel_wait.wait_once(lock, self._impl.filename_base):
                return None

    def _found(self, sig: Any, target_context: Any) -> Any:
        with suppress(OSError):
            if (found := super().load_overload(sig, target_context)) is not None:
                return found
        if shipped() is None:
            return None
        key = self._index_key(sig, target_context.codegen())
        data = self._shipped.load((key[0], (key[1][0], PORTABLE, ""), *key[2:]))
        return None if data is None else self._impl.rebuild(target_context, data)

    def save_overload(self, sig: Any, data: Any) -> None:
        """Keep the machine code for a signature, on a full disk or a read-only one as long as we run."""
        try:
            super().save_overload(sig, data)
        except OSError as error:
            _say_not_kept(error.strerror or type(error).__name__)


@cache
def _say_not_kept(reason: str) -> None:
    _log.warning("compiled kernels are not kept: %s", reason)


def _bases() -> list[Path]:
    """Folders that may hold the machine code, the first that can be written to is taken."""
    bases = [Path(shipped)] if (shipped := os.environ.get("SCHULER_CACHE_DIR")) else []
    bases += [home / "schuler-bench"] if (home := _user_cache()) else []
    with suppress(FileNotFoundError):  # no temporary folder can be written to
        bases.append(Path(tempfile.gettempdir()) / f"schuler-bench-{os.getuid()}")
    return bases


def _user_cache() -> Path | None:
    try:
        if sys.platform == "darwin":
            return Path.home() / "Library" / "Caches"
        return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    except RuntimeError:  # no HOME, and a user without an account
        return None


@cache
def cache_folder() -> Path:
    """Folder of the machine code of exactly these kernels; made when missing.

    Raises
    ------
    InputError
        Nothing can be written to, and there is no complete one.
    """
    folders = [base / _name() for base in _bases()]
    for folder in folders:
        with suppress(OSError):  # it is missing, or lies in a folder that cannot be searched
            if (folder / _COMPLETE).is_file() and not kernel_files.untrusted(folder):
                _used(folder)
                return folder
    named = os.environ.get("SCHULER_CACHE_DIR") or _user_cache()
    why_not = "" if named else "there is no home folder"
    for folder in folders:
        missing = not _exists(folder)
        reason = kernel_files.refusal(folder)
        if not reason:
            _used(folder)
            if missing and why_not and shipped() is None:
                _log.warning("compiled kernels are kept in %s: %s", folder.parent, why_not)
            return folder
        why_not = f"{folder.parent} {reason}"
    nowhere = "no folder for compiled kernels can be written to: name one in SCHULER_CACHE_DIR"
    raise InputError(Fault("kernels", "", None, nowhere))


def _name() -> str:
    return f"kernels-{kernel_hash()}"


@cache
def shipped() -> Path | None:
    """Folder of the kernels that came with the wheel; None where there are none that fit this machine."""
    folder = SHIPPED / _name()
    if not _exists(folder / _COMPLETE):
        return None
    features = get_host_cpu_features().split(",") if _NEEDED else []
    return folder if all(f"+{needed}" in features for needed in _NEEDED) else None


def any_folder() -> Path:
    """Folder of the machine code, or a place where nothing can be."""
    try:
        return cache_folder()
    except InputError:
        return Path(os.devnull)


def _exists(folder: Path) -> bool:
    try:
        return folder.exists()
    except OSError:  # it lies in a folder that cannot be searched
        return False


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


def ready() -> bool:
    """Whether no kernel need be compiled: all came with the wheel, or are in the folder.

    Raises
    ------
    InputError
        See `cache_folder`.
    """
    return shipped() is not None or complete()


def under_way() -> kernel_wait.Compiling | None:
    """Return how far another process is that compiles every kernel; None when there is none."""
    return kernel_wait.under_way(cache_folder() / _LOCK)


def note_progress(kernel: str) -> kernel_wait.Compiling:
    """Let others know how far this process is, which holds the right to compile every kernel."""
    folder = cache_folder()
    done = len([*folder.glob("*/*.nbi")])
    compiling = kernel_wait.Compiling(done, max(done, number_of_kernels()), kernel)
    kernel_wait.note(folder / _LOCK, compiling)
    return compiling


@contextmanager
def compiling() -> Iterator[bool]:
    """Hold the right to compile every kernel; the body does so when given True.

    While another process has it, wait: it compiles the same. False when nothing is left to do. The folder
    counts as complete once the body has ended without an exception.

    Raises
    ------
    InputError
        The folder has no room for them.
    """
    if complete():
        yield False
        return
    folder = cache_folder()
    if shutil.disk_usage(folder).free < ROOM_BYTES:
        allowed = f"the disk has no {ROOM_BYTES >> 20} MiB for them: name another folder in SCHULER_CACHE_DIR"
        raise InputError(Fault("kernels", "", None, allowed))
    with open(folder / _LOCK, "a") as lock:
        _lock(lock.fileno())
        if complete():
            yield False
            return
        yield True
        with kernel_files.replacing(folder / _COMPLETE):
            pass
        prune()


def _lock(file: int) -> None:
    try:
        import fcntl
    except ImportError:  # no such thing: two processes then compile the same, which is only slower
        return
    fcntl.flock(file, fcntl.LOCK_EX)

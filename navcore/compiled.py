"""The one decorator for compiled kernels, and where their machine code is kept.

numba's on-disk cache does not notice an edit in *another* file that a kernel inlines, so the cache folder is
named after a hash of all kernel sources and of the versions that made it. The folder lies under
``SCHULER_CACHE_DIR``, else the user's cache folder, else (read-only home) a temporary folder; a cache that
was shipped read-only is copied to a writable place first, since numba refuses a folder that it cannot write
to.

``python -m navcore.compiled`` compiles every kernel once.
"""

from __future__ import annotations

import hashlib
import os
import platform
import re
import shutil
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

import numba
from numba.core import config

_PACKAGE = Path(__file__).resolve().parent
_IMPORT = re.compile(r"^from (navcore[\w.]*) import", re.MULTILINE)
_F = TypeVar("_F", bound=Callable[..., Any])


def kernel_sources() -> list[Path]:
    """Return the files whose text is compiled: those that import this module, and what they import."""
    texts = {path: path.read_text("utf-8") for path in _PACKAGE.rglob("*.py")}
    found = {path for path, text in texts.items() if "from navcore.compiled import" in text}
    waiting = list(found)
    while waiting:
        for module in _IMPORT.findall(texts[waiting.pop()]):
            stem = _PACKAGE.parent.joinpath(*module.split("."))
            for path in (stem.with_suffix(".py"), stem / "__init__.py"):
                if path in texts and path not in found:
                    found.add(path)
                    waiting.append(path)
    return sorted(found)


def kernel_hash() -> str:
    """Hash of all kernel sources and of the Python, numba and numpy versions, 16 hex digits."""
    digest = hashlib.sha256(f"{sys.version}|{numba.__version__}|{platform.machine()}".encode())
    for path in kernel_sources():
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


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


def cache_folder() -> Path:
    """Folder of the machine code of exactly these sources; writable, made when missing."""
    name = f"kernels-{kernel_hash()}"
    shipped = os.environ.get("SCHULER_CACHE_DIR")
    bases = [_user_cache() / "schuler-bench", Path(tempfile.gettempdir()) / f"schuler-bench-{os.getuid()}"]
    for base in [Path(shipped), *bases] if shipped else bases:
        if shipped and not (base / name).exists() and (Path(shipped) / name).is_dir() and _writable(base):
            _copy_writable(Path(shipped) / name, base / name)
        if _writable(base / name):
            return base / name
    raise OSError("no folder for compiled kernels can be written to: name one in SCHULER_CACHE_DIR")


def _copy_writable(source: Path, target: Path) -> None:
    # Renamed into place, so that a process that starts at the same time never sees half a copy.
    with tempfile.TemporaryDirectory(dir=target.parent) as made:
        copy = Path(made) / "copy"
        shutil.copytree(source, copy)
        for path in (copy, *copy.rglob("*")):
            path.chmod(path.stat().st_mode | 0o200)
        try:
            copy.rename(target)
        except OSError:
            if not target.is_dir():
                raise


config.CACHE_DIR = str(cache_folder())  # pyright: ignore[reportAttributeAccessIssue]


def kernel(function: _F) -> _F:
    """Compile a function of scalars and arrays: cached on disk, GIL released, no Python exceptions on 1/0."""
    return numba.njit(cache=True, nogil=True, error_model="numpy")(function)  # pyright: ignore[reportReturnType]


def inlined(function: _F) -> _F:
    """Compile a small function that kernels call, inlined by LLVM."""
    return numba.njit(nogil=True, error_model="numpy", forceinline=True)(function)  # pyright: ignore[reportReturnType]


def plain(function: _F) -> _F:
    """Return the Python function behind a compiled one: for single calls, which are not worth compiling."""
    return function.py_func  # pyright: ignore[reportFunctionMemberAccess]


def main() -> None:
    """Compile every kernel into the cache, saying what is under way."""
    from navcore.warm import warm

    warm(lambda what: print(f"kernels: {what}", file=sys.stderr, flush=True))
    print(f"kernels: ready in {cache_folder()}", file=sys.stderr)


if __name__ == "__main__":
    main()

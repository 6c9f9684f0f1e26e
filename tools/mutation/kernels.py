"""Kernels of a changed tree without compiling all of them anew.

A changed kernel, and each that calls it, is run as Python (``interpret``) or compiled for this process; every
other kernel is loaded from the machine code of the unchanged tree. A small inlined function that a test or an
interpreted kernel calls runs as Python. To be used before anything of navcore is imported.
"""

import ast
import hashlib
from collections.abc import Callable
from typing import Any

import numba
import numpy as np
from numba.core.registry import CPUDispatcher


class _Record:
    """A numpy record whose fields are attributes, as compiled code sees it."""

    __slots__ = ("_of",)

    def __init__(self, of: Any) -> None:
        object.__setattr__(self, "_of", of)

    def __getattr__(self, name: str) -> Any:
        own = self._of.dtype.names
        return _seen(self._of[name]) if name in own else getattr(self._of, name)

    def __getitem__(self, place: Any) -> Any:
        return _seen(self._of[place])

    def __setattr__(self, name: str, value: Any) -> None:
        self._of[name] = _given(value)

    def __setitem__(self, place: Any, value: Any) -> None:
        self._of[place] = _given(value)

    def __len__(self) -> int:
        return len(self._of)


def _seen(value: Any) -> Any:
    """Value as an interpreted kernel sees it."""
    if isinstance(value, np.void) or (isinstance(value, np.ndarray) and value.dtype.names):
        return _Record(value)
    if isinstance(value, tuple):
        seen = [_seen(each) for each in value]
        return type(value)(*seen) if hasattr(value, "_fields") else tuple(seen)
    return value


def _given(value: Any) -> Any:
    """Value as a compiled kernel takes it."""
    if isinstance(value, _Record):
        return value._of
    if isinstance(value, tuple):
        given = [_given(each) for each in value]
        return type(value)(*given) if hasattr(value, "_fields") else tuple(given)
    return value


class _Interpreted(CPUDispatcher):
    """A compiled function that runs as Python when Python calls it."""

    def __call__(self, *args: Any) -> Any:  # pyright: ignore[reportIncompatibleMethodOverride]
        with np.errstate(all="ignore"):
            return self.py_func(*(_seen(each) for each in args))


class _Compiled(CPUDispatcher):
    """A kernel that takes what an interpreted one hands it."""

    def __call__(self, *args: Any) -> Any:  # pyright: ignore[reportIncompatibleMethodOverride]
        return super().__call__(*(_given(each) for each in args))


Closures = dict[str, tuple[str, list[str]]]
"""Of each kernel, by ``module:name``: digest of it and all that it names, and the modules of these."""


def install(digest: str, closures: Closures, interpret: bool) -> None:
    """Put the decorators of this module in the place of navcore's.

    Parameters
    ----------
    digest : str
        Digest of the unchanged tree's kernels, which names the folder of their machine code.
    closures : dict
        Of the unchanged tree.
    interpret : bool
        Run what has changed as Python; otherwise compile it.
    """
    now = kernel_closures()
    from navcore.foundation import kernel_cache

    kernel_cache.kernel_hash = lambda: digest
    from navcore.foundation import compiled

    changed = {name for name, found in now.items() if closures.get(name, ("", []))[0] != found[0]}

    def inlined(function: Callable[..., Any]) -> Any:
        made = numba.njit(nogil=True, error_model="numpy", forceinline=True, _nrt=False)(function)  # pyright: ignore[reportCallIssue]
        made.__class__ = _Interpreted
        return made

    def kernel(function: Callable[..., Any]) -> Any:
        other = f"{function.__module__}:{function.__qualname__.partition('.')[0]}" in changed
        if not function.__module__.startswith("navcore."):  # of a test: it inlines what may have changed
            other = bool(changed)
        made = numba.njit(cache=not other, nogil=True, error_model="numpy")(function)
        made.__class__ = _Interpreted if other and interpret else _Compiled
        return made

    compiled.inlined, compiled.kernel = inlined, kernel


def kernel_closures() -> Closures:
    """Find what each kernel of this tree, inlined functions left out, is compiled from."""
    from navcore.foundation import kernel_digest as source

    found: Closures = {}
    for path in sorted(source.PACKAGE.rglob("*.py")):
        if "@kernel" not in path.read_text("utf-8"):
            continue
        parts = path.relative_to(source.PACKAGE.parent).with_suffix("").parts
        module = ".".join(parts[:-1] if parts[-1] == "__init__" else parts)
        held = source._module(module)
        for function in held.functions if held else ():
            if any(getattr(d, "id", "") == "kernel" for d in function.decorator_list):
                texts, modules = _closure(source, module, function)
                digest = hashlib.sha256("".join(sorted(texts)).encode()).hexdigest()
                found[f"{module}:{function.name}"] = (digest, sorted(modules))
    return found


def _closure(source: Any, module: str, function: ast.stmt) -> tuple[list[str], set[str]]:
    texts, seen, modules = [], set(), set()
    waiting = [(module, function)]
    while waiting:
        where, statement = waiting.pop()
        if id(statement) not in seen:
            seen.add(id(statement))
            modules.add(where)
            texts.append(f"{where}:{source._without_text(statement)}")
            waiting += source._named(where, statement)
    return texts, modules

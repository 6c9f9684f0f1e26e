"""The decorators for compiled kernels; `kernel_cache` says where their machine code is kept.

``python -m navcore.warm`` compiles every kernel once.
"""

import os
import time
from collections.abc import Callable
from typing import Any, TypeVar

import numba
from numba.core import config, event

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.kernel_cache import PORTABLE, KernelCache, KernelLocator, any_folder

_F = TypeVar("_F", bound=Callable[..., Any])

PORTABLE_SETTINGS = {"NUMBA_CPU_NAME": PORTABLE, "NUMBA_CPU_FEATURES": ""}
"""Settings of numba with which the kernels of a wheel are compiled."""
_UNSET = (
    *("BOUNDSCHECK", "DEBUGINFO", "DEBUGINFO_DEFAULT", "DISABLE_JIT", "ENABLE_AVX", "JIT_COVERAGE"),
    *("LOOP_VECTORIZE", "OPT", "SLP_VECTORIZE", "CPU_NAME", "CPU_FEATURES"),
)


def _refuse_settings() -> None:
    """Refuse settings of numba that change the machine code: its cache does not tell them apart.

    Raises
    ------
    InputError
        Names each of them.
    """
    names = [f"NUMBA_{name}" for name in _UNSET]
    found = {name: value for name in names if (value := os.environ.get(name)) is not None}
    if found and found != PORTABLE_SETTINGS:
        allowed = "must not be set: the kernels are compiled with numba's own settings"
        raise InputError(Fault("environment", name, value, allowed) for name, value in found.items())


_refuse_settings()
config.CACHE_DIR = str(any_folder())  # pyright: ignore[reportAttributeAccessIssue]
config.CACHE_LOCATOR_CLASSES = (  # pyright: ignore[reportAttributeAccessIssue]
    f"{KernelLocator.__module__}.{KernelLocator.__qualname__},UserProvidedCacheLocator"
)


class Compilation(event.Listener):
    """Compilation by numba in this process; a kernel that is loaded from the cache does not count.

    Attributes
    ----------
    count : int
        Kernels that have been compiled, with all that was compiled on the way to each.
    seconds : float
        Time that this has taken, s.
    """

    def __init__(self) -> None:
        self.count, self.seconds = 0, 0.0
        self._names: list[str] = []
        self._began = 0.0

    def on_start(self, event: event.Event) -> None:  # pyright: ignore[reportIncompatibleMethodOverride]
        """Note the function; functions that it calls are compiled within its own compilation."""
        function = event.data["dispatcher"].py_func  # pyright: ignore[reportOptionalSubscript]
        if not self._names:
            self._began = time.perf_counter()
        self._names.append(f"{function.__module__}.{function.__qualname__}")

    def on_end(self, event: event.Event) -> None:  # pyright: ignore[reportIncompatibleMethodOverride]
        """Note the time of a compilation that is over."""
        self._names.pop()
        if not self._names:
            self.count, self.seconds = self.count + 1, self.seconds + time.perf_counter() - self._began

    def under_way(self) -> tuple[str, float]:
        """Return the kernel that is being compiled and for how long, s; an empty name when there is none."""
        names = self._names[:1]
        return (names[0], time.perf_counter() - self._began) if names else ("", 0.0)


COMPILATION = Compilation()
event.register("numba:compile", COMPILATION)


def kernel(function: _F) -> _F:
    """Compile a function of scalars and arrays: cached on disk, GIL released, no Python exceptions on 1/0."""
    compiled: Any = numba.njit(nogil=True, error_model="numpy")(function)
    compiled._cache = KernelCache(function)
    return compiled


def inlined(function: _F) -> _F:
    """Compile a small function that kernels call, inlined by LLVM.

    It makes no array and keeps none, so the arrays that it is given need not be counted as in use: counting
    them in the loop over samples, as numba does unless told, takes a third of its time.
    """
    return numba.njit(nogil=True, error_model="numpy", forceinline=True, _nrt=False)(function)  # pyright: ignore[reportReturnType, reportCallIssue]


def plain(function: _F) -> _F:
    """Return the Python function behind a compiled one: for single calls, which are not worth compiling."""
    return function.py_func  # pyright: ignore[reportFunctionMemberAccess]

"""The decorators for compiled kernels; `kernel_cache` says where their machine code is kept.

``python -m navcore.warm`` compiles every kernel once.
"""

from collections.abc import Callable
from typing import Any, TypeVar

import numba
from numba.core import config

from navcore.foundation.kernel_cache import KernelLocator, cache_folder

_F = TypeVar("_F", bound=Callable[..., Any])

config.CACHE_DIR = str(cache_folder())  # pyright: ignore[reportAttributeAccessIssue]
config.CACHE_LOCATOR_CLASSES = (  # pyright: ignore[reportAttributeAccessIssue]
    f"{KernelLocator.__module__}.{KernelLocator.__qualname__},UserProvidedCacheLocator"
)


def kernel(function: _F) -> _F:
    """Compile a function of scalars and arrays: cached on disk, GIL released, no Python exceptions on 1/0."""
    return numba.njit(cache=True, nogil=True, error_model="numpy")(function)  # pyright: ignore[reportReturnType]


def inlined(function: _F) -> _F:
    """Compile a small function that kernels call, inlined by LLVM.

    It makes no array and keeps none, so the arrays that it is given need not be counted as in use: counting
    them in the loop over samples, as numba does unless told, takes a third of its time.
    """
    return numba.njit(nogil=True, error_model="numpy", forceinline=True, _nrt=False)(function)  # pyright: ignore[reportReturnType, reportCallIssue]


def plain(function: _F) -> _F:
    """Return the Python function behind a compiled one: for single calls, which are not worth compiling."""
    return function.py_func  # pyright: ignore[reportFunctionMemberAccess]

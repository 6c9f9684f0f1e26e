"""Compiled code of policies and switching methods that were added from outside the program.

Each function of such a class becomes a C function of its own (`navcore.law.added_call`), which the kernels
call by its address. It is compiled once: its machine code is kept beside the kernels, under a digest of what
the function and all that it calls say, and of the records that it reads.
"""

import hashlib
import inspect
import types
from collections.abc import Callable, Iterator
from functools import cache
from typing import Any

import numba
import numpy as np
from numba.core.errors import NumbaError

from navcore.foundation.compiled import inlined
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.kernel_cache import KernelCache
from navcore.foundation.records import fill_record, new_record
from navcore.foundation.registry import place_of
from navcore.foundation.text import Text
from navcore.law.added_call import ROOM_MEMORY, ROOM_NUMBERS
from navcore.law.records import Law, Sensed

_POINTER, _WHOLE, _NUMBER = numba.types.voidptr, numba.types.int64, numba.types.float64
_SIGNATURE = _WHOLE(*[_POINTER] * 5, _WHOLE, *[_NUMBER] * 3)
_PAIR = ROOM_MEMORY
"""Place of the two numbers that ``feed`` gives, behind the memory."""
LawRecords = tuple[np.dtype, np.dtype, np.dtype]
"""Types of the law's parameters, state and history."""
carray: Any = numba.carray  # pyright: ignore[reportPrivateImportUsage]


class _Cache(KernelCache):
    """Machine code of one added function, found by its digest."""

    def __init__(self, function: Any, digest: str) -> None:
        super().__init__(function)
        self._digest = digest

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """Load the machine code; None also where it names a module that this process has not loaded."""
        try:
            return super().load_overload(sig, target_context)
        except ImportError:
            return None

    def _index_key(self, sig: Any, codegen: Any) -> Any:
        return sig, codegen.magic_tuple(), (self._digest,)


def policy_place(kind: type, records: LawRecords, packed: dict[str, Any]) -> dict[str, Any]:
    """Values of the place of an added policy in the law's parameters.

    Parameters
    ----------
    kind : type
        The class: a `PolicyParameters`.
    records : tuple of dtype
        Of the law.
    packed : dict
        Its numbers.

    Raises
    ------
    InputError
        It cannot be compiled, or its numbers do not fit; named with the class and its line.
    """
    return _place(kind, records, packed, ("decide", "follow"))


def switching_place(kind: type, records: LawRecords, packed: dict[str, Any]) -> dict[str, Any]:
    """Values of the place of an added switching method; as `policy_place`."""
    return _place(kind, records, packed, ("switch", "restore", "feed"))


def remembered(kind: type, values: dict[str, Any]) -> dict[str, Any]:
    """Values of the place of an added class in the law's state, from those of its memory that are not 0."""
    return {"room": _numbers(new_record(kind.memory, **values), ROOM_MEMORY)} if values else {}  # pyright: ignore[reportAttributeAccessIssue]


def room_faults(kind: Any) -> Iterator[str]:
    """Say which records of a class do not fit into the place of an added one."""
    for name, room in (("numbers", ROOM_NUMBERS), ("memory", ROOM_MEMORY)):
        if getattr(kind, name).itemsize > 8 * room:
            yield Text(
                "{name} takes {size} bytes: at most {room} for a class from outside the program",
                name=name,
                size=getattr(kind, name).itemsize,
                room=8 * room,
            )


def _place(kind: Any, records: LawRecords, packed: dict[str, Any], names: tuple[str, ...]) -> dict[str, Any]:
    try:
        own = new_record(kind.numbers)
        fill_record(own, packed)
    except (ValueError, KeyError, IndexError, TypeError) as error:
        why = Text("packed() does not fit the record of its numbers: {error}", error=str(error))
        raise InputError(Fault(place_of(kind), kind.__name__, None, why)) from error
    place: dict[str, Any] = {"room": _numbers(own, ROOM_NUMBERS)}
    for name in names:
        function = inspect.getattr_static(kind, name, None)
        if function is not None:
            place[name] = _address(kind, name, records)
    return place


def _numbers(record: np.void, room: int) -> np.ndarray:
    """A record's bytes as the numbers of a place."""
    raw = record.tobytes()
    return np.frombuffer(raw + bytes(8 * room - len(raw)), dtype=np.float64)


@cache
def _address(kind: Any, name: str, records: LawRecords) -> int:
    """Compile a function of a class, or load it; return its address. It stays as long as the process."""
    function = _dispatcher(inspect.getattr_static(kind, name))
    entry = _entry(function, name, kind.numbers, kind.memory, records)
    digest = hashlib.sha256()
    digest.update(f"{function.py_func.__module__}|{name}|{kind.numbers.descr}|{kind.memory.descr}".encode())
    known = all([*map(_take(digest), _meaning(function.py_func, set()))])
    made = _cfunc(entry, digest.hexdigest() if known else "")
    try:
        made.compile()
    except NumbaError as error:
        lines = [line for line in str(error).splitlines() if line.strip()]
        why = Text('"{name}" cannot be compiled: {why}', name=name, why=" ".join(lines[:6]))
        raise InputError(Fault(place_of(kind), kind.__name__, None, why)) from error
    _KEPT.append(made)
    return made.address


_KEPT: list[Any] = []
"""Functions whose addresses have been given out."""


def _cfunc(entry: Callable[..., Any], digest: str) -> Any:
    """Make a C function, not compiled yet; with a digest its machine code is kept."""
    from numba.core.ccallback import CFunc

    made = CFunc(
        entry, (_SIGNATURE.args, _SIGNATURE.return_type), locals={}, options={"error_model": "numpy"}
    )
    if digest:
        made._cache = _Cache(entry, digest)  # pyright: ignore[reportAttributeAccessIssue]
    return made


def _dispatcher(function: Any) -> Any:
    function = getattr(function, "__func__", function)  # of a staticmethod
    return function if hasattr(function, "py_func") else inlined(function)


def _entry(function: Any, name: str, numbers: Any, memory: Any, records: LawRecords) -> Callable[..., Any]:
    """C function that makes the records of the pointers and calls ``function`` with them."""
    parameters, state, history = records
    called = _CALLS[name](function)

    def entry(own_at, kept_at, p_at, s_at, ring_at, rows, a, b, c):
        own, kept = carray(own_at, 1, numbers)[0], carray(kept_at, 1, memory)[0]
        law = Law(carray(p_at, 1, parameters)[0], carray(s_at, 1, state)[0], carray(ring_at, rows, history))
        return called(own, kept, law, a, b, c, carray(kept_at, _PAIR + 2, np.float64))

    return entry


def _deciding(function: Any) -> Any:
    @inlined
    def call(own, memory, law, a, b, c, pair):
        return 1 if function(own, memory, law, Sensed(a, b, c)) else 0

    return call


def _following(function: Any) -> Any:
    @inlined
    def call(own, memory, law, a, b, c, pair):
        function(own, memory, law, a, b)
        return 0

    return call


def _switching(function: Any) -> Any:
    @inlined
    def call(own, memory, law, a, b, c, pair):
        function(own, memory, law, a > 0.5)
        return 0

    return call


def _restoring(function: Any) -> Any:
    @inlined
    def call(own, memory, law, a, b, c, pair):
        function(own, memory, law)
        return 0

    return call


def _feeding(function: Any) -> Any:
    @inlined
    def call(own, memory, law, a, b, c, pair):
        pair[_PAIR], pair[_PAIR + 1] = function(own, memory, law)
        return 0

    return call


_CALLS = {
    "decide": _deciding,
    "follow": _following,
    "switch": _switching,
    "restore": _restoring,
    "feed": _feeding,
}


# ------------------------------------------------------------ what a function says


def _take(digest: Any) -> Callable[[str | None], bool]:
    def take(text: str | None) -> bool:
        digest.update((text or "").encode())
        return text is not None

    return take


def _meaning(function: Any, seen: set[int]) -> Iterator[str | None]:
    """Yield what a function says and all that it names; None where that cannot be told."""
    if id(function) in seen:
        return
    seen.add(id(function))
    yield from _code(function.__code__)
    inner = inspect.getclosurevars(function)
    for name, value in sorted({**inner.globals, **inner.nonlocals}.items()):
        yield f"{name}="
        yield from _named(value, function.__code__.co_names, seen)


def _code(code: types.CodeType) -> Iterator[str]:
    yield code.co_code.hex() + repr(code.co_names) + repr(code.co_varnames)
    for constant in code.co_consts:
        if isinstance(constant, types.CodeType):
            yield from _code(constant)
        else:
            yield repr(constant)


def _named(value: Any, names: tuple[str, ...], seen: set[int]) -> Iterator[str | None]:
    if hasattr(value, "py_func"):
        yield from _meaning(value.py_func, seen)
    elif isinstance(value, types.FunctionType):
        yield from _meaning(value, seen)
    elif isinstance(value, types.ModuleType):
        yield value.__name__
        for name in names:
            if isinstance(found := getattr(value, name, None), bool | int | float | str):
                yield f"{name}={found!r}"
    elif isinstance(value, bool | int | float | complex | str | bytes | None):
        yield repr(value)
    elif isinstance(value, tuple):
        for one in value:
            yield from _named(one, names, seen)
    elif isinstance(value, np.ndarray | np.generic):
        yield f"{value.dtype.descr}{np.shape(value)}{value.tobytes().hex()}"
    elif isinstance(value, np.dtype):
        yield repr(value.descr)
    elif isinstance(value, type) or callable(value):
        # a type, or a function of numpy or numba: of the program's versions, which name the cache
        yield f"{value.__module__}.{getattr(value, '__qualname__', value)}"
    else:
        yield None

"""The reader's hold on names, constants and places in the state."""

from __future__ import annotations

import ast
import builtins
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from navcore.exporting.ir import Const, Expr, Field, Item, Let, Num, Program, StateField, Statement, Var
from navcore.exporting.notes import notes_of
from navcore.exporting.values import (
    NUMBERS,
    Group,
    Known,
    Named,
    NotWrittenError,
    Place,
    Slot,
    Value,
    kind_of,
    leaves,
    literal,
    rebuilt,
)
from navcore.exporting.words import RESERVED

RESULT = "result"
"""Name of what a function returns without a name."""
_HIDDEN = ("policies", "switchings")
"""Records of which each method has its own: their names are left out of the names of what they hold."""


@dataclass
class Frame:
    """A function that is being read."""

    function: Any
    names: dict[str, Value]
    tree: ast.FunctionDef
    inline: bool
    depth: int = 0
    ended: bool = False
    result: Value = field(default_factory=lambda: Known(None))
    pending: dict[str, list[Statement]] = field(default_factory=dict)
    hoisted: dict[str, Slot] = field(default_factory=dict)


class StateReader:
    """Names, constants and the state of the method that is read.

    Parameters
    ----------
    state : mapping of str to (record or ndarray)
        Roots of the state by name; the numbers are those before the first call.
    fixed : set of str
        Names of the state that nothing changes: they are constants.
    """

    def __init__(self, state: Mapping[str, Any], fixed: frozenset[str] = frozenset()) -> None:
        self.state, self.fixed = state, fixed
        self.program = Program()
        self._block: list[Statement] = []
        self._taken: list[set[str]] = [set(RESERVED)]
        self._present: dict[Field, Expr] = {}
        self._frames: list[Frame] = []

    def _fresh(self, wanted: str) -> str:
        base = wanted.lstrip("_") or "value"
        name, number = base, 2
        while name in self._taken[-1]:
            name, number = f"{base}_{number}", number + 1
        self._taken[-1].add(name)
        return name

    def _held(self, name: str, value: Value) -> Value:
        """Return a value that stays what it is now: numbers that may change get a variable of their own."""
        if isinstance(value, Slot):
            value = value.value
        if isinstance(value, Group):
            fields = getattr(value.kind, "_fields", None) or [f"{name}_{i}" for i in range(len(value.items))]
            items = (self._held(f, item) for f, item in zip(fields, value.items, strict=True))
            return Group(tuple(items), value.kind)
        if not isinstance(value, NUMBERS) or isinstance(value, Num | Const):
            return value
        if isinstance(value, Var) and value.fixed:
            return value
        variable = Var(self._fresh(name), value.kind)
        self._block.append(Let(variable, value))
        return variable

    def _slot(self, name: str, value: Value, block: list[Statement]) -> Slot:
        """Give a value variables that can be assigned again."""
        found = leaves(value)
        variables: list[Expr] = []
        for part, number in found:
            variable = Var(self._fresh(f"{name}_{part}".rstrip("_")), number.kind, fixed=False)
            block.append(Let(variable, number))
            variables.append(variable)
        return Slot(rebuilt(value, variables))

    def _lookup(self, name: str) -> Value:
        frame = self._frames[-1]
        if name in frame.names:
            found = frame.names[name]
            return found.value if isinstance(found, Slot) else found
        function = frame.function
        free = function.__code__.co_freevars
        if name in free:
            return literal(function.__closure__[free.index(name)].cell_contents)
        if name in function.__globals__:
            value = function.__globals__[name]
            named = isinstance(value, float) and name.isupper()
            return self._constant_of((name.lstrip("_"),), value) if named else literal(value)
        return literal(getattr(builtins, name))

    def _constant_of(self, path: tuple[str, ...], value: Any) -> Value:
        """A constant: a number that decides is known, another has a name."""
        if isinstance(value, np.void | np.ndarray) or hasattr(value, "_fields"):
            return Named(path, value)
        number = literal(value)
        if not isinstance(number, Num) or number.kind != "real" or number.value in (0.0, 1.0, -1.0):
            return number
        name = flat(path).upper()
        self.program.constants[name] = float(number.value), notes_of(path)
        return Const(name, float(number.value))

    def _element(self, value: Named, index: tuple[Expr, ...]) -> Value:
        if all(isinstance(one, Num) for one in index):
            at = tuple(int(one.value) for one in index if isinstance(one, Num))
            return self._constant_of((*value.path, *map(str, at)), value.value[at])
        if len(index) < value.value.ndim:
            raise NotWrittenError(flat(value.path))
        name, table = flat(value.path).upper(), np.asarray(value.value)
        self.program.tables[name] = table, notes_of(value.path)
        return Item(name, index, kind_of(table.dtype))

    def _loaded(self, place: Place) -> Value:
        """Read a number of the state; a record or an array stays a place."""
        if place.shape or place.dtype.names:
            return place
        found = self._field(place)
        if found.name in self.fixed:
            return self._fixed(place, found)
        return self._present.get(found, found)

    def _fixed(self, place: Place, found: Field) -> Value:
        """A number of the state that nothing changes."""
        initial = self.program.state[found.name].initial
        if not found.index:
            return self._constant_of(place.path, initial[()])
        return self._element(Named(place.path, initial), found.index)

    def _field(self, place: Place) -> Field:
        name = flat(place.path)
        if name not in self.program.state:
            initial = initial_of(self.state, place.path)
            kind = kind_of(initial.dtype)
            self.program.state[name] = StateField(initial.shape, kind, initial, notes_of(place.path))
        return Field(name, place.index, self.program.state[name].kind)


def field_of(dtype: np.dtype, name: str) -> tuple[np.dtype, tuple[int, ...]]:
    """Type and shape of a field of a record."""
    if dtype.fields is None or name not in dtype.fields:
        raise NotWrittenError(f"no field {name}")
    fields: Any = dtype.fields
    inner = fields[name][0]
    return inner.subdtype if inner.subdtype is not None else (inner, ())


def flat(path: tuple[str, ...]) -> str:
    """Name of what lies at the end of a path."""
    kept = [name for name in path[(path[0] in ("s", "p")) :] if name not in _HIDDEN]
    return "_".join(kept)


def initial_of(state: Mapping[str, Any], path: tuple[str, ...]) -> np.ndarray:
    """Numbers of a place of the state before the first call."""
    value = state[path[0]]
    for name in path[1:]:
        value = value[name]
    return np.asarray(value)

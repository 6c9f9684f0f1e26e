"""What the reader of the law knows of a name: an object, a constant, a place, a group, a number."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from navcore.exporting.ir import Const, Expr, Field, Item, Kind, Num, Op, Var


class NotWrittenError(Exception):
    """The law says something that an exported program cannot say."""


class NotInlinedError(Exception):
    """A function has to stay one: it returns from within."""


@dataclass(frozen=True)
class Known:
    """An object of Python: a function, a class, a text, an array without elements."""

    value: Any


@dataclass(frozen=True)
class Named:
    """A record or an array of constants, or one number of it, with its name."""

    path: tuple[str, ...]
    value: Any


@dataclass(frozen=True)
class Place:
    """A record, an array or a number in the state.

    Attributes
    ----------
    path : tuple of str
        Names from the state on.
    index : tuple of Expr
        Indices so far, in the order of the axes.
    dtype : dtype
        Of an element.
    shape : tuple of int
        Of what is left.
    """

    path: tuple[str, ...]
    index: tuple[Expr, ...]
    dtype: np.dtype
    shape: tuple[int, ...] = ()


@dataclass(frozen=True)
class Group:
    """A tuple, or a named one.

    Attributes
    ----------
    items : tuple
        Values.
    kind : type or None
        Class of a named tuple.
    """

    items: tuple[Any, ...]
    kind: type | None = None

    def named(self, name: str) -> Any:
        """Value of a field of a named tuple."""
        return self.items[self.kind._fields.index(name)]  # pyright: ignore[reportOptionalMemberAccess, reportAttributeAccessIssue]


@dataclass(frozen=True)
class Slot:
    """A variable, or a group of variables, that is assigned more than once."""

    value: Any


Value = Known | Named | Place | Group | Slot | Expr
NUMBERS = (Num, Const, Item, Var, Field, Op)
"""Classes of expressions."""


def kind_of(dtype: np.dtype) -> Kind:
    """Kind of the numbers of an array."""
    return "real" if dtype.kind == "f" else "bool" if dtype.kind == "b" else "int"


def literal(value: Any) -> Value:
    """Return what is known of a Python object."""
    if isinstance(value, bool | np.bool_):
        return Num(bool(value))
    if isinstance(value, int | np.integer):
        return Num(int(value))
    if isinstance(value, float | np.floating):
        return Num(float(value))
    if isinstance(value, tuple):
        kind = type(value) if hasattr(value, "_fields") else None
        return Group(tuple(map(literal, value)), kind)
    return Known(value)


def leaves(value: Value) -> list[tuple[str, Expr]]:
    """Numbers of a value with the names of their fields; raises where it has anything else."""
    if isinstance(value, Slot):
        return leaves(value.value)
    if isinstance(value, Group):
        names = getattr(value.kind, "_fields", None) or [""] * len(value.items)
        found = []
        for name, item in zip(names, value.items, strict=True):
            found += [("_".join(filter(None, (name, rest))), one) for rest, one in leaves(item)]
        return found
    if isinstance(value, NUMBERS):
        return [("", value)]
    raise NotWrittenError(f"no numbers: {value}")


def rebuilt(value: Value, numbers: list[Expr]) -> Value:
    """Put other numbers in the place of the `leaves` of a value; takes them from the list."""
    if isinstance(value, Slot):
        return rebuilt(value.value, numbers)
    if isinstance(value, Group):
        return Group(tuple(rebuilt(item, numbers) for item in value.items), value.kind)
    return numbers.pop(0)

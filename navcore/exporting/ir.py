"""The law as a small program: what is left of the compiled law once its parameters are known.

`navcore.exporting.reading` makes it from the law's own source; each target (C, Python, MATLAB) prints it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np

Kind = Literal["real", "int", "bool"]
"""What a number is."""


@dataclass(frozen=True)
class Num:
    """A number that is known."""

    value: float | int | bool

    @property
    def kind(self) -> Kind:
        """Of the number."""
        if isinstance(self.value, bool):
            return "bool"
        return "int" if isinstance(self.value, int) else "real"


@dataclass(frozen=True)
class Const:
    """A constant with a name: a coefficient, a threshold."""

    name: str
    value: float
    kind: Kind = "real"


@dataclass(frozen=True)
class Item:
    """An element of a table of constants."""

    table: str
    index: tuple[Expr, ...]
    kind: Kind


@dataclass(frozen=True)
class Var:
    """A local variable or a parameter of a function; ``fixed`` ones are assigned once."""

    name: str
    kind: Kind
    fixed: bool = True


@dataclass(frozen=True)
class Field:
    """A place in the state."""

    name: str
    index: tuple[Expr, ...]
    kind: Kind


@dataclass(frozen=True)
class Op:
    """An operation: + - * / neg < <= > >= == != and or not if real int, or the name of a function."""

    op: str
    args: tuple[Expr, ...]
    kind: Kind


Expr = Num | Const | Item | Var | Field | Op
"""An expression; it changes nothing."""


@dataclass
class Let:
    """A variable gets its value: for good, or (``declare``) its first one, or a new one."""

    var: Var
    value: Expr
    declare: bool = True


@dataclass
class Store:
    """A place in the state gets a value."""

    place: Field
    value: Expr


@dataclass
class If:
    """One of two blocks."""

    condition: Expr
    then: list[Statement]
    otherwise: list[Statement]


@dataclass
class For:
    """A count from ``start`` to before ``stop`` by +1 or -1."""

    var: Var
    start: Expr
    stop: Expr
    step: int
    body: list[Statement]


@dataclass
class While:
    """A block that is repeated."""

    condition: Expr
    body: list[Statement]


@dataclass
class Call:
    """A function is called; its results get names."""

    targets: tuple[Var, ...]
    function: str
    args: tuple[Expr, ...]


@dataclass
class Return:
    """A function ends."""

    values: tuple[Expr, ...]


Statement = Let | Store | If | For | While | Call | Return


@dataclass
class Function:
    """A function of the program.

    Attributes
    ----------
    name, doc : str
        Its name, and the first lines of the docstring of the law's own function.
    params : tuple of Var
        Numbers that it is given; the state is at hand everywhere.
    results : tuple of (str, Kind)
        Names and kinds of what it returns.
    body : list of Statement
        What it does.
    """

    name: str
    doc: str
    params: tuple[Var, ...]
    results: tuple[tuple[str, Kind], ...]
    body: list[Statement]


@dataclass(frozen=True, eq=False)
class StateField:
    """A number or array of the state.

    Attributes
    ----------
    shape : tuple of int
        Empty for a number.
    kind : {"real", "int", "bool"}
        Of each element.
    initial : ndarray, shape ``shape``
        Values before the first call.
    note : str
        What it is, with its unit.
    """

    shape: tuple[int, ...]
    kind: Kind
    initial: np.ndarray
    note: str


@dataclass
class Program:
    """The law of one method, ready to be printed.

    Attributes
    ----------
    functions : list of Function
        Each after those that it calls; the last one is a step.
    state : dict of StateField
        By name.
    constants : dict of (float, str)
        Value and note of each constant by name.
    tables : dict of (ndarray, str)
        Values and note of each table of constants.
    """

    functions: list[Function] = field(default_factory=list)
    state: dict[str, StateField] = field(default_factory=dict)
    constants: dict[str, tuple[float, str]] = field(default_factory=dict)
    tables: dict[str, tuple[np.ndarray, str]] = field(default_factory=dict)


def children(expr: Expr) -> tuple[Expr, ...]:
    """Return the expressions within an expression."""
    if isinstance(expr, Op):
        return expr.args
    return expr.index if isinstance(expr, Field | Item) else ()


def parts(expr: Expr) -> Iterator[Expr]:
    """Yield an expression and all within it."""
    yield expr
    for one in children(expr):
        yield from parts(one)


def blocks(statement: Statement) -> tuple[list[Statement], ...]:
    """Return the blocks within a statement."""
    if isinstance(statement, If):
        return statement.then, statement.otherwise
    return (statement.body,) if isinstance(statement, For | While) else ()


def statements(block: list[Statement]) -> Iterator[Statement]:
    """Yield the statements of a block and of all within it."""
    for statement in block:
        yield statement
        for inner in blocks(statement):
            yield from statements(inner)


def expressions(statement: Statement) -> tuple[Expr, ...]:
    """Return what a statement itself reads."""
    if isinstance(statement, Let):
        return (statement.value,)
    if isinstance(statement, Store):
        return (*statement.place.index, statement.value)
    if isinstance(statement, If | While):
        return (statement.condition,)
    if isinstance(statement, For):
        return statement.start, statement.stop
    return statement.args if isinstance(statement, Call) else statement.values


_FOLDED: dict[str, Callable[..., Any]] = {
    "+": lambda a, b: a + b,
    "-": lambda a, b: a - b,
    "*": lambda a, b: a * b,
    "/": lambda a, b: a / b,
    "neg": lambda a: -a,
    "<": lambda a, b: a < b,
    "<=": lambda a, b: a <= b,
    ">": lambda a, b: a > b,
    ">=": lambda a, b: a >= b,
    "==": lambda a, b: a == b,
    "!=": lambda a, b: a != b,
    "not": lambda a: not a,
    "real": float,
    "int": int,
    "min": min,
    "max": max,
    "abs": abs,
    **{name: getattr(math, name) for name in ("sqrt", "sin", "cos", "tan", "exp", "floor", "hypot", "atan2")},
}
COMPARISONS = ("<", "<=", ">", ">=", "==", "!=")
"""Operations that give a truth value of two numbers."""


def operation(op: str, *args: Expr) -> Expr:
    """Make an operation, simplified: of known numbers the result, and without what changes nothing."""
    if all(isinstance(one, Num) for one in args) and op in _FOLDED:
        try:
            return Num(_FOLDED[op](*(one.value for one in args if isinstance(one, Num))))
        except (ZeroDivisionError, ValueError):
            pass
    if op in ("and", "or"):
        return _logical(op, args)
    if op == "if":
        return _chosen(*args)
    kinds = {one.kind for one in args}
    if op in COMPARISONS or op == "not":
        if "real" in kinds and "int" in kinds:
            args = tuple(_as_real(one) for one in args)
        return Op(op, args, "bool")
    if op in ("+", "-", "*", "min", "max", "abs", "neg"):
        if "real" in kinds:
            args = tuple(_as_real(one) for one in args)
            simple = _without_effect(op, args)
            return Op(op, args, "real") if simple is None else simple
        return Op(op, args, "int")
    if op == "int":
        return args[0] if args[0].kind == "int" else Op("int", args, "int")
    if op == "real":
        return _as_real(args[0])
    return Op(op, tuple(_as_real(one) for one in args), "bool" if op == "isfinite" else "real")


def _as_real(expr: Expr) -> Expr:
    if expr.kind == "real":
        return expr
    return Num(float(expr.value)) if isinstance(expr, Num) else Op("real", (expr,), "real")


def _is(expr: Expr, value: float) -> bool:
    return isinstance(expr, Num) and expr.value == value


def _without_effect(op: str, args: tuple[Expr, ...]) -> Expr | None:
    """Return what is simpler and has the same value for finite numbers; None where nothing is."""
    if op == "+":
        a, b = args
        return b if _is(a, 0.0) else a if _is(b, 0.0) else None
    if op == "-":
        a, b = args
        return a if _is(b, 0.0) else operation("neg", b) if _is(a, 0.0) else None
    if op == "*":
        a, b = args
        if _is(a, 0.0) or _is(b, 0.0):
            return Num(0.0)
        return b if _is(a, 1.0) else a if _is(b, 1.0) else None
    return None


def _logical(op: str, args: tuple[Expr, ...]) -> Expr:
    """Leave out what is known; stop at what decides."""
    decides, left = op == "or", []
    for one in args:
        if isinstance(one, Num):
            if bool(one.value) == decides:
                left.append(Num(decides))
                break
            continue
        left.append(one)
    if not left or isinstance(left[0], Num):
        return left[0] if left else Num(not decides)
    return left[0] if len(left) == 1 else Op(op, tuple(left), "bool")


def _chosen(condition: Expr, then: Expr, otherwise: Expr) -> Expr:
    if isinstance(condition, Num):
        return then if condition.value else otherwise
    if then == otherwise:
        return then
    if then.kind != otherwise.kind:
        then, otherwise = _as_real(then), _as_real(otherwise)
    return Op("if", (condition, then, otherwise), then.kind)

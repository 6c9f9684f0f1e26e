"""What all targets share when they print a program: expressions with few brackets, and blocks."""

from __future__ import annotations

import textwrap

from navcore.exporting.ir import (
    COMPARISONS,
    Call,
    Const,
    Expr,
    Field,
    For,
    Function,
    If,
    Item,
    Let,
    Num,
    Op,
    Program,
    Return,
    Statement,
    Store,
    Var,
    While,
    expressions,
    parts,
    statements,
)

INDENT = "    "
_STRENGTH = {"if": 0, "or": 1, "and": 2, "not": 7, "+": 5, "-": 5, "*": 6, "/": 6, "neg": 7}
_ATOM = 9


class Printer:
    """Base of the printers: how a language writes expressions and blocks.

    Attributes
    ----------
    signs : dict of str to str
        Operators by operation, where they differ from its name.
    """

    signs: dict[str, str]

    def __init__(self, program: Program) -> None:
        self.program = program
        self._needs = touched(program, self.constants_need_state)

    constants_need_state: bool = False
    """Whether constants lie in the state."""

    # ------------------------------------------------------------ what a language says

    def number(self, value: float) -> str:
        """A real number."""
        raise NotImplementedError

    def whole(self, value: float | int | bool, truth: bool) -> str:
        """A whole number, or a truth value."""
        raise NotImplementedError

    def element(self, name: str, index: tuple[Expr, ...]) -> str:
        """An element of an array."""
        raise NotImplementedError

    def constant(self, name: str) -> str:
        """A constant."""
        return name

    def of_state(self, name: str) -> str:
        """A place in the state."""
        raise NotImplementedError

    def chosen(self, condition: str, then: str, otherwise: str) -> str:
        """One of two values."""
        raise NotImplementedError

    def function(self, op: str, args: list[str], expr: Op) -> str:
        """A function of mathematics, or a conversion."""
        raise NotImplementedError

    # ------------------------------------------------------------ expressions

    def expression(self, expr: Expr) -> str:
        """An expression."""
        if isinstance(expr, Num):
            if expr.kind == "real":
                return self.number(float(expr.value))
            return self.whole(expr.value, expr.kind == "bool")
        if isinstance(expr, Var):
            return expr.name
        if isinstance(expr, Const):
            return self.constant(expr.name)
        if isinstance(expr, Field | Item):
            name = self.of_state(expr.name) if isinstance(expr, Field) else self.constant(expr.table)
            return self.element(name, expr.index) if expr.index else name
        return self._operation(expr)

    def _operation(self, expr: Op) -> str:
        op, args = expr.op, expr.args
        if op in ("neg", "not"):
            return self.signs.get(op, "-") + self.bracketed(args[0])
        if op in (*COMPARISONS, "and", "or", "+", "-", "*", "/"):
            sign = self.signs.get(op, op)
            return f" {sign} ".join(self._inner(one, expr, i > 0) for i, one in enumerate(args))
        if op == "if":
            condition, then, otherwise = (self._inner(one, expr, True) for one in args)
            return self.chosen(condition, then, otherwise)
        return self.function(op, [self.expression(one) for one in args], expr)

    def _inner(self, expr: Expr, outer: Op, right: bool) -> str:
        """An operand: the order of operations stays that of the law."""
        mine, its = strength(expr), strength(outer)
        mixed = isinstance(expr, Op) and {expr.op, outer.op} == {"and", "or"}
        text = self.expression(expr)
        return f"({text})" if mine < its or (right and mine == its) or mixed else text

    def bracketed(self, expr: Expr) -> str:
        """An expression with brackets, where it is not a single thing."""
        text = self.expression(expr)
        return f"({text})" if strength(expr) < _ATOM or isinstance(expr, Op) else text

    # ------------------------------------------------------------ statements

    def block(self, body: list[Statement], depth: int, function: Function) -> list[str]:
        """Lines of a block."""
        return [line for one in body for line in self.statement(one, depth, function)]

    def statement(self, one: Statement, depth: int, function: Function) -> list[str]:
        """Lines of a statement."""
        pad = INDENT * depth
        if isinstance(one, Let):
            return [f"{pad}{self.assigned(one)}"]
        if isinstance(one, Store):
            return [f"{pad}{self.stored(self.expression(one.place), self.expression(one.value))}"]
        if isinstance(one, If):
            then, otherwise = (self.block(part, depth + 1, function) for part in (one.then, one.otherwise))
            condition = self.expression(one.condition)
            if not then:
                then, otherwise = otherwise, then
                condition = self.signs["not"] + self.bracketed(one.condition)
            return self.branches(condition, then, otherwise, pad)
        if isinstance(one, For | While):
            return [pad + self.head(one), *self.block(one.body, depth + 1, function), *self.end(pad)]
        if isinstance(one, Call):
            return [pad + line for line in self.call(one)]
        return [pad + line for line in self.returned(one, function)]

    def assigned(self, one: Let) -> str:
        """A variable gets a value."""
        raise NotImplementedError

    def stored(self, place: str, value: str) -> str:
        """A place gets a value."""
        raise NotImplementedError

    def branches(self, condition: str, then: list[str], otherwise: list[str], pad: str) -> list[str]:
        """One of two blocks."""
        raise NotImplementedError

    def head(self, one: For | While) -> str:
        """Head of a loop."""
        raise NotImplementedError

    def end(self, pad: str) -> list[str]:
        """What ends a block."""
        raise NotImplementedError

    def call(self, one: Call) -> list[str]:
        """Lines of a call."""
        raise NotImplementedError

    def returned(self, one: Return, function: Function) -> list[str]:
        """Lines with which a function ends."""
        raise NotImplementedError

    def touches(self, function: Function) -> tuple[bool, bool]:
        """Whether a function is given the state, and whether it changes it."""
        return self._needs[function.name]

    def needs_state(self, function: Function) -> bool:
        """Whether a function is given the state."""
        return self._needs[function.name][0]


def strength(expr: Expr) -> int:
    """How strongly the operation of an expression binds."""
    if isinstance(expr, Num) and not isinstance(expr.value, bool) and expr.value < 0:
        return _STRENGTH["neg"]
    if not isinstance(expr, Op):
        return _ATOM
    return 4 if expr.op in COMPARISONS else _STRENGTH.get(expr.op, _ATOM)


def touched(program: Program, constants: bool = False) -> dict[str, tuple[bool, bool]]:
    """Whether each function, or one that it calls, needs the state, and whether it changes it.

    Parameters
    ----------
    program : Program
        The law.
    constants : bool
        Constants lie in the state.
    """
    kinds = (Field, Const, Item) if constants else (Field,)
    found: dict[str, tuple[bool, bool]] = {}
    for function in program.functions:
        reads = writes = False
        for statement in statements(function.body):
            if isinstance(statement, Call):
                inner = found[statement.function]
                reads, writes = reads or inner[0], writes or inner[1]
            writes = writes or isinstance(statement, Store)
            reads = reads or any(
                isinstance(part, kinds) for one in expressions(statement) for part in parts(one)
            )
        found[function.name] = (reads or writes, writes)
    return found


def wrapped(text: str, width: int) -> list[str]:
    """Lines of a comment."""
    return textwrap.wrap(text, width)

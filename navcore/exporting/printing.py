"""What all targets share when they print a program: precedence, indentation, and what a function needs."""

from __future__ import annotations

from navcore.exporting.ir import (
    COMPARISONS,
    Call,
    Expr,
    Field,
    Function,
    Num,
    Op,
    Program,
    Statement,
    Store,
    expressions,
    parts,
    statements,
)

_STRENGTH = {"if": 0, "or": 1, "and": 2, "not": 7, "+": 5, "-": 5, "*": 6, "/": 6, "neg": 7}
ATOM = 9
"""Strength of what needs no brackets."""


def strength(expr: Expr) -> int:
    """How strongly the operation of an expression binds."""
    if isinstance(expr, Num) and not isinstance(expr.value, bool) and expr.value < 0:
        return _STRENGTH["neg"]
    if not isinstance(expr, Op):
        return ATOM
    return 4 if expr.op in COMPARISONS else _STRENGTH.get(expr.op, ATOM)


def right_needs_more(op: str) -> bool:
    """Whether the right operand of equal strength needs brackets: the law's order of operations stays."""
    return op in ("-", "/", "+", "*", *COMPARISONS)


def touched(program: Program) -> dict[str, tuple[bool, bool]]:
    """Whether each function, or one that it calls, needs the state, and whether it changes it."""
    found: dict[str, tuple[bool, bool]] = {}
    for function in program.functions:
        reads = writes = False
        for statement in statements(function.body):
            if isinstance(statement, Call):
                inner = found[statement.function]
                reads, writes = reads or inner[0], writes or inner[1]
            writes = writes or isinstance(statement, Store)
            reads = reads or any(
                isinstance(part, Field) for one in expressions(statement) for part in parts(one)
            )
        found[function.name] = (reads or writes, writes)
    return found


def uses(function: Function, kind: type) -> bool:
    """Whether a function reads an expression of a kind."""
    return any(
        isinstance(part, kind)
        for statement in statements(function.body)
        for one in expressions(statement)
        for part in parts(one)
    )


def wrapped(text: str, width: int) -> list[str]:
    """Lines of a comment."""
    import textwrap

    return textwrap.wrap(text, width)


Block = list[Statement]

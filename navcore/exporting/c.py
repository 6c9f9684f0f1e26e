"""A program as C99: state, constants and functions; no allocation, no global state."""

from __future__ import annotations

import math
import re

import numpy as np

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
    Kind,
    Let,
    Num,
    Op,
    Program,
    Return,
    Statement,
    Store,
    Var,
    While,
)
from navcore.exporting.printing import right_needs_more, strength, touched, wrapped

_TYPES: dict[Kind, str] = {"int": "int64_t", "bool": "int"}
_SIGNS = {"and": "&&", "or": "||", **{one: one for one in (*COMPARISONS, "+", "-", "*", "/")}}
_INDENT = "    "


class CPrinter:
    """Prints a program.

    Parameters
    ----------
    program : Program
        Of the law.
    prefix : str
        Of all names that other files see.
    single : bool
        Numbers are float in place of double.
    """

    def __init__(self, program: Program, prefix: str, single: bool = False) -> None:
        self.program, self.prefix, self.single = program, prefix, single
        self.real = "float" if single else "double"
        self._needs = touched(program)

    # ------------------------------------------------------------ numbers

    def number(self, value: float) -> str:
        """A number as a literal of the target's type."""
        if math.isinf(value):
            return "INFINITY" if value > 0 else "-INFINITY"
        text = str(np.float32(value)) if self.single else repr(float(value))
        text = text if re.search(r"[.e]", text) else f"{text}.0"
        return f"{text}f" if self.single else text

    def type_of(self, kind: Kind) -> str:
        """Type of a variable."""
        return _TYPES.get(kind, self.real)

    # ------------------------------------------------------------ expressions

    def expression(self, expr: Expr) -> str:
        """An expression."""
        if isinstance(expr, Num):
            return self.number(expr.value) if expr.kind == "real" else str(int(expr.value))
        if isinstance(expr, Var | Const):
            return expr.name
        if isinstance(expr, Field | Item):
            name = f"s->{expr.name}" if isinstance(expr, Field) else expr.table
            return name + "".join(f"[{self.expression(one)}]" for one in expr.index)
        return self._operation(expr)

    def _operation(self, expr: Op) -> str:
        op, args = expr.op, expr.args
        if op in _SIGNS:
            return f" {_SIGNS[op]} ".join(
                self._inner(one, expr, i > 0 and right_needs_more(op)) for i, one in enumerate(args)
            )
        if op == "if":
            condition, then, otherwise = (self._inner(one, expr, True) for one in args)
            return f"{condition} ? {then} : {otherwise}"
        if op in ("neg", "not"):
            return ("-" if op == "neg" else "!") + self._bracketed(args[0])
        if op in ("real", "int"):
            return f"({self.type_of(expr.kind)}){self._bracketed(args[0])}"
        given = [self.expression(one) for one in args]
        if expr.kind == "int":
            return self._of_integers(op, [self._bracketed(one) for one in args])
        if op == "isfinite":
            return f"isfinite({given[0]})"
        name = {"min": "fmin", "max": "fmax", "abs": "fabs"}.get(op, op)
        return f"{name}{'f' if self.single else ''}({', '.join(given)})"

    def _of_integers(self, op: str, args: list[str]) -> str:
        if op == "abs":
            return f"({args[0]} < 0 ? -{args[0]} : {args[0]})"
        sign = "<" if op == "min" else ">"
        return f"({args[0]} {sign} {args[1]} ? {args[0]} : {args[1]})"

    def _inner(self, expr: Expr, outer: Op, equal_too: bool) -> str:
        mine, its = strength(expr), strength(outer)
        mixed = isinstance(expr, Op) and {expr.op, outer.op} == {"and", "or"}
        text = self.expression(expr)
        return f"({text})" if mine < its or (equal_too and mine == its) or mixed else text

    def _bracketed(self, expr: Expr) -> str:
        text = self.expression(expr)
        return f"({text})" if isinstance(expr, Op) or (isinstance(expr, Num) and expr.value < 0) else text

    # ------------------------------------------------------------ statements

    def block(self, body: list[Statement], depth: int, function: Function) -> list[str]:
        """Lines of a block."""
        return [line for one in body for line in self._statement(one, depth, function)]

    def _statement(self, one: Statement, depth: int, function: Function) -> list[str]:
        pad = _INDENT * depth
        if isinstance(one, Let):
            kind = f"{'const ' if one.var.fixed else ''}{self.type_of(one.var.kind)} " if one.declare else ""
            return [f"{pad}{kind}{one.var.name} = {self.expression(one.value)};"]
        if isinstance(one, Store):
            return [f"{pad}{self.expression(one.place)} = {self.expression(one.value)};"]
        if isinstance(one, If):
            return self._if(one, depth, function)
        if isinstance(one, For):
            sign, move = ("<", "++") if one.step > 0 else (">", "--")
            name = one.var.name
            head = (
                f"for (int64_t {name} = {self.expression(one.start)}; "
                f"{name} {sign} {self.expression(one.stop)}; {name}{move})"
            )
            return [f"{pad}{head} {{", *self.block(one.body, depth + 1, function), f"{pad}}}"]
        if isinstance(one, While):
            head = f"{pad}while ({self.expression(one.condition)}) {{"
            return [head, *self.block(one.body, depth + 1, function), f"{pad}}}"]
        if isinstance(one, Call):
            return self._call(one, pad)
        return self._return(one, pad, function)

    def _if(self, one: If, depth: int, function: Function) -> list[str]:
        pad = _INDENT * depth
        then = self.block(one.then, depth + 1, function)
        otherwise = self.block(one.otherwise, depth + 1, function)
        if not then:
            head = f"{pad}if (!{self._bracketed(one.condition)}) {{"
            return [head, *otherwise, f"{pad}}}"]
        lines = [f"{pad}if ({self.expression(one.condition)}) {{", *then]
        return [*lines, *([f"{pad}}} else {{", *otherwise] if otherwise else []), f"{pad}}}"]

    def _call(self, one: Call, pad: str) -> list[str]:
        given = ["s"] if self._needs[one.function][0] else []
        given += [self.expression(arg) for arg in one.args]
        if len(one.targets) == 1:
            (target,) = one.targets
            kind = self.type_of(target.kind)
            return [f"{pad}const {kind} {target.name} = {one.function}({', '.join(given)});"]
        lines = [f"{pad}{self.type_of(target.kind)} {target.name};" for target in one.targets]
        given += [f"&{target.name}" for target in one.targets]
        return [*lines, f"{pad}{one.function}({', '.join(given)});"]

    def _return(self, one: Return, pad: str, function: Function) -> list[str]:
        if len(one.values) == 1:
            return [f"{pad}return {self.expression(one.values[0])};"]
        pairs = zip(function.results, one.values, strict=bool(one.values))
        lines = [f"{pad}*{_result(name)} = {self.expression(value)};" for (name, _), value in pairs]
        return lines if one is function.body[-1] else [*lines, f"{pad}return;"]

    # ------------------------------------------------------------ parts of a file

    def needs_state(self, function: Function) -> bool:
        """Whether a function is given the state."""
        return self._needs[function.name][0]

    def signature(self, function: Function) -> str:
        """Head of a function."""
        several = len(function.results) != 1
        kind = "void" if several else self.type_of(function.results[0][1])
        given = [f"{self.prefix}_state *s"] if self._needs[function.name][0] else []
        given += [f"{self.type_of(one.kind)} {one.name}" for one in function.params]
        if several:
            given += [f"{self.type_of(k)} *{_result(name)}" for name, k in function.results]
        return f"static {kind} {function.name}({', '.join(given) or 'void'})"

    def functions(self) -> str:
        """All functions, with what they do as comments."""
        found = []
        for function in self.program.functions:
            head = "\n".join(_comment(function.doc)) if function.doc else ""
            body = "\n".join(self.block(function.body, 1, function))
            found.append(f"{head}\n{_folded(self.signature(function))}\n{{\n{body}\n}}".lstrip("\n"))
        return "\n\n".join(found)

    def constants(self) -> str:
        """Constants and tables with their notes."""
        lines = []
        for name, (value, note) in self.program.constants.items():
            lines.append(f"static const {self.real} {name} = {self.number(value)};{_beside(note)}")
        for name, (table, note) in self.program.tables.items():
            kind = self.real if table.dtype.kind == "f" else "int64_t"
            shape = "".join(f"[{n}]" for n in table.shape)
            lines.append(f"static const {kind} {name}{shape} = {self._table(table)};{_beside(note)}")
        return "\n".join(lines)

    def _table(self, table: np.ndarray) -> str:
        if table.ndim > 1:
            return "{" + ",\n ".join(self._table(row) for row in table) + "}"
        values = [self.number(v) if table.dtype.kind == "f" else str(int(v)) for v in table.tolist()]
        return "{" + ", ".join(values) + "}"

    def state_fields(self) -> str:
        """Fields of the state with their notes."""
        lines = []
        for name, one in self.program.state.items():
            shape = "".join(f"[{n}]" for n in one.shape)
            lines.append(f"{_INDENT}{self.type_of(one.kind)} {name}{shape};{_beside(one.note)}")
        return "\n".join(lines or [f"{_INDENT}int nothing; /* this law keeps nothing */"])

    def initial_values(self) -> str:
        """Statements that put the state before the first call."""
        lines = []
        for name, one in self.program.state.items():
            for at in np.ndindex(one.shape):
                value = one.initial[at]
                if value != 0:
                    text = self.number(float(value)) if one.kind == "real" else str(int(value))
                    lines.append(f"{_INDENT}s->{name}{''.join(f'[{i}]' for i in at)} = {text};")
        return "\n".join(lines)


def _result(name: str) -> str:
    return f"{name}_out"


def _beside(note: str) -> str:
    return f" /* {note} */" if note else ""


def _comment(text: str) -> list[str]:
    lines = wrapped(text.replace("*/", "* /"), 96)
    if len(lines) == 1:
        return [f"/* {lines[0]} */"]
    return [f"/* {lines[0]}", *(f" * {line}" for line in lines[1:-1]), f" * {lines[-1]} */"]


def _folded(head: str) -> str:
    """A long signature in several lines."""
    if len(head) <= 100:
        return head
    start, _, given = head.partition("(")
    lines, line = [], _INDENT
    for one in given.rstrip(")").split(", "):
        if len(line) + len(one) > 96:
            lines.append(line.rstrip())
            line = _INDENT
        line += f"{one}, "
    return f"{start}(\n" + "\n".join([*lines, line.rstrip(", ")]) + ")"

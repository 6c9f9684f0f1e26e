"""A program as C99: state, constants and functions; no allocation, no global state."""

from __future__ import annotations

import math
import re

import numpy as np

from navcore.exporting.ir import Call, Expr, For, Function, Kind, Let, Op, Program, Return, While
from navcore.exporting.printing import INDENT, Printer, wrapped

_TYPES: dict[Kind, str] = {"int": "int64_t", "bool": "int"}
_NAMES = {"min": "fmin", "max": "fmax", "abs": "fabs"}


class CPrinter(Printer):
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

    signs = {"and": "&&", "or": "||", "not": "!"}

    def __init__(self, program: Program, prefix: str, single: bool = False) -> None:
        super().__init__(program)
        self.prefix, self.single = prefix, single
        self.real = "float" if single else "double"

    def number(self, value: float) -> str:
        """A number as a literal of the target's type."""
        if math.isinf(value):
            return "INFINITY" if value > 0 else "-INFINITY"
        text = str(np.float32(value)) if self.single else repr(float(value))
        text = text if re.search(r"[.e]", text) else f"{text}.0"
        return f"{text}f" if self.single else text

    def whole(self, value: float | int | bool, truth: bool) -> str:
        """A whole number; 1 is true."""
        return str(int(value))

    def element(self, name: str, index: tuple[Expr, ...]) -> str:
        """An element of an array."""
        return name + "".join(f"[{self.expression(one)}]" for one in index)

    def of_state(self, name: str) -> str:
        """A place in the state."""
        return f"s->{name}"

    def chosen(self, condition: str, then: str, otherwise: str) -> str:
        """One of two values."""
        return f"{condition} ? {then} : {otherwise}"

    def function(self, op: str, args: list[str], expr: Op) -> str:
        """A function of mathematics, or a conversion."""
        if op in ("real", "int"):
            return f"({self.type_of(expr.kind)}){self.bracketed(expr.args[0])}"
        if expr.kind == "int":
            first, *others = (self.bracketed(one) for one in expr.args)
            if op == "abs":
                return f"({first} < 0 ? -{first} : {first})"
            return f"({first} {'<' if op == 'min' else '>'} {others[0]} ? {first} : {others[0]})"
        if op == "isfinite":
            return f"isfinite({args[0]})"
        return f"{_NAMES.get(op, op)}{'f' if self.single else ''}({', '.join(args)})"

    def type_of(self, kind: Kind) -> str:
        """Type of a variable."""
        return _TYPES.get(kind, self.real)

    # ------------------------------------------------------------ statements

    def assigned(self, one: Let) -> str:
        """A variable gets a value."""
        kind = f"{'const ' if one.var.fixed else ''}{self.type_of(one.var.kind)} " if one.declare else ""
        return f"{kind}{one.var.name} = {self.expression(one.value)};"

    def stored(self, place: str, value: str) -> str:
        """A place gets a value."""
        return f"{place} = {value};"

    def branches(self, condition: str, then: list[str], otherwise: list[str], pad: str) -> list[str]:
        """One of two blocks."""
        middle = [f"{pad}}} else {{", *otherwise] if otherwise else []
        return [f"{pad}if ({condition}) {{", *then, *middle, f"{pad}}}"]

    def head(self, one: For | While) -> str:
        """Head of a loop."""
        if isinstance(one, While):
            return f"while ({self.expression(one.condition)}) {{"
        sign, move = ("<", "++") if one.step > 0 else (">", "--")
        name, start, stop = one.var.name, self.expression(one.start), self.expression(one.stop)
        return f"for (int64_t {name} = {start}; {name} {sign} {stop}; {name}{move}) {{"

    def end(self, pad: str) -> list[str]:
        """What ends a block."""
        return [f"{pad}}}"]

    def call(self, one: Call) -> list[str]:
        """Lines of a call: one result is returned, several go to where they are wanted."""
        given = ["s"] if self._needs[one.function][0] else []
        given += [self.expression(arg) for arg in one.args]
        if len(one.targets) == 1:
            (target,) = one.targets
            kind = self.type_of(target.kind)
            return [f"const {kind} {target.name} = {one.function}({', '.join(given)});"]
        lines = [f"{self.type_of(target.kind)} {target.name};" for target in one.targets]
        given += [f"&{target.name}" for target in one.targets]
        return [*lines, f"{one.function}({', '.join(given)});"]

    def returned(self, one: Return, function: Function) -> list[str]:
        """Lines with which a function ends."""
        if len(one.values) == 1:
            return [f"return {self.expression(one.values[0])};"]
        pairs = zip(function.results, one.values, strict=bool(one.values))
        lines = [f"*{_result(name)} = {self.expression(value)};" for (name, _), value in pairs]
        return lines if one is function.body[-1] else [*lines, "return;"]

    # ------------------------------------------------------------ parts of a file

    def signature(self, function: Function) -> str:
        """Head of a function."""
        several = len(function.results) != 1
        kind = "void" if several else self.type_of(function.results[0][1])
        given = [f"{self.prefix}_state *s"] if self.needs_state(function) else []
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
            lines.append(f"{INDENT}{self.type_of(one.kind)} {name}{shape};{_beside(one.note)}")
        return "\n".join(lines or [f"{INDENT}int nothing; /* this law keeps nothing */"])

    def initial_values(self) -> str:
        """Statements that put the state before the first call."""
        lines = []
        for name, one in self.program.state.items():
            for at in np.ndindex(one.shape):
                value = one.initial[at]
                if value != 0:
                    text = self.number(float(value)) if one.kind == "real" else str(int(value))
                    lines.append(f"{INDENT}s->{name}{''.join(f'[{i}]' for i in at)} = {text};")
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
    lines, line = [], INDENT
    for one in given.rstrip(")").split(", "):
        if len(line) + len(one) > 96:
            lines.append(line.rstrip())
            line = INDENT
        line += f"{one}, "
    return f"{start}(\n" + "\n".join([*lines, line.rstrip(", ")]) + ")"

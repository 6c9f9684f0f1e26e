"""A program as MATLAB, for Octave too: functions that take and give the state."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from navcore.exporting.ir import Call, Expr, For, Function, Let, Num, Op, Program, Return, While, operation
from navcore.exporting.printing import INDENT, Printer, wrapped


class MatlabPrinter(Printer):
    """Prints a program; ``single`` as of `CPrinter`."""

    signs = {"and": "&&", "or": "||", "not": "~", "!=": "~="}
    constants_need_state = True

    def __init__(self, program: Program, single: bool = False) -> None:
        super().__init__(program)
        self.single = single

    def number(self, value: float) -> str:
        """A real number."""
        if math.isinf(value):
            return "Inf" if value > 0 else "-Inf"
        return str(np.float32(value)) if self.single else repr(float(value))

    def whole(self, value: float | int | bool, truth: bool) -> str:
        """A whole number, or a truth value."""
        return str(bool(value)).lower() if truth else str(int(value))

    def element(self, name: str, index: tuple[Expr, ...]) -> str:
        """An element of an array: they are counted from 1."""
        return f"{name}({', '.join(self.expression(operation('+', one, Num(1))) for one in index)})"

    def constant(self, name: str) -> str:
        """A field of the constants."""
        return f"s.k.{name}"

    def of_state(self, name: str) -> str:
        """A field of the state."""
        return f"s.{name}"

    def chosen(self, condition: str, then: str, otherwise: str) -> str:
        """One of two values."""
        return f"pick_fn({condition}, {then}, {otherwise})"

    def function(self, op: str, args: list[str], expr: Op) -> str:
        """A function of mathematics, or a conversion."""
        name = {"real": "double", "int": "double"}.get(op, op)
        if op == "real" and self.single:
            name = "single"
        return f"{name}({', '.join(args)})"

    # ------------------------------------------------------------ statements

    def assigned(self, one: Let) -> str:
        """A variable gets a value."""
        return f"{one.var.name} = {self.expression(one.value)};"

    def stored(self, place: str, value: str) -> str:
        """A place gets a value."""
        return f"{place} = {value};"

    def branches(self, condition: str, then: list[str], otherwise: list[str], pad: str) -> list[str]:
        """One of two blocks."""
        middle = [f"{pad}else", *otherwise] if otherwise else []
        return [f"{pad}if {condition}", *then, *middle, f"{pad}end"]

    def head(self, one: For | While) -> str:
        """Head of a loop."""
        if isinstance(one, While):
            return f"while {self.expression(one.condition)}"
        start = self.expression(one.start)
        last = self.expression(operation("-" if one.step > 0 else "+", one.stop, Num(1)))
        return f"for {one.var.name} = {start}:{'' if one.step > 0 else '-1:'}{last}"

    def end(self, pad: str) -> list[str]:
        """What ends a block."""
        return [f"{pad}end"]

    def call(self, one: Call) -> list[str]:
        """A call: a function that changes the state gives it back."""
        needs, changes = self._needs[one.function]
        given = [*(["s"] if needs else []), *(self.expression(arg) for arg in one.args)]
        targets = [*(["s"] if changes else []), *(target.name for target in one.targets)]
        left = f"[{', '.join(targets)}] = " if len(targets) > 1 else f"{targets[0]} = " if targets else ""
        return [f"{left}{one.function}({', '.join(given)});"]

    def returned(self, one: Return, function: Function) -> list[str]:
        """Lines with which a function ends."""
        pairs = zip(function.results, one.values, strict=bool(one.values))
        lines = [f"{name}_out = {self.expression(value)};" for (name, _), value in pairs]
        return lines if one is function.body[-1] else [*lines, "return"]

    # ------------------------------------------------------------ parts of a file

    def functions(self) -> str:
        """All functions."""
        found = []
        for function in self.program.functions:
            needs, changes = self._needs[function.name]
            given = [*(["s"] if needs else []), *(one.name for one in function.params)]
            results = [*(["s"] if changes else []), *(f"{name}_out" for name, _ in function.results)]
            left = f"[{', '.join(results)}] = " if results else ""
            lines = [f"function {left}{function.name}({', '.join(given)})"]
            lines += [f"{INDENT}% {line}" for line in wrapped(function.doc, 92)]
            lines += self.block(function.body, 1, function)
            found.append("\n".join([*lines, "end"]))
        return "\n\n".join(found)

    def constants(self) -> str:
        """Statements that fill the constants."""
        lines = [
            f"k.{name} = {self._typed(self.number(value))};{_beside(note)}"
            for name, (value, note) in self.program.constants.items()
        ]
        for name, (table, note) in self.program.tables.items():
            rows = np.atleast_2d(table)
            text = "; ".join(", ".join(self._entry(v, table) for v in row) for row in rows.tolist())
            lines.append(f"k.{name} = {self._typed(f'[{text}]')};{_beside(note)}")
        return "\n".join(INDENT + line for line in lines)

    def _entry(self, value: float, table: np.ndarray) -> str:
        return self.number(value) if table.dtype.kind == "f" else str(int(value))

    def _typed(self, text: str) -> str:
        return f"single({text})" if self.single else text

    def initial_values(self) -> str:
        """Statements that put the state before the first call."""
        lines = []
        for name, one in self.program.state.items():
            single = ", 'single'" if self.single and one.kind == "real" else ""
            if one.shape:
                shape = one.shape if len(one.shape) > 1 else (1, *one.shape)
                lines.append(f"s.{name} = zeros({', '.join(map(str, shape))}{single});{_beside(one.note)}")
                for at in np.ndindex(one.shape):
                    if one.initial[at] != 0:
                        index = ", ".join(str(i + 1) for i in at)
                        lines.append(f"s.{name}({index}) = {self._initial(one.initial[at], one.kind)};")
                continue
            lines.append(f"s.{name} = {self._initial(one.initial[()], one.kind)};{_beside(one.note)}")
        return "\n".join(INDENT + line for line in lines)

    def _initial(self, value: Any, kind: str) -> str:
        if kind == "real":
            return self._typed(self.number(float(value)))
        return self.whole(value, kind == "bool")


def _beside(note: str) -> str:
    return f" % {note}" if note else ""

"""A program as Python: one class on numpy."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from navcore.exporting.ir import Call, Expr, For, Function, Let, Op, Program, Return, While
from navcore.exporting.printing import INDENT, Printer, wrapped

_BUILT_IN = ("min", "max", "abs")


class PythonPrinter(Printer):
    """Prints a program as methods of a class; ``single`` as of `CPrinter`."""

    signs = {"not": "not "}

    def __init__(self, program: Program, single: bool = False) -> None:
        super().__init__(program)
        self.single = single

    def number(self, value: float) -> str:
        """A real number."""
        if math.isinf(value):
            return "math.inf" if value > 0 else "-math.inf"
        return str(np.float32(value)) if self.single else repr(float(value))

    def whole(self, value: float | int | bool, truth: bool) -> str:
        """A whole number, or a truth value."""
        return str(bool(value)) if truth else str(int(value))

    def element(self, name: str, index: tuple[Expr, ...]) -> str:
        """An element of an array."""
        return f"{name}[{', '.join(self.expression(one) for one in index)}]"

    def of_state(self, name: str) -> str:
        """An attribute of the object."""
        return f"self.{name}"

    def chosen(self, condition: str, then: str, otherwise: str) -> str:
        """One of two values."""
        return f"({then} if {condition} else {otherwise})"

    def function(self, op: str, args: list[str], expr: Op) -> str:
        """A function of mathematics, or a conversion."""
        given = ", ".join(args)
        if op in ("real", "int"):
            return f"{'float' if op == 'real' else 'int'}({given})"
        if op in _BUILT_IN:
            return f"{op}({given})"
        if self.single:
            return f"np.{'arctan2' if op == 'atan2' else op}({given})"
        return f"float(math.floor({given}))" if op == "floor" else f"math.{op}({given})"

    # ------------------------------------------------------------ statements

    def assigned(self, one: Let) -> str:
        """A variable gets a value."""
        return f"{one.var.name} = {self.expression(one.value)}"

    def stored(self, place: str, value: str) -> str:
        """A place gets a value."""
        return f"{place} = {value}"

    def branches(self, condition: str, then: list[str], otherwise: list[str], pad: str) -> list[str]:
        """One of two blocks."""
        return [f"{pad}if {condition}:", *then, *([f"{pad}else:", *otherwise] if otherwise else [])]

    def head(self, one: For | While) -> str:
        """Head of a loop."""
        if isinstance(one, While):
            return f"while {self.expression(one.condition)}:"
        start, stop = self.expression(one.start), self.expression(one.stop)
        step = "" if one.step > 0 else ", -1"
        return f"for {one.var.name} in range({start}, {stop}{step}):"

    def end(self, pad: str) -> list[str]:
        """Nothing ends a block."""
        return []

    def call(self, one: Call) -> list[str]:
        """A call of a method."""
        called = f"self.{one.function}({', '.join(self.expression(arg) for arg in one.args)})"
        targets = ", ".join(target.name for target in one.targets)
        return [f"{targets} = {called}" if targets else called]

    def returned(self, one: Return, function: Function) -> list[str]:
        """The line with which a method ends."""
        return [f"return {', '.join(self.expression(value) for value in one.values)}".rstrip()]

    # ------------------------------------------------------------ parts of a file

    def functions(self) -> str:
        """All methods."""
        found = []
        for function in self.program.functions:
            names = ", ".join(["self", *(one.name for one in function.params)])
            doc = "\n".join(wrapped(f'"""{function.doc}"""', 92)).splitlines() if function.doc else []
            lines = [f"def {function.name}({names}):", *(INDENT + line for line in doc)]
            lines += self.block(function.body, 1, function) or [f"{INDENT}pass"]
            found.append("\n".join(INDENT + line if line else line for line in lines))
        return "\n\n".join(found)

    def constants(self) -> str:
        """Constants of the module."""
        lines = [
            f"{name} = {self._typed(self.number(value))}{_beside(note)}"
            for name, (value, note) in self.program.constants.items()
        ]
        for name, (table, note) in self.program.tables.items():
            lines.append(f"{name} = {self._array(table)}{_beside(note)}")
        return "\n".join(lines)

    def _typed(self, text: str) -> str:
        return f"np.float32({text})" if self.single else text

    def _array(self, table: np.ndarray) -> str:
        if table.dtype.kind != "f":
            return f"np.array({table.tolist()}, dtype=np.int64)"
        values = ", ".join(map(self.number, table.ravel().tolist()))
        shaped = f".reshape({table.shape})" if table.ndim > 1 else ""
        return f"np.array([{values}]{', dtype=np.float32' if self.single else ''}){shaped}"

    def initial_values(self) -> str:
        """Statements that put the state before the first call."""
        lines = []
        for name, one in self.program.state.items():
            if one.shape:
                kind = ", dtype=np.float32" if self.single else ""
                kind = {"int": ", dtype=np.int64", "bool": ", dtype=bool"}.get(one.kind, kind)
                lines.append(f"self.{name} = np.zeros({one.shape}{kind}){_beside(one.note)}")
                for at in np.ndindex(one.shape):
                    if one.initial[at] != 0:
                        index = ", ".join(map(str, at))
                        lines.append(f"self.{name}[{index}] = {self._initial(one.initial[at], one.kind)}")
                continue
            value = self._initial(one.initial[()], one.kind)
            lines.append(f"self.{name} = {value}{_beside(one.note)}")
        return "\n".join(2 * INDENT + line for line in lines or ["pass"])

    def _initial(self, value: Any, kind: str) -> str:
        if kind == "real":
            return self._typed(self.number(float(value)))
        return self.whole(value, kind == "bool")


def _beside(note: str) -> str:
    return f"  # {note}" if note else ""

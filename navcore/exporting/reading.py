"""Read the compiled law and write down what is left of it for one method: its parameters are known.

The law that runs in the program is written in a small part of Python, the part that numba compiles:
numbers, records, named tuples, loops and conditions. This module follows its functions with the parameters of
one method at hand. What depends on them alone is decided here; what is left is a small program
(`navcore.exporting.ir`) with the method's own policy, switching method and network, and nothing of the
others. So a policy, a switching method or a network that is added to the law is exported without a line here.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from navcore.exporting.ir import (
    Call,
    Expr,
    Function,
    Kind,
    Num,
    Return,
    Statement,
    Store,
    Var,
    operation,
    statements,
)
from navcore.exporting.read_state import RESULT, Frame
from navcore.exporting.read_statements import StatementReader
from navcore.exporting.syntax import first_lines, tree_of
from navcore.exporting.values import (
    NUMBERS,
    Group,
    Known,
    Named,
    NotInlinedError,
    NotWrittenError,
    Place,
    Slot,
    Value,
    leaves,
    literal,
    rebuilt,
)
from navcore.exporting.words import RESERVED


@dataclass
class _Written:
    """A function of the program with the shape of its result and the state that it changes."""

    function: Function
    shape: Value | None
    changes: set[str]


class Reader(StatementReader):
    """Reads functions of the law for one method; parameters as of `StateReader`."""

    def __init__(self, state: Mapping[str, Any], fixed: frozenset[str] = frozenset()) -> None:
        super().__init__(state, fixed)
        self._written: dict[Any, _Written] = {}
        self._function_names: set[str] = set(RESERVED)

    def function(self, called: Any, arguments: list[Value], name: str) -> Function:
        """Write a function of the law as one of the program; numbers among the arguments are parameters."""
        return self._function(called, arguments, name).function

    def _function(self, called: Any, arguments: list[Value], name: str = "") -> _Written:
        plain = getattr(called, "py_func", called)
        tree = tree_of(plain)
        key = (plain, *map(_key, arguments))
        if key in self._written:
            return self._written[key]
        saved = self._block, self._present
        self._block, self._present = [], {}
        self._taken.append(set(RESERVED))
        params: list[Var] = []
        names: dict[str, Value] = {}
        for parameter, value in self._bound(plain, tree, arguments):
            names[parameter] = self._parameter(parameter, value, params)
        frame = Frame(plain, names, tree, inline=False)
        self._frames.append(frame)
        try:
            self._read(tree.body)
            body = self._block
        finally:
            self._frames.pop()
            self._taken.pop()
            self._block, self._present = saved
        shape, results = _results(body, frame)
        doc = first_lines(ast.get_docstring(tree) or "")
        made = Function(self._function_name(name or tree.name), doc, tuple(params), results, body)
        self.program.functions.append(made)
        self._written[key] = _Written(made, shape, self._changes(body))
        return self._written[key]

    def _function_name(self, wanted: str) -> str:
        base, number = wanted.lstrip("_"), 2
        name = f"{base}_fn"  # no local variable and no function of the interface has such a name
        while name in self._function_names:
            name, number = f"{base}_{number}_fn", number + 1
        self._function_names.add(name)
        return name

    def _parameter(self, name: str, value: Value, params: list[Var]) -> Value:
        """A number becomes a parameter; what is known or in the state stays as it is."""
        if isinstance(value, Slot):
            value = value.value
        if isinstance(value, Group):
            fields = getattr(value.kind, "_fields", None) or [f"{name}_{i}" for i in range(len(value.items))]
            items = (self._parameter(f, item, params) for f, item in zip(fields, value.items, strict=True))
            return Group(tuple(items), value.kind)
        if isinstance(value, NUMBERS) and not isinstance(value, Num):
            params.append(Var(self._fresh(value.name if isinstance(value, Var) else name), value.kind))
            return params[-1]
        return value

    def _bound(
        self, plain: Any, tree: ast.FunctionDef, arguments: list[Value]
    ) -> Iterator[tuple[str, Value]]:
        """Parameters of a function and their values."""
        positional = [one.arg for one in tree.args.args]
        yield from zip(positional, arguments, strict=False)
        if tree.args.vararg is not None:
            yield tree.args.vararg.arg, Group(tuple(arguments[len(positional) :]))
        elif len(arguments) < len(positional):
            defaults = plain.__defaults__ or ()
            missing = positional[len(arguments) :]
            for name, value in zip(missing, defaults[len(defaults) - len(missing) :], strict=True):
                yield name, literal(value)

    def _changes(self, body: list[Statement]) -> set[str]:
        changed = {one.place.name for one in statements(body) if isinstance(one, Store)}
        called = {one.function for one in statements(body) if isinstance(one, Call)}
        for other in self._written.values():
            if other.function.name in called:
                changed |= other.changes
        return changed

    def _outcome(self, called: Any, arguments: list[Value]) -> Value:
        """Value of a call: inlined where that goes, else a call of a function of the program."""
        plain = getattr(called, "py_func", called)
        stays = hasattr(called, "py_func") and not called.targetoptions.get("forceinline", False)
        if not stays:
            kept = list(self._block), dict(self._present), set(self._taken[-1])
            try:
                return self._inlined(plain, arguments)
            except NotInlinedError:
                self._block[:], self._present, self._taken[-1] = kept[0], kept[1], kept[2]
        return self._called(called, arguments)

    def _inlined(self, plain: Any, arguments: list[Value]) -> Value:
        tree = tree_of(plain)
        several = tree.args.vararg.arg if tree.args.vararg is not None else ""
        names = {
            name: value if name == several else self._held(name, value)
            for name, value in self._bound(plain, tree, arguments)
        }
        frame = Frame(plain, names, tree, inline=True)
        self._frames.append(frame)
        try:
            self._read(tree.body)
        finally:
            self._frames.pop()
        return frame.result

    def _called(self, called: Any, arguments: list[Value]) -> Value:
        written = self._function(called, arguments)
        given = [number for value in arguments for number in _given(value)]
        base = called.__name__.lstrip("_")
        targets = tuple(
            Var(self._fresh(base if name == RESULT else name), kind)
            for name, kind in written.function.results
        )
        self._block.append(Call(targets, written.function.name, tuple(given)))
        self._forget(written.changes)
        if written.shape is None:
            return Known(None)
        return rebuilt(written.shape, list(targets))


def _key(value: Value) -> Any:
    """What of an argument makes another function."""
    if isinstance(value, Slot):
        return _key(value.value)
    if isinstance(value, Group):
        return value.kind, tuple(map(_key, value.items))
    if isinstance(value, Num):
        return value.kind, value.value
    if isinstance(value, NUMBERS):
        return value.kind
    if isinstance(value, Place):
        if not all(isinstance(one, Num) for one in value.index):
            raise NotWrittenError(f"a moving place is passed on: {value.path}")
        return value
    return value.path if isinstance(value, Named) else id(value.value)


def _given(value: Value) -> Iterator[Expr]:
    """Numbers of an argument that are parameters."""
    if isinstance(value, Slot):
        yield from _given(value.value)
    elif isinstance(value, Group):
        for item in value.items:
            yield from _given(item)
    elif isinstance(value, NUMBERS) and not isinstance(value, Num):
        yield value


def _results(body: list[Statement], frame: Frame) -> tuple[Value | None, tuple[tuple[str, Kind], ...]]:
    """Shape, names and kinds of what a function returns; the returns are brought to these kinds."""
    returns = [one for one in statements(body) if isinstance(one, Return) and one.values]
    if not returns:
        return None, ()
    kinds: list[Kind] = []
    for column in zip(*(one.values for one in returns), strict=True):
        found = {one.kind for one in column}
        kinds.append("real" if "real" in found else "int" if "int" in found else "bool")
    for one in returns:
        pairs = zip(one.values, kinds, strict=True)
        one.values = tuple(operation("real", v) if kind == "real" else v for v, kind in pairs)
    names: list[str] = []
    for name, _ in leaves(frame.result):
        base, number = name or RESULT, 2
        while (name or RESULT) in names:
            name, number = f"{base}_{number}", number + 1
        names.append(name or RESULT)
    return frame.result, tuple(zip(names, kinds, strict=True))

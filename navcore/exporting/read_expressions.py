"""The reader of expressions."""

from __future__ import annotations

import ast
import math
from collections.abc import Callable
from typing import Any

import numpy as np

from navcore.exporting.ir import Call, Expr, Num, Store, operation, statements
from navcore.exporting.read_state import StateReader, field_of
from navcore.exporting.values import (
    NUMBERS,
    Group,
    Known,
    Named,
    NotWrittenError,
    Place,
    Slot,
    Value,
    literal,
)

OPERATORS: dict[type, str] = {
    ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/",
    ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">=", ast.Eq: "==", ast.NotEq: "!=",
}  # fmt: skip
CALLS: dict[Any, str] = {
    **{getattr(math, name): name for name in ("sqrt", "sin", "cos", "tan", "exp", "floor", "hypot", "atan2")},
    math.isfinite: "isfinite", abs: "abs", min: "min", max: "max", float: "real", int: "int",
}  # fmt: skip


class ExpressionReader(StateReader):
    """Reads expressions: what is known is reckoned, the rest is written down."""

    def _outcome(self, called: Any, arguments: list[Value]) -> Value:
        """Value of a call of a function of the law."""
        raise NotImplementedError

    def _number(self, node: ast.expr) -> Expr:
        value = self._value(node)
        if not isinstance(value, NUMBERS):
            raise NotWrittenError(f"{ast.unparse(node)} is no number: {value}")
        return value

    def _value(self, node: ast.expr) -> Value:
        read: Callable[[Any], Value] | None = getattr(self, f"_{type(node).__name__.lower()}", None)
        if read is None:
            raise NotWrittenError(ast.unparse(node))
        return read(node)

    def _constant(self, node: ast.Constant) -> Value:
        return literal(node.value)

    def _name(self, node: ast.Name) -> Value:
        return self._lookup(node.id)

    def _tuple(self, node: ast.Tuple) -> Value:
        return Group(tuple(self._value(one) for one in node.elts))

    def _list(self, node: ast.List) -> Value:
        return Group(tuple(self._value(one) for one in node.elts))

    def _listcomp(self, node: ast.ListComp) -> Value:
        """A group made of another: its elements are known one by one."""
        (loop,) = node.generators
        group, names = self._value(loop.iter), self._frames[-1].names
        if not isinstance(group, Group) or loop.ifs or not isinstance(loop.target, ast.Name):
            raise NotWrittenError(ast.unparse(node))
        found = []
        for item in group.items:
            names[loop.target.id] = item
            found.append(self._value(node.elt))
        return Group(tuple(found))

    def _slice(self, node: ast.Slice) -> Value:
        ends = [None if one is None else self._number(one) for one in (node.lower, node.upper)]
        if node.step is not None or not all(one is None or isinstance(one, Num) for one in ends):
            raise NotWrittenError(ast.unparse(node))
        return Known(slice(*(None if one is None else int(one.value) for one in ends)))  # pyright: ignore[reportAttributeAccessIssue]

    def _attribute(self, node: ast.Attribute) -> Value:
        return self._member(self._value(node.value), node.attr)

    def _member(self, value: Value, name: str) -> Value:
        if isinstance(value, Slot):
            value = value.value
        if isinstance(value, Group):
            return value.named(name)
        if isinstance(value, Place):
            if name == "shape":
                return literal(value.shape)
            kind, shape = field_of(value.dtype, name)
            return self._loaded(Place((*value.path, name), value.index, kind, shape))
        if isinstance(value, Named):
            if name == "shape":
                return literal(value.value.shape)
            found = value.value[name] if isinstance(value.value, np.void) else getattr(value.value, name)
            return self._constant_of((*value.path, name), found)
        if isinstance(value, Known):
            return literal(getattr(value.value, name))
        raise NotWrittenError(f"{value}.{name}")

    def _subscript(self, node: ast.Subscript) -> Value:
        value = self._value(node.value)
        index = self._value(node.slice)
        if isinstance(index, Known) and isinstance(index.value, str):
            return self._member(value, index.value)
        indices = index.items if isinstance(index, Group) else (index,)
        if isinstance(value, Group):
            (place,) = indices
            if isinstance(place, Num):
                return value.items[int(place.value)]
            if isinstance(place, Known) and isinstance(place.value, slice):
                return Group(value.items[place.value])
            raise NotWrittenError(ast.unparse(node))
        numbers = tuple(one for one in indices if isinstance(one, NUMBERS))
        if isinstance(value, Named):
            return self._element(value, numbers)
        if not isinstance(value, Place):
            raise NotWrittenError(ast.unparse(node))
        return self._loaded(
            Place(value.path, (*value.index, *numbers), value.dtype, value.shape[len(numbers) :])
        )

    def _place(self, node: ast.expr) -> Place:
        """Place that an assignment names."""
        if isinstance(node, ast.Attribute):
            value = self._value(node.value)
            if isinstance(value, Place):
                kind, shape = field_of(value.dtype, node.attr)
                return Place((*value.path, node.attr), value.index, kind, shape)
        if isinstance(node, ast.Subscript):
            value, index = self._value(node.value), self._value(node.slice)
            indices = index.items if isinstance(index, Group) else (index,)
            if isinstance(value, Place):
                numbers = tuple(one for one in indices if isinstance(one, NUMBERS))
                return Place(value.path, (*value.index, *numbers), value.dtype, value.shape[len(numbers) :])
        raise NotWrittenError(ast.unparse(node))

    def _binop(self, node: ast.BinOp) -> Value:
        return self._binary(node.op, self._value(node.left), self._value(node.right))

    def _binary(self, op: ast.operator, left: Value, right: Value) -> Value:
        if not isinstance(left, NUMBERS) or not isinstance(right, NUMBERS):
            raise NotWrittenError(f"{left} {op} {right}")
        if isinstance(op, ast.Pow):
            if not isinstance(right, Num) or right.value != 2:
                raise NotWrittenError("only squares can be written")
            base = self._held("base", left)
            assert isinstance(base, NUMBERS)
            return operation("*", base, base)
        if type(op) not in OPERATORS:
            raise NotWrittenError(str(op))
        return operation(OPERATORS[type(op)], left, right)

    def _unaryop(self, node: ast.UnaryOp) -> Value:
        value = self._number(node.operand)
        if isinstance(node.op, ast.UAdd):
            return value
        return operation("not" if isinstance(node.op, ast.Not) else "neg", value)

    def _boolop(self, node: ast.BoolOp) -> Value:
        op = "and" if isinstance(node.op, ast.And) else "or"
        found: list[Expr] = []
        for one in node.values:
            found.append(self._pure(one))
            last = found[-1]
            if isinstance(last, Num) and bool(last.value) == (op == "or"):
                break
        return operation(op, *found)

    def _compare(self, node: ast.Compare) -> Value:
        sides = [self._value(one) for one in (node.left, *node.comparators)]
        found: list[Expr] = []
        for op, left, right in zip(node.ops, sides, sides[1:], strict=False):
            if isinstance(op, ast.Is | ast.IsNot):
                same = isinstance(left, Known) and isinstance(right, Known) and left.value is right.value
                found.append(Num(same == isinstance(op, ast.Is)))
                continue
            if not isinstance(left, NUMBERS) or not isinstance(right, NUMBERS):
                raise NotWrittenError(ast.unparse(node))
            found.append(operation(OPERATORS[type(op)], left, right))
        return operation("and", *found)

    def _ifexp(self, node: ast.IfExp) -> Value:
        condition = self._number(node.test)
        if isinstance(condition, Num):
            return self._value(node.body if condition.value else node.orelse)
        then, otherwise = self._plain(node.body), self._plain(node.orelse)
        if isinstance(then, Group) and isinstance(otherwise, Group):
            pairs = zip(then.items, otherwise.items, strict=True)
            return Group(tuple(operation("if", condition, a, b) for a, b in pairs), then.kind)
        if not isinstance(then, NUMBERS) or not isinstance(otherwise, NUMBERS):
            raise NotWrittenError(ast.unparse(node))
        return operation("if", condition, then, otherwise)

    def _pure(self, node: ast.expr) -> Expr:
        value = self._plain(node)
        if not isinstance(value, NUMBERS):
            raise NotWrittenError(ast.unparse(node))
        return value

    def _plain(self, node: ast.expr) -> Value:
        """Value of what is read only sometimes: reading it must change nothing."""
        before = len(self._block)
        value = self._value(node)
        for one in statements(self._block[before:]):
            if isinstance(one, Store | Call):
                raise NotWrittenError(ast.unparse(node))
        return value

    def _call(self, node: ast.Call) -> Value:
        called = self._value(node.func)
        arguments: list[Value] = []
        for one in node.args:
            if isinstance(one, ast.Starred):
                group = self._value(one.value)
                assert isinstance(group, Group)
                arguments += group.items
            else:
                arguments.append(self._value(one))
        if not isinstance(called, Known):
            raise NotWrittenError(ast.unparse(node))
        function = called.value
        if isinstance(function, type) and hasattr(function, "_fields"):
            return Group(tuple(arguments), function)
        if function is len and isinstance(arguments[0], Group):
            return Num(len(arguments[0].items))
        try:
            op = CALLS.get(function)
        except TypeError:
            op = None
        if op is None:
            return self._outcome(function, arguments)
        numbers = [one for one in arguments if isinstance(one, NUMBERS)]
        if op in ("min", "max") and len(numbers) > 2:
            return operation(op, operation(op, *numbers[:2]), *numbers[2:])
        return operation(op, *numbers)

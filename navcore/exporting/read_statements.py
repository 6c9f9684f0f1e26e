"""The reader of statements."""

from __future__ import annotations

import ast
from dataclasses import replace

from navcore.exporting.ir import (
    Expr,
    Field,
    For,
    If,
    Kind,
    Let,
    Num,
    Return,
    Statement,
    Store,
    Var,
    While,
    operation,
    parts,
)
from navcore.exporting.read_expressions import ExpressionReader
from navcore.exporting.read_state import RESULT
from navcore.exporting.syntax import as_read, assigned, bounds_of, read_outside
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
    rebuilt,
)

_ZEROS: dict[Kind, float | int | bool] = {"real": 0.0, "int": 0, "bool": False}


class StatementReader(ExpressionReader):
    """Reads statements: conditions that are known are decided, loops over known groups are unrolled."""

    def _read(self, body: list[ast.stmt]) -> None:
        for node in body:
            if self._frames[-1].ended:
                return
            self._statement(node)

    def _statement(self, node: ast.stmt) -> None:
        frame = self._frames[-1]
        if isinstance(node, ast.Return):
            self._return(Known(None) if node.value is None else self._value(node.value))
        elif isinstance(node, ast.Assign):
            self._assign_all(node.targets, node.value)
        elif isinstance(node, ast.AugAssign):
            value = self._binary(node.op, self._value(as_read(node.target)), self._value(node.value))
            self._assign(node.target, value)
        elif isinstance(node, ast.Expr):
            if not isinstance(node.value, ast.Constant):
                self._value(node.value)
        elif isinstance(node, ast.If):
            self._if(node)
        elif isinstance(node, ast.For):
            self._for(node)
        elif isinstance(node, ast.While):
            self._while(node)
        elif isinstance(node, ast.Continue) and frame.depth == 0:
            raise NotWrittenError("continue")
        elif not isinstance(node, ast.Pass):
            raise NotWrittenError(ast.unparse(node))

    def _return(self, value: Value) -> None:
        frame = self._frames[-1]
        if frame.inline:
            if frame.depth:
                raise NotInlinedError
            frame.result, frame.ended = self._held(RESULT, value), True
            return
        if isinstance(value, Known) and value.value is None:
            self._block.append(Return(()))
        else:
            self._block.append(Return(tuple(number for _, number in leaves(value))))
            frame.result = value
        frame.ended = frame.depth == 0

    def _assign_all(self, targets: list[ast.expr], node: ast.expr) -> None:
        value = self._value(node)
        if len(targets) > 1 or isinstance(targets[0], ast.Tuple):
            value = self._settled(value)
        for target in targets:
            self._assign(target, value)

    def _settled(self, value: Value) -> Value:
        """Numbers of a group that the first of several assignments might change get variables."""
        if isinstance(value, Group):
            return Group(tuple(map(self._settled, value.items)), value.kind)
        if isinstance(value, NUMBERS) and any(
            isinstance(one, Field) or (isinstance(one, Var) and not one.fixed) for one in parts(value)
        ):
            return self._held("value", value)
        return value

    def _assign(self, target: ast.expr, value: Value) -> None:
        if isinstance(target, ast.Tuple):
            if not isinstance(value, Group):
                raise NotWrittenError(ast.unparse(target))
            for one, item in zip(target.elts, value.items, strict=True):
                self._assign(one, item)
        elif isinstance(target, ast.Name):
            self._assign_name(target.id, value)
        else:
            self._store(target, value)

    def _assign_name(self, name: str, value: Value) -> None:
        frame = self._frames[-1]
        names, held = frame.names, frame.names.get(name)
        if held is None and frame.depth and name in frame.pending:
            zeros: list[Expr] = [Num(_ZEROS[number.kind]) for _, number in leaves(value)]
            held = self._slot(name, rebuilt(value, zeros), frame.pending.pop(name))
            frame.hoisted[name] = names[name] = held
        if isinstance(held, Slot):
            numbers = [number for _, number in leaves(value)]
            for (_, variable), number in zip(leaves(held), numbers, strict=True):
                assert isinstance(variable, Var)
                number = operation("real", number) if variable.kind == "real" else number
                if number.kind != variable.kind:
                    raise NotWrittenError(f"{name} is a {variable.kind} and becomes a {number.kind}")
                self._block.append(Let(variable, number, declare=False))
            return
        names[name] = self._held(name, value)

    def _store(self, target: ast.expr, value: Value) -> None:
        if isinstance(target, ast.Subscript) and isinstance(target.slice, ast.Slice):
            self._fill(self._value(target.value), value)
            return
        place = self._place(target)
        if place.shape or place.dtype.names:
            raise NotWrittenError(ast.unparse(target))
        if not isinstance(value, NUMBERS):
            raise NotWrittenError(f"{ast.unparse(target)} = {value}")
        self._put(self._field(place), value)

    def _fill(self, place: Value, value: Value) -> None:
        if not isinstance(place, Place) or len(place.shape) != 1 or not isinstance(value, NUMBERS):
            raise NotWrittenError("only one axis can be filled")
        index = Var(self._fresh("i"), "int")
        body: list[Statement] = []
        one = self._field(replace(place, index=(*place.index, index), shape=()))
        body.append(Store(one, value))
        self._block.append(For(index, Num(0), Num(place.shape[0]), 1, body))
        self._forget({one.name})

    def _put(self, place: Field, value: Expr) -> None:
        if place.kind == "real":
            value = operation("real", value)
        if self._present.get(place) == value or value == place:
            return
        self._block.append(Store(place, value))
        self._forget_place(place)
        if all(isinstance(one, Num) for one in place.index) and isinstance(value, Num):
            self._present[place] = value

    def _forget(self, names: set[str]) -> None:
        self._present = {place: value for place, value in self._present.items() if place.name not in names}

    def _forget_place(self, place: Field) -> None:
        moving = not all(isinstance(one, Num) for one in place.index)
        for other in [one for one in self._present if one.name == place.name]:
            if moving or other.index == place.index:
                del self._present[other]

    # ------------------------------------------------------------ control

    def _if(self, node: ast.If) -> None:
        condition = self._number(node.test)
        if isinstance(condition, Num):
            self._read(node.body if condition.value else node.orelse)
            return
        self._prepare([node])
        then, after_then = self._branch(node.body)
        otherwise, after_otherwise = self._branch(node.orelse)
        self._present = {
            place: value for place, value in after_then.items() if after_otherwise.get(place) == value
        }
        if then or otherwise:
            self._block.append(If(condition, then, otherwise))

    def _branch(self, body: list[ast.stmt]) -> tuple[list[Statement], dict[Field, Expr]]:
        frame = self._frames[-1]
        outer, present, names = self._block, dict(self._present), dict(frame.names)
        self._block = []
        frame.depth += 1
        try:
            self._read(body)
            return self._block, self._present
        finally:
            frame.depth -= 1
            self._block, self._present = outer, present
            frame.names.clear()
            frame.names.update(names | frame.hoisted)

    def _prepare(self, nodes: list[ast.stmt]) -> None:
        """Give names that a block assigns, and that are read outside, variables that can be assigned."""
        frame = self._frames[-1]
        for name in sorted(assigned(nodes)):
            held = frame.names.get(name)
            if isinstance(held, Slot):
                continue
            if held is not None:
                if isinstance(held, Known | Named | Place):
                    continue
                frame.names[name] = self._slot(name, held, self._block)
            elif read_outside(frame.tree, nodes, name):
                frame.pending.setdefault(name, self._block)

    def _for(self, node: ast.For) -> None:
        items = self._items(node.iter)
        if items is not None:
            for item in items:
                self._assign(node.target, item)
                self._read(node.body)
            return
        assert isinstance(node.target, ast.Name)
        bounds = [self._number(one) for one in bounds_of(node.iter)]
        start, stop, step = (*((Num(0),) if len(bounds) == 1 else ()), *bounds, Num(1))[:3]
        if not isinstance(step, Num) or step.value not in (1, -1):
            raise NotWrittenError(ast.unparse(node.iter))
        if isinstance(start, Num) and isinstance(stop, Num) and abs(stop.value - start.value) <= 1:
            for value in range(int(start.value), int(stop.value), int(step.value)):
                self._frames[-1].names[node.target.id] = Num(value)
                self._read(node.body)
            return
        self._prepare(node.body)
        index = Var(self._fresh(node.target.id), "int")
        body = self._repeated(node.body, {node.target.id: index})
        self._block.append(For(index, start, stop, int(step.value), body))

    def _while(self, node: ast.While) -> None:
        self._prepare(node.body)
        before = len(self._block)
        self._present = {}
        condition = self._number(node.test)
        if len(self._block) != before:
            raise NotWrittenError(ast.unparse(node.test))
        self._block.append(While(condition, self._repeated(node.body, {})))

    def _repeated(self, body: list[ast.stmt], bound: dict[str, Value]) -> list[Statement]:
        """Block of a loop: what is in the state may have changed when it begins again."""
        self._present = {}
        names = self._frames[-1].names
        kept = {name: names.get(name) for name in bound}
        names.update(bound)
        block, _ = self._branch(body)
        self._present = {}
        for name, value in kept.items():
            if value is None:
                names.pop(name, None)
            else:
                names[name] = value
        return block

    def _items(self, node: ast.expr) -> list[Value] | None:
        """Values of a loop over a group; None of one over a range."""
        if isinstance(node, ast.Call):
            return None
        group = self._value(node)
        if not isinstance(group, Group):
            raise NotWrittenError(ast.unparse(node))
        return list(group.items)

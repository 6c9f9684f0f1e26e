"""The program of one method's law: read until nothing more is known, and without what nobody reads."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from navcore.exporting.extents import cropped
from navcore.exporting.ir import (
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
    blocks,
    expressions,
    operation,
    parts,
    statements,
)
from navcore.exporting.reading import Reader
from navcore.exporting.values import Group, Named, Place, Value

STEP = "call"
"""Name of the function that is called once a step."""


def place_of(name: str, root: Any) -> Place:
    """Root of the state: a record, or an array of records."""
    return Place((name,), (), root.dtype, root.shape if isinstance(root, np.ndarray) else ())


def constants_of(name: str, value: Any) -> Named:
    """Root of the constants."""
    return Named((name,), value)


def inputs_of(kind: Any, integers: tuple[str, ...] = ()) -> Group:
    """Inputs of a step: one variable a field of a named tuple."""
    return Group(tuple(Var(name, "int" if name in integers else "real") for name in kind._fields), kind)


def read_program(step: Any, state: Mapping[str, Any], arguments: Sequence[Value]) -> Program:
    """Read a step of the law.

    What nothing changes is a constant; which these are is known once all has been read.

    Parameters
    ----------
    step : compiled function
        Of `navcore.exporting.step`, say.
    state : mapping of str to (record or ndarray)
        Roots of the state, with the values before the first call.
    arguments : list
        Of the step.
    """
    fixed: frozenset[str] = frozenset()
    while True:
        reader = Reader(state, fixed)
        reader.function(step, list(arguments), STEP)
        stored = {
            one.place.name
            for function in reader.program.functions
            for one in statements(function.body)
            if isinstance(one, Store)
        }
        unchanged = frozenset(reader.program.state).difference(stored) | fixed
        if unchanged == fixed:
            return cropped(tidied(reader.program))
        fixed = unchanged


def tidied(program: Program) -> Program:
    """Leave out variables, places, parameters, results and functions that nobody reads."""
    while True:
        before = _size(program)
        read = {
            one.name for function in program.functions for one in _read(function) if isinstance(one, Field)
        }
        for function in program.functions:
            function.body[:] = _changing(function.body)
            variables = {one.name for one in _read(function) if isinstance(one, Var)}
            function.body[:] = _needed(function.body, read, variables)
        for function in program.functions[:-1]:
            _without_known_results(program, function)
        for function in program.functions:
            _without_idle_parameters(program, function)
        if _size(program) == before:
            break
    called = _called(program)
    program.functions = [one for one in program.functions if one.name in called]
    for function in program.functions:
        _without_unread_result(function)
    found = [one for function in program.functions for one in _read(function)]
    found += [
        one.place
        for function in program.functions
        for one in statements(function.body)
        if isinstance(one, Store)
    ]
    names = {kind: {one.name for one in found if isinstance(one, kind)} for kind in (Field, Const)}
    tables = {one.table for one in found if isinstance(one, Item)}
    program.state = {name: one for name, one in program.state.items() if name in names[Field]}
    program.constants = {name: one for name, one in program.constants.items() if name in names[Const]}
    program.tables = {name: one for name, one in program.tables.items() if name in tables}
    return program


def _calls(program: Program, function: Function) -> list[tuple[Function, Call]]:
    """Calls of a function, with the functions in which they stand."""
    return [
        (other, one)
        for other in program.functions
        for one in statements(other.body)
        if isinstance(one, Call) and one.function == function.name
    ]


def _without_idle_parameters(program: Program, function: Function) -> None:
    """Leave out parameters that the function does not read."""
    read = {one.name for one in _read(function) if isinstance(one, Var)}
    kept = [i for i, one in enumerate(function.params) if one.name in read]
    if len(kept) < len(function.params):
        function.params = tuple(function.params[i] for i in kept)
        for _, call in _calls(program, function):
            call.args = tuple(call.args[i] for i in kept)


def _without_known_results(program: Program, function: Function) -> None:
    """Put the number itself in the place of a result that is always the same; leave out what nobody reads."""
    returns = [one for one in statements(function.body) if isinstance(one, Return)]
    calls = _calls(program, function)
    for i in range(len(function.results) - 1, -1, -1):
        values = {(type(one.values[i]), one.values[i]) for one in returns if one.values}
        known = next(iter(values))[1] if len(values) == 1 else None
        if isinstance(known, Num):
            for other, call in calls:
                other.body[:] = [_replaced(one, {call.targets[i].name: known}) for one in other.body]
        elif any(
            isinstance(one, Var) and one.name == call.targets[i].name
            for other, call in calls
            for one in _read(other)
        ):
            continue
        function.results = function.results[:i] + function.results[i + 1 :]
        for one in returns:
            one.values = one.values[:i] + one.values[i + 1 :]
        calls = _calls(program, function)
        for _, call in calls:
            call.targets = call.targets[:i] + call.targets[i + 1 :]


def _without_unread_result(function: Function) -> None:
    """Give no name to the one result of a call that nobody reads: C would warn of the variable."""
    read = {one.name for one in _read(function) if isinstance(one, Var)}
    for one in statements(function.body):
        if isinstance(one, Call) and len(one.targets) == 1 and one.targets[0].name not in read:
            one.targets = ()


def _replaced(statement: Statement, known: dict[str, Num]) -> Statement:
    """Put numbers in the place of variables."""

    def put(expr: Expr) -> Expr:
        if isinstance(expr, Var):
            return known.get(expr.name, expr)
        if isinstance(expr, Op):
            args = tuple(map(put, expr.args))
            return expr if args == expr.args else operation(expr.op, *args)
        if isinstance(expr, Field | Item):
            return replace(expr, index=tuple(map(put, expr.index)))
        return expr

    if isinstance(statement, Let):
        statement.value = put(statement.value)
    elif isinstance(statement, Store):
        statement.value, statement.place = put(statement.value), put(statement.place)  # pyright: ignore[reportAttributeAccessIssue]
    elif isinstance(statement, If | While):
        statement.condition = put(statement.condition)
    elif isinstance(statement, For):
        statement.start, statement.stop = put(statement.start), put(statement.stop)
    elif isinstance(statement, Call):
        statement.args = tuple(map(put, statement.args))
    else:
        statement.values = tuple(map(put, statement.values))
    for block in blocks(statement):
        block[:] = [_replaced(one, known) for one in block]
    return statement


def _size(program: Program) -> int:
    return sum(
        len(list(statements(one.body))) + len(one.params) + len(one.results) for one in program.functions
    )


def _read(function: Function) -> list[Expr]:
    """All expressions that a function reads."""
    return [
        part
        for statement in statements(function.body)
        for expression in expressions(statement)
        for part in parts(expression)
    ]


def _called(program: Program) -> set[str]:
    """Functions that the step needs."""
    bodies = {function.name: function.body for function in program.functions}
    wanted, found = [program.functions[-1].name], set()
    while wanted:
        name = wanted.pop()
        if name in found:
            continue
        found.add(name)
        wanted += [one.function for one in statements(bodies[name]) if isinstance(one, Call)]
    return found


def _needed(body: list[Statement], fields: set[str], variables: set[str]) -> list[Statement]:
    """Statements that do something."""
    kept: list[Statement] = []
    for statement in body:
        if isinstance(statement, Store) and statement.place.name not in fields:
            continue
        if isinstance(statement, Let) and statement.var.name not in variables:
            continue
        for block in blocks(statement):
            block[:] = _needed(block, fields, variables)
        if isinstance(statement, If | For) and not any(blocks(statement)):
            continue
        kept.append(statement)
    return kept


def _changing(body: list[Statement]) -> list[Statement]:
    """Leave out what puts a number of the state back where it was just read."""
    present: dict[str, Field] = {}
    kept: list[Statement] = []
    for statement in body:
        if isinstance(statement, Store) and isinstance(statement.value, Var):
            if present.get(statement.value.name) == statement.place:
                continue
        for block in blocks(statement):
            block[:] = _changing(block)
        kept.append(statement)
        inner = list(statements([statement]))
        if any(isinstance(one, Call) for one in inner):
            present.clear()
        for one in inner:
            if isinstance(one, Store):
                present = {
                    name: place
                    for name, place in present.items()
                    if place.name != one.place.name
                    or (_numbered(place) and _numbered(one.place) and place != one.place)
                }
        if isinstance(statement, Let) and statement.var.fixed and isinstance(statement.value, Field):
            present[statement.var.name] = statement.value
    return kept


def _numbered(place: Field) -> bool:
    return all(isinstance(one, Num) for one in place.index)

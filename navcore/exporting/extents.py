"""Arrays of an exported program as large as what it reads and writes of them.

The compiled law has room for the largest network; an exported one holds a single network, and on a small
computer the rest would be memory that nobody touches.
"""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from navcore.exporting.ir import (
    Expr,
    Field,
    For,
    Item,
    Num,
    Op,
    Program,
    Statement,
    Store,
    Var,
    blocks,
    expressions,
    parts,
)

_Extent = tuple[int | None, ...]
"""Elements that are touched along each axis; None: all of them."""


def cropped(program: Program) -> Program:
    """Cut the arrays of the state, and the tables, down to the elements that the program can touch.

    Parameters
    ----------
    program : Program
        Changed in place.

    Returns
    -------
    Program
        The same.
    """
    found: dict[str, _Extent] = {}
    for function in program.functions:
        _look(function.body, {}, found)
    for name, extent in found.items():
        if name in program.state:
            initial = _cut(program.state[name].initial, extent)
            program.state[name] = replace(program.state[name], shape=initial.shape, initial=initial)
        elif name in program.tables:
            table, note = program.tables[name]
            program.tables[name] = _cut(table, extent), note
    return program


def _cut(values: np.ndarray, extent: _Extent) -> np.ndarray:
    return values[tuple(slice(n) for n in extent)]


def _look(body: list[Statement], largest: Mapping[str, int | None], found: dict[str, _Extent]) -> None:
    """Note what the statements touch; ``largest`` holds the largest value of each loop's count."""
    for one in body:
        read = (*expressions(one), one.place) if isinstance(one, Store) else expressions(one)
        for expression in read:
            for part in parts(expression):
                if isinstance(part, Field | Item) and part.index:
                    _note(part, largest, found)
        inner = largest
        if isinstance(one, For):
            last = _largest(one.start if one.step < 0 else one.stop, largest)
            inner = {**largest, one.var.name: last if last is None or one.step < 0 else last - 1}
        for block in blocks(one):
            _look(block, inner, found)


def _note(part: Field | Item, largest: Mapping[str, int | None], found: dict[str, _Extent]) -> None:
    name = part.name if isinstance(part, Field) else part.table
    places = [_largest(index, largest) for index in part.index]
    here = tuple(None if place is None else place + 1 for place in places)
    before = found.get(name, (0,) * len(here))
    found[name] = tuple(
        None if a is None or b is None else max(a, b) for a, b in zip(before, here, strict=True)
    )


def _largest(index: Expr, largest: Mapping[str, int | None]) -> int | None:
    """Largest value of an index; None where it is not known."""
    if isinstance(index, Num):
        return int(index.value)
    if isinstance(index, Var):
        return largest.get(index.name)
    if isinstance(index, Op) and index.op in ("+", "-"):
        first, second = index.args
        base, other = _largest(first, largest), _largest(second, largest)
        if base is None or other is None or (index.op == "-" and not isinstance(second, Num)):
            return None
        return base + other if index.op == "+" else base - other
    return None

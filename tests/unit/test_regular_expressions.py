"""No regular expression of ours takes more than linear time, whatever it is fed.

The expressions are collected from the source. For each, hostile texts are made from what it matches itself,
and the time for twice the text is compared with the time for the text: 2 when linear, 4 when quadratic.
"""

import ast
import math
import re
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from re import _constants as codes  # pyright: ignore[reportAttributeAccessIssue]
from re import _parser as parser  # pyright: ignore[reportAttributeAccessIssue]
from typing import Any

import pytest

METHODS = ("search", "match", "fullmatch", "sub", "split", "findall", "finditer")
SMALL, LARGEST = 1 << 13, 1 << 20
"""Every text at the small size, the slowest of an expression at 1 MiB."""
ENOUGH_S = 0.004
"""Shorter times cannot be compared."""
TOO_LONG_S = 2.0
"""Processor time for 1 MiB or less that shows by itself that an expression is not linear."""
PARTS = 6
"""Tests among which the expressions are shared out: one would take minutes."""
STEEPEST = 3.0
LOOKS = 3
"""An expression is steep when it is so every time that it is looked at."""


def _expressions(root: Path) -> Iterator[tuple[str, str | bytes, int, tuple[str, ...]]]:
    """Where, pattern, flags and the methods used, of every expression that is written out in the source.

    Of those made at run time, `_compiled` finds the ones of a module.
    """
    for path in sorted([*(root / "navcore").rglob("*.py"), *(root / "app").rglob("*.py")]):
        text = path.read_text(encoding="utf-8")
        for node in ast.walk(ast.parse(text)):
            match node:
                case ast.Call(
                    func=ast.Attribute(value=ast.Name(id="re"), attr=name),
                    args=[ast.Constant(value=str() | bytes() as pattern), *_],
                ) if name in ("compile", *METHODS):
                    used = _methods_of(text, node) if name == "compile" else (name,)
                    yield f"{path.relative_to(root)}:{node.lineno}", pattern, 0, used


def _methods_of(text: str, node: ast.Call) -> tuple[str, ...]:
    """Methods that a module calls on the name an expression is bound to; all when it is not clear."""
    line = text.splitlines()[node.lineno - 1]
    name = re.match(r"\s{0,40}([A-Za-z_]\w{0,60})\s?=", line)
    if name is None:
        return METHODS
    used = {m for m in METHODS if f"{name[1]}.{m}(" in text}
    return tuple(sorted(used)) or METHODS


def _compiled(root: Path) -> Iterator[tuple[str, str | bytes, int, tuple[str, ...]]]:
    """Expressions that modules of files in put together when they are imported."""
    from navcore.io import stamps

    del root
    for number, (pattern, _) in enumerate(stamps._FORMS):
        yield f"navcore/io/stamps.py form {number}", pattern.pattern, pattern.flags & ~re.UNICODE, ("search",)


def _sample(parsed: Any, most: bool) -> str:
    """A text that the parsed expression matches, or nearly so: its shortest, or with repetitions."""
    return "".join(_sample_of(op, argument, most) for op, argument in parsed)


def _sample_of(op: Any, argument: Any, most: bool) -> str:
    match op:
        case codes.LITERAL:
            return chr(argument)
        case codes.NOT_LITERAL | codes.ANY:
            return "x"
        case codes.IN:
            return _member(*argument[0])
        case codes.MAX_REPEAT | codes.MIN_REPEAT | codes.POSSESSIVE_REPEAT:
            least, largest, inner = argument
            return _sample(inner, most) * (max(least, min(int(largest), 3)) if most else least)
        case codes.SUBPATTERN:
            return _sample(argument[3], most)
        case codes.ATOMIC_GROUP:
            return _sample(argument, most)
        case codes.BRANCH:
            return _sample(argument[1][0], most)
        case _:
            return ""


def _member(op: Any, argument: Any) -> str:
    match op:
        case codes.LITERAL:
            return chr(argument)
        case codes.RANGE:
            return chr(argument[0])
        case codes.CATEGORY:
            return {codes.CATEGORY_DIGIT: "1", codes.CATEGORY_SPACE: " "}.get(argument, "x")
        case _:
            return "~"


def _units(pattern: str) -> list[str]:
    """Texts that are repeated: what the expression matches, its beginnings, and single characters of it."""
    parsed = parser.parse(pattern)
    whole = [_sample(parsed, most) for most in (False, True)]
    found = [*whole, *(text[: len(text) // 2] for text in whole), *(text[:-1] for text in whole)]
    found += sorted({character for text in whole for character in text})[:12]
    return [unit for unit in dict.fromkeys(found) if unit]


def _steepness(
    run: Callable[[Any], object], unit: Any, tail: Any, size: int, before: float | None = None
) -> tuple[float, float]:
    """How much longer twice the text takes, and the time for all of it; ``before`` is that for half of it.

    1 where both take too little, inf where one takes too long.
    """
    half, whole = (unit * (n // len(unit) + 1) + tail for n in (size // 2, size))
    if before is None:
        before = _timed(run, half)
    taken = _timed(run, whole)
    if taken > TOO_LONG_S:
        taken = _timed(run, whole)  # the machine may have been busy
    if taken > TOO_LONG_S:
        return math.inf, taken
    if taken < ENOUGH_S or taken < STEEPEST * before:
        return 1.0, taken
    ratio = STEEPEST
    times = 2 if taken > 20.0 * ENOUGH_S else 4
    for _ in range(LOOKS):  # the machine may have been busy
        before = min(_timed(run, half) for _ in range(times))
        ratio = min(_timed(run, whole) for _ in range(times)) / max(before, 1e-9)
        if ratio <= STEEPEST:
            break
    return ratio, taken


def _timed(run: Callable[[Any], object], text: Any) -> float:
    began = time.thread_time()  # other threads of the process may have work of their own
    run(text)
    return time.thread_time() - began


def _run(compiled: re.Pattern[Any], method: str) -> Callable[[Any], object]:
    empty = b"" if isinstance(compiled.pattern, bytes) else ""
    if method == "sub":
        return lambda text: compiled.sub(empty, text)
    if method == "finditer":
        return lambda text: sum(1 for _ in compiled.finditer(text))
    return getattr(compiled, method)


def _worst(pattern: str | bytes, flags: int, methods: tuple[str, ...]) -> tuple[float, str]:
    """The steepest growth found for an expression, and what it was fed."""
    compiled = re.compile(pattern, flags)
    text = pattern.decode("latin-1") if isinstance(pattern, bytes) else pattern
    tail: Any = "\n\x01" if isinstance(pattern, str) else b"\n\x01"
    steepest, slowest = (1.0, ""), (0.0, None, None)
    for unit in _units(text):
        given: Any = unit if isinstance(pattern, str) else unit.encode("latin-1")
        for method in methods:
            run = _run(compiled, method)
            ratio, taken = _steepness(run, given, tail, SMALL)
            steepest = max(steepest, (ratio, f"{method} on {unit!r}"))
            if steepest[0] > STEEPEST:
                return steepest
            slowest = max(slowest, (taken, given, run), key=lambda found: found[0])
    if slowest[1] is None or slowest[2] is None:
        return steepest
    size, taken = SMALL, slowest[0]
    while size < LARGEST:  # step by step: a quadratic one that a busy machine hid would take hours at 1 MiB
        size *= 2
        ratio, taken = _steepness(slowest[2], slowest[1], tail, size, before=taken)
        if ratio > STEEPEST:
            return ratio, f"{size} of {slowest[1]!r}"
    return steepest


@pytest.mark.parametrize("part", range(PARTS))
def test_every_expression_takes_linear_time(repo_root: Path, part: int) -> None:
    found = [*_expressions(repo_root), *_compiled(repo_root)]
    assert len(found) > 20
    found = found[part::PARTS]
    steep = []
    for where, pattern, flags, methods in found:
        ratio, fed = _worst(pattern, flags, methods)
        if ratio > STEEPEST:
            steep.append(f"{where}: {pattern!r}: {fed}: x {ratio:.1f}")
    assert not steep, "\n".join(steep)


@pytest.mark.parametrize("pattern", [r"\$..RMC,(\d{6}(?:\.\d+)?),A,[^*\n]*?,(\d\d)(\d\d)(\d\d),", r"\s+$"])
def test_one_that_backtracks_is_found(pattern: str) -> None:
    assert _worst(pattern, 0, ("search",))[0] > STEEPEST


def test_no_group_is_possessive(repo_root: Path) -> None:
    """Python before 3.11.5 matches a possessive group that can backtrack wrongly, an atomic one rightly."""
    of_group = re.compile(r"\)[*+?]\+")
    files = [*(repo_root / "navcore").rglob("*.py"), *(repo_root / "app").rglob("*.py")]
    assert files
    assert [str(path) for path in files if of_group.search(path.read_text(encoding="utf-8"))] == []

"""Mutation run over navcore: small changes of the code, and whether the tests notice (`make mutation`).

A sample of mutants is drawn from the source files of a room; each is applied to a copy of the tree, and the
tests of the room run on it until one fails. A mutant that no test notices *survives*: it stands in
docs/mutation.md, to be killed by a test or explained. Not part of `make test`: a mutant takes 5 to 60 s.

    python -m tests.mutation --sample 20 --seed 1 analysis sensors
"""

from __future__ import annotations

import argparse
import ast
import random
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
TESTS: dict[str, tuple[str, ...]] = {
    "analysis": (
        "tests/unit/test_loop_*.py", "tests/unit/test_whole_system.py", "tests/unit/test_held_log.py",
        "tests/unit/test_network_report.py", "tests/acceptance/test_whole_system_values.py",
        "tests/acceptance/test_closed_loop_values.py", "tests/acceptance/test_network_unity2.py",
    ),
    "sensors": (
        "tests/unit/test_imu*.py", "tests/unit/test_noise.py", "tests/unit/test_reference_*.py",
        "tests/unit/test_recorded_imu.py", "tests/acceptance/test_signs_and_sizes.py",
    ),
    "law": ("tests/unit/test_control_*.py", "tests/acceptance/test_switching_episodes.py"),
    "mechanization": (
        "tests/unit/test_error_model.py", "tests/unit/test_strapdown_*.py",
        "tests/acceptance/test_signs_and_sizes.py",
    ),
    "foundation": ("tests/unit/test_earth.py", "tests/unit/test_trigonometry.py"),
}  # fmt: skip
_SWAPS: dict[type[ast.AST], type[ast.AST]] = {
    ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult,
    ast.Lt: ast.GtE, ast.LtE: ast.Gt, ast.Gt: ast.LtE, ast.GtE: ast.Lt, ast.Eq: ast.NotEq, ast.NotEq: ast.Eq,
    ast.And: ast.Or, ast.Or: ast.And,
}  # fmt: skip
_TIMEOUT_S = 300


@dataclass(frozen=True)
class Mutant:
    """One change: the ``place``-th node of a file that can be changed."""

    file: str
    place: int
    line: int
    what: str


def mutants_of(path: Path) -> list[Mutant]:
    """Every change of a file: an operator turned round, or a number that grows by a tenth."""
    name = str(path.relative_to(ROOT))
    tree = ast.parse(path.read_text("utf-8"))
    return [Mutant(name, i, node.lineno, _words(node)) for i, node in enumerate(_changeable(tree))]


def changed(source: str, place: int) -> str:
    """Source with the ``place``-th changeable node changed."""
    tree = ast.parse(source)
    node = _changeable(tree)[place]
    if isinstance(node, ast.BinOp | ast.BoolOp):
        node.op = _SWAPS[type(node.op)]()  # pyright: ignore[reportAttributeAccessIssue]
    elif isinstance(node, ast.Compare):
        node.ops[0] = _SWAPS[type(node.ops[0])]()  # pyright: ignore[reportArgumentType, reportCallIssue]
    elif isinstance(node, ast.Constant):
        node.value = 1.1 * float(str(node.value)) or 0.1
    return ast.unparse(tree)


def _changeable(tree: ast.AST) -> list[ast.expr]:
    found: list[ast.expr] = []
    for node in ast.walk(tree):
        numbered = isinstance(node, ast.Constant) and isinstance(node.value, float)
        operated = isinstance(node, ast.BinOp | ast.BoolOp) and type(node.op) in _SWAPS
        compared = isinstance(node, ast.Compare) and type(node.ops[0]) in _SWAPS
        if (numbered or operated or compared) and isinstance(node, ast.expr):
            found.append(node)
    return found


def _words(node: ast.expr) -> str:
    text = ast.unparse(node)
    if isinstance(node, ast.Constant):
        return f"{text} x 1.1"
    op = node.ops[0] if isinstance(node, ast.Compare) else node.op  # pyright: ignore[reportAttributeAccessIssue]
    return f"{type(op).__name__} -> {_SWAPS[type(op)].__name__} in {text[:70]}"


def killed(mutant: Mutant, room: str, copy: Path) -> bool:
    """Whether a test of the room fails on the mutant; the copy is as before afterwards."""
    path = copy / mutant.file
    before = path.read_text("utf-8")
    path.write_text(changed(before, mutant.place), "utf-8")
    tests = [str(p.relative_to(copy)) for pattern in TESTS[room] for p in sorted(copy.glob(pattern))]
    command = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", *tests]
    try:
        done = subprocess.run(command, cwd=copy, capture_output=True, timeout=_TIMEOUT_S, check=False)
        return done.returncode != 0
    except subprocess.TimeoutExpired:
        return True
    finally:
        path.write_text(before, "utf-8")


def main() -> None:
    """Draw the sample, run it, print one line a mutant and the score."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("rooms", nargs="*", default=list(TESTS))
    parser.add_argument("--sample", type=int, default=20, help="mutants a room")
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder) / "tree"
        ignored = shutil.ignore_patterns(".git", ".venv", "__pycache__", "*.webp")
        shutil.copytree(ROOT, copy, ignore=ignored)
        for room in given.rooms:
            files = sorted((ROOT / "navcore" / room).rglob("*.py"))
            every = [mutant for file in files for mutant in mutants_of(file)]
            sample = random.Random(given.seed).sample(every, min(given.sample, len(every)))
            alive = 0
            for number, mutant in enumerate(sample, start=1):
                dead = killed(mutant, room, copy)
                alive += not dead
                fate = "killed" if dead else "SURVIVED"
                print(f"{fate}  {mutant.file}:{mutant.line}  {mutant.what}")
                print(f"{room}: {number - alive} of {number} killed, {len(every)} possible", flush=True)


if __name__ == "__main__":
    main()

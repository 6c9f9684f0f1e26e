"""docs/serving.md: every row names a test that is there."""

from __future__ import annotations

import ast
import re
from pathlib import Path

ROW = re.compile(r"^\| (\d+) \|.*\| `(tests/[\w/]+\.py)::([\w:]+)` \|$", re.MULTILINE)


def names(path: Path) -> set[str]:
    """Functions of a module, those of a class as ``Class::function``."""
    found = set()
    for node in ast.parse(path.read_text("utf-8")).body:
        if isinstance(node, ast.FunctionDef):
            found.add(node.name)
        elif isinstance(node, ast.ClassDef):
            found |= {f"{node.name}::{part.name}" for part in node.body if isinstance(part, ast.FunctionDef)}
    return found


def test_every_row_has_its_test(repo_root: Path) -> None:
    rows = ROW.findall((repo_root / "docs" / "serving.md").read_text("utf-8"))
    assert [int(number) for number, _, _ in rows] == list(range(1, len(rows) + 1)) and len(rows) >= 36
    for number, file, name in rows:
        assert name in names(repo_root / file), f"row {number}: {file}::{name}"

"""Each point of tests/browser/windows/points.toml has a test in every window and in both languages."""

from __future__ import annotations

import ast
import tomllib
from pathlib import Path

from tests.browser.test_page_layout import SIZES
from tests.browser.windows.conftest import LOCALES, RUNS

FIXTURES = {"window", "pinned", "another"}
"""Of tests/browser/windows: each gives a page in all windows and languages, one after the other."""
BOTH = {"language", "size"}


def asked_by(path: Path) -> dict[str, set[str]]:
    """Name of each test of a module and the fixtures it asks for."""
    found = [node for node in ast.parse(path.read_text("utf-8")).body if isinstance(node, ast.FunctionDef)]
    return {
        node.name: {argument.arg for argument in node.args.args}
        for node in found
        if node.name.startswith("test_")
    }


def test_every_point_has_a_test_in_all_windows_and_languages(repo_root: Path) -> None:
    folder = repo_root / "tests" / "browser" / "windows"
    points = tomllib.loads((folder / "points.toml").read_text("utf-8"))
    named = [test for part in points.values() for test in part.values()]
    assert len(named) >= 45
    tests = {path.name: asked_by(path) for path in folder.glob("test_*.py")}
    for test in named:
        file, _, name = test.partition("::")
        asked = tests[file][name]
        assert asked & FIXTURES or asked >= BOTH, test
    new = {f"{file}::{name}" for file, found in tests.items() if file != "test_work.py" for name in found}
    assert new == set(named), "a test without its point"


def test_the_fixtures_take_all_windows_and_languages(repo_root: Path) -> None:
    text = (repo_root / "tests" / "browser" / "windows" / "conftest.py").read_text("utf-8")
    asked = {
        node.name: {argument.arg for argument in node.args.args}
        for node in ast.parse(text).body
        if isinstance(node, ast.FunctionDef)
    }
    assert "resized" in asked["window"] and "size" in asked["resized"] and "spoken" in asked["resized"]
    assert "language" in asked["spoken"] and asked["another"] >= BOTH
    assert text.count("params=SIZES") == 1 and text.count("params=tuple(LOCALES)") == 1


def test_the_runs_take_each_window_in_both_languages() -> None:
    assert set(RUNS) == {(language, size) for language in LOCALES for size in SIZES}
    assert len(RUNS) == 6

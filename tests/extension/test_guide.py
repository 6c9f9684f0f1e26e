"""Every example of CONTRIBUTING.md is put into one copy of the program, where the contract tests pass.

The guide's own text is taken: the block behind ``<!-- file: PATH -->`` is the file PATH; of the block behind
``<!-- line: PATH -->`` the first line stands in PATH already and the second one is written below it.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

RECIPES = (
    "network",
    "policy",
    "switching method",
    "motion",
    "sensor error",
    "tab",
    "import format",
)
_BLOCK = re.compile(r"<!-- (file|line): (\S+) -->\n+```\w+\n(.*?)```\n", re.DOTALL)
_LEFT_OUT = shutil.ignore_patterns(".git", ".venv", "__pycache__", "build", ".*_cache")
pytestmark = pytest.mark.timeout(1500)  # the kernels of the changed program are compiled


def recipes(guide: str) -> dict[str, list[tuple[str, str, str]]]:
    """Blocks of each recipe, (file or line, path, text), by what it adds."""
    sections = re.split(r"^## ", guide, flags=re.MULTILINE)
    titled = [re.match(r"Add an? (.+)\n", section) for section in sections]
    return {
        title[1]: _BLOCK.findall(section)
        for title, section in zip(titled, sections, strict=True)
        if title is not None
    }


def follow(blocks: list[tuple[str, str, str]], folder: Path) -> None:
    """Do in a copy of the program what a recipe says."""
    for kind, name, text in blocks:
        path = folder / name
        if kind == "file":
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
            continue
        present, added = text.splitlines()
        registry = path.read_text(encoding="utf-8")
        assert registry.count(f"{present}\n") == 1, f"{name} has no line {present}"
        path.write_text(registry.replace(f"{present}\n", f"{present}\n{added}\n"), encoding="utf-8")


@pytest.fixture(scope="module")
def program(tmp_path_factory: pytest.TempPathFactory, repo_root: Path) -> Iterator[Path]:
    """Copy of the program with all examples of the guide in it."""
    folder = tmp_path_factory.mktemp("copy") / "program"
    shutil.copytree(repo_root, folder, ignore=_LEFT_OUT)
    for blocks in recipes((folder / "CONTRIBUTING.md").read_text(encoding="utf-8")).values():
        follow(blocks, folder)
    yield folder
    shutil.rmtree(folder)


def python(program: Path, *arguments: str) -> str:
    """Run Python in the copy; return what it prints."""
    cache = str(program.parent / "cache")
    environment = os.environ | {"PYTHONPATH": str(program), "SCHULER_CACHE_DIR": cache}
    command = [sys.executable, *arguments]
    ended = subprocess.run(command, cwd=program, env=environment, capture_output=True, text=True, check=False)
    assert ended.returncode == 0, ended.stdout[-10_000:] + ended.stderr[-10_000:]
    return ended.stdout


def test_the_guide_has_every_recipe(repo_root: Path) -> None:
    found = recipes((repo_root / "CONTRIBUTING.md").read_text(encoding="utf-8"))
    assert tuple(found) == RECIPES
    for name, blocks in found.items():
        assert {kind for kind, _, _ in blocks} == {"file", "line"}, name
        assert sum(kind == "line" for kind, _, _ in blocks) == 1, f"{name}: one line of a registry"


def test_the_contract_tests_pass_with_all_examples(program: Path) -> None:
    for module in ("scenario.guide", "scenario.schema_file", "analysis.network_table"):  # make guide
        python(program, "-m", f"navcore.{module}")
    python(program, "-m", "ruff", "check", ".")
    python(program, "-m", "pytest", "-q", "-p", "no:cacheprovider", "-m", "contract", "tests/unit")


@pytest.mark.nightly
def test_the_whole_unit_stage_passes_with_all_examples(program: Path) -> None:
    python(program, "-m", "pytest", "-q", "-p", "no:cacheprovider", "tests/unit")

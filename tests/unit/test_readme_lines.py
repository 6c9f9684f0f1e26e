"""The lines of the README's command line run as they stand, with the tutorial's ``my.toml``."""

import re
import shlex
from pathlib import Path

import pytest

from schuler_bench.cli import main

ROOT = Path(__file__).resolve().parents[2]
SLOW = "tune", "pareto", "design", "study"


def _lines() -> list[str]:
    part = (ROOT / "README.md").read_text("utf-8").partition("**Command line.**")[2]
    return re.findall(r"^    schuler (.+)$", part.partition("**Notebook.**")[0], re.MULTILINE)


def _tutorial_scenario() -> str:
    (block,) = re.findall(r"```toml\n(schema = 1\ntitle = \"My ship\".+?)```", _tutorial(), re.DOTALL)
    return block


def _tutorial() -> str:
    return (ROOT / "docs" / "tutorial.md").read_text("utf-8")


EACH = [pytest.param(line, marks=[pytest.mark.slow] * line.startswith(SLOW)) for line in _lines()]


@pytest.mark.parametrize("line", EACH)
def test_a_line_of_the_readme_runs(
    line: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "my.toml").write_text(_tutorial_scenario(), "utf-8")
    (tmp_path / "assets").symlink_to(ROOT / "assets")
    assert main([*shlex.split(line, comments=True), *(["--quiet"] if "run" in line[:4] else [])]) == 0
    captured = capsys.readouterr()
    assert captured.out and not captured.err


def test_the_lines_name_the_tutorials_scenario_and_all_commands_that_it_teaches() -> None:
    assert len(_lines()) >= 12 and sum("my.toml" in line for line in _lines()) >= 2
    assert "`my.toml`" in _tutorial()

"""The sums over the stages, and the Makefile's answers where it cannot go on."""

from __future__ import annotations

import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from navcore.foundation.stage_cache import _size
from tests import stages
from tests.stages import BESIDE, CHECKS, CODE, STAGES, Count, closing_line, read_counts, run_beside


def report(folder: Path, tests: int, failures: int = 0, errors: int = 0, skipped: int = 0) -> Path:
    """JUnit report as pytest writes it."""
    path = folder / "report.xml"
    counted = f'tests="{tests}" failures="{failures}" errors="{errors}" skipped="{skipped}"'
    path.write_text(f"<testsuites><testsuite {counted}/></testsuites>")
    return path


def test_counts_are_those_of_the_report(tmp_path: Path):
    path = report(tmp_path, 10, failures=1, errors=2, skipped=3)
    assert read_counts("unit", path, 1, 2.5) == Count("unit", 4, 3, 3, 2.5)


@pytest.mark.parametrize(
    ("tests", "exit_code"),
    [
        pytest.param(0, 5, id="no test ran"),
        pytest.param(0, 0, id="no test, good exit"),
        pytest.param(7, 3, id="died"),
    ],
)
def test_a_stage_that_went_wrong_counts_as_failed(tmp_path: Path, tests: int, exit_code: int):
    assert read_counts("unit", report(tmp_path, tests), exit_code, 0.0).failed == 1


def test_a_stage_without_report_counts_as_failed(tmp_path: Path):
    assert read_counts("unit", tmp_path / "none.xml", 0, 0.0).failed == 1


def test_closing_line_is_the_sum():
    counts = [Count("a", 3, 0, 1, 1.0), Count("b", 4, 2, 0, 1.0)]
    assert closing_line(counts) == "7 passed, 2 failed, 1 skipped"


def test_every_folder_of_tests_is_in_exactly_one_stage():
    first, *others = STAGES.values()
    taken = [part for stage in others for part in stage if not part.startswith("-")]
    left_out = [part.removeprefix("--ignore=") for part in first if part.startswith("--ignore=")]
    assert sorted(taken) == sorted(left_out)
    assert set(CODE) <= set(first)


def test_lanes_name_checks_and_stages_once():
    named = [name for lane in BESIDE for name in lane]
    assert len(set(named)) == len(named)
    assert set(named) <= {*CHECKS, *STAGES}


def test_stages_side_by_side_run_their_files_and_fail_where_these_are_gone(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
):
    monkeypatch.setitem(stages.STAGES, "one file", ["tests/unit/test_chromium.py"])
    monkeypatch.setitem(stages.STAGES, "lost", ["tests/no-such-folder"])
    monkeypatch.setitem(stages.CHECKS, "broken", ["no_such_module"])
    counts = run_beside([["one file"], ["broken", "lost"]])
    assert [(count.stage, count.failed) for count in counts] == [("one file", 0), ("broken", 1), ("lost", 1)]
    printed = capsys.readouterr().out
    assert "No module named no_such_module" in printed.partition("== broken\n")[2].partition("\n== ")[0]
    assert counts[0].passed > 0


@pytest.fixture
def bare_checkout(repo_root: Path, tmp_path: Path) -> Path:
    """What `make setup` needs before it looks at any code."""
    for name in ("Makefile", "pyproject.toml", *repo_root.glob("requirements*.lock")):
        shutil.copy(repo_root / name, tmp_path)
    (tmp_path / "navcore" / "foundation").mkdir(parents=True)
    shutil.copy(repo_root / "navcore" / "foundation" / "version.py", tmp_path / "navcore" / "foundation")
    return tmp_path


def make(folder: Path, python: Path) -> subprocess.CompletedProcess[str]:
    """Run make setup with some Python."""
    environment = {"PATH": "/usr/bin:/bin:/usr/local/bin", "HOME": str(folder)}
    command = ["make", "setup", f"PYTHON={python}"]
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True)


def stand_in(folder: Path, script: str) -> Path:
    """Python that answers as told."""
    path = folder / "python-stand-in"
    path.write_text(f"#!/bin/sh\n{script}\n")
    path.chmod(0o755)
    return path


def test_an_old_python_is_named_and_refused(bare_checkout: Path):
    python = stand_in(bare_checkout, 'if [ "$1" = --version ]; then echo "Python 3.9.6"; else exit 1; fi')
    done = make(bare_checkout, python)
    assert done.returncode != 0
    assert "needs Python 3.11 or newer" in done.stderr
    assert "Python 3.9.6" in done.stderr
    assert not (bare_checkout / ".venv").exists()


def test_a_python_without_venv_is_told_how_to_get_it(bare_checkout: Path):
    python = stand_in(bare_checkout, 'case "$2" in *ensurepip*) exit 1;; *) exit 0;; esac')
    done = make(bare_checkout, python)
    assert done.returncode != 0
    assert "apt-get install python3-venv" in done.stderr
    assert not (bare_checkout / ".venv").exists()


@dataclass
class Held:
    inside: object


def test_the_cache_counts_arrays_wherever_they_lie() -> None:
    rows = np.zeros(1000)
    assert _size(Held((rows, {"more": [rows]}))) == 1024 + 16_000
    assert _size(Held(Held(rows))) == 1024 + 8_000
    assert _size(Held("text")) == 1024

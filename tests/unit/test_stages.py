"""The sums over the stages, and the Makefile's answers where it cannot go on."""

import os
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from navcore.foundation.stage_cache import bytes_of
from tools import stages
from tools.stages import BESIDE, CHECKS, CODE, STAGES, Count, closing_line, read_counts, run_beside


@pytest.mark.parametrize(
    ("counted", "exit_code", "expected"),
    [
        pytest.param({"tests": 10, "failures": 1, "errors": 2, "skipped": 3}, 1, (4, 3, 3), id="a report"),
        pytest.param({"tests": 0}, 5, (0, 1, 0), id="no test ran"),
        pytest.param({"tests": 0}, 0, (0, 1, 0), id="no test, good exit"),
        pytest.param({"tests": 7}, 3, (7, 1, 0), id="died"),
        pytest.param(None, 0, (0, 1, 0), id="no report"),
    ],
)
def test_a_stage_is_counted_by_its_report_and_fails_where_it_went_wrong(
    tmp_path: Path, counted: dict[str, int] | None, exit_code: int, expected: tuple[int, int, int]
) -> None:
    path = tmp_path / "report.xml"
    if counted is not None:
        words = " ".join(f'{name}="{number}"' for name, number in counted.items())
        path.write_text(f"<testsuites><testsuite {words}/></testsuites>")
    assert read_counts("unit", path, exit_code, 2.5) == Count("unit", *expected, 2.5)


def test_closing_line_is_the_sum():
    counts = [Count("a", 3, 0, 1, 1.0), Count("b", 4, 2, 0, 1.0)]
    assert closing_line(counts) == "7 passed, 2 failed, 1 skipped"


def test_every_folder_is_in_exactly_one_stage_and_lanes_name_each_once() -> None:
    first, *others = STAGES.values()
    taken = [part for stage in others for part in stage if not part.startswith("-")]
    left_out = [part.removeprefix("--ignore=") for part in first if part.startswith("--ignore=")]
    assert sorted(taken) == sorted(left_out) and set(CODE) <= set(first)
    named = [name for lanes in BESIDE for lane in lanes for name in lane]
    assert len(set(named)) == len(named) and set(named) <= {*CHECKS, *STAGES}


def test_stages_side_by_side_run_their_files_and_fail_where_these_are_gone(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
):
    monkeypatch.setitem(stages.STAGES, "one file", ["tests/unit/test_text.py"])
    monkeypatch.setitem(stages.STAGES, "lost", ["tests/no-such-folder"])
    monkeypatch.setitem(stages.CHECKS, "broken", ["no_such_module"])
    counts = run_beside([["one file"], ["broken", "lost"]])
    assert [(count.stage, count.failed) for count in counts] == [("one file", 0), ("broken", 1), ("lost", 1)]
    printed = capsys.readouterr().out
    assert "No module named no_such_module" in printed.partition("== broken\n")[2].partition("\n== ")[0]
    assert counts[0].passed > 0


HANDED_DOWN = ("MAKEFLAGS", "MAKEOVERRIDES", "MAKELEVEL", "MFLAGS", "SLOW")


def test_make_test_leaves_slow_tests_to_continuous_integration(repo_root: Path) -> None:
    # the make that runs this test hands its own choice down
    env = {name: value for name, value in os.environ.items() if name not in HANDED_DOWN}

    def would_run(*given: str) -> str:
        make = ["make", "--dry-run", "test", *given]
        done = subprocess.run(make, cwd=repo_root, env=env, capture_output=True, text=True, check=True)
        return done.stdout.splitlines()[-1]

    assert would_run() == "SCHULER_QUICK=yes .venv/bin/python -m tools.stages"
    assert would_run("SLOW=yes").strip() == ".venv/bin/python -m tools.stages"
    assert "test SLOW=yes" in (repo_root / ".ci" / "run").read_text()


@pytest.mark.parametrize("quick", ["", "yes"])
def test_a_quick_run_leaves_out_what_is_slow(repo_root: Path, quick: str) -> None:
    file, slow = "tests/unit/test_kalman_method.py", "test_its_covariance_holds_over_seeds"
    done = subprocess.run(
        [sys.executable, "-m", "pytest", "--collect-only", "-q", "-n0", file],
        cwd=repo_root, env=os.environ | {"SCHULER_QUICK": quick}, capture_output=True, text=True,
    )  # fmt: skip
    assert (slow in done.stdout) == (not quick) and done.stdout.count(f"{file}::") > 3


@pytest.fixture
def bare_checkout(repo_root: Path, tmp_path: Path) -> Path:
    """What `make setup` needs before it looks at any code."""
    for name in ("Makefile", "pyproject.toml"):
        shutil.copy(repo_root / name, tmp_path)
    shutil.copytree(repo_root / "requirements", tmp_path / "requirements")
    (tmp_path / "navcore" / "foundation").mkdir(parents=True)
    shutil.copy(repo_root / "navcore" / "foundation" / "version.py", tmp_path / "navcore" / "foundation")
    return tmp_path


@pytest.mark.parametrize(
    ("script", "told"),
    [
        (
            'if [ "$1" = --version ]; then echo "Python 3.9.6"; else exit 1; fi',
            ["needs Python 3.11 or newer", "Python 3.9.6"],
        ),
        ('case "$2" in *ensurepip*) exit 1;; *) exit 0;; esac', ["apt-get install python3-venv"]),
    ],
    ids=["old", "without venv"],
)
def test_a_python_that_will_not_do_is_told_before_anything_is_made(
    bare_checkout: Path, script: str, told: list[str]
) -> None:
    python = bare_checkout / "python-stand-in"
    python.write_text(f"#!/bin/sh\n{script}\n")
    python.chmod(0o755)
    done = subprocess.run(
        ["make", "setup", f"PYTHON={python}"],
        cwd=bare_checkout,
        env={"PATH": "/usr/bin:/bin:/usr/local/bin", "HOME": str(bare_checkout)},
        capture_output=True,
        text=True,
    )
    assert done.returncode != 0 and not (bare_checkout / ".venv").exists()
    assert [text for text in told if text not in done.stderr] == []


@dataclass
class Held:
    inside: object


def test_the_cache_counts_arrays_wherever_they_lie() -> None:
    rows = np.zeros(1000)
    assert bytes_of(Held((rows, {"more": [rows]}))) == 1024 + 16_000
    assert bytes_of(Held(Held(rows))) == 1024 + 8_000
    assert bytes_of(Held("text")) == 1024

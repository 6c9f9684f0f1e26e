"""Runs all checks and tests in stages and sums them up: ``python -m tools.stages [lint | unit]``.

Stages that leave a core idle at times run side by side: each says that it begins, and is shown when it ends.
The last line printed is ``N passed, N failed, N skipped`` over all stages; a check (ruff, basedpyright)
counts as one test. The exit code is 1 when anything failed or when a test stage ran no test at all.
"""

import os
import subprocess
import sys
import tempfile
import threading
import time
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import IO

from tools.chromium import provide_chromium
from tools.fonts import provide_fonts

ROOT = Path(__file__).resolve().parent.parent
STAMPS = ROOT / ".venv" / ".stamps"
CODE = ["tests", "schuler_bench", "navcore", "tools"]


@dataclass(frozen=True)
class Count:
    """Result of a stage: passed, failed and skipped tests, and its wall time."""

    stage: str
    passed: int
    failed: int
    skipped: int
    seconds: float


CHECKS = {
    "ruff check": ["ruff", "check", "--quiet", "."],
    "ruff format": ["ruff", "format", "--check", "--quiet", "."],
    "basedpyright": ["basedpyright", "--level", "warning"],
}

# The first stage takes every folder that has no stage of its own, so that no test is forgotten.
STAGES = {
    "unit, acceptance, doctests": [
        *CODE,
        "README.md",
        *(f"--ignore=tests/{own}" for own in ("attack", "browser", "extension")),
        # A file stays in one process, so that what its tests share is made once; the longest come first.
        *("-n2", "--dist=loadfile", "--no-loadscope-reorder"),
        "-mnot browser and not attack",
    ],
    "extension": ["tests/extension"],
    "attack": ["tests/attack"],
    # All tests of a process share a page; a process that has no tests left takes half of the other's.
    "browser": ["tests/browser", "-n2", "--dist=worksteal"],
}

BESIDE = (
    (("attack",), ("extension",)),
    (("browser",), ("basedpyright",)),
)
"""Groups of lanes that run side by side, before and after all else; the stages of a lane one after the other.

Attack and extension keep one core busy each. The workers of the browser stage wait a good part of their time,
for frames, timers and answers, in which the types are checked; the attacks are not, whose ends are timed.
"""


def read_counts(stage: str, report: Path, exit_code: int, seconds: float) -> Count:
    """Read a JUnit report; a run that died, wrote none or held no test counts as one failure."""
    passed = failed = skipped = 0
    if report.is_file():
        for suite in ElementTree.parse(report).getroot().iter("testsuite"):
            bad = int(suite.get("failures", 0)) + int(suite.get("errors", 0))
            left_out = int(suite.get("skipped", 0))
            passed += int(suite.get("tests", 0)) - bad - left_out
            failed, skipped = failed + bad, skipped + left_out
    if (exit_code != 0 and failed == 0) or passed + failed + skipped == 0:
        failed += 1
    return Count(stage, passed, failed, skipped, seconds)


def closing_line(counts: Iterable[Count]) -> str:
    """Sum of all stages."""
    counts = list(counts)
    passed, failed, skipped = (
        sum(getattr(c, key) for c in counts) for key in ("passed", "failed", "skipped")
    )
    return f"{passed} passed, {failed} failed, {skipped} skipped"


def table(counts: Iterable[Count]) -> str:
    """One line a stage."""
    rows = [
        f"{c.stage:<28} {c.seconds:8.1f} s {c.passed:6d} passed {c.failed:4d} failed {c.skipped:4d} skipped"
        for c in counts
    ]
    return "\n".join(rows)


def run_check(name: str, out: IO[str] | None = None) -> Count:
    """Run one linter; what it prints goes to ``out``, by default to the standard output."""
    print(f"== {name}", file=out, flush=True)
    start = time.perf_counter()
    command = [sys.executable, "-m", *CHECKS[name]]
    done = subprocess.run(command, cwd=ROOT, stdout=out, stderr=out and subprocess.STDOUT)
    bad = int(done.returncode != 0)
    return Count(name, 1 - bad, bad, 0, time.perf_counter() - start)


def run_stage(name: str, out: IO[str] | None = None) -> Count:
    """Run the tests of one stage; what they print goes to ``out``, by default to the standard output."""
    print(f"== {name}", file=out, flush=True)
    start = time.perf_counter()
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder) / "report.xml"
        command = [sys.executable, "-m", "pytest", "-q", f"--junitxml={report}", *STAGES[name]]
        done = subprocess.run(
            command, cwd=ROOT, stdin=subprocess.DEVNULL, stdout=out, stderr=out and subprocess.STDOUT
        )
        return read_counts(name, report, done.returncode, time.perf_counter() - start)


def provide_browser() -> None:
    """Find or install what the tests of the page need, and say what was done or what is missing."""
    path, how = provide_chromium()
    print(f"== Chromium: {path} ({how})" if path else f"== tests/browser will be skipped: {how}")
    print(f"== fonts of tests/browser: {provide_fonts()}", flush=True)


def run_beside(lanes: Iterable[Iterable[str]]) -> list[Count]:
    """Run lanes of checks and stages side by side; what each of them prints stays together."""
    printing = threading.Lock()

    def run_lane(names: Iterable[str]) -> list[Count]:
        counts = []
        for name in names:
            with printing:
                print(f"== {name} begins", flush=True)
            with tempfile.TemporaryFile("w+", encoding="utf-8", errors="replace") as out:
                counts.append(run_check(name, out) if name in CHECKS else run_stage(name, out))
                out.seek(0)
                with printing:
                    print(out.read(), end="", flush=True)
        return counts

    lanes = list(lanes)
    with ThreadPoolExecutor(len(lanes)) as pool:
        return [count for counts in pool.map(run_lane, lanes) for count in counts]


def setup_times() -> str:
    """Wall times that the Makefile noted when it installed and compiled."""
    named = {"packages": "install", "kernels": "compile the kernels", "test": "install for the tests"}
    rows = []
    for stamp, what in named.items():
        if (STAMPS / stamp).is_file():
            rows.append(f"{what:<28} {(STAMPS / stamp).read_text().strip():>6}   s  (when it was last done)")
    return "\n".join(rows)


def main(arguments: list[str]) -> int:
    """Run what is asked for, all by default; return the exit code."""
    wanted = arguments[0] if arguments else "all"
    if wanted not in ("all", "lint", "unit"):
        print(f"stages: {wanted}: all, lint or unit", file=sys.stderr)
        return 2
    start = time.perf_counter()
    counts: list[Count] = []
    if wanted == "lint":
        counts = [run_check(name) for name in CHECKS]
    else:
        # Hundreds of processes are started: they read the byte code that the first of them has written.
        os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
        # Compiled before the first test, and once for all its processes.
        subprocess.run([sys.executable, "-m", "navcore.warm"], cwd=ROOT, check=True)
        if wanted == "all":
            provide_browser()
            before, after = BESIDE
            taken = {name for lanes in BESIDE for lane in lanes for name in lane}
            counts += [run_check(name) for name in CHECKS if name not in taken]
            counts += run_beside(before)
            counts += [run_stage(name) for name in STAGES if name not in taken]
            counts += run_beside(after)
        else:
            counts.append(run_stage(next(iter(STAGES))))
    whole = f"{'all, from first to last':<28} {time.perf_counter() - start:8.1f} s"
    failing = [count.stage for count in counts if count.failed]
    blame = f"failed: {', '.join(failing)}\n" if failing else ""
    print(f"\n{setup_times()}\n{table(counts)}\n{whole}\n\n{blame}{closing_line(counts)}", flush=True)
    return int(bool(failing))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

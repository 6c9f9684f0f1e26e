"""One process that runs the tests of a room on a tree, in which one place may be changed."""

from __future__ import annotations

import os
import signal
import sys
import time
import traceback
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from tests.mutation import kernels


class Recorder:
    """Chooses the tests, in order, and keeps what became of each."""

    def __init__(self, chosen: list[str] | None) -> None:
        self.chosen = chosen
        self.seconds: dict[str, float] = {}
        self.bad: list[str] = []

    def pytest_collection_modifyitems(self, items: list[Any]) -> None:
        """Keep the chosen tests, in the order of the choice."""
        if self.chosen is not None:
            place = {name: i for i, name in enumerate(self.chosen)}
            items[:] = sorted((i for i in items if i.nodeid in place), key=lambda i: place[i.nodeid])

    def pytest_runtest_logreport(self, report: Any) -> None:
        """Sum a test's phases up."""
        self.seconds[report.nodeid] = self.seconds.get(report.nodeid, 0.0) + report.duration
        if report.failed or report.skipped:
            self.bad.append(report.nodeid)


def run_tests(
    tree: Path,
    files: list[str],
    chosen: list[str] | None,
    kept: tuple[str, kernels.Closures],
    interpret: bool,
    test_limit_s: float,
    *,
    collect_only: bool = False,
) -> tuple[int, Recorder]:
    """Run tests in this process; to be called in a fork that has not imported navcore.

    Parameters
    ----------
    tree : Path
        The tree, changed or not.
    files : list of str
        Files of the tests.
    chosen : list of str or None
        The tests, in order; the first that fails ends the run. None: all of them, to their end.
    kept : tuple
        Digest of the unchanged kernels, and their closures.
    interpret : bool
        Run changed kernels as Python.
    test_limit_s : float
        A test that takes longer fails, s.
    collect_only : bool
        Run none, but write the byte code of the tests.
    """
    os.chdir(tree)
    sys.path[:0] = [str(tree)]
    for name in [n for n in sys.modules if n.partition(".")[0] in ("tests", "navcore", "app")]:
        del sys.modules[name]
    # A changed file must leave no byte code that could be taken for that of the unchanged one.
    sys.dont_write_bytecode = not collect_only
    recorder = Recorder(chosen)
    try:
        kernels.install(*kept, interpret)
    except Exception:
        return 1, recorder
    options = ["-q", "-p", "no:cacheprovider", "-p", "no:xdist", f"--timeout={test_limit_s:g}"]
    code = pytest.main(
        [*options, *(["--collect-only"] if collect_only else [] if chosen is None else ["-x"]), *files],
        plugins=[recorder],
    )
    return int(code), recorder


def in_fork(work: Callable[[Any], None], limit_s: float) -> str:
    """Do work in a fork and return what it wrote, or "timeout" when it took longer than ``limit_s``."""
    read, write = os.pipe()
    pid = os.fork()
    if pid == 0:
        os.setpgid(0, 0)
        os.close(read)
        null = os.open(
            os.environ.get("MUTATION_OUTPUT", os.devnull), os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o600
        )
        os.dup2(null, 1)
        os.dup2(null, 2)
        try:
            with os.fdopen(write, "w") as out:
                work(out)
        except BaseException:
            traceback.print_exc()
        finally:
            os._exit(0)
    os.close(write)
    os.set_blocking(read, False)
    parts, end, done = [], time.monotonic() + limit_s, False
    while time.monotonic() < end and not done:
        done = os.waitpid(pid, os.WNOHANG)[0] == pid
        try:
            parts.append(os.read(read, 1 << 20))
        except BlockingIOError:
            pass
        if not done:
            time.sleep(0.05)
    if not done:
        os.kill(pid, signal.SIGKILL)
        os.waitpid(pid, 0)
    while done and (part := os.read(read, 1 << 20)):
        parts.append(part)
    os.close(read)
    return b"".join(parts).decode() if done else "timeout"

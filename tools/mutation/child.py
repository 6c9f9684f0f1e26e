"""One process that runs the tests of a room on a tree, in which one place may be changed."""

import math
import os
import resource
import signal
import sys
import time
import traceback
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from tools.compile_time import Uncounted
from tools.mutation import kernels


class Recorder:
    """Chooses the tests, in order, and keeps what became of each, and its CPU time."""

    def __init__(self, chosen: list[str] | None, test_limit_s: float) -> None:
        self.chosen, self.test_limit_s = chosen, test_limit_s
        self.seconds: dict[str, float] = {}
        self.bad: list[str] = []

    def pytest_collection_modifyitems(self, items: list[Any]) -> None:
        """Keep the chosen tests, in the order of the choice."""
        if self.chosen is not None:
            place = {name: i for i, name in enumerate(self.chosen)}
            items[:] = sorted((i for i in items if i.nodeid in place), key=lambda i: place[i.nodeid])

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_protocol(self, item: Any) -> Iterator[None]:
        """Take a test's CPU time, which a busy machine does not lengthen, and end one that takes too long."""
        begin = time.process_time()
        signal.setitimer(signal.ITIMER_PROF, self.test_limit_s)
        try:
            return (yield)
        finally:
            signal.setitimer(signal.ITIMER_PROF, 0.0)
            self.seconds[item.nodeid] = time.process_time() - begin

    def pytest_runtest_logreport(self, report: Any) -> None:
        """Keep the tests that do not pass."""
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
        A test that takes more CPU time fails, s.
    collect_only : bool
        Run none, but write the byte code of the tests.
    """
    os.chdir(tree)
    sys.path[:0] = [str(tree)]
    ours = ("tests", "tools", "navcore", "schuler_bench")
    for name in [name for name in sys.modules if name.partition(".")[0] in ours]:
        del sys.modules[name]
    # A changed file must leave no byte code that could be taken for that of the unchanged one.
    sys.dont_write_bytecode = not collect_only
    recorder = Recorder(chosen, test_limit_s)
    signal.signal(signal.SIGPROF, _too_long)
    Uncounted(signal.ITIMER_PROF).listen()
    try:
        kernels.install(*kept, interpret)
    except Exception:
        return 1, recorder
    options = ["-q", "-p", "no:cacheprovider", "-p", "no:xdist", "--timeout=0"]
    code = pytest.main(
        [*options, *(["--collect-only"] if collect_only else [] if chosen is None else ["-x"]), *files],
        plugins=[recorder],
    )
    return int(code), recorder


def _too_long(number: int, frame: object) -> None:
    pytest.fail("the test took too long")


def in_fork(work: Callable[[Any], object], limit_s: float) -> str:
    """Do work in a fork; return what it wrote, or "timeout" after more than ``limit_s`` of CPU time."""
    read, write = os.pipe()
    pid = os.fork()
    if pid == 0:
        os.setpgid(0, 0)
        resource.setrlimit(resource.RLIMIT_CPU, (math.ceil(limit_s), math.ceil(limit_s) + 5))
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
    parts, status = [], None
    while status is None:
        ended, found = os.waitpid(pid, os.WNOHANG)
        status = found if ended == pid else None
        try:
            parts.append(os.read(read, 1 << 20))
        except BlockingIOError:
            pass
        if status is None:
            time.sleep(0.02)
    while part := os.read(read, 1 << 20):
        parts.append(part)
    os.close(read)
    if os.WIFSIGNALED(status) and os.WTERMSIG(status) in (signal.SIGXCPU, signal.SIGKILL):
        return "timeout"
    return b"".join(parts).decode()

"""A dashboard in a process of its own, as ``schuler serve`` starts it."""

import os
import socket
import subprocess
import sys
import tempfile
import time
import urllib.request
from collections.abc import Sequence
from pathlib import Path
from typing import Self

_ROOT = Path(__file__).resolve().parents[2]
_MIB = 1024.0 * 1024.0


def environment() -> dict[str, str]:
    """Environment in which a child finds this very installation, whatever the current folder."""
    paths = [str(_ROOT), *filter(None, [os.environ.get("PYTHONPATH")])]
    kept = {name: value for name, value in os.environ.items() if name != "SCHULER_TOKEN"}
    return {**kept, "PYTHONPATH": os.pathsep.join(paths)}


def free_port() -> int:
    """Port that nobody listens on at this moment."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Server:
    """A running dashboard, used as a context.

    Parameters
    ----------
    workers : int
        Processes that share the visitors (``schuler serve --workers``); 1: one process, without a door.
    options : sequence of str
        Further options of the command.

    Attributes
    ----------
    port : int
        Where it listens.
    startup_s : float
        From the start of the process until the page was served.
    """

    def __init__(self, workers: int = 1, options: Sequence[str] = ()) -> None:
        self._options = options
        self.port = free_port()
        self._workers = workers
        self.startup_s = 0.0

    def __enter__(self) -> Self:
        words = [sys.executable, "-m", "schuler_bench", "serve", "--port", str(self.port)]
        words += ["--workers", str(self._workers)] if self._workers > 1 else []
        words += self._options
        began = time.perf_counter()
        # What the timed visitor did is not kept among the user's sessions.
        self._state = tempfile.TemporaryDirectory(prefix="schuler-bench-")
        self._process = subprocess.Popen(
            words,
            env=environment() | {"XDG_STATE_HOME": self._state.name},
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
        )
        try:
            self._wait_for_page()
        except BaseException:
            self.__exit__()
            raise
        self.startup_s = time.perf_counter() - began
        return self

    def __exit__(self, *_: object) -> None:
        self._process.terminate()
        try:
            self._process.wait(6.0)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        self._state.cleanup()

    def rss_mb(self) -> float:
        """Memory that the server holds now, the door and all workers together, MiB."""
        pages = [_statistic(pid, "statm").split() for pid in self._pids()]
        if any(pages):
            return sum(int(fields[1]) for fields in pages if fields) * os.sysconf("SC_PAGE_SIZE") / _MIB
        listed = subprocess.run(
            ["ps", "-o", "rss=", "-p", str(self._process.pid)], capture_output=True, text=True, check=True
        )
        return int(listed.stdout) * 1024.0 / _MIB

    def cpu_s(self) -> float:
        """Processor time that the server has used, s; 0 where the system does not tell."""
        ticks = sum(int(number) for pid in self._pids() for number in _after_name(pid)[11:13])
        return ticks / os.sysconf("SC_CLK_TCK")

    def threads(self) -> int:
        """Most threads of one process of the server; 0 where the system does not tell."""
        folders = [Path(f"/proc/{pid}/task") for pid in self._pids()]
        return max((len(list(folder.iterdir())) for folder in folders if folder.exists()), default=0)

    def _pids(self) -> list[int]:
        """Process numbers: of the server, and of its workers."""
        door = self._process.pid
        if self._workers == 1:
            return [door]
        every = (int(folder.name) for folder in Path("/proc").glob("[0-9]*"))
        return [door, *(pid for pid in every if _after_name(pid)[1:2] == [str(door)])]

    def _wait_for_page(self, seconds: float = 30.0) -> None:
        until = time.monotonic() + seconds
        direct = urllib.request.build_opener(urllib.request.ProxyHandler({}))
        while time.monotonic() < until:
            if self._process.poll() is not None:
                raise RuntimeError(f"the dashboard ended with exit code {self._process.returncode}")
            try:
                with direct.open(f"http://127.0.0.1:{self.port}/", timeout=10.0) as page:
                    page.read()
                return
            except OSError:
                time.sleep(0.005)
        raise TimeoutError(f"the dashboard served no page within {seconds:g} s")


def _statistic(pid: int, name: str) -> str:
    """A file of the system about a process; empty for one that has ended, or where there is none."""
    try:
        return Path(f"/proc/{pid}/{name}").read_text()
    except OSError:
        return ""


def _after_name(pid: int) -> list[str]:
    """Fields of the process's ``stat`` after its name: state, parent, ..."""
    return _statistic(pid, "stat").rpartition(") ")[2].split()

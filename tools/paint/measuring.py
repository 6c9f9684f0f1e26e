"""Common parts of measurements of the page: a server of a tree, CPU times (Linux), timed slider steps."""

import os
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from urllib.request import urlopen

from playwright.sync_api import Locator, Page

WINDOW: Any = {"width": 1920, "height": 1080}
_PROC = Path("/proc")
# From a key press until two frames after the number of a later run is there with all its figures.
_PAINTED = """after => new Promise(resolve => {
  let start = null;
  addEventListener('keydown', () => { start = performance.now(); }, {capture: true, once: true});
  const plots = () => [...document.querySelectorAll('.js-plotly-plot')].filter(p => p.offsetParent !== null);
  const shown = () => plots().map(p => Number(p._fullLayout?.meta?.run));
  const current = () => {
    const page = document.querySelector('#sb-run');
    const run = page === null ? Math.max(...shown()) : Number(page.dataset.run);
    return run > after && shown().every(number => number === run);
  };
  const look = () => requestAnimationFrame(() => {
    if (start === null || !current()) return look();
    requestAnimationFrame(() => requestAnimationFrame(() => resolve(performance.now() - start)));
  });
  look();
})"""
_NUMBER = """() => {
  const runs = [...document.querySelectorAll('.js-plotly-plot')].map(p => Number(p._fullLayout?.meta?.run));
  return Number(document.querySelector('#sb-run')?.dataset.run ?? Math.max(...runs));
}"""


@contextmanager
def served(tree: Path, state: Path, port: int) -> Iterator[tuple[str, subprocess.Popen[bytes]]]:
    """Serve a tree in a process of its own, which keeps its sessions in a folder; gives its address."""
    environment = os.environ | {"XDG_STATE_HOME": str(state), "XDG_DATA_HOME": str(state)}
    # By the name that an earlier checkout has too.
    command, quiet = [sys.executable, "-m", "app", "serve", "--port", str(port)], subprocess.DEVNULL
    process = subprocess.Popen(command, cwd=tree, env=environment, stdout=quiet, stderr=quiet)
    try:
        until = time.monotonic() + 60.0
        while not _answers(f"http://127.0.0.1:{port}/healthz"):
            assert process.poll() is None and time.monotonic() < until, "the server does not answer"
            time.sleep(0.05)
        yield f"http://127.0.0.1:{port}/", process
    finally:
        process.kill()
        process.wait(60.0)


def _answers(url: str) -> bool:
    try:
        urlopen(url, timeout=5.0).close()
    except OSError:
        return False
    return True


def thumb(page: Page, labels: list[str]) -> Locator:
    """The thumb of the slider that has one of these labels."""
    script = "l => [...document.querySelectorAll('label')].find(e => l.includes(e.textContent)).htmlFor"
    return page.locator(f"[id='{page.evaluate(script, labels)}'] [role=slider]")


def step_times_ms(page: Page, labels: list[str], count: int, pause_ms: float = 300.0) -> list[float]:
    """Time of each step of a slider to the last paint, ms."""
    taken = []
    for step in range(count):
        thumb(page, labels).focus()
        page.evaluate(f"window.paint = ({_PAINTED})({page.evaluate(_NUMBER)}); null")
        page.keyboard.press("ArrowRight" if step % 2 else "ArrowLeft")
        page.wait_for_function("() => window.paint.then(time => (window.painted = time))")
        taken.append(page.evaluate("() => window.painted"))
        page.wait_for_timeout(pause_ms)
    return taken


# ------------------------------------------------------------ CPU


def server_cpu_ms(pid: int) -> float:
    """CPU time that a process has used, ms."""
    fields = _text(_PROC / str(pid) / "stat").rpartition(")")[2].split()
    return 1e3 * (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def browser_cpu_ms() -> tuple[float, float]:
    """CPU time of the pages' main threads, and of all else that paints: other threads of pages, GPU process.

    Counted by the scheduler in nanoseconds, so that a busy machine makes it longer only as far as its caches
    are shared.
    """
    main = other = 0
    for pid in _descendants(os.getpid()):
        words = (
            _text(_PROC / str(pid) / "cmdline").replace("\0", " ").split()
        )  # Chromium's children: by spaces
        if not {"--type=renderer", "--type=gpu-process"} & set(words):
            continue
        for thread in _entries(_PROC / str(pid) / "task"):
            time_ns = int((_text(thread / "schedstat").split() or ["0"])[0])
            if "--type=renderer" in words and thread.name == str(pid):
                main += time_ns
            else:
                other += time_ns
    return main / 1e6, other / 1e6


def _descendants(root: int) -> set[int]:
    parents = {
        int(entry.name): int((_text(entry / "stat").rpartition(")")[2].split() or ["0", "0"])[1])
        for entry in _entries(_PROC)
        if entry.name.isdigit()
    }
    found = {root}
    while more := {pid for pid, parent in parents.items() if parent in found} - found:
        found |= more
    return found - {root}


def _entries(folder: Path) -> list[Path]:
    """Read a file of a process's folder; nothing once the process has ended."""
    try:
        return list(folder.iterdir())
    except OSError:
        return []


def _text(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8", errors="replace")
    except OSError:
        return ""

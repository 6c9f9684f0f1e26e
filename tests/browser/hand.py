"""How the page follows a hand: ``python -m tests.browser.hand [--before TREE] [--rounds N] [--seconds S]``.

A slider is dragged, moved step by step, and the page is opened, in headless Chromium with software rendering.
Everything is read from the page alone, so that the same script measures the tree of an earlier commit: with
``--before`` both are served side by side and measured in turns, and the ratios are told.
"""

from __future__ import annotations

import argparse
import os
import re
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any
from urllib.request import urlopen

from app.bench.dashboard import median_and_p95
from app.bench.process import free_port
from tests.browser.cpu import browser_cpu_ms
from tests.browser.fields import slider_labels
from tests.chromium import launched

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

HERE = Path(__file__).parents[2]
SLIDER = ["zeta", *slider_labels("network.zeta")]
"""Its labels, that of an earlier commit first."""
SIZES: dict[str, tuple[Any, tuple[str, ...]]] = {
    "Frequency, Errors, 3D": ({"width": 1920, "height": 1080}, ("Method", "Frequency", "Errors")),
    "Errors alone": ({"width": 1366, "height": 768}, ("Method", "Errors")),
}
_THREADS = ("main thread", "painting")
"""What `browser_cpu_ms` tells apart."""
_MOVES = 60
_WARM_S = 5.0
"""So long the kernels may take that are loaded behind the page."""
_SWING_PX = 90
_PAUSE_MS = 700
"""Between steps whose cost is counted: longer than the slowest takes."""
_AWAY = 6
"""Steps beyond the pins: one that equals the run has another name, and the legend is laid out anew."""

_WATCH = """() => {
  const charts = () => Object.values(window.__viserTestpoints?.uplots ?? {}).map(entry => entry.chart);
  const plots = () => [...document.querySelectorAll('.js-plotly-plot')].filter(p => p.offsetParent !== null);
  const seen = {began: performance.now(), frames: [], curves: [], figures: []};
  let last = performance.now(), data = charts()[0]?.data, run = plots()[0]?._fullLayout?.meta?.run;
  window.stopWatch = () => { seen.on = false; return seen; };
  seen.on = true;
  const look = () => requestAnimationFrame(() => {
    const now = performance.now();
    seen.frames.push(now - last);
    last = now;
    const newData = charts()[0]?.data, newRun = plots()[0]?._fullLayout?.meta?.run;
    if (newData !== data) { data = newData; seen.curves.push(now); }
    if (newRun !== run) { run = newRun; seen.figures.push(now); }
    if (seen.on) look();
  });
  look();
}"""
_TRACK = """labels => {
  const label = [...document.querySelectorAll('label')].find(e => labels.includes(e.textContent));
  const track = document.getElementById(label.htmlFor).closest('.mantine-Slider-root')
    .querySelector('.mantine-Slider-track').getBoundingClientRect();
  return [track.left, track.right];
}"""
_STEP = """after => new Promise(resolve => {
  let start = null;
  addEventListener('keydown', () => { start = performance.now(); }, {capture: true, once: true});
  const shown = () => [...document.querySelectorAll('.js-plotly-plot')]
    .filter(p => p.offsetParent !== null).map(p => Number(p._fullLayout?.meta?.run));
  const current = () => {
    const run = Number(document.querySelector('#sb-run').dataset.run);
    return run > after && shown().every(number => number === run);
  };
  const look = () => requestAnimationFrame(() => {
    if (start === null || !current()) return look();
    requestAnimationFrame(() => requestAnimationFrame(() => resolve(performance.now() - start)));
  });
  look();
})"""
_FIRST_PICTURE = """() => {
  const charts = Object.values(window.__viserTestpoints?.uplots ?? {});
  return charts.length > 0 || document.querySelector('.js-plotly-plot .trace') !== null;
}"""
_CLOSE_NOTICES = """() =>
  document.querySelectorAll('.mantine-Notification-closeButton').forEach(button => button.click())"""
_SERIES = """() => Math.max(...Object.values(window.__viserTestpoints?.uplots ?? {})
  .map(entry => entry.chart.series.length))"""
_SHOWN_RUN = "Number(document.querySelector('#sb-run').dataset.run)"
_EVERYTHING = """() => {
  const run = document.querySelector('#sb-run')?.dataset.run;
  const plots = [...document.querySelectorAll('.js-plotly-plot')].filter(p => p.offsetParent !== null);
  const charts = Object.values(window.__viserTestpoints?.uplots ?? {});
  return run !== undefined && charts.length > 0 && plots.length > 0
    && plots.every(p => String(p._fullLayout?.meta?.run) === run);
}"""


@dataclass
class Followed:
    """What was seen of one tree, over all rounds."""

    figures: dict[str, list[float]] = field(default_factory=dict)

    def note(self, name: str, *values: float) -> None:
        """Add values of a figure."""
        self.figures.setdefault(name, []).extend(values)

    def median(self, name: str) -> float:
        """Median of a figure."""
        return statistics.median(self.figures[name])


@contextmanager
def served(tree: Path) -> Iterator[str]:
    """Serve a tree in a process of its own; gives the address."""
    port = free_port()
    with tempfile.TemporaryDirectory() as state:
        environment = os.environ | {"XDG_STATE_HOME": state, "XDG_DATA_HOME": state}
        command = [sys.executable, "-m", "app", "serve", "--port", str(port)]
        process = subprocess.Popen(
            command, cwd=tree, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        )
        try:
            url = f"http://127.0.0.1:{port}/"
            _wait_for(url)
            time.sleep(_WARM_S)
            yield url
        finally:
            process.kill()
            process.wait()


def _wait_for(url: str) -> None:
    until = time.monotonic() + 60.0
    while True:
        try:
            urlopen(f"{url}healthz", timeout=5.0).close()
            return
        except OSError:
            if time.monotonic() > until:
                raise
            time.sleep(0.1)


def open_page(browser: Browser, url: str, size: Any, tabs: tuple[str, ...], seen: Followed) -> Page:
    """Open a page, note how long that took, and bring tabs to the front."""
    page = browser.new_context(viewport=size).new_page()
    page.set_default_timeout(60_000)
    began = time.monotonic()
    page.goto(f"{url}?fixedDpr=0.25&start=no", wait_until="commit")
    page.wait_for_function(_FIRST_PICTURE, polling=20)
    seen.note("opening, first picture (ms)", 1e3 * (time.monotonic() - began))
    if size["width"] >= 1600:
        page.wait_for_function(_EVERYTHING, polling=20)
        seen.note("opening, everything (ms)", 1e3 * (time.monotonic() - began))
    page.wait_for_timeout(2500)
    page.evaluate(
        "() => document.querySelectorAll('.mantine-Notification-closeButton').forEach(b => b.click())"
    )
    for name in tabs:
        tab = page.get_by_role("tab", name=name, exact=True)
        if tab.get_attribute("aria-selected") != "true":
            tab.click()
        page.wait_for_timeout(400)
    page.wait_for_timeout(1000)
    return page


def _thumb(page: Page) -> Any:
    script = "l => [...document.querySelectorAll('label')].find(e => l.includes(e.textContent)).htmlFor"
    return page.locator(f"[id='{page.evaluate(script, SLIDER)}'] [role=slider]")


def drag(page: Page, seconds: float, what: str, seen: Followed) -> None:
    """Move the slider to and fro with the mouse held down, and note the pictures that come meanwhile."""
    box, track = _thumb(page).bounding_box(), page.evaluate(_TRACK, SLIDER)
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    swing = min(_SWING_PX, track[1] - x)  # beyond the slider's end a move changes nothing
    page.mouse.move(x, y)
    page.mouse.down()
    page.evaluate(_WATCH)
    began, began_cpu = time.monotonic(), browser_cpu_ms()
    there = False
    while time.monotonic() - began < seconds:
        there = not there
        page.mouse.move(x + swing * there, y, steps=_MOVES)  # each waits until the page has heard it
    seconds = time.monotonic() - began
    found = page.evaluate("() => window.stopWatch()")
    painted = browser_cpu_ms()
    page.mouse.move(x, y)  # the next drag begins here: at the slider's end it would move nothing
    page.mouse.up()
    pictures = max(len(found["curves"]), 1)
    for thread, before, after in zip(_THREADS, began_cpu, painted, strict=True):
        seen.note(f"drag, {what}: {thread}, CPU a picture (ms)", (after - before) / pictures)
    seen.note(f"drag, {what}: curves/s", len(found["curves"]) / seconds)
    if found["figures"]:
        seen.note(f"drag, {what}: plotly figures/s", len(found["figures"]) / seconds)
    seen.note(f"drag, {what}: worst frame (ms)", max(found["frames"]))
    gaps = [later - sooner for sooner, later in zip(found["curves"], found["curves"][1:], strict=False)]
    seen.note(f"drag, {what}: longest wait for curves (ms)", max(gaps, default=1e3 * seconds))
    page.wait_for_timeout(1500)


def steps(page: Page, count: int, pid: int, seen: Followed, what: str) -> None:
    """Single steps of the slider by a key: time to the last paint, and what they cost.

    What looks for the last paint asks for frames and measures the page, so the cost is that of other steps,
    at which nothing looks.
    """
    thumb = _thumb(page)
    taken = []
    thumb.focus()
    for step in range(count):
        page.evaluate(f"window.paint = ({_STEP})({_SHOWN_RUN}); null")
        page.keyboard.press("ArrowRight" if step % 2 else "ArrowLeft")
        page.wait_for_function("() => window.paint.then(time => (window.painted = time))")
        taken.append(page.evaluate("() => window.painted"))
        page.wait_for_timeout(300)
    seen.note(f"step{what} to last paint (ms)", *taken[1:])
    cpu, painting = _server_cpu_ms(pid), browser_cpu_ms()
    for step in range(count):
        page.keyboard.press("ArrowRight" if step % 2 else "ArrowLeft")
        page.wait_for_timeout(_PAUSE_MS)
    for thread, before, after in zip(_THREADS, painting, browser_cpu_ms(), strict=True):
        seen.note(f"step{what}: {thread}, CPU (ms)", (after - before) / count)
    seen.note(f"step{what}: server, CPU (ms)", (_server_cpu_ms(pid) - cpu) / count)


def pin(page: Page) -> None:
    """Pin the present run and move on from it, until its curves are laid over those of the run."""
    before = page.evaluate(_SERIES)
    page.locator("#sb-status").click()
    page.keyboard.press("p")
    page.wait_for_timeout(1000)
    move_on(page, 3)
    page.wait_for_function(f"before => ({_SERIES})() > before", arg=before)
    page.wait_for_timeout(1500)


def move_on(page: Page, count: int) -> None:
    """Press the slider's key some times."""
    for _ in range(count):
        _thumb(page).press("ArrowRight")
        page.wait_for_timeout(300)


def _server_cpu_ms(pid: int) -> float:
    fields = Path(f"/proc/{pid}/stat").read_text(encoding="ascii").rpartition(")")[2].split()
    return 1e3 * (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def _listener(url: str) -> int:
    port = re.search(r":(\d+)/", url)[1]
    found = subprocess.run(["pgrep", "-f", f"app serve --port {port}"], capture_output=True, text=True)
    return int(found.stdout.split()[0])


def measure(browser: Browser, url: str, options: Any, seen: Followed) -> None:
    """One round on one server."""
    for what, (size, tabs) in SIZES.items():
        if options.only and options.only not in what:
            continue
        page = open_page(browser, url, size, tabs, seen)
        drag(page, options.seconds, what, seen)
        if "3D" in what:
            steps(page, options.steps, _listener(url), seen, "")
            if options.pins:
                for _ in range(2):
                    pin(page)
                drag(page, options.seconds, "two pins", seen)
                move_on(page, _AWAY)
                steps(page, options.steps, _listener(url), seen, ", two pins,")
        page.context.close()


def main() -> int:
    """Print the figures, and the ratios where an earlier tree is given."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--before", type=Path, help="tree of an earlier commit, measured beside this one")
    parser.add_argument("--rounds", type=int, default=2)
    parser.add_argument("--seconds", type=float, default=4.0)
    parser.add_argument("--steps", type=int, default=8)
    parser.add_argument("--only", default="", help="part of the name of what is in front")
    parser.add_argument("--no-pins", dest="pins", action="store_false")
    options = parser.parse_args()
    trees = [HERE] if options.before is None else [options.before, HERE]
    followed = [Followed() for _ in trees]
    with launched() as browser:
        for _ in range(options.rounds):
            for tree, seen in zip(trees, followed, strict=True):
                with served(tree) as url:
                    measure(browser, url, options, seen)
    for name in followed[-1].figures:
        told = [_told(name, seen) for seen in followed if name in seen.figures]
        ratio = ""
        if len(told) == 2 and followed[0].median(name) > 0.0:
            ratio = f"   ratio {followed[1].median(name) / followed[0].median(name):.2f}"
        print(f"{name:62s} {'  ->  '.join(told)}{ratio}", flush=True)
    return 0


def _told(name: str, seen: Followed) -> str:
    if "last paint" in name:
        return "{:.0f} / {:.0f}".format(*median_and_p95(seen.figures[name]))
    return f"{seen.median(name):.1f}"


if __name__ == "__main__":
    sys.exit(main())

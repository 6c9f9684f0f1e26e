"""How the page follows a hand: ``python -m tools.paint.hand [--before TREE] [--rounds N] [--seconds S]``.

A slider is dragged, moved step by step (with the tab Design in front, too), and the page is opened, in
headless Chromium with software rendering. Everything is read from the page alone, so that the same script
measures the tree of an earlier commit: with ``--before`` both are served side by side and measured in turns,
and the ratios are told.
"""

import argparse
import statistics
import sys
import tempfile
import time
from collections import defaultdict
from pathlib import Path
from typing import Any

from playwright.sync_api import Browser, Page

from schuler_bench.bench.dashboard import median_and_p95
from schuler_bench.bench.process import free_port
from tests.browser.fields import slider_labels
from tools.chromium import launched
from tools.paint.measuring import WINDOW, browser_cpu_ms, served, server_cpu_ms, step_times_ms, thumb

HERE = Path(__file__).parents[2]
SLIDER = ["zeta", *slider_labels("network.zeta")]
"""Its labels, that of an earlier commit first."""
SIZES: dict[str, tuple[Any, tuple[str, ...]]] = {
    "Frequency, Errors, 3D": (WINDOW, ("Method", "Frequency", "Errors")),
    "Errors alone": ({"width": 1366, "height": 768}, ("Method", "Errors")),
    "Design": (WINDOW, ("Method", "Frequency", "Design")),
}
_STEPPED = {"Frequency, Errors, 3D": "", "Design": ", Design,"}
"""Where single steps are timed, and how these are told."""
_THREADS = ("main thread", "painting")
"""Parts that `browser_cpu_ms` tells apart."""
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
_FIRST_PICTURE = """() => {
  const charts = Object.values(window.__viserTestpoints?.uplots ?? {});
  return charts.length > 0 || document.querySelector('.js-plotly-plot .trace') !== null;
}"""
_CLOSE_NOTICES = """() =>
  document.querySelectorAll('.mantine-Notification-closeButton').forEach(button => button.click())"""
_SERIES = """() => Math.max(...Object.values(window.__viserTestpoints?.uplots ?? {})
  .map(entry => entry.chart.series.length))"""
_EVERYTHING = """() => {
  const run = document.querySelector('#sb-run')?.dataset.run;
  const plots = [...document.querySelectorAll('.js-plotly-plot')].filter(p => p.offsetParent !== null);
  const charts = Object.values(window.__viserTestpoints?.uplots ?? {});
  return run !== undefined && charts.length > 0 && plots.length > 0
    && plots.every(p => String(p._fullLayout?.meta?.run) === run);
}"""

Followed = dict[str, list[float]]
"""Values of each figure that was seen of one tree, over all rounds."""


def open_page(browser: Browser, url: str, size: Any, tabs: tuple[str, ...], seen: Followed) -> Page:
    """Open a page, note how long that took, and bring tabs to the front."""
    page = browser.new_context(viewport=size).new_page()
    page.set_default_timeout(60_000)
    began = time.monotonic()
    page.goto(f"{url}?fixedDpr=0.25&start=no", wait_until="commit")
    page.wait_for_function(_FIRST_PICTURE, polling=20)
    seen["opening, first picture (ms)"].append(1e3 * (time.monotonic() - began))
    if size == WINDOW:
        page.wait_for_function(_EVERYTHING, polling=20)
        seen["opening, everything (ms)"].append(1e3 * (time.monotonic() - began))
    page.wait_for_timeout(2500)
    page.evaluate(_CLOSE_NOTICES)
    for name in tabs:
        page.evaluate("name => { schuler.show(name); }", name)
        page.wait_for_timeout(400)
    page.wait_for_timeout(1000)
    return page


def drag(page: Page, seconds: float, what: str, seen: Followed) -> None:
    """Move the slider to and fro with the mouse held down, and note the pictures that come meanwhile."""
    box: Any = thumb(page, SLIDER).bounding_box()
    track = page.evaluate(_TRACK, SLIDER)
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
    curves, figures = found["curves"], found["figures"]
    for thread, before, after in zip(_THREADS, began_cpu, painted, strict=True):
        seen[f"drag, {what}: {thread}, CPU a picture (ms)"].append((after - before) / max(len(curves), 1))
    seen[f"drag, {what}: curves/s"].append(len(curves) / seconds)
    if figures:
        seen[f"drag, {what}: plotly figures/s"].append(len(figures) / seconds)
    seen[f"drag, {what}: worst frame (ms)"].append(max(found["frames"]))
    gaps = [later - sooner for sooner, later in zip(curves, curves[1:], strict=False)]
    seen[f"drag, {what}: longest wait for curves (ms)"].append(max(gaps, default=1e3 * seconds))
    page.wait_for_timeout(1500)


def steps(page: Page, count: int, pid: int, seen: Followed, what: str) -> None:
    """Single steps of the slider by a key: time to the last paint, and what they cost.

    What looks for the last paint asks for frames and measures the page, so the cost is that of other steps,
    at which nothing looks.
    """
    seen[f"step{what} to last paint (ms)"] += step_times_ms(page, SLIDER, count)[1:]
    cpu, painting = server_cpu_ms(pid), browser_cpu_ms()
    for step in range(count):
        page.keyboard.press("ArrowRight" if step % 2 else "ArrowLeft")
        page.wait_for_timeout(_PAUSE_MS)
    for thread, before, after in zip(_THREADS, painting, browser_cpu_ms(), strict=True):
        seen[f"step{what}: {thread}, CPU (ms)"].append((after - before) / count)
    seen[f"step{what}: server, CPU (ms)"].append((server_cpu_ms(pid) - cpu) / count)


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
        thumb(page, SLIDER).press("ArrowRight")
        page.wait_for_timeout(300)


def measure(browser: Browser, tree: Path, options: Any, seen: Followed) -> None:
    """One round on the server of one tree."""
    with tempfile.TemporaryDirectory() as state, served(tree, Path(state), free_port()) as (url, process):
        time.sleep(_WARM_S)
        for what, (size, tabs) in SIZES.items():
            if options.only and options.only not in what:
                continue
            page = open_page(browser, url, size, tabs, seen)
            if "Errors" in tabs:
                drag(page, options.seconds, what, seen)
            if what in _STEPPED:
                steps(page, options.steps, process.pid, seen, _STEPPED[what])
            if options.pins and _STEPPED.get(what) == "":
                for _ in range(2):
                    pin(page)
                drag(page, options.seconds, "two pins", seen)
                move_on(page, _AWAY)
                steps(page, options.steps, process.pid, seen, ", two pins,")
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
    followed: list[Followed] = [defaultdict(list) for _ in trees]
    with launched() as browser:
        for _ in range(options.rounds):
            for tree, seen in zip(trees, followed, strict=True):
                measure(browser, tree, options, seen)
    for name in followed[-1]:
        told = [_told(name, seen[name]) for seen in followed if name in seen]
        medians = [statistics.median(seen[name]) for seen in followed if name in seen]
        ratio = f"   ratio {medians[1] / medians[0]:.2f}" if len(medians) == 2 and medians[0] > 0.0 else ""
        print(f"{name:62s} {'  ->  '.join(told)}{ratio}", flush=True)
    return 0


def _told(name: str, values: list[float]) -> str:
    if "last paint" in name:
        return "{:.0f} / {:.0f}".format(*median_and_p95(values))
    return f"{statistics.median(values):.1f}"


if __name__ == "__main__":
    sys.exit(main())

"""Time from a slider step to the browser's last paint of it: ``python -m tests.browser.last_paint [STEPS]``.

24 h, three methods, 1920 x 1080, frequency and errors in view, in headless Chromium with software rendering.
The clock starts at the key press in the page and stops two animation frames after the run's number and all
its figures are there, so that what they changed has been painted.
"""

from __future__ import annotations

import statistics
import sys

from playwright.sync_api import sync_playwright

from app.serve import open_dashboard
from tests.browser.driver import Bench
from tests.chromium import FLAGS, find_chromium

SCENARIO = "liu-networks"
SLIDER = "zeta"
DURATION_H = 24

_PAINTED = """after => new Promise(resolve => {
  let start = null;
  addEventListener('keydown', () => { start = performance.now(); }, {capture: true, once: true});
  const current = () => {
    const run = document.querySelector('#sb-run').dataset.run;
    const plots = [...document.querySelectorAll('.js-plotly-plot')].filter(p => p.offsetParent !== null);
    return Number(run) > after && plots.every(p => String(p._fullLayout?.meta?.run) === run);
  };
  const look = () => requestAnimationFrame(() => {
    if (start === null || !current()) return look();
    requestAnimationFrame(() => requestAnimationFrame(() => resolve(performance.now() - start)));
  });
  look();
})"""


def times_ms(steps: int) -> list[float]:
    """Time of each step, ms; the first three, which warm the page, are left out."""
    server, dashboard = open_dashboard(port=0)
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=find_chromium(), args=list(FLAGS))
        page = browser.new_page(viewport={"width": 1920, "height": 1080})
        bench = Bench(page, server.url, dashboard.sessions).open()
        bench.reset(SCENARIO, selected=2)
        bench.tab("Run")
        if bench.value("duration (h), exact") != DURATION_H:
            bench.type("duration (h), exact", str(DURATION_H))
        bench.settle()
        bench.tab("Method")
        taken = []
        for step in range(steps + 3):
            bench.slider(SLIDER).focus()
            waiting = f"window.paint = ({_PAINTED})({bench.run}); null"
            page.evaluate(waiting)
            page.keyboard.press("ArrowRight" if step % 2 else "ArrowLeft")
            taken.append(page.evaluate("() => window.paint"))
            bench.settle()
        browser.close()
    server.stop()
    dashboard.close()
    return taken[3:]


def main(arguments: list[str]) -> int:
    """Print median and 95th percentile."""
    taken = sorted(times_ms(int(arguments[0]) if arguments else 30))
    p95 = taken[max(0, round(0.95 * len(taken)) - 1)]
    print(f"slider step to last paint, {len(taken)} steps, {DURATION_H} h, 3 methods, software rendering:")
    print(f"median {statistics.median(taken):.0f} ms, 95th percentile {p95:.0f} ms")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

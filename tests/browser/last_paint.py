"""Time from a slider step to the browser's last paint of it: ``python -m tests.browser.last_paint [STEPS]``.

24 h, three methods, two pinned baselines, 1920 x 1080, frequency and errors in view, in headless Chromium
with software rendering; beside it the same plots built the plain way (`tests.browser.plain_page`), and the
ratio. The clock starts at the key press in the page and stops two animation frames after the run's number and
all its figures are there, so that what they changed has been painted.
"""

from __future__ import annotations

import statistics
import sys
from typing import TYPE_CHECKING, Any

from app.bench.dashboard import median_and_p95
from app.bench.process import free_port
from app.editing import edits
from app.serve import open_dashboard
from navcore.engine.simulation import simulate
from tests.browser.driver import Bench
from tests.browser.fields import label_of
from tests.browser.patience import THROTTLE_MS
from tests.browser.plain_page import SLIDER as PLAIN_SLIDER
from tests.browser.plain_page import PlainPage
from tests.chromium import launched

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

    from navcore.engine.run import Run
    from navcore.scenario.model import Scenario

SCENARIO = "sikuliaq-like"
SLIDER = "network.zeta"
DURATION_H = 24
PINS = 2
_WARM_STEPS = 3
_SIZE: Any = {"width": 1920, "height": 1080}
_ZETA = ("method", 2, "network", "zeta")

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


def _steps(page: Page, label: str, steps: int) -> list[float]:
    """Time of each step of a slider, ms; the first ones, which warm the page, are left out."""
    script = "l => [...document.querySelectorAll('label')].find(e => e.textContent === l).htmlFor"
    thumb = page.locator(f"[id='{page.evaluate(script, label)}'] [role=slider]")
    taken = []
    for step in range(steps + _WARM_STEPS):
        thumb.focus()
        page.evaluate(f"window.paint = ({_PAINTED})({page.evaluate(_NUMBER)}); null")
        page.keyboard.press("ArrowRight" if step % 2 else "ArrowLeft")
        page.wait_for_function("() => window.paint.then(time => (window.painted = time))")
        taken.append(page.evaluate("() => window.painted"))
        page.wait_for_timeout(3 * THROTTLE_MS)
    return taken[_WARM_STEPS:]


def times_ms(browser: Browser, steps: int) -> tuple[list[float], Scenario]:
    """Time of each step in our page, ms, and the scenario that was shown."""
    server, dashboard = open_dashboard(port=0)
    page = browser.new_page(viewport=_SIZE)
    page.set_default_timeout(60_000)
    bench = Bench(page, server.url, dashboard.sessions).open()
    bench.reset(SCENARIO, selected=2)
    bench.tab("Run")
    if bench.value("run.duration_h") != DURATION_H:
        bench.type("run.duration_h", str(DURATION_H))
    bench.settle()
    bench.tab("Method")
    session = bench.session
    for number in range(PINS):
        assert session.run is not None
        session.pins.add(session.run, SCENARIO)
        for _ in range(2 + number):
            bench.press(SLIDER)
    bench.settle()
    taken = _steps(page, label_of(SLIDER), steps)
    scenario = session.scenario
    page.close()
    server.stop()
    dashboard.close()
    return taken, scenario


def plain_times_ms(browser: Browser, scenario: Scenario, steps: int) -> list[float]:
    """Time of each step in the plain page, ms."""

    def run_at(zeta: float) -> Run:
        return simulate(edits.with_value(scenario, _ZETA, zeta))

    pinned = [method for zeta in (0.4, 0.6)[:PINS] for method in run_at(zeta).methods]
    plain = PlainPage(run_at, pinned, port=free_port())
    page = browser.new_page(viewport=_SIZE)
    page.set_default_timeout(120_000)
    page.goto(f"http://127.0.0.1:{plain.server.get_port()}/?fixedDpr=0.25")
    page.wait_for_function("() => document.querySelectorAll('.js-plotly-plot .trace').length > 0")
    page.wait_for_timeout(2000)
    taken = _steps(page, PLAIN_SLIDER, steps)
    page.close()
    plain.server.stop()
    return taken


def _told(taken: list[float]) -> str:
    median, p95 = median_and_p95(taken)
    return f"median {median:.0f} ms, 95th percentile {p95:.0f} ms"


def main(arguments: list[str]) -> int:
    """Print median and 95th percentile of both pages, and the ratio of the medians."""
    steps = int(arguments[0]) if arguments else 30
    with launched() as browser:
        ours, scenario = times_ms(browser, steps)
        plain = plain_times_ms(browser, scenario, max(steps // 3, 5))
    shown = f"{DURATION_H} h, 3 methods, {PINS} pins"
    print(f"slider step to last paint, {steps} steps, {shown}, software rendering:")
    print(_told(ours))
    rows = len(simulate(scenario).t_s)
    print(f"the same plots as go.Figure, all {rows} output rows: {_told(plain)}")
    print(f"ratio of the medians {statistics.median(plain) / statistics.median(ours):.1f}")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

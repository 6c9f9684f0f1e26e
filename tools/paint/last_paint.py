"""Time from a slider step to the browser's last paint of it: ``python -m tools.paint.last_paint [STEPS]``.

24 h, three methods, two pinned baselines, 1920 x 1080, frequency and errors in view, in headless Chromium
with software rendering; beside it the same plots built the plain way (`PlainPage`), and the ratio. The clock
starts at the key press in the page and stops two animation frames after the run's number and all its figures
are there, so that what they changed has been painted.
"""

import statistics
import sys
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import plotly.graph_objects as go
import viser
from playwright.sync_api import Browser
from plotly.subplots import make_subplots

from navcore.engine.run import MethodRun, Run
from navcore.engine.simulation import simulate
from navcore.mechanization.recorder import NAMES
from navcore.scenario.file import load
from navcore.scenario.model import Scenario
from schuler_bench.bench.dashboard import median_and_p95
from schuler_bench.bench.process import free_port
from schuler_bench.editing import edits
from schuler_bench.plots.effective import loop_of, network_curve, transfer_curve
from schuler_bench.serve import open_dashboard
from tests.browser.driver import Bench
from tests.browser.fields import label_of
from tests.browser.patience import THROTTLE_MS
from tools.chromium import launched
from tools.paint.measuring import WINDOW, step_times_ms

SLIDER = "network.zeta"
DURATION_H = 24
PINS = 2
_WARM_STEPS = 3
_ZETA = ("method", 2, "network", "zeta")
PLAIN_SLIDER = "plain zeta"
_ERRORS = ("phi_e_rad", "phi_n_rad", "phi_u_rad", "dve_mps", "dvn_mps", "position_m")


class PlainPage:
    """A viser server with one slider, a Bode figure and six error figures.

    Parameters
    ----------
    run_at : callable
        ``run_at(zeta)``.
    pinned : sequence of MethodRun
        Drawn in every figure too.
    port : int
        To listen on.
    """

    def __init__(self, run_at: Callable[[float], Run], pinned: Sequence[MethodRun], port: int) -> None:
        self.server = viser.ViserServer(host="127.0.0.1", port=port, verbose=False)
        self._run_at, self._pinned, self._number = run_at, pinned, 0
        gui = self.server.gui
        self._slider = gui.add_slider(PLAIN_SLIDER, 0.05, 2.0, 0.05, 0.5)
        self._handles = [gui.add_plotly(figure, aspect=0.4) for figure in self._figures()]
        self._slider.on_update(lambda _: self._show())

    def _show(self) -> None:
        for handle, figure in zip(self._handles, self._figures(), strict=True):
            handle.figure = figure
        self.server.flush()

    def _figures(self) -> list[go.Figure]:
        run = self._run_at(self._slider.value)
        self._number += 1
        methods = (*run.methods, *self._pinned)
        figures = [_bode(run, methods), *(_errors(methods, name) for name in _ERRORS)]
        for figure in figures:
            figure.update_layout(meta={"run": self._number})
        return figures


def _errors(methods: Sequence[MethodRun], name: str) -> go.Figure:
    figure, column = go.Figure(), NAMES.index(name)
    for method in methods:
        figure.add_trace(go.Scatter(x=method.t_s / 3600.0, y=method.rows[:, column], name=method.method.name))
    figure.update_layout(xaxis_title="time (h)", yaxis_title=name)
    return figure


def _bode(run: Run, methods: Sequence[MethodRun]) -> go.Figure:
    figure: Any = make_subplots(rows=2, cols=2)
    for method in methods:
        shown = (network_curve(loop_of(method)), transfer_curve(method, "dv_r", "phi"))
        for col, response in enumerate(shown, start=1):
            if response is None:
                continue
            omega, value = response.omega, response.value
            curves = (20.0 * np.log10(np.abs(value)), np.degrees(np.unwrap(np.angle(value))))
            for row, curve in enumerate(curves, start=1):
                figure.add_trace(go.Scatter(x=omega, y=curve, name=method.method.name), row=row, col=col)
    figure.update_xaxes(type="log")
    return figure


def times_ms(browser: Browser, steps: int) -> tuple[list[float], Scenario]:
    """Time of each step in our page, ms, and the scenario that was shown."""
    server, dashboard = open_dashboard(port=0)
    page = browser.new_page(viewport=WINDOW)
    bench = Bench(page, server.url, dashboard.sessions).open()
    bench.put(load("sikuliaq-like", [f"run.duration_h={DURATION_H}"]), "Method", selected=2)
    for number in range(PINS):
        run: Any = bench.session.run
        bench.session.pins.add(run, "sikuliaq-like")
        for _ in range(2 + number):
            bench.press(SLIDER)
    taken = step_times_ms(page, [label_of(SLIDER)], steps + _WARM_STEPS, 3 * THROTTLE_MS)
    scenario = bench.session.scenario
    page.close()
    server.stop()
    dashboard.close()
    return taken[_WARM_STEPS:], scenario


def plain_times_ms(browser: Browser, scenario: Scenario, steps: int) -> list[float]:
    """Time of each step in the plain page, ms."""

    def run_at(zeta: float) -> Run:
        return simulate(edits.with_value(scenario, _ZETA, zeta))

    pinned = [method for zeta in (0.4, 0.6)[:PINS] for method in run_at(zeta).methods]
    plain = PlainPage(run_at, pinned, port=free_port())
    page = browser.new_page(viewport=WINDOW)
    page.set_default_timeout(120_000)
    page.goto(f"http://127.0.0.1:{plain.server.get_port()}/?fixedDpr=0.25")
    page.wait_for_function("() => document.querySelectorAll('.js-plotly-plot .trace').length > 0")
    page.wait_for_timeout(2000)
    taken = step_times_ms(page, [PLAIN_SLIDER], steps + _WARM_STEPS, 3 * THROTTLE_MS)
    page.close()
    plain.server.stop()
    return taken[_WARM_STEPS:]


def main(arguments: list[str]) -> int:
    """Print median and 95th percentile of both pages, and the ratio of the medians."""
    steps = int(arguments[0]) if arguments else 30
    with launched() as browser:
        ours, scenario = times_ms(browser, steps)
        plain = plain_times_ms(browser, scenario, max(steps // 3, 5))
    shown = f"{DURATION_H} h, 3 methods, {PINS} pins"
    print(f"slider step to last paint, {steps} steps, {shown}, software rendering:")
    told = [
        "median {:.0f} ms, 95th percentile {:.0f} ms".format(*median_and_p95(one)) for one in (ours, plain)
    ]
    print(told[0])
    print(f"the same plots as go.Figure, all {len(simulate(scenario).t_s)} output rows: {told[1]}")
    print(f"ratio of the medians {statistics.median(plain) / statistics.median(ours):.1f}")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

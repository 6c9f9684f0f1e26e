"""Time from a slider step to the browser's last paint of it: ``python -m tests.browser.last_paint [STEPS]``.

24 h, three methods, two pinned baselines, 1920 x 1080, frequency and errors in view, in headless Chromium with
software rendering. The clock starts at the key press in the page and stops two animation frames after the run's
number and all its figures are there, so that what they changed has been painted. Beside it, in the same page:
the same figures built the plain way, as `plotly.graph_objects.Figure` of every output row, undecimated.
"""

from __future__ import annotations

import statistics
import sys
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any
from unittest import mock

from playwright.sync_api import sync_playwright

from app.figures.errors import QUANTITIES
from app.panels.curves import OVERVIEW_KEYS
from app.panels.results import ResultsPanel
from app.serve import open_dashboard
from navcore.mechanization.recorder import NAMES
from tests.browser.driver import Bench
from tests.chromium import FLAGS, find_chromium

if TYPE_CHECKING:
    from collections.abc import Iterator

SCENARIO = "liu-networks"
SLIDER = "zeta"
DURATION_H = 24
PINS = 2

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


class _Plain:
    """Shows a run the plain way: one `go.Figure` for the frequency side, one for each error, all rows in it."""

    def __init__(self) -> None:
        self._handles: dict[str, Any] = {}

    def show(self, panel: ResultsPanel, pictures: Any) -> None:
        import plotly.graph_objects as go

        run = pictures.run
        figures = {"frequency": go.Figure(_as_lists(pictures.plotly["Frequency"]))}
        for key in OVERVIEW_KEYS:
            figure = go.Figure(layout={"meta": {"run": run_number(pictures)}, "title": QUANTITIES[key]})
            column = _column(key)
            for method in (*run.methods, *_pinned(panel)):
                figure.add_trace(
                    go.Scatter(x=method.t_s / 3600.0, y=method.rows[:, column], name=method.method.name)
                )
            figures[key] = figure
        for key, figure in figures.items():
            if key in self._handles:
                self._handles[key].figure = figure
            else:
                tab = panel._tabs["Frequency" if key == "frequency" else "Errors"]
                with tab:
                    self._handles[key] = panel._gui.add_plotly(figure, aspect=0.4)

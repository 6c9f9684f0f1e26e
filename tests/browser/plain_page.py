"""The page's plots built the plain way, to compare with: a `go.Figure` each, every output row."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import plotly.graph_objects as go
import viser
from plotly.subplots import make_subplots

from app.plots.effective import effective_network, frequency
from app.views.frequency.figure import omega_grid
from navcore.engine.run import MethodRun, Run
from navcore.mechanization.recorder import NAMES

SLIDER = "plain zeta"
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
        self._slider = gui.add_slider(SLIDER, 0.05, 2.0, 0.05, 0.5)
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
    omega = omega_grid(run.scenario.omega_s)
    for method in methods:
        shown = (effective_network(method).response(omega), frequency(method, "dv_r", "phi", omega))
        for col, value in enumerate(shown, start=1):
            if value is None:
                continue
            curves = (20.0 * np.log10(np.abs(value)), np.degrees(np.unwrap(np.angle(value))))
            for row, curve in enumerate(curves, start=1):
                figure.add_trace(go.Scatter(x=omega, y=curve, name=method.method.name), row=row, col=col)
    figure.update_xaxes(type="log")
    return figure

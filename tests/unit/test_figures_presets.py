"""Every preset can be drawn: all figures and the table, from the first minutes of its run."""

from __future__ import annotations

from html import escape

import numpy as np
import pytest

from app.views.errors.figure import error_plots
from app.views.frequency.figure import bode
from app.views.metrics.table import metrics_html
from app.views.poles.figure import poles
from app.views.scene.track import track
from app.views.step.figure import step
from app.views.switching.figure import switched_methods, switching_plots
from navcore.engine.simulation import simulate
from navcore.scenario.file import load, presets


@pytest.mark.parametrize("name", presets())
def test_a_preset_is_drawn(name: str) -> None:
    run = simulate(load(name, ["run.duration_h=0.1"]))
    for figure in (bode(run), poles(run), step(run)):
        assert len(figure.to_json()) > 1000
    for plot in error_plots(run).values():
        assert len(plot.data) == 1 + len(run.methods)
        assert np.isfinite(plot.data[1]).any()
    assert bool(switching_plots(run)) == bool(switched_methods(run))
    table = metrics_html(run)
    assert all(escape(method.method.name) in table for method in run.methods)
    assert len(track(run, None).methods) == len(run.methods)

"""What every figure keeps to, over all figures and many runs; their own numbers are tested beside it."""

import json
import re
from collections.abc import Callable
from functools import cache, partial
from html import escape

import numpy as np
import pytest

from navcore.engine.run import Run
from navcore.engine.simulation import simulate
from navcore.scenario.file import load, presets
from schuler_bench.misprints import MISPRINTS
from schuler_bench.plots import style
from schuler_bench.plots.effective import OPEN_LOOP, TRANSFERS
from schuler_bench.plots.pinned import restyled, together
from schuler_bench.plots.plotly_data import PlotlyFigure, values_of
from schuler_bench.plots.saved import time_figure
from schuler_bench.session.display import Display
from schuler_bench.views.errors.figure import RECORDED, error_plots
from schuler_bench.views.frequency.figure import frequency_view
from schuler_bench.views.metrics.table import metrics_html
from schuler_bench.views.misprints.figure import SHOWN, comparison_plot
from schuler_bench.views.poles.figure import poles
from schuler_bench.views.poles.whole import whole_system_figure
from schuler_bench.views.scene.track import track
from schuler_bench.views.spectrum.figure import spectrum
from schuler_bench.views.step.figure import step
from schuler_bench.views.switching.figure import switched_methods, switching_plots
from tests.unit.figures_runs import (
    INTERNAL,
    THREE,
    UNSTABLE,
    Pinned,
    diverging,
    moving_run,
    run_of,
    static_run,
)

Make = Callable[[Run], PlotlyFigure]
TRANSFER = {key: partial(frequency_view, shown=key, discrete=True) for key in (*TRANSFERS, OPEN_LOOP)}
LOOPS: dict[str, Make] = {**TRANSFER, "poles": poles, "whole": whole_system_figure, "step": step}
SPECTRA: dict[str, Make] = {key: partial(spectrum, key=key) for key in RECORDED}
OVER_TIME: dict[str, Make] = {
    scale: lambda run, scale=scale: time_figure(list(error_plots(run, display=Display(scale=scale)).values()))
    for scale in ("linear", "log")
}
FIGURES = LOOPS | SPECTRA | OVER_TIME
RUNS: dict[str, Callable[[], Run]] = {
    "at rest": static_run,
    "under way": moving_run,
    "diverged": lambda: diverging(static_run(), 0, rows=800),
    "ended at once": lambda: diverging(static_run(), 0, rows=4),
    "all kinds": lambda: run_of(method=[*THREE, INTERNAL, UNSTABLE]),
    "no log": lambda: run_of(method=[{"name": "a<b> & <i>c"}], reference={"kind": "none"}),
    "nothing moves": lambda: run_of(imu={}, initial_error={}, reference={"kind": "none"}, method=[{}]),
}
UNITLESS = "Re L|Im L|Re s / ω<sub>s</sub>|Im s / ω<sub>s</sub>|φ/φ<sub>0</sub>|output / step|growth, 1/day"
OF_TRANSFER = r"arcsec per .*|m/s per .*|dB re 1 s|dB|frequency .* and period"
every_figure = pytest.mark.parametrize("name", FIGURES)


@cache
def run_named(name: str) -> Run:
    return RUNS[name]()


def axes_of(figure: PlotlyFigure) -> list[dict]:
    return [value for key, value in figure["layout"].items() if re.fullmatch(r"[xy]axis\d*", key)]


def check(figure: PlotlyFigure, run: Run) -> None:
    """Axes are named with their units; traces are whole, in their methods' colours, under plain names."""
    assert axes_of(figure)
    for axis in axes_of(figure):
        title = axis["title"]["text"]
        named = re.search(r"\((.+)\)$", title) or re.fullmatch(f"{UNITLESS}|{OF_TRANSFER}", title)
        assert named or axis.get("showticklabels") is False, title
        assert np.isfinite(axis.get("range", [0.0])).all(), title
    for trace in figure["data"]:
        x, y = (np.array(values_of(trace[key]), dtype=float) for key in "xy")
        assert len(x) == len(y), trace
        finite = np.isfinite(x) & np.isfinite(y)
        assert finite.any() or not len(x) or trace.get("hoverinfo") == "skip" or run.status != "ok", trace
        group = trace.get("legendgroup", "")
        if group.isdigit():
            assert style.plain(run.methods[int(group)].method.name) in trace["name"]
            look = trace.get("line") or trace["marker"]
            assert style.method_color(int(group)) in (look["color"], look.get("line", {}).get("color"))


@pytest.mark.parametrize("of", RUNS)
@every_figure
def test_a_figure_of_any_run_is_whole(name: str, of: str) -> None:
    check(FIGURES[name](run_named(of)), run_named(of))


@every_figure
def test_plotly_accepts_it_and_its_text_is_large_enough(name: str) -> None:
    import plotly.graph_objects as go

    figure = FIGURES[name](static_run())
    checked = go.Figure(json.loads(figure.to_json()))
    layout = figure["layout"]
    assert len(checked.data) == len(figure["data"]) and layout["legend"]["orientation"] == "h"
    sized = [layout, layout["legend"], *layout["annotations"], *(axis["title"] for axis in axes_of(figure))]
    sizes = [part["font"]["size"] for part in sized] + [axis["tickfont"]["size"] for axis in axes_of(figure)]
    assert min(sizes) >= 13


@pytest.mark.parametrize("name", [*LOOPS, *SPECTRA])
def test_a_pin_is_drawn_over_it_in_its_own_colour(name: str) -> None:
    run, pin = static_run(), Pinned("before <b>", "#C2185B", run_named("all kinds"))
    alone, both = FIGURES[name](run), restyled(FIGURES[name](together(run, (pin,))), (pin,))

    def look(trace: dict) -> dict:
        return trace.get("line") or trace["marker"]

    places = [
        int(group) if (group := trace.get("legendgroup", "")).isdigit() else -1 for trace in both["data"]
    ]
    pinned = [trace for trace, place in zip(both["data"], places, strict=True) if place >= 3]
    assert pinned and all("before &lt;b&gt;" in trace["name"] for trace in pinned)
    ring = {"white"} if name in TRANSFER else set()
    assert {look(trace)["color"] for trace in pinned} - ring == {"#C2185B"}
    own = [look(trace) for trace, place in zip(both["data"], places, strict=True) if 0 <= place < 3]
    assert own == [look(trace) for trace in alone["data"] if trace.get("legendgroup", "").isdigit()]
    # how many settling times are named follows from the room that the legend leaves
    texts = [[note["text"] for note in figure["layout"]["annotations"]] for figure in (both, alone)]
    counts = [sum(not text.endswith((" min", " h")) for text in own) for own in texts]
    # a pinned method with internal damping takes "no method reacts" away
    assert "acceleration" in name or counts[0] == counts[1]


@pytest.mark.parametrize("preset", presets())
def test_a_preset_is_drawn(preset: str) -> None:
    run = simulate(load(preset, ["run.duration_h=0.1"]))
    assert run.scenario.title and run.scenario.source
    for make in FIGURES.values():
        check(make(run), run)
    assert bool(switching_plots(run)) == bool(switched_methods(run))
    table = metrics_html(run)
    assert all(escape(method.method.name) in table for method in run.methods)
    assert len(track(run, None).methods) == len(run.methods)


@pytest.mark.parametrize("shown", SHOWN)
@pytest.mark.parametrize("id", MISPRINTS)
def test_a_misprint_is_drawn(id: str, shown: str) -> None:
    figure = comparison_plot(MISPRINTS[id].compute(), shown)
    assert all(axis["title"]["text"] for axis in axes_of(figure))
    assert all({"dash", "color"} <= set(trace["line"]) for trace in figure["data"])

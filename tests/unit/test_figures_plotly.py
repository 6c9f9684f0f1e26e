from __future__ import annotations

import json
import math
import re
import subprocess
import sys
from collections.abc import Callable

import numpy as np
import pytest

from app.plots import style
from app.plots.plotly_data import PlotlyFigure, packed, unpacked
from app.plots.transfer_views import TRANSFERS, VIEWS
from app.views.frequency.figure import (
    OMEGA_MAX,
    OMEGA_MIN,
    bode,
    natural_frequencies,
    omega_grid,
)
from app.views.poles.figure import poles
from app.views.step.figure import step
from navcore.analysis import frequency_response, initial_tilt_response
from navcore.engine.run import Run
from navcore.foundation.earth import EARTH_RATE
from navcore.foundation.units import ARCSEC
from tests.unit.figures_runs import INTERNAL, THREE, UNSTABLE, run_of, static_run

FIGURES: list[Callable[[Run], PlotlyFigure]] = [bode, poles, step]


def traces(figure: PlotlyFigure, name: str, yaxis: str) -> list[dict]:
    return [t for t in figure["data"] if t.get("name") == name and t["yaxis"] == yaxis]


def texts(figure: PlotlyFigure) -> list[str]:
    return [note["text"] for note in figure["layout"]["annotations"]]


@pytest.mark.parametrize("make", FIGURES)
def test_plotly_accepts_the_figure(make: Callable[[Run], PlotlyFigure]) -> None:
    import plotly.graph_objects as go

    figure = make(static_run())
    checked = go.Figure(json.loads(figure.to_json()))
    assert len(checked.data) == len(figure["data"])
    assert json.loads(checked.to_json())["layout"]["legend"]["orientation"] == "h"


@pytest.mark.parametrize("make", FIGURES)
def test_every_axis_has_a_title_and_text_is_large_enough(make: Callable[[Run], PlotlyFigure]) -> None:
    layout = make(static_run())["layout"]
    axes = [value for key, value in layout.items() if key.startswith(("xaxis", "yaxis"))]
    assert len(axes) >= 4
    assert all(axis["title"]["text"] for axis in axes)
    sizes = [axis[font]["size"] for axis in axes for font in ("tickfont",)]
    sizes += [axis["title"]["font"]["size"] for axis in axes]
    sizes += [note["font"]["size"] for note in layout["annotations"]]
    assert min([*sizes, layout["legend"]["font"]["size"], layout["font"]["size"]]) >= 13


@pytest.mark.parametrize("make", FIGURES)
def test_a_method_has_its_colour_in_every_trace(make: Callable[[Run], PlotlyFigure]) -> None:
    figure = make(static_run())
    for index, name in enumerate(("free", "classic2", "compass")):
        mine = [t for t in figure["data"] if t.get("name") == name]
        assert mine
        colors = {(t.get("line") or t["marker"])["color"] for t in mine}
        assert colors == {style.method_color(index)}


def test_packed_arrays_come_back_and_infinity_is_a_gap() -> None:
    values = np.array([1.0, -2.5, np.inf, np.nan])
    back = unpacked(packed(values))
    assert back.dtype == np.float32
    np.testing.assert_array_equal(back, [1.0, -2.5, np.nan, np.nan])


def test_figures_load_neither_viser_nor_plotly_nor_scipy() -> None:
    code = (
        "import sys; import app.views.frequency.figure, app.views.poles.figure, app.views.step.figure;"
        "import app.views.errors.figure;"
        "import app.views.scene.track, app.views.metrics.table, app.views.scene.ship, app.plots.warnings;"
        # numba itself loads the bare scipy package
        "slow = {'viser', 'plotly', 'control', 'matplotlib', 'scipy.linalg', 'scipy.signal'};"
        "bad = slow & set(sys.modules);"
        "assert not bad, bad"
    )
    subprocess.run([sys.executable, "-c", code], check=True, timeout=60)


class TestBode:
    def test_shows_the_networks_response(self) -> None:
        run = static_run()
        trace = traces(bode(run), "classic2", "y")[0]
        omega = unpacked(trace["x"])
        expected = 20.0 * np.log10(np.abs(run.methods[1].network.response(omega_grid(run.scenario.omega_s))))
        np.testing.assert_allclose(unpacked(trace["y"]), expected, atol=1e-4)
        np.testing.assert_allclose(omega, omega_grid(run.scenario.omega_s), rtol=1e-6)

    def test_shows_the_transfer_in_its_unit(self) -> None:
        run = static_run()
        omega = omega_grid(run.scenario.omega_s)
        trace = traces(bode(run, "phi/dv_r"), "compass", "y3")[0]
        expected = np.abs(frequency_response(run.methods[2].network, "dv_r", "phi", omega)) / ARCSEC
        np.testing.assert_allclose(unpacked(trace["y"]), expected, rtol=1e-5)

    def test_phase_is_continuous_and_right(self) -> None:
        run = static_run()
        omega = omega_grid(run.scenario.omega_s)
        phase = unpacked(traces(bode(run, "phi/dv_r"), "classic2", "y4")[0]["y"])
        value = frequency_response(run.methods[1].network, "dv_r", "phi", omega)
        assert np.max(np.abs(np.diff(phase))) < 90.0
        np.testing.assert_allclose(np.exp(1j * np.deg2rad(phase)), value / np.abs(value), atol=1e-5)

    @pytest.mark.parametrize("transfer", TRANSFERS)
    def test_every_transfer_is_drawn_for_a_method_it_reaches(self, transfer: str) -> None:
        run = run_of(method=[*THREE, INTERNAL])
        figure = bode(run, transfer)
        name = "inner" if VIEWS[transfer].source == "acceleration" else "compass"
        assert np.isfinite(unpacked(traces(figure, name, "y3")[0]["y"])).all()

    def test_says_which_method_does_not_react(self) -> None:
        run = static_run()
        assert len(unpacked(traces(bode(run, "phi/dv_r"), "free", "y3")[0]["y"])) == 0
        assert any("no log in: free" in text for text in texts(bode(run, "phi/dv_r")))
        assert len(unpacked(traces(bode(run, "phi/eps"), "free", "y3")[0]["y"])) > 100

    @pytest.mark.parametrize("transfer", TRANSFERS)
    @pytest.mark.parametrize("width_px", [560.0, 640.0, 940.0])
    def test_titles_fit_their_column(self, transfer: str, width_px: float) -> None:
        figure = bode(run_of(method=[*THREE, INTERNAL]), transfer, 0.6, width_px=width_px)
        titles = [n["text"] for n in figure["layout"]["annotations"] if n["font"]["size"] == style.TITLE_SIZE]
        assert len(titles) == 2
        for title in titles:
            assert 7.8 * len(re.sub("<[^>]*>", "", title)) <= 0.44 * (width_px - 84.0)

    def test_without_a_log_the_plot_says_that_nothing_reacts(self) -> None:
        free = run_of(method=[{"name": "free"}], reference={"kind": "none"})
        assert "no method reacts" in texts(bode(free, "phi/dv_r"))

    def test_free_method_ignores_its_network(self) -> None:
        run = run_of(method=[{"name": "free", "network": {"id": "classic2"}}])
        np.testing.assert_array_equal(unpacked(traces(bode(run), "free", "y")[0]["y"]), 0.0)

    def test_natural_frequencies_are_marked_at_their_place(self) -> None:
        run = static_run()
        lines = [s["x0"] for s in bode(run)["layout"]["shapes"] if s["xref"] == "x"]
        foucault = EARTH_RATE * math.sin(math.radians(32.06))
        assert sorted(lines) == pytest.approx(sorted([EARTH_RATE, foucault, run.scenario.omega_s]))
        assert any(text.startswith("Schuler<br>84.") for text in texts(bode(run)))
        assert any(text.startswith("Foucault<br>45.1 h") for text in texts(bode(run)))

    @pytest.mark.parametrize("lat_deg", [-89.0, -45.0, 0.0, 3.0, 8.0, 32.06, 70.0, 89.0])
    def test_marker_labels_do_not_overlap(self, lat_deg: float) -> None:
        run = run_of(site={"lat_deg": lat_deg}, method=[{"name": "free"}])
        figure = bode(run, width_px=760.0)
        names = ("Schuler", "Foucault", "24 h")
        notes = [
            n for n in figure["layout"]["annotations"] if n["xref"] == "x" and n["text"].startswith(names)
        ]
        column_px = 0.44 * (760.0 - 84.0)
        spans = []
        for note in notes:
            width = 7.5 * max(len(line) for line in note["text"].split("<br>"))
            decades = math.log10(OMEGA_MAX / OMEGA_MIN)
            at = (note["x"] - math.log10(OMEGA_MIN)) / decades * column_px + note.get("xshift", 0)
            left = {"left": at, "right": at - width, "center": at - 0.5 * width}[note["xanchor"]]
            spans.append((left, left + width))
        spans.sort()
        assert len(spans) == len(natural_frequencies(run)) == (2 if abs(lat_deg) < 3.5 else 3)
        assert all(first[1] <= second[0] for first, second in zip(spans, spans[1:], strict=False))

    def test_undamped_peak_does_not_set_the_scale(self) -> None:
        run = run_of(method=[{"name": "free"}])
        low, high = bode(run, "phi/eps")["layout"]["yaxis3"]["range"]
        curve = np.log10(unpacked(traces(bode(run, "phi/eps"), "free", "y3")[0]["y"]))
        assert np.max(curve) > high
        assert np.median(curve) > low


class TestPoles:
    def test_classic2_as_in_physics_9_1(self) -> None:
        figure = poles(run_of(run={"duration_h": 0.1, "earth": "sphere"}))
        trace = traces(figure, "classic2", "y")[0]
        found = sorted(zip(unpacked(trace["x"]), unpacked(trace["y"]), strict=True))
        expected = [(-9.879, 0.0), (-2.674, 0.0), (-0.982, -1.003), (-0.982, 1.003)]
        np.testing.assert_allclose(found, expected, atol=6e-4)
        assert any("damping ratio 0.699" in text for text in trace["text"])

    def test_free_poles_lie_on_the_boundary(self) -> None:
        run = run_of(method=[{"name": "free", "network": {"id": "classic2"}}])
        trace = traces(poles(run), "free", "y")[0]
        np.testing.assert_array_equal(unpacked(trace["x"]), [0.0, 0.0])
        np.testing.assert_array_equal(np.abs(unpacked(trace["y"])), [1.0, 1.0])

    def test_every_pole_is_inside_the_left_panel(self) -> None:
        run = run_of(method=[*THREE, INTERNAL, UNSTABLE])
        figure = poles(run)
        re, im = (figure["layout"][axis]["range"] for axis in ("xaxis", "yaxis"))
        for name in ("free", "classic2", "compass", "inner", "as printed"):
            trace = traces(figure, name, "y")[0]
            x, y = unpacked(trace["x"]), unpacked(trace["y"])
            assert (re[0] < x).all() and (x < re[1]).all() and (im[0] < y).all() and (y < im[1]).all()

    def test_far_zero_is_named_at_the_edge(self) -> None:
        assert any(text.startswith("◂ zero at -75.9") for text in texts(poles(static_run())))

    @pytest.mark.parametrize("width_px", [940.0, 640.0, 360.0])
    def test_labels_of_rays_and_settling_lines_stand_apart(self, width_px: float) -> None:
        layout = poles(static_run(), width_px=width_px)["layout"]
        for axis in ("x", "x2"):
            (low, high), (left, right) = (layout[f"{axis[0]}axis{axis[1:]}"][k] for k in ("range", "domain"))
            scale = (right - left) * (width_px - 74) / (high - low)  # px a unit
            notes = [n for n in layout["annotations"] if n["xref"] == axis]
            rays = sorted(n["x"] for n in notes if re.fullmatch(r"0\.\d", n["text"]) and n["x"] < -0.01)
            lines = sorted(n["x"] for n in notes if re.fullmatch(r"\d+ (min|h)", n["text"]))
            assert rays
            level = max(n["y"] for n in notes if re.fullmatch(r"0\.\d", n["text"]))
            top = sorted(n["x"] for n in notes if re.fullmatch(r"0\.\d", n["text"]) and n["y"] == level)
            assert all(scale * (b - a) >= 27 for a, b in zip(top, top[1:], strict=False))
            assert all(scale * (b - a) >= 62 for a, b in zip(lines, lines[1:], strict=False))

    def test_panels_have_equal_scales(self) -> None:
        layout = poles(static_run(), 0.46, width_px=940.0)["layout"]
        margin = layout["margin"]
        width = (940.0 - margin["l"] - margin["r"]) * (layout["xaxis"]["domain"][1])
        height = 0.46 * 940.0 - margin["t"] - margin["b"]
        for suffix in ("", "2"):
            x, y = layout[f"xaxis{suffix}"]["range"], layout[f"yaxis{suffix}"]["range"]
            assert (x[1] - x[0]) / width == pytest.approx((y[1] - y[0]) / height, rel=1e-6)


class TestStep:
    def test_tilt_response_and_settling_mark(self) -> None:
        run = static_run()
        figure = step(run)
        trace = traces(figure, "compass", "y")[0]
        minutes = unpacked(trace["x"]).astype(float)
        expected = initial_tilt_response(run.methods[2].network, minutes * 60.0)
        np.testing.assert_allclose(unpacked(trace["y"]), expected, atol=1e-4)
        mark = traces(figure, "compass settled", "y")[0]
        assert mark["x"][0] * 60.0 == pytest.approx(run.methods[2].loop.settling_s)
        assert abs(mark["y"][0]) == pytest.approx(0.02, abs=0.004)
        assert traces(figure, "free settled", "y")[0]["x"] == []

    def test_feedback_takes_over_the_log_and_the_network_rejects_it(self) -> None:
        figure = step(static_run())
        compass, classic = (unpacked(traces(figure, n, "y3")[0]["y"]) for n in ("compass", "classic2"))
        assert compass[-1] == pytest.approx(1.0, abs=1e-4)
        assert classic[-1] == pytest.approx(0.0, abs=1e-3)
        assert "δV (m/s)" in figure["layout"]["yaxis3"]["title"]["text"]

    def test_unstable_method_does_not_set_the_scale(self) -> None:
        alone = step(run_of(method=[THREE[1]]))["layout"]["yaxis"]["range"]
        both = step(run_of(method=[THREE[1], UNSTABLE]))
        assert both["layout"]["yaxis"]["range"] == pytest.approx(alone, rel=1e-3)
        assert (
            np.max(np.abs(unpacked(traces(both, "as printed", "y")[0]["y"])))
            > both["layout"]["yaxis"]["range"][1]
        )

    def test_without_a_log_the_gyro_step_fills_the_lower_half(self) -> None:
        figure = step(run_of(method=[{"name": "free"}], reference={"kind": "none"}))
        assert any("gyro step" in text for text in texts(figure))
        velocity = unpacked(traces(figure, "free", "y3")[0]["y"])
        # two R eps at the far turn of the undamped swing: 2 x 6378137 m x 0.01 deg/h
        assert np.min(velocity) == pytest.approx(-2 * 6378137.0 * math.radians(0.01) / 3600.0, rel=1e-3)


def test_a_name_with_markup_is_shown_as_written() -> None:
    run = run_of(method=[{"name": "a<b> & <i>c"}])
    for make in FIGURES:
        names = {t.get("name") for t in make(run)["data"]}
        assert "a&lt;b&gt; &amp; &lt;i&gt;c" in names

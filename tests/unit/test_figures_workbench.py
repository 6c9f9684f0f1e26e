"""Nyquist, locus, settling lines, regions of the requirements and dots of the running filter: by numbers."""

from __future__ import annotations

import json
import math
import re

import numpy as np
import pytest

from app.plots import style
from app.plots.plotly_data import PlotlyFigure, unpacked
from app.views.frequency.discrete import law_step_s, measured_gain
from app.views.frequency.figure import OPEN_LOOP, SHOWN, bode, frequency_view
from app.views.frequency.nyquist import margin_words, margins_of, nyquist
from app.views.poles.figure import poles
from app.views.poles.grid import Allowed, settling_lines
from app.views.poles.locus import locus_fields, locus_of
from app.views.step.figure import StepLimits, step
from navcore.foundation.units import ARCSEC
from navcore.networks.discrete import discretise
from tests.unit.figures_runs import INTERNAL, THREE, UNSTABLE, run_of, static_run

SIZES = [(0.46, 940.0), (0.9, 640.0), (1.0, 560.0)]


def named(figure: PlotlyFigure, name: str, yaxis: str = "y") -> dict:
    return next(t for t in figure["data"] if t.get("name") == name and t["yaxis"] == yaxis)


def complex_of(trace: dict) -> np.ndarray:
    x, y = (np.asarray(v) if isinstance(v, list) else unpacked(v) for v in (trace["x"], trace["y"]))
    return x + 1j * y


class TestNyquist:
    def test_curve_is_the_open_loop(self) -> None:
        run = static_run()
        figure = nyquist(run)
        ratio = unpacked(named(figure, "classic2")["x"]).astype(float)
        expected = -run.methods[1].network.response(ratio * run.scenario.omega_s) / ratio**2
        shown = complex_of(named(figure, "classic2", "y3"))
        np.testing.assert_allclose(shown, expected, rtol=1e-5, atol=1e-6)
        level = unpacked(named(figure, "classic2")["y"])
        np.testing.assert_allclose(level, 20 * np.log10(np.abs(expected)), atol=1e-3)

    def test_margins_are_marked_where_they_are(self) -> None:
        run = static_run()
        figure, found = nyquist(run), margins_of(run.methods[1])
        assert found is not None and found.phase_rad is not None and found.crossover_rad_s is not None
        dot = complex_of(named(figure, "classic2 margin", "y3"))[0]
        assert abs(dot) == pytest.approx(1.0)
        assert np.angle(-dot) == pytest.approx(found.phase_rad)
        ratio = found.crossover_rad_s / run.scenario.omega_s
        assert named(figure, "classic2 margin")["x"] == [pytest.approx(ratio)]
        value = -run.methods[1].network.response(found.crossover_rad_s) / ratio**2
        assert dot == pytest.approx(complex(value), rel=1e-6)
        diamonds = named(figure, "classic2 gain margin", "y3")["x"]
        assert found.gain_up is not None
        assert diamonds == [pytest.approx(-1.0 / found.gain_up)]

    def test_says_the_margins_and_why_there_are_none(self) -> None:
        run = run_of(method=[*THREE, UNSTABLE])
        words = [margin_words(m, margins_of(m)) for m in run.methods]
        assert words[0] == "no margin: undamped"
        assert words[3] == "unstable"
        assert re.fullmatch(r"phase 4\d\.\d°, gain to ×9\.\d+, delay 6\.\d+ min", words[1])
        notes = [note["text"] for note in nyquist(run)["layout"]["annotations"]]
        assert all(any(word in note for note in notes) for word in words)
        narrow = [note["text"] for note in nyquist(run, 1.0, width_px=560.0)["layout"]["annotations"]]
        lines = [line for note in narrow for line in note.split("<br>")]
        assert max(len(line) for line in lines if "phase" in line or "gain" in line) <= 36
        assert all(any(part in line for line in lines) for word in words for part in word.split(", "))

    @pytest.mark.parametrize(("aspect", "width_px"), SIZES)
    def test_plane_has_equal_scales_and_shows_the_unit_circle(self, aspect: float, width_px: float) -> None:
        layout = nyquist(static_run(), aspect, width_px=width_px)["layout"]
        margin = layout["margin"]
        width = (width_px - margin["l"] - margin["r"]) * np.diff(layout["xaxis2"]["domain"])[0]
        height = aspect * width_px - margin["t"] - margin["b"]
        (left, right), (low, high) = layout["xaxis2"]["range"], layout["yaxis3"]["range"]
        assert (right - left) / width == pytest.approx((high - low) / height, rel=1e-6)
        assert left < -1.2 and right > 1.05 and low < -1.05 and high > 1.05

    def test_plotly_accepts_it_and_the_chooser_offers_it(self) -> None:
        import plotly.graph_objects as go

        figure = frequency_view(static_run(), OPEN_LOOP)
        assert len(go.Figure(json.loads(figure.to_json())).data) == len(figure["data"])
        assert OPEN_LOOP in SHOWN
        names = {t["name"] for t in frequency_view(static_run(), "phi/dv_r")["data"]}
        assert names == {"free", "classic2", "compass"}


class TestDots:
    def test_dots_lie_on_the_discrete_filters_curve(self) -> None:
        run = run_of(method=[THREE[1], INTERNAL])
        figure = bode(run, discrete=True)
        for method in run.methods:
            name = method.method.name
            trace, angle = named(figure, f"{name} measured"), named(figure, f"{name} measured", "y2")
            omega = unpacked(trace["x"]).astype(float)
            exact = discretise(method.network, law_step_s(run)).response(omega)
            np.testing.assert_allclose(unpacked(trace["y"]), 20 * np.log10(np.abs(exact)), atol=1e-3)
            np.testing.assert_allclose(
                np.exp(1j * np.deg2rad(unpacked(angle["y"]))), exact / np.abs(exact), atol=1e-4
            )
            beside = np.interp(
                np.log(omega),
                np.log(unpacked(named(figure, name)["x"])),
                unpacked(named(figure, name, "y2")["y"]),
            )
            assert np.max(np.abs(unpacked(angle["y"]) - beside)) < 10.0

    def test_a_long_step_moves_the_dots_off_the_curve(self) -> None:
        """Bilinear: the dot at omega is H at omega_s tan(omega T/2)/tan(omega_s T/2)."""
        run = run_of(run={"duration_h": 1.0, "step_s": 10.0}, reference={"kind": "none"}, method=[INTERNAL])
        method = run.methods[0]
        found = measured_gain(method, law_step_s(run))
        assert found is not None
        omega, gain = found
        w = run.scenario.omega_s
        warped = w * np.tan(0.5 * omega * 10.0) / math.tan(0.5 * w * 10.0)
        np.testing.assert_allclose(gain, method.network.response(warped), rtol=1e-4)
        assert np.max(np.abs(gain / method.network.response(omega) - 1.0)) > 1e-3

    def test_none_where_no_filter_runs(self) -> None:
        free, _, feedback = static_run().methods
        assert measured_gain(free, 1.0) is None and measured_gain(feedback, 1.0) is None
        names = {t["name"] for t in bode(static_run(), discrete=True)["data"]}
        assert names == {"free", "classic2", "classic2 measured", "compass"}
        assert not any("measured" in t["name"] for t in bode(static_run())["data"])


class TestLocus:
    def test_branches_run_through_the_present_poles(self) -> None:
        run = run_of(
            method=[{"name": "u", "damping": "external", "network": {"id": "unity2", "zeta": 0.515}}]
        )
        found = locus_of(run, 0, "zeta")
        assert found is not None
        present = np.argmin(np.abs(found.values - 0.515))
        now = run.methods[0].loop.poles
        for pole in now:
            assert np.abs(found.poles[present] - pole).min() < 0.05 * run.scenario.omega_s
        trace = named(poles(run, selected=0, locus="zeta"), "u locus")
        assert trace["line"]["color"] == style.method_color(0)
        finite = complex_of(trace)
        finite = finite[np.isfinite(finite)]
        assert len(finite) == found.poles.size

    def test_ends_are_marked_and_named(self) -> None:
        run = static_run()
        figure = poles(run, selected=2, locus="xi")
        ends = complex_of(named(figure, "compass locus ends"))
        sigma = 0.0088 / run.scenario.omega_s
        # all three poles keep Re = -sigma; the pair's frequency is sigma/xi, from xi = 0.05 to the real axis
        pair = sigma * math.sqrt(1 / 0.05**2 - 1)
        assert np.max(np.imag(ends)) == pytest.approx(pair, rel=1e-5)
        notes = [note["text"] for note in figure["layout"]["annotations"]]
        assert any("over ζ: ○ 0.05 … □ 1.5, ✕ 0.7" in note for note in notes)

    def test_gains_can_be_moved_while_sigma_and_xi_are_given(self) -> None:
        run = static_run()
        found = locus_of(run, 2, "k1")
        assert found is not None
        w, parameters = run.scenario.omega_s, run.methods[2].method.network
        _, k2, k3 = parameters.gains(w)  # type: ignore[attr-defined]
        for place in (0, 80, 160):
            k1 = found.values[place]
            roots = np.roots([1.0, k1, w**2 * (1 + k2), w**2 * k3])
            assert np.sort_complex(found.poles[place]) == pytest.approx(np.sort_complex(roots), rel=1e-6)

    def test_none_for_a_free_method_or_a_foreign_parameter(self) -> None:
        run = static_run()
        assert locus_of(run, 0, "xi") is None and locus_of(run, 2, "zeta") is None
        assert locus_of(run, 9, "xi") is None and locus_of(run, 2, "") is None
        assert locus_fields(run.methods[1].method.network) == {}
        assert "decay rate σ (1/s)" in locus_fields(run.methods[2].method.network).values()
        assert not any("locus" in str(t.get("name")) for t in poles(run, selected=0, locus="xi")["data"])


class TestPoleMap:
    def test_settling_lines_are_at_ln_50_over_the_time(self) -> None:
        omega_s = 1.24e-3
        lines = settling_lines(-4.0, omega_s, 400.0, 4.6)
        assert {60.0, 30.0} <= set(lines)
        for minutes, at in lines.items():
            assert math.exp(at * omega_s * minutes * 60.0) == pytest.approx(0.02)
        places = sorted(lines.values())
        assert min(b - a for a, b in zip(places, places[1:], strict=False)) >= 62.0 / 400.0 * 4.6
        notes = [n["text"] for n in poles(static_run())["layout"]["annotations"] if n["xref"] == "x2"]
        assert "60 min" in notes

    def test_regions_begin_where_the_requirements_end(self) -> None:
        run = static_run()
        figure = poles(run, allowed=Allowed(damping_ratio=0.5, rate=1e-3))
        shapes = {s["name"]: s for s in figure["layout"]["shapes"] if s.get("name") and s["xref"] == "x2"}
        edge = float(shapes["settling"]["path"].split()[1])
        assert edge == pytest.approx(-1e-3 / run.scenario.omega_s)
        x, y = (float(v) for v in shapes["damping"]["path"].split()[1:3])
        assert -x / math.hypot(x, y) == pytest.approx(0.5)
        assert not any(s.get("name") for s in poles(run)["layout"]["shapes"])

    def test_says_where_it_takes_clicks(self) -> None:
        layout = poles(static_run())["layout"]
        assert all(axis in layout for pair in layout["meta"]["pick"]["panels"] for axis in pair)


class TestStepRegions:
    def test_regions_are_the_limits(self) -> None:
        limits = StepLimits(settling_s=3600.0, overshoot=0.4, log_tilt=20.0 * ARCSEC)
        shapes = [s for s in step(static_run(), limits=limits)["layout"]["shapes"] if s.get("name")]
        # the panel is in arcmin: without the limit the tilts of these methods reach several
        boxes = [(s["name"], s["xref"], s["x0"], s["y0"] if s["y0"] > -1e5 else s["y1"]) for s in shapes]
        assert boxes == [
            ("overshoot", "x", 0.0, -0.4),
            ("settling", "x", 60.0, 0.02),
            ("settling", "x", 60.0, -0.02),
            ("log tilt", "x4", 0.0, pytest.approx(20.0 / 60.0)),
            ("log tilt", "x4", 0.0, pytest.approx(-20.0 / 60.0)),
        ]

    def test_a_gyro_step_has_no_log_limit(self) -> None:
        run = run_of(method=[{"name": "free"}], reference={"kind": "none"})
        assert not any(s.get("name") for s in step(run, limits=StepLimits(log_tilt=1e-4))["layout"]["shapes"])

"""Pole map, locus, whole system and step responses: by numbers."""

import math
import re
from typing import Any

import numpy as np
import pytest

from navcore.analysis import initial_tilt_response
from navcore.analysis.whole_system import EARTH_MODE, NETWORK_MODE, SCHULER_MODE, whole_system
from navcore.foundation.units import ARCSEC, DEG
from schuler_bench.plots.effective import earth_mode_text
from schuler_bench.views.method.view import loop_text
from schuler_bench.views.poles.azimuth import azimuth_loops
from schuler_bench.views.poles.figure import poles
from schuler_bench.views.poles.grid import locus_fields, locus_of, settling_lines
from schuler_bench.views.poles.whole import LATITUDES, whole_system_figure
from schuler_bench.views.step.figure import step
from tests.unit.figures_runs import (
    INTERNAL,
    THREE,
    UNSTABLE,
    of_trace,
    run_of,
    static_run,
    texts_of,
    trace_of,
)

ALONE = [{"name": "free", "network": {"id": "classic2"}}]


class TestPoles:
    def test_classic2_as_in_physics_9_1(self) -> None:
        figure = poles(run_of(run={"duration_h": 0.1, "earth": "sphere"}))
        expected = [(-9.879, 0.0), (-2.674, 0.0), (-0.982, -1.003), (-0.982, 1.003)]
        np.testing.assert_allclose(
            sorted(zip(*of_trace(figure, "classic2"), strict=True)), expected, atol=6e-4
        )
        assert any("damping ratio 0.699" in text for text in trace_of(figure, "classic2")["text"])

    def test_free_poles_lie_on_the_boundary(self) -> None:
        x, y = of_trace(poles(run_of(method=ALONE)), "free")
        assert (x.tolist(), np.abs(y).tolist()) == ([0.0, 0.0], [1.0, 1.0])

    def test_the_azimuth_map_is_that_of_y_in_units_of_the_earths_rate(self) -> None:
        """Without Y the pair stays undamped at Omega; a gyrocompass and a free method have no such loop."""
        whole = {**THREE[1], "name": "whole", "azimuth": {"id": "unity2", "zeta": 0.6}}
        compass = {**THREE[2], "name": "gyro", "gyrocompass": {}}
        run = run_of(method=[THREE[0], THREE[1], whole, compass])
        figure = poles(azimuth_loops(run), block="azimuth")
        level = poles(
            run_of(method=[{**THREE[1], "name": "whole", "network": {"id": "unity2", "zeta": 0.6}}])
        )
        mine, same = (sorted(zip(*of_trace(one, "whole"), strict=True)) for one in (figure, level))
        np.testing.assert_allclose(mine, same, atol=1e-5)
        x, y = of_trace(figure, "classic2")
        assert np.abs(x).max() < 1e-9 and np.abs(y).tolist() == [1.0, 1.0]
        assert all(len(of_trace(figure, name)[0]) == 0 for name in ("free", "gyro"))
        texts = [*texts_of(figure), figure["layout"]["xaxis"]["title"]["text"]]
        assert "Re s / Ω" in texts and any("Earth" in text for text in texts)
        assert not any("ω<sub>s" in text for text in texts)
        assert any("j Ω" in text for text in trace_of(figure, "whole")["text"])
        locus = poles(azimuth_loops(run), block="azimuth", selected=2, locus="zeta")
        assert len(of_trace(locus, "whole locus")[0]) > 100

    def test_every_pole_is_inside_the_left_panel(self) -> None:
        run = run_of(method=[*THREE, INTERNAL, UNSTABLE])
        figure = poles(run)
        re_axis, im_axis = (figure["layout"][axis]["range"] for axis in ("xaxis", "yaxis"))
        for method in run.methods:
            x, y = of_trace(figure, method.method.name)
            assert (
                re_axis[0] < x.min()
                and x.max() < re_axis[1]
                and im_axis[0] < y.min()
                and y.max() < im_axis[1]
            )

    def test_far_zero_is_named_at_the_edge(self) -> None:
        assert any(text.startswith("◂ zero at -75.9") for text in texts_of(poles(static_run())))

    @pytest.mark.parametrize("axis", ["x", "x2"])
    @pytest.mark.parametrize("width_px", [940.0, 640.0, 360.0])
    def test_labels_of_rays_and_settling_lines_stand_apart(self, width_px: float, axis: str) -> None:
        layout = poles(static_run(), width_px=width_px)["layout"]
        (low, high), (left, right) = (layout[f"{axis[0]}axis{axis[1:]}"][k] for k in ("range", "domain"))
        scale = (right - left) * (width_px - 74) / (high - low)  # px a unit
        notes = [note for note in layout["annotations"] if note["xref"] == axis]
        rays = [note for note in notes if re.fullmatch(r"0\.\d", note["text"])]
        level = max(note["y"] for note in rays)
        assert any(note["x"] < -0.01 for note in rays)
        for labels, apart in (
            ([note for note in rays if note["y"] == level], 27),
            ([note for note in notes if re.fullmatch(r"\d+ (min|h)", note["text"])], 62),
        ):
            assert all(np.diff(sorted(scale * note["x"] for note in labels)) >= apart)

    def test_panels_have_equal_scales(self) -> None:
        layout = poles(static_run(), 0.46, width_px=940.0)["layout"]
        margin = layout["margin"]
        width = (940.0 - margin["l"] - margin["r"]) * layout["xaxis"]["domain"][1]
        height = 0.46 * 940.0 - margin["t"] - margin["b"]
        for suffix in ("", "2"):
            spans = [np.ptp(layout[f"{axis}axis{suffix}"]["range"]) for axis in "xy"]
            assert spans[0] / width == pytest.approx(spans[1] / height, rel=1e-6)

    def test_settling_lines_are_at_ln_50_over_the_time(self) -> None:
        lines = settling_lines(-4.0, 1.24e-3, 400.0, 4.6)
        assert {60.0, 30.0} <= set(lines)
        for minutes, at in lines.items():
            assert math.exp(at * 1.24e-3 * minutes * 60.0) == pytest.approx(0.02)
        assert min(np.diff(sorted(lines.values()))) >= 62.0 / 400.0 * 4.6
        assert "60 min" in texts_of(poles(static_run()))

    @pytest.mark.parametrize("suffix", ["", "2"])
    def test_the_region_that_a_limit_rules_out_has_the_limit_as_its_only_edge(self, suffix: str) -> None:
        run = static_run()
        layout = poles(run, limits={"damping_ratio": 0.5, "settling_s": math.log(50.0) / 1e-3})["layout"]
        mine = [shape for shape in layout["shapes"] if shape["xref"] == f"x{suffix}"]
        damping, settling = (
            next(s for s in mine if s.get("name") == name) for name in ("damping", "settling")
        )
        x, y = (float(word) for word in damping["path"].split()[1:3])
        assert -x / math.hypot(x, y) == pytest.approx(0.5) and settling["line"]["width"] == 0
        at = pytest.approx(-1e-3 / run.scenario.omega_s)
        assert float(settling["path"].split()[1]) == at
        assert sum(shape["type"] == "line" and shape["x0"] == shape["x1"] == at for shape in mine) == 1
        # its far side lies beyond all that a zoom shows
        far = max(float(word) for word in settling["path"].split() if word[0].isdigit())
        assert far > 100.0 * max(map(abs, layout[f"xaxis{suffix}"]["range"]))
        assert not any(shape.get("name") for shape in poles(run)["layout"]["shapes"])

    def test_says_where_it_takes_clicks(self) -> None:
        layout = poles(static_run())["layout"]
        assert all(axis in layout for pair in layout["meta"]["pick"]["panels"] for axis in pair)


class TestLocus:
    def test_branches_run_through_the_present_poles(self) -> None:
        network = {"id": "unity2", "zeta": 0.515}
        run = run_of(method=[{"name": "u", "damping": "external", "network": network}])
        locus = locus_of(run, 0, "zeta")
        present = locus.poles[np.argmin(np.abs(locus.values - 0.515))]
        distance = np.abs(np.subtract.outer(run.methods[0].loop.poles, present)).min(axis=1)
        assert distance.max() < 0.05 * run.scenario.omega_s
        x, _ = of_trace(poles(run, selected=0, locus="zeta"), "u locus")
        assert np.count_nonzero(np.isfinite(x)) == locus.poles.size

    def test_ends_are_marked_and_named(self) -> None:
        run = static_run()
        figure = poles(run, selected=2, locus="xi")
        # all three poles keep Re = -sigma; the pair's frequency is sigma/xi, from xi = 0.05 to the real axis
        pair = 0.0088 / run.scenario.omega_s * math.sqrt(1 / 0.05**2 - 1)
        assert np.max(of_trace(figure, "compass locus ends")[1]) == pytest.approx(pair, rel=1e-5)
        assert any("over ζ: ○ 0.05 … □ 1.5, ✕ 0.7" in text for text in texts_of(figure))

    def test_gains_can_be_moved_while_sigma_and_xi_are_given(self) -> None:
        run = static_run()
        locus, w = locus_of(run, 2, "k1"), run.scenario.omega_s
        network: Any = run.methods[2].method.network
        _, k2, k3 = network.gains(w)
        for place in (0, 80, 160):
            roots = np.roots([1.0, locus.values[place], w**2 * (1 + k2), w**2 * k3])
            assert np.sort_complex(locus.poles[place]) == pytest.approx(np.sort_complex(roots), rel=1e-6)

    def test_none_for_a_free_method_or_a_foreign_parameter(self) -> None:
        run = static_run()
        for place, field in ((0, "xi"), (2, "zeta"), (9, "xi"), (2, "")):
            assert locus_of(run, place, field) is None
        assert locus_fields(run.methods[1].method) == {}
        assert "decay rate σ (1/s)" in locus_fields(run.methods[2].method).values()
        assert not any("locus" in str(t.get("name")) for t in poles(run, selected=0, locus="xi")["data"])


class TestWholeSystem:
    def test_every_method_has_its_modes_and_its_curve_of_growth(self) -> None:
        run = run_of(method=THREE)
        figure = whole_system_figure(run)
        for method in run.methods:
            name = method.method.name
            for kind, suffix in (
                (EARTH_MODE, f" {EARTH_MODE}"),
                (SCHULER_MODE, ""),
                (NETWORK_MODE, " network"),
            ):
                assert len(trace_of(figure, f"{name}{suffix}")["text"]) == len(method.whole.named(kind))
            assert len(of_trace(figure, f"{name} growth", "y2")[0]) == len(LATITUDES)
            assert trace_of(figure, f"{name} at the site", "y2")["y"] == [method.whole.earth_growth * 86400.0]

    @pytest.mark.parametrize(
        ("growth", "text"),
        [
            (1.0 / (3.09 * 86400.0), "grows, e-folding 3.1 days"),
            (-1.0 / (20.0 * 3600.0), "decays, e-folding 20 h"),
            (0.0, "neither grows nor decays"),
        ],
    )
    def test_the_24_h_mode_in_words(self, growth: float, text: str) -> None:
        assert earth_mode_text(growth) == text

    def test_the_line_below_the_network_says_both(self) -> None:
        run = run_of(method=THREE)
        lat_deg = run.scenario.site.lat_deg
        text = loop_text(run.methods[1], lat_deg)
        growth = whole_system(run.methods[1].network, lat_deg * DEG, run.scenario.earth).earth_growth
        assert np.isclose(run.methods[1].whole.earth_growth, growth)
        assert text.startswith("One channel: least damping ratio 0.699, settles to 2 % in 53")
        assert " min (tilt) and " in text and " min (velocity)" in text
        assert f"Whole system: 24 h mode {earth_mode_text(growth)}" in text


class TestStep:
    def test_tilt_response_and_settling_mark(self) -> None:
        run, figure = static_run(), step(static_run())
        minutes, tilt = of_trace(figure, "compass")
        expected = initial_tilt_response(run.methods[2].network, minutes * 60.0)
        np.testing.assert_allclose(tilt, expected, atol=1e-4)
        mark = trace_of(figure, "compass settled")
        assert mark["x"][0] * 60.0 == pytest.approx(run.methods[2].loop.settling_s)
        assert abs(mark["y"][0]) == pytest.approx(0.02, abs=0.004)
        assert trace_of(figure, "free settled")["x"] == []

    def test_feedback_takes_over_the_log_and_the_network_rejects_it(self) -> None:
        figure = step(static_run())
        ends = [of_trace(figure, name, "y3")[1][-1] for name in ("compass", "classic2")]
        assert ends == pytest.approx([1.0, 0.0], abs=1e-3)
        assert "δV (m/s)" in figure["layout"]["yaxis3"]["title"]["text"]

    def test_unstable_method_does_not_set_the_scale(self) -> None:
        alone = step(run_of(method=[THREE[1]]))["layout"]["yaxis"]["range"]
        both = step(run_of(method=[THREE[1], UNSTABLE]))
        assert both["layout"]["yaxis"]["range"] == pytest.approx(alone, rel=1e-3)
        assert np.max(np.abs(of_trace(both, "as printed")[1])) > alone[1]

    def test_without_a_log_the_gyro_step_fills_the_lower_half(self) -> None:
        figure = step(
            run_of(method=[{"name": "free"}], reference={"kind": "none"}), limits={"log_tilt": 1e-4}
        )
        assert any("gyro step" in text for text in texts_of(figure))
        # two R eps at the far turn of the undamped swing: 2 x 6378137 m x 0.01 deg/h
        least = -2 * 6378137.0 * math.radians(0.01) / 3600.0
        assert np.min(of_trace(figure, "free", "y3")[1]) == pytest.approx(least, rel=1e-3)
        assert not any(shape.get("name") for shape in figure["layout"]["shapes"]), (
            "a gyro step has no log limit"
        )

    def test_regions_are_the_limits(self) -> None:
        limits = {"settling_s": 3600.0, "tilt_overshoot": 0.4, "log_tilt": 20.0 * ARCSEC}
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

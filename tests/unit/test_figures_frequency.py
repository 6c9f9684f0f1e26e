"""Bode and Nyquist plots: curves, margins and the dots of the running filter, by numbers."""

import math
import re
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import pytest

from navcore.analysis import RADIUS, frequency_response
from navcore.foundation.earth import EARTH_RATE
from navcore.foundation.units import ARCSEC, DEG_PER_HOUR
from navcore.networks.discrete import discretise
from schuler_bench.plots.effective import OMEGA_MAX, OMEGA_MIN, TRANSFERS, VIEWS
from schuler_bench.plots.plotly_data import values_of
from schuler_bench.views.frequency.curves import law_step_s, measured_gain
from schuler_bench.views.frequency.figure import bode, natural_frequencies
from schuler_bench.views.frequency.nyquist import HIGH, LOW, margin_words, margins_of, nyquist
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

NO_LOG = {"kind": "none"}


class TestBode:
    def test_shows_the_networks_response(self) -> None:
        run = static_run()
        omega, level = of_trace(bode(run), "classic2")
        assert (omega[0], omega[-1]) == (OMEGA_MIN, OMEGA_MAX) and len(omega) > 250
        np.testing.assert_allclose(
            level, 20.0 * np.log10(np.abs(run.methods[1].network.response(omega))), atol=1e-4
        )

    def test_the_azimuth_network_is_dotted_beside_the_level_network(self) -> None:
        whole = {**THREE[1], "name": "whole", "azimuth": {"id": "unity2", "zeta": 0.5}}
        run = run_of(method=[THREE[1], whole])
        figure = bode(run)
        (dotted,) = (
            trace
            for trace in figure["data"]
            if trace["yaxis"] == "y" and trace.get("line", {}).get("dash") == "dot"
        )
        assert dotted["line"]["color"] == trace_of(figure, "whole")["line"]["color"]
        assert any("Y(jω)" in text for text in texts_of(figure))
        assert not any("Y(jω)" in text for text in texts_of(bode(static_run())))
        network = run.methods[1].method.azimuth.at_earth_rate()
        omega, level = (np.array(values_of(dotted[axis]), float) for axis in "xy")
        np.testing.assert_allclose(level, 20.0 * np.log10(np.abs(network.response(omega))), atol=1e-4)

    @pytest.mark.parametrize("place", [1, 2])
    def test_shows_the_transfer_in_its_unit_and_its_phase_continuously(self, place: int) -> None:
        run, figure = static_run(), bode(static_run(), "phi/dv_r")
        name = run.methods[place].method.name
        omega, size = of_trace(figure, name, "y3")
        _, degrees = of_trace(figure, name, "y4")
        value = frequency_response(run.methods[place].network, "dv_r", "phi", omega)
        np.testing.assert_allclose(size, np.abs(value) / ARCSEC, rtol=1e-5)
        np.testing.assert_allclose(np.exp(1j * np.deg2rad(degrees)), value / np.abs(value), atol=1e-5)
        assert np.max(np.abs(np.diff(degrees))) < 90.0

    @pytest.mark.parametrize("transfer", TRANSFERS)
    def test_every_transfer_is_drawn_for_a_method_it_reaches(self, transfer: str) -> None:
        name = "inner" if VIEWS[transfer].source == "acceleration" else "compass"
        _, size = of_trace(bode(run_of(method=[*THREE, INTERNAL]), transfer), name, "y3")
        assert np.isfinite(size).all() and len(size) > 100

    def test_says_which_method_does_not_react(self) -> None:
        of_log, of_gyro = (bode(static_run(), key) for key in ("phi/dv_r", "phi/eps"))
        assert len(of_trace(of_log, "free", "y3")[1]) == 0 and len(of_trace(of_gyro, "free", "y3")[1]) > 100
        assert any("no log in: free" in text for text in texts_of(of_log))
        assert "no method reacts" in texts_of(
            bode(run_of(method=[{"name": "free"}], reference=NO_LOG), "phi/dv_r")
        )

    @pytest.mark.parametrize("transfer", TRANSFERS)
    @pytest.mark.parametrize("width_px", [560.0, 640.0, 940.0])
    def test_titles_fit_their_column(self, transfer: str, width_px: float) -> None:
        layout = bode(run_of(method=[*THREE, INTERNAL]), transfer, 0.6, width_px=width_px)["layout"]
        titles = [n["text"] for n in layout["annotations"] if n["text"].startswith("<b>")]
        widths = [7.8 * len(re.sub("<[^>]*>", "", title)) for title in titles]
        assert len(widths) == 2 and max(widths) <= 0.44 * (width_px - 84.0)

    def test_free_method_ignores_its_network(self) -> None:
        run = run_of(method=[{"name": "free", "network": {"id": "classic2"}}])
        np.testing.assert_array_equal(of_trace(bode(run), "free")[1], 0.0)

    def test_natural_frequencies_are_marked_at_their_place(self) -> None:
        run, figure = static_run(), bode(static_run())
        lines = [shape["x0"] for shape in figure["layout"]["shapes"] if shape["xref"] == "x"]
        foucault = EARTH_RATE * math.sin(math.radians(32.06))
        assert sorted(lines) == pytest.approx(sorted([EARTH_RATE, foucault, run.scenario.omega_s]))
        for start in ("Schuler<br>84.", "Foucault<br>45.1 h"):
            assert any(text.startswith(start) for text in texts_of(figure))

    @pytest.mark.parametrize("lat_deg", [-89.0, -45.0, 0.0, 3.0, 8.0, 32.06, 70.0, 89.0])
    def test_marker_labels_do_not_overlap(self, lat_deg: float) -> None:
        run = run_of(site={"lat_deg": lat_deg}, method=[{"name": "free"}])
        notes = bode(run, width_px=760.0)["layout"]["annotations"]
        px = 0.44 * (760.0 - 84.0) / math.log10(OMEGA_MAX / OMEGA_MIN)
        spans = []
        for note in notes:
            if note["xref"] == "x" and note["text"].startswith(("Schuler", "Foucault", "24 h")):
                width = 7.5 * max(len(line) for line in note["text"].split("<br>"))
                at = (note["x"] - math.log10(OMEGA_MIN)) * px + note.get("xshift", 0)
                left = {"left": at, "right": at - width, "center": at - 0.5 * width}[note["xanchor"]]
                spans.append((left, left + width))
        spans.sort()
        assert len(spans) == len(natural_frequencies(run)) == (2 if abs(lat_deg) < 3.5 else 3)
        assert all(first[1] <= second[0] for first, second in zip(spans, spans[1:], strict=False))

    def test_undamped_peak_does_not_set_the_scale(self) -> None:
        figure = bode(run_of(method=[{"name": "free"}]), "phi/eps")
        low, high = figure["layout"]["yaxis3"]["range"]
        curve = np.log10(of_trace(figure, "free", "y3")[1])
        assert np.max(curve) > high and np.median(curve) > low


class TestNyquist:
    def test_curve_is_the_open_loop(self) -> None:
        run, figure = static_run(), nyquist(static_run())
        ratio, level = of_trace(figure, "classic2")
        expected = -run.methods[1].network.response(ratio * run.scenario.omega_s) / ratio**2
        re_l, im_l = of_trace(figure, "classic2", "y3")
        np.testing.assert_allclose(re_l + 1j * im_l, expected, rtol=1e-5, atol=1e-6)
        np.testing.assert_allclose(level, 20 * np.log10(np.abs(expected)), atol=1e-3)

    def test_margins_are_marked_where_they_are(self) -> None:
        run, figure = static_run(), nyquist(static_run())
        margin = margins_of(run.methods[1])
        assert margin.crossover_rad_s is not None and margin.gain_up is not None
        ratio = margin.crossover_rad_s / run.scenario.omega_s
        value = -run.methods[1].network.response(margin.crossover_rad_s) / ratio**2
        (x,), (y,) = of_trace(figure, "classic2 margin", "y3")
        assert abs(x + 1j * y) == pytest.approx(1.0) and np.angle(-x - 1j * y) == pytest.approx(
            margin.phase_rad
        )
        assert x + 1j * y == pytest.approx(complex(value), rel=1e-6)
        assert trace_of(figure, "classic2 margin")["x"] == [pytest.approx(ratio)]
        assert trace_of(figure, "classic2 gain margin", "y3")["x"] == [pytest.approx(-1.0 / margin.gain_up)]

    def test_says_the_margins_and_why_there_are_none(self) -> None:
        run = run_of(method=[*THREE, UNSTABLE])
        words = [margin_words(m, margins_of(m)) for m in run.methods]
        assert (words[0], words[3]) == ("no margin: undamped", "unstable")
        assert re.fullmatch(r"phase 4\d\.\d°, gain to ×9\.\d+, delay 6\.\d+ min", words[1])
        assert all(any(word in note for note in texts_of(nyquist(run))) for word in words)
        lines = [line for note in texts_of(nyquist(run, 1.0, width_px=560.0)) for line in note.split("<br>")]
        assert max(len(line) for line in lines if "phase" in line or "gain" in line) <= 36
        assert all(any(part in line for line in lines) for word in words for part in word.split(", "))

    @pytest.mark.parametrize(("aspect", "width_px"), [(0.46, 940.0), (0.9, 640.0), (1.0, 560.0)])
    def test_plane_has_equal_scales_and_shows_the_unit_circle(self, aspect: float, width_px: float) -> None:
        layout = nyquist(static_run(), aspect, width_px=width_px)["layout"]
        margin = layout["margin"]
        width = (width_px - margin["l"] - margin["r"]) * np.diff(layout["xaxis2"]["domain"])[0]
        height = aspect * width_px - margin["t"] - margin["b"]
        (left, right), (low, high) = layout["xaxis2"]["range"], layout["yaxis3"]["range"]
        assert (right - left) / width == pytest.approx((high - low) / height, rel=1e-6)
        assert left < -1.2 and right > 1.05 and low < -1.05 and high > 1.05


class TestDots:
    def test_dots_lie_on_the_discrete_filters_curve(self) -> None:
        run = run_of(method=[THREE[1], INTERNAL])
        figure = bode(run, discrete=True)
        for method in run.methods:
            name = method.method.name
            omega, level = of_trace(figure, f"{name} measured")
            _, angle = of_trace(figure, f"{name} measured", "y2")
            exact = discretise(method.network, law_step_s(run)).response(omega)
            np.testing.assert_allclose(level, 20 * np.log10(np.abs(exact)), atol=1e-3)
            np.testing.assert_allclose(np.exp(1j * np.deg2rad(angle)), exact / np.abs(exact), atol=1e-4)
            beside = np.interp(
                np.log(omega), np.log(of_trace(figure, name)[0]), of_trace(figure, name, "y2")[1]
            )
            assert np.max(np.abs(angle - beside)) < 10.0

    def test_a_long_step_moves_the_dots_off_the_curve(self) -> None:
        """Bilinear: the dot at omega is H at omega_s tan(omega T/2)/tan(omega_s T/2)."""
        run = run_of(run={"duration_h": 1.0, "step_s": 10.0}, reference=NO_LOG, method=[INTERNAL])
        network, w = run.methods[0].network, run.scenario.omega_s
        measured = measured_gain(run.methods[0], law_step_s(run))
        assert measured is not None
        omega, gain = measured
        warped = w * np.tan(0.5 * omega * 10.0) / math.tan(0.5 * w * 10.0)
        np.testing.assert_allclose(gain, network.response(warped), rtol=1e-4)
        assert np.max(np.abs(gain / network.response(omega) - 1.0)) > 1e-3

    def test_none_where_no_filter_runs(self) -> None:
        run = static_run()
        assert [measured_gain(method, 1.0) is None for method in run.methods] == [True, False, True]
        with_dots, without = ({t["name"] for t in bode(run, discrete=dots)["data"]} for dots in (True, False))
        assert without == {"free", "classic2", "compass"} and with_dots - without == {"classic2 measured"}


def random_networks(seed: int) -> list[dict[str, Any]]:
    """Networks and loops with resonances and notches of damping ratios from 0.001 to 1."""
    rng = np.random.default_rng(seed)
    small = partial(_between, rng, 1e-3, 1.0)

    def pairs(count: int) -> list[list[float]]:
        roots = [(_between(rng, 2e-4, 2e-2), small()) for _ in range(count)]
        return [[-w * d, way * w * math.sqrt(1.0 - d * d)] for w, d in roots for way in (1.0, -1.0)]

    networks = [
        {"id": "unity2", "zeta": small(), "r": _between(rng, 1.01, 2.0)},
        {"id": "compass", "sigma": _between(rng, 3e-4, 2e-2), "xi": _between(rng, 0.01, 1.0)},
        {"id": "complementary", "zeta": small()},
        {"id": "custom", "zeros": pairs(1), "poles": pairs(1)},
        {"id": "custom", "zeros": pairs(2), "poles": pairs(2)},
    ]
    return [{"name": f"{i}", "damping": "external", "network": n} for i, n in enumerate(networks)]


def _between(rng: np.random.Generator, low: float, high: float) -> float:
    return math.exp(rng.uniform(math.log(low), math.log(high)))


def extremes(size: Callable[[np.ndarray], np.ndarray], span: tuple[float, float]) -> tuple[float, float]:
    """Largest and smallest value by a dense search over a span of rad/s, refined twice."""
    ends = []
    for place_of in (np.argmax, np.argmin):
        omega, value = np.geomspace(*span, 200_001), math.nan
        for _ in range(3):
            values = size(omega)
            place = int(place_of(values))
            value = float(values[place])
            omega = np.linspace(omega[max(place - 1, 0)], omega[min(place + 1, len(omega) - 1)], 2001)
        ends.append(value)
    return ends[0], ends[1]


@pytest.mark.parametrize("seed", range(6))
def test_narrow_peaks_and_notches_reach_their_true_value(seed: int) -> None:
    """H, s/(s^2 + w^2 H) times (1 - H)/R or 1 (theory.md 3), and 1 + L, from the polynomials of H."""
    run = run_of(run={"duration_h": 0.02}, method=random_networks(seed))
    of_log, of_gyro, plane, w = bode(run), bode(run, "phi/eps"), nyquist(run), run.scenario.omega_s
    for method in run.methods:
        name, num, den = method.method.name, method.network.num, method.network.den
        poles = np.roots(np.polyadd(np.append(den, [0.0, 0.0]), w * w * num))
        if np.min(np.abs(poles.real) / np.abs(poles)) < 1e-3:
            continue  # by chance: a curve is cut off where its peak is as good as infinite

        def h(omega: np.ndarray, num: np.ndarray = num, den: np.ndarray = den) -> np.ndarray:
            return np.polyval(num, 1j * omega) / np.polyval(den, 1j * omega)

        def loop(omega: np.ndarray, h: Callable[[np.ndarray], np.ndarray] = h) -> np.ndarray:
            return w * w * h(omega) - omega * omega

        level = 10.0 ** (of_trace(of_log, name)[1] / 20.0)
        re_l, im_l = of_trace(plane, name, "y3")
        drawn = [
            (level, lambda omega, h=h: np.abs(h(omega))),
            (
                of_trace(of_log, name, "y3")[1] * ARCSEC,
                lambda omega, h=h, loop=loop: np.abs((1.0 - h(omega)) * omega / RADIUS / loop(omega)),
            ),
            (
                of_trace(of_gyro, name, "y3")[1] * ARCSEC / (0.01 * DEG_PER_HOUR),
                lambda omega, loop=loop: np.abs(omega / loop(omega)),
            ),
            (
                np.abs(1.0 + re_l + 1j * im_l),
                lambda omega, loop=loop: np.abs(loop(omega)) / omega**2,
            ),
        ]
        for (size, exact), span in zip(
            drawn, [*[(OMEGA_MIN, OMEGA_MAX)] * 3, (LOW * w, HIGH * w)], strict=True
        ):
            assert (size.max(), size.min()) == pytest.approx(extremes(exact, span), rel=5e-3), name


@pytest.mark.parametrize(("network", "least"), [("unity2", 0.001), ("complementary", 0.05)])
def test_a_curve_keeps_its_number_of_points_when_a_slider_moves(network: str, least: float) -> None:
    """Else the page lays the figure out anew (`static/redraw.js`)."""
    counts = set()
    for zeta in np.round(np.linspace(least, 2.0, 60), 3).tolist():
        run = run_of(
            run={"duration_h": 0.02}, method=[{**THREE[1], "network": {"id": network, "zeta": zeta}}]
        )
        counts.add(tuple(len(of_trace(bode(run), "classic2", axis)[0]) for axis in ("y", "y3")))
    assert len(counts) == 1

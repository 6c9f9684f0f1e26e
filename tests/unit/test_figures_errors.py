"""Error curves over time: units, scales, pins, verification and what the legend makes of them."""

import inspect
import math
from dataclasses import replace

import numpy as np
import pytest
from pydantic import ValidationError

from navcore.engine.measures import measure
from navcore.engine.simulation import simulate
from navcore.engine.verification import Verification, verify
from navcore.foundation.units import ARCSEC
from navcore.mechanization.recorder import NAMES
from navcore.quantities import limit_unit
from navcore.scenario.file import load
from navcore.scenario.requirement import Requirement
from schuler_bench.plots import style
from schuler_bench.plots.legend import STATES, after
from schuler_bench.plots.uplot import stack_heights
from schuler_bench.session.display import Display
from schuler_bench.session.requirements import LimitLine, asked, error_limits
from schuler_bench.session.shown import Shown, Verified
from schuler_bench.views.errors.figure import GROUPS, VERIFIED, Overlay, error_plots, verification_plots
from schuler_bench.views.errors.view import error_curves, legend_html, moving
from schuler_bench.views.learn.lessons import lessons
from tests.unit.figures_runs import Pinned, diverging, run_of, static_run

KEYS = ("phi_e", "phi_n", "phi_u", "dve", "dvn", "dlat", "dlon", "position")
LENGTHS = {"tilt": "tilt_max_arcsec", "velocity": "velocity_max_mps"}
"""Keys of the curves of a length, and the quantity that is its largest value."""


def test_keys_are_the_agreed_ones_and_every_group_uses_them() -> None:
    assert tuple(error_plots(static_run())) == (*LENGTHS, *KEYS)
    assert {key for keys in GROUPS.values() for key in keys} == {*LENGTHS, *KEYS}


@pytest.mark.parametrize("key", KEYS)
def test_curves_are_the_runs_in_the_labelled_unit_with_their_peaks(key: str) -> None:
    run, plot = static_run(), error_plots(static_run())[key]
    assert plot.names == ("free", "classic2", "compass") and plot.unit.name in plot.axes()[1]["label"]
    for curve, method in zip(plot.data[1:], run.methods, strict=True):
        values = method.plot.values[:, NAMES.index(plot.quantity)]
        np.testing.assert_allclose(curve * plot.unit.si, values, rtol=1e-12)
        peak = method.errors[plot.quantity]["max_abs"]
        assert np.max(np.abs(curve)) * plot.unit.si == pytest.approx(peak, rel=1e-9)


@pytest.mark.parametrize(
    ("run", "display", "unit", "end"),
    [
        (static_run, Display(), "h", 6.0),
        (static_run, Display(time="min"), "min", 360.0),
        (run_of, Display(), "min", 60.0),
    ],
)
def test_time_axis_runs_from_start_to_end_in_its_unit(run, display: Display, unit: str, end: float) -> None:
    plot = error_plots(run(), display=display)["phi_e"]
    assert (plot.time[0], plot.time[-1]) == pytest.approx((0.0, end))
    assert np.all(np.diff(plot.time) > 0.0) and plot.axes()[0]["label"] == f"time ({unit})"
    np.testing.assert_allclose(plot.time[1:-1] * plot.time_unit.si, run().methods[0].plot.t_s[1:-1])


def test_one_unit_for_each_family() -> None:
    units = {key: plot.unit for key, plot in error_plots(static_run()).items()}
    assert units["phi_e"] == units["phi_n"] and units["dve"] == units["dvn"]
    assert units["position"] == units["dlat"] == units["dlon"]


@pytest.mark.parametrize(
    ("choice", "key", "unit"),
    [
        ({"angle": "arcsec"}, "phi_u", "arcsec"),
        ({"angle": "arcmin"}, "phi_e", "arcmin"),
        ({"angle": "deg"}, "phi_e", "°"),
        ({"length": "nmi"}, "position", "nmi"),
        ({"speed": "kn"}, "dve", "kn"),
    ],
)
def test_curves_are_drawn_legibly_in_the_wanted_unit(choice: dict[str, str], key: str, unit: str) -> None:
    auto, wanted = (error_plots(static_run(), display=d)[key] for d in (Display(), Display(**choice)))
    assert wanted.unit.name.removeprefix("10⁻³ ") == unit and np.nanmax(np.abs(wanted.data[1])) >= 0.02
    np.testing.assert_allclose(wanted.data[1] * wanted.unit.si, auto.data[1] * auto.unit.si, rtol=1e-12)


def test_three_decimals_are_enough_on_every_axis() -> None:
    quiet = {"gyro_bias_dph": [0.0, 1e-6, 0.0]}
    run = run_of(imu=quiet, initial_error={}, reference={"kind": "none"}, method=[{"name": "free"}])
    for plot in error_plots(run).values():
        peak = np.max(np.abs(plot.data[1]))
        # what lies below a micrometre need not be legible
        assert peak >= 0.02 or peak * plot.unit.si < 1e-9, plot.key


def test_ended_method_is_padded_and_named_and_does_not_set_the_scale() -> None:
    whole, plot = (error_plots(run)["dve"] for run in (static_run(), diverging(static_run(), 0, rows=800)))
    ended, *others = plot.data[1:]
    assert plot.names[0] == "free (diverged)" and plot.unit == whole.unit
    assert np.isnan(ended[-1]) and np.nanmax(np.abs(ended)) <= 3.0 * np.max(np.abs(others))
    np.testing.assert_array_equal(others, whole.data[2:])
    alone = diverging(run_of(method=[{"name": "free"}]), 0, rows=100)
    assert np.isfinite(error_plots(alone)["phi_n"].data[1]).all()


def test_an_error_that_every_run_leaves_at_zero_is_said_to_be() -> None:
    labels = {key: plot.axes()[1]["label"] for key, plot in error_plots(simulate(load("zha-fast"))).items()}
    zero = {key for key, label in labels.items() if " = 0" in label}
    assert {"phi_n", "dve"} <= zero and not zero & {"phi_e", "dvn", "position"}
    assert labels["dve"].startswith("δVE = 0 (")


def test_viser_takes_the_arguments() -> None:
    from viser import GuiApi, uplot

    arguments = error_plots(static_run())["position"].kwargs(height=100)
    assert set(arguments) <= set(inspect.signature(GuiApi.add_uplot).parameters)
    assert len(arguments["series"]) == len(arguments["data"]) == 4
    for kind, parts in (
        (uplot.Series, arguments["series"]),
        (uplot.Axis, arguments["axes"]),
        (uplot.Scale, arguments["scales"].values()),
        (uplot.Cursor, [arguments["cursor"]]),
    ):
        assert all(set(part) <= set(kind.__annotations__) for part in parts)
    assert all(values.dtype == np.float64 and values.flags.c_contiguous for values in arguments["data"])


def test_configuration_is_equal_while_only_numbers_change() -> None:
    run = static_run()
    quieter = replace(run.methods[0].plot, values=run.methods[0].plot.values * 0.9)
    changed = replace(run, methods=(replace(run.methods[0], plot=quieter), *run.methods[1:]))
    first, again = (error_plots(each)["phi_e"] for each in (run, changed))
    for part in ("config_key", "axes"):
        assert getattr(first, part)() == getattr(again, part)()
    assert first.series == again.series and first.scales == again.scales
    assert not np.array_equal(first.data[1], again.data[1])


def test_colours_fonts_and_legend() -> None:
    plot = error_plots(static_run())["phi_u"]
    assert [series["stroke"] for series in plot.series[1:]] == [style.method_color(i) for i in range(3)]
    assert all("13px" in axis["font"] for axis in plot.axes())
    html = legend_html(run_of(method=[{"name": "<script>x"}]))
    assert "&lt;script&gt;x" in html and "<script>" not in html and style.method_color(0) in html


def test_stack_fills_the_height_and_leaves_room_for_the_time_labels() -> None:
    heights = stack_heights(400, 3)
    assert 396 <= sum(heights) <= 400 and heights[2] > heights[0] == heights[1]
    assert min(stack_heights(100, 6)) >= 84


@pytest.mark.parametrize("old", [False, True])
def test_strapdown_is_drawn_dashed_over_the_methods(old: bool) -> None:
    run = static_run()
    plot = error_plots(run, Overlay(run, old))["phi_e"]
    assert plot.names[3:] == tuple(f"{name}: full strapdown" for name in plot.names[:3])
    assert [bool(curve.dash) for curve in plot.curves] == [False] * 3 + [True] * 3
    assert (plot.curves[3].color == plot.curves[0].color) != old
    # the same bins: the same points
    np.testing.assert_array_equal(plot.data[4], plot.data[1])
    assert ("of an earlier scenario" in legend_html(run, Overlay(run, old))) == old
    assert "strapdown" not in legend_html(run)


def test_pins_and_overlays_with_other_bins_keep_their_peaks_and_end_where_they_end() -> None:
    run, shorter = static_run(), run_of()
    pin = Pinned("before <b>", "#C2185B", shorter)
    for plot in error_plots(run, Overlay(shorter, False), pins=(pin,)).values():
        own, pinned = plot.curves[:3], plot.curves[6:]
        assert [curve.name for curve in pinned] == [f"before <b>: {curve.name}" for curve in own]
        assert {curve.color for curve in pinned} == {pin.hex} and len(
            {curve.dash for curve in pinned} - {()}
        ) == 3
        assert max(curve.width for curve in pinned) < min(curve.width for curve in own)
        for curve, method in zip(plot.curves[3:], 2 * shorter.methods, strict=True):
            assert np.isnan(curve.values[plot.time > 1.1]).all()
            assert np.isfinite(curve.values[plot.time < 0.99]).all()
            if plot.key in LENGTHS:
                peak = measure(method, LENGTHS[plot.key])
            else:
                peak = method.errors[plot.quantity]["max_abs"]
            assert np.nanmax(np.abs(curve.values)) * plot.unit.si == pytest.approx(peak, rel=0.02)
    html = legend_html(run, None, (pin,))
    assert "before &lt;b&gt;: compass" in html and pin.hex in html


def test_limits_are_lines_at_both_signs_from_their_time_on() -> None:
    limits = {
        "phi_u": [LimitLine("heading_max_arcmin", 5e-4)],
        "tilt": [LimitLine("tilt_max_arcsec", 1e-4, 3600.0)],
    }
    plots = error_plots(static_run(), limits=limits)
    lines = {
        key: [curve.values[-1] * plot.unit.si for curve in plot.curves if curve.limit]
        for key, plot in plots.items()
    }
    drawn = {key: pytest.approx(values) for key, values in {"phi_u": [5e-4, -5e-4], "tilt": [1e-4]}.items()}
    assert {key: values for key, values in lines.items() if values} == drawn
    plot = plots["tilt"]
    line = plot.curves[-1]
    np.testing.assert_array_equal(np.isnan(line.values), plot.time * plot.time_unit.si < 3600.0 - 1e-6)
    quantity, size = line.limit or ("", 0.0)
    assert quantity == "tilt_max_arcsec" and size * line.values[-1] == pytest.approx(1e-4 / ARCSEC)


WATCHED = ("tilt_max_arcsec", "velocity_max_mps", "heading_max_arcmin", "position_max_m")
NOISY = {
    "run": {"duration_h": 6.0},
    "imu": {"gyro_bias_dph": [0.01, 0.02, 0.0], "accel_vrw_ugpshz": 50.0, "gyro_arw_dpsh": 0.005},
    "reference": {"kind": "log", "noise_mps": 0.3, "bias_mps": [0.3, -0.2]},
}


@pytest.mark.parametrize("part", [0.999, 1.001])
@pytest.mark.parametrize("from_h", [0.0, 2.5])
def test_a_curve_passes_a_limits_line_exactly_where_the_limit_is_missed(part: float, from_h: float) -> None:
    """The limit is on the vector; its lines were on each axis, and every curve inside them was "missed"."""
    blocks = [{"quantity": key, "at_most": 1.0, "from_h": from_h} for key in WATCHED]
    first = run_of(**NOISY, requirement=blocks)
    for key in WATCHED:
        for place, method in enumerate(first.methods):
            limit = part * measure(method, key, from_h * 3600.0)
            if not 0.0 < limit < math.inf:
                continue
            one = Requirement(quantity=key, at_most=limit / limit_unit(key), from_h=from_h)
            (verdict,) = asked(first, [one])
            ((where, lines),) = error_limits([one], first).items()
            plot = error_plots(first, limits={where: lines})[where]
            line = np.abs(plot.curves[-1].values)
            passed = np.any(np.abs(plot.curves[place].values) > line * (1.0 + 1e-9))
            assert passed == (verdict.words[place] == "missed"), (key, method.method.name)


def test_logarithmic_axis_shows_magnitudes_over_whole_decades() -> None:
    linear, log = (error_plots(static_run(), display=Display(scale=s))["dve"] for s in ("linear", "log"))
    first, last = log.decades or (0, 0)
    peak = max(np.max(np.abs(values)) for values in linear.data[1:])
    assert 10.0 ** (last - 1) < peak <= 10.0**last and last - first >= 3
    np.testing.assert_allclose(log.data[2], np.maximum(np.abs(linear.data[2]), 10.0**first))
    ticks = log.axes()[1]
    assert len(ticks["splits"]) == last - first + 1 and ticks["label"].startswith("|")
    assert log.scales["y"]["range"] == (10.0**first, 10.0**last) and log.config_key() != linear.config_key()


def test_clicks_go_through_all_states_and_come_back() -> None:
    display, seen = Display(), []
    for _ in STATES:
        display = display.with_(legend=display.clicked("free"))
        seen.append(display.state_of("free"))
    assert seen == [*STATES[1:], "shown"] and display == Display() and after("shown") == "unscaled"
    with pytest.raises(ValidationError):
        Display().with_(legend=[("free", "gone")])


@pytest.mark.parametrize("state", ["unscaled", "hidden"])
def test_what_is_off_the_scale_decides_no_unit_and_no_decade(state: str) -> None:
    run = static_run()
    whole = error_plots(run)["position"]
    largest = int(np.argmax([np.nanmax(np.abs(curve)) for curve in whole.data[1:]]))
    name = whole.names[largest]
    plot = error_plots(run, display=Display(legend=((name, state),), scale="log"))["position"]
    peak = max(float(np.nanmax(curve.values)) for curve in plot.curves if curve.name != name)
    assert plot.decades is not None and 10.0 ** plot.decades[1] < 10.0 * peak
    series = plot.series[1 + largest]
    assert series["auto"] is False and (series.get("show", True) is (state == "unscaled"))
    assert plot.config_key() != error_plots(run, display=Display(scale="log"))["position"].config_key()
    dimmed = error_plots(run, display=Display(legend=((name, "dimmed"),)))["position"]
    assert dimmed.series[1 + largest]["stroke"] == whole.curves[largest].color + "59"
    assert dimmed.unit == whole.unit


@pytest.fixture(scope="module")
def verified() -> Verification:
    return verify(load("sikuliaq-like", ["run.duration_h=0.3"]))


def test_the_curves_of_a_verified_run_stay_what_they_were(verified: Verification) -> None:
    run = simulate(load("sikuliaq-like", ["run.duration_h=0.3"]))
    before = error_curves(Shown(run, 1, Display()))
    after = error_curves(Shown(run, 1, Display(), verified=Verified(verified, old=False)))
    assert after.legend == before.legend
    for key, plot in before.plots.items():
        np.testing.assert_array_equal(plot.data, after.plots[key].data)


def test_the_difference_that_is_drawn_is_the_one_in_the_table(verified: Verification) -> None:
    plots = verification_plots(verified)
    assert list(plots) == [f"{which}_{key}" for key in VERIFIED for which in ("both", "difference")]
    for key in VERIFIED:
        difference, both = plots[f"difference_{key}"], plots[f"both_{key}"]
        assert [bool(curve.dash) for curve in both.curves] == [False] * 3 + [True] * 3
        drawn = [np.nanmax(np.abs(curve.values)) * difference.unit.si for curve in difference.curves]
        peaks = [differences[both.quantity].peak for differences in verified.differences]
        assert drawn == pytest.approx(peaks) and min(drawn) > 0.0


def test_a_step_of_a_lesson_leaves_out_what_is_zero_throughout() -> None:
    run = simulate(lessons()[0].scenario_of(0))
    plots = error_curves(Shown(run, 1, Display())).plots
    zero = [key for key, plot in plots.items() if not np.any(plot.curves[0].values)]
    assert zero and list(moving(plots)) == [key for key in plots if key not in zero]
    assert moving({key: plots[key] for key in zero}) == {key: plots[key] for key in zero}, (
        "else nothing is seen"
    )


def test_a_lesson_in_minutes_has_a_tick_at_every_swing() -> None:
    lesson = lessons()[0]
    run, action = simulate(lesson.scenario_of(0)), lesson.steps[0].action
    assert action is not None and action.display == {"time": "min"}
    shown = Display().with_(lesson=lesson.id, **action.display)
    swing = round(2.0 * np.pi / run.scenario.omega_s / 60.0, 1)
    assert swing == 84.4 or swing == 84.5
    for display, first in ((shown, swing), (Display(time="min"), 0.01), (Display(lesson=lesson.id), None)):
        axis = error_plots(run, display=display)["phi_e"].kwargs(height=300)["axes"][0]
        assert (axis["incrs"][0] == first) == (first is not None), display

from __future__ import annotations

import inspect
from dataclasses import replace

import numpy as np
import pytest

from app.plots import style
from app.plots.uplot import UplotFigure, stack_heights
from app.views.errors.figure import GROUPS, Overlay, error_plots
from app.views.errors.legend import legend_html
from navcore.mechanization.recorder import NAMES
from tests.unit.figures_runs import diverging, run_of, static_run

KEYS = ("phi_e", "phi_n", "phi_u", "dve", "dvn", "dlat", "dlon", "position")


def test_keys_are_the_agreed_ones_and_every_group_uses_them() -> None:
    assert tuple(error_plots(static_run())) == KEYS
    assert {key for keys in GROUPS.values() for key in keys} == set(KEYS)


@pytest.mark.parametrize("key", KEYS)
def test_curves_are_the_runs_in_the_labelled_unit(key: str) -> None:
    run = static_run()
    plot = error_plots(run)[key]
    column = NAMES.index(plot.quantity)
    for curve, method in zip(plot.data[1:], run.methods, strict=True):
        np.testing.assert_allclose(curve * plot.unit.si, method.plot.values[:, column], rtol=1e-12)
    assert plot.names == ("free", "classic2", "compass")
    assert plot.unit.name in plot.axes()[1]["label"]


def test_time_axis_runs_from_start_to_end_in_hours() -> None:
    time = error_plots(static_run())["phi_e"].data[0]
    assert time[0] == 0.0
    assert time[-1] == pytest.approx(6.0)
    assert np.all(np.diff(time) > 0.0)
    np.testing.assert_allclose(time[1:-1] * 3600.0, static_run().methods[0].plot.t_s[1:-1])


def test_short_run_is_shown_in_minutes() -> None:
    plot = error_plots(run_of())["phi_e"]
    assert plot.time_unit.name == "min"
    assert plot.data[0][-1] == pytest.approx(60.0)
    assert plot.axes()[0]["label"] == "time (min)"


def test_peak_of_a_curve_is_the_peak_of_the_metrics() -> None:
    run = static_run()
    for plot in error_plots(run).values():
        for curve, method in zip(plot.data[1:], run.methods, strict=True):
            peak = method.errors[plot.quantity]["max_abs"]
            assert np.max(np.abs(curve)) * plot.unit.si == pytest.approx(peak, rel=1e-9)


def test_one_unit_for_each_family() -> None:
    plots = error_plots(static_run())
    assert plots["phi_e"].unit == plots["phi_n"].unit
    assert plots["dve"].unit == plots["dvn"].unit
    assert plots["position"].unit == plots["dlat"].unit == plots["dlon"].unit


def test_three_decimals_are_enough_on_every_axis() -> None:
    quiet = {"gyro_bias_dph": [0.0, 1e-6, 0.0]}
    run = run_of(imu=quiet, initial_error={}, reference={"kind": "none"}, method=[{"name": "free"}])
    for plot in error_plots(run).values():
        peak = np.max(np.abs(plot.data[1]))
        # what lies below a micrometre need not be legible
        assert peak >= 0.02 or peak * plot.unit.si < 1e-9, plot.key


def test_ended_method_is_padded_and_named_and_does_not_set_the_scale() -> None:
    run = diverging(static_run(), 0, rows=800)
    plots = error_plots(run)
    whole = error_plots(static_run())
    plot = plots["dve"]
    assert plot.names[0] == "free (diverged)"
    assert len({len(values) for values in plot.data}) == 1
    assert np.isnan(plot.data[1][-1]) and np.isfinite(plot.data[2]).all()
    assert plot.unit == whole["dve"].unit
    assert np.nanmax(np.abs(plot.data[1])) <= 3.0 * max(np.max(np.abs(values)) for values in plot.data[2:])
    np.testing.assert_array_equal(plot.data[2], whole["dve"].data[2])


def test_all_methods_diverged_is_still_drawn() -> None:
    run = run_of(method=[{"name": "free"}])
    plot = error_plots(diverging(run, 0, rows=100))["phi_n"]
    assert np.isfinite(plot.data[1]).all()


def test_viser_takes_the_arguments() -> None:
    from viser import GuiApi, uplot

    plot = error_plots(static_run())["position"]
    arguments = plot.kwargs(height=100)
    assert set(arguments) <= set(inspect.signature(GuiApi.add_uplot).parameters)
    assert len(arguments["series"]) == len(arguments["data"]) == 4
    assert all(set(series) <= set(uplot.Series.__annotations__) for series in arguments["series"])
    assert all(set(axis) <= set(uplot.Axis.__annotations__) for axis in arguments["axes"])
    assert all(set(scale) <= set(uplot.Scale.__annotations__) for scale in arguments["scales"].values())
    assert set(arguments["cursor"]) <= set(uplot.Cursor.__annotations__)
    assert all(values.dtype == np.float64 and values.flags.c_contiguous for values in arguments["data"])


def test_configuration_is_equal_while_only_numbers_change() -> None:
    run = static_run()
    quieter = replace(
        run.methods[0], plot=replace(run.methods[0].plot, values=run.methods[0].plot.values * 0.9)
    )
    again = error_plots(replace(run, methods=(quieter, *run.methods[1:])))["phi_e"]
    first = error_plots(run)["phi_e"]
    assert first.config_key() == again.config_key()
    assert first.series == again.series and first.axes() == again.axes() and first.scales == again.scales
    assert not np.array_equal(first.data[1], again.data[1])


def test_colours_fonts_and_legend() -> None:
    plot: UplotFigure = error_plots(static_run())["phi_u"]
    assert [series["stroke"] for series in plot.series[1:]] == [style.method_color(i) for i in range(3)]
    assert all("13px" in axis["font"] for axis in plot.axes())
    html = legend_html(run_of(method=[{"name": "<script>x"}]))
    assert "&lt;script&gt;x" in html and "<script>" not in html
    assert style.method_color(0) in html


def test_stack_fills_the_height_and_leaves_room_for_the_time_labels() -> None:
    heights = stack_heights(400, 3)
    assert sum(heights) <= 400 and sum(heights) >= 396
    assert heights[2] > heights[0] == heights[1]
    assert min(stack_heights(100, 6)) >= 84


def test_strapdown_is_drawn_dashed_over_the_methods() -> None:
    run = static_run()
    for old in (False, True):
        plots = error_plots(run, Overlay(run, old))
        plot = plots["phi_e"]
        assert plot.names[3:] == tuple(f"{name}: full strapdown" for name in plot.names[:3])
        assert [len(series.get("dash", ())) for series in plot.series[1:]] == [0, 0, 0, 2, 2, 2]
        assert (plot.curves[3].color == plot.curves[0].color) != old
        # the same bins: the same points
        np.testing.assert_array_equal(plot.data[4], plot.data[1])
        assert ("of an earlier scenario" in legend_html(run, Overlay(run, old))) == old
    assert "strapdown" not in legend_html(run)


def test_an_overlay_with_other_bins_keeps_its_peaks_and_ends_where_it_ends() -> None:
    run, shorter = static_run(), run_of()
    plot = error_plots(run, Overlay(shorter, False))["phi_e"]
    curve = plot.data[4]
    hours = plot.data[0]
    assert np.isnan(curve[hours > 1.1]).all() and np.isfinite(curve[hours < 0.99]).all()
    peak = shorter.methods[0].errors["phi_e_rad"]["max_abs"] / plot.unit.si
    assert np.nanmax(np.abs(curve)) == pytest.approx(peak, rel=0.02)

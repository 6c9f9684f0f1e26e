"""The objective over each parameter alone, against single settings; its picture."""

import math

import numpy as np
import pytest

from navcore.design.pareto import measured
from navcore.design.profile import profiles
from navcore.design.vary import tunable_fields
from navcore.foundation.errors import InputError
from navcore.scenario.file import load
from schuler_bench.plots.plotly_data import values_of
from schuler_bench.plots.saved import plotly_csv
from schuler_bench.views.tune.profiles import profiles_figure

SCENARIO = load("sikuliaq-like")
FIELDS = tunable_fields(SCENARIO, 2)


def test_an_objective_over_one_parameter_is_that_of_the_settings() -> None:
    told: list[float] = []
    found = profiles(SCENARIO, "tilt_rms", FIELDS, progress=told.append).curves
    assert [one.field for one in found] == list(FIELDS) and told == [0.5, 1.0]
    before = measured(SCENARIO, ("tilt_rms", "velocity_rms"), 2)[0]
    for one in found:
        assert (len(one.values), one.values[0], one.values[-1], one.log) == (21, 0.05, 2.0, True)
        assert one.now == (0.5, pytest.approx(before))
        place = 7
        name = one.field.removeprefix("method.2.")
        other = load("sikuliaq-like", [f"method.2.{name}={one.values[place]!r}"])
        assert one.found[place] == pytest.approx(measured(other, ("tilt_rms", "velocity_rms"), 2)[0])
        # the present setting lies on the curve
        on_curve = np.interp(math.log(0.5), np.log(one.values), one.found)
        assert on_curve == pytest.approx(before, rel=1e-2)


def test_it_stops_and_refuses_a_field_that_does_not_vary() -> None:
    assert profiles(SCENARIO, "tilt_rms", FIELDS, cancelled=lambda: True).curves == ()
    with pytest.raises(InputError, match="method.2.network.id"):
        profiles(SCENARIO, "tilt_rms", ["method.2.network.id"])


def test_settings_that_are_refused_leave_a_gap() -> None:
    scenario = load("sikuliaq-like", ["method.1.network.id=unity2"])
    found = profiles(scenario, "settling_s", tunable_fields(scenario, 1), whole=True).curves
    method = scenario.method[1]
    figure = profiles_figure(found, "settling_s", method, 1, 0.5)
    gaps = [math.isinf(value) for one in found for value in one.found]
    assert any(gaps) and not all(gaps)
    curves = [trace for trace in figure["data"] if trace["mode"] == "lines"]
    drawn = [value for trace in curves for value in values_of(trace["y"])]
    assert [value is None or not math.isfinite(value) for value in drawn] == gaps


def test_the_picture_has_a_panel_a_parameter_with_one_axis_for_the_objective() -> None:
    found = profiles(SCENARIO, "tilt_rms", FIELDS).curves
    figure = profiles_figure(found, "tilt_rms", SCENARIO.method[2], 2, 0.5)
    layout = figure["layout"]
    assert [layout[axis]["title"]["text"] for axis in ("xaxis", "xaxis2")] == [
        "damping ratio ζ",
        "damping ratio η",
    ]
    assert layout["yaxis2"]["matches"] == "y" and layout["annotations"][0]["text"].endswith("(arcsec)</b>")
    assert b",steady tilt RMS per axis (arcsec)," in plotly_csv(figure, [])
    assert layout["xaxis"]["domain"][1] < layout["xaxis2"]["domain"][0]
    assert layout["xaxis"]["ticktext"] == ["0.05", "0.1", "0.2", "0.5", "1", "2"]
    dots = [trace for trace in figure["data"] if trace["mode"] == "markers"]
    assert [(dot["x"], dot["legendgroup"]) for dot in dots] == [([0.5], "2"), ([0.5], "2")]

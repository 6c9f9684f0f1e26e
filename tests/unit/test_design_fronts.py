"""Pareto fronts: the picture, which point a click means, and what the point does to the scenario."""

import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from navcore.design.fronts import Pareto
from navcore.design.pareto import measured, pareto
from navcore.design.vary import read_varied
from navcore.engine.simulation import simulate
from navcore.foundation.errors import InputError
from navcore.foundation.units import ARCSEC
from navcore.networks.optimal import OptimalNetwork
from navcore.questions.pareto import ParetoQuestion
from navcore.scenario.file import load, to_toml
from navcore.scenario.model import Scenario
from schuler_bench.cli import main
from schuler_bench.editing.edits import with_network
from schuler_bench.plots.plotly_data import values_of
from schuler_bench.views.frequency.curves import optimal_reference
from schuler_bench.views.frequency.figure import bode
from schuler_bench.views.tune.finder import read_place
from schuler_bench.views.tune.fronts import fronts_figure, nearest
from schuler_bench.views.tune.setting import requirements_told
from tests.acceptance.test_design_values import set_a
from tests.limits import limits

OBJECTIVES = ("tilt_rms", "velocity_rms")


@pytest.fixture(scope="module")
def ship() -> Scenario:
    return load("sikuliaq-like")


@pytest.fixture(scope="module")
def found(ship: Scenario) -> Pareto:
    return pareto(ship, OBJECTIVES, 2, networks=("classic2", "classic3"))


def test_the_picture_has_a_curve_a_network_the_star_and_the_floor(ship: Scenario, found: Pareto) -> None:
    present = measured(ship, OBJECTIVES, 2)
    assert present is not None and present == found.present
    made = fronts_figure(found, OBJECTIVES, present, "complementary")
    traces = {trace["name"]: trace for trace in made["data"]}
    assert set(traces) == {"classic2", "classic3", "now: complementary"}
    assert traces["now: complementary"]["x"] == [pytest.approx(present[0] / ARCSEC)]
    assert traces["classic2"]["x"] == [pytest.approx(found.fronts["classic2"][0].values[0] / ARCSEC)]
    layout = made["layout"]
    assert found.floor[0] is not None
    dashed = [shape for shape in layout["shapes"] if shape["type"] == "line"]
    assert [line["x0"] for line in dashed[:1]] == [pytest.approx(found.floor[0] / ARCSEC)]
    for trace in made["data"]:
        for axis in "xy":
            low, high = layout[f"{axis}axis"]["range"]
            assert all(low < math.log10(value) < high for value in trace[axis])
    assert layout["meta"]["pick"]["panels"] == (("xaxis", "yaxis"),)


def test_a_point_whose_whole_system_grows_has_an_open_mark(found: Pareto) -> None:
    (classic3,) = found.fronts["classic3"]
    assert classic3.earth_growth > 0.0  # H'(0) > 0 (physics, docs/networks.md)
    decaying = replace(classic3, earth_growth=-1e-5, growth_per_s=-1e-5)
    other = replace(decaying, growth_per_s=1.0 / 7200.0)  # not the 24 h mode
    for point, symbol, told in (
        (classic3, "-open", "24 h mode grows"),
        (other, "-open", "24 h mode decays, e-folding 1.2 days<br>whole system grows by e in 2 h"),
        (decaying, "", "whole system does not grow"),
    ):
        one = replace(found, fronts={"classic3": (point,)}, floor=(None, None))
        made = fronts_figure(one, OBJECTIVES, None, "")
        (trace,) = made["data"]
        assert trace["marker"]["symbol"][0].removeprefix("square") == symbol
        assert told in trace["text"][0]
        said = [note["text"] for note in made["layout"]["annotations"]]
        assert said == (["open mark: its whole system grows"] if symbol else [])


@pytest.mark.slow
def test_fronts_stay_within_the_sliders_unless_asked(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    scenario = set_a({"id": "classic2"})
    fields = [f"method.0.network.{name}" for name in ("zeta", "r", "zeta2")]
    sliders = read_varied(set_a({"id": "unity2"}), fields)
    file = tmp_path / "ship.toml"
    file.write_text(to_toml(scenario), "utf-8")
    ends = []
    for flags in ([], ["--beyond-sliders"]):
        assert main(["pareto", str(file), "--network", "unity2", "--json", *flags]) == 0
        (front,) = json.loads(capsys.readouterr().out)["fronts"]
        points = front["points"]
        inside = [one.low <= p["network"][one.path[-1]] <= one.high for p in points for one in sliders]
        assert all(inside) is not bool(flags)
        ends.append(points[-1]["values"][1])
    assert ends[1] < 0.9 * ends[0]


@pytest.mark.slow
def test_the_end_of_a_front_over_the_run_is_found(ship: Scenario) -> None:
    """A dense search (1,586 runs) knows a velocity 5 % below what weighted searches alone find."""
    known = with_network(ship, 2, {"id": "unity2", "zeta": 5.0, "r": 1.01006, "zeta2": 3.988})
    best = measured(known, OBJECTIVES, 2, along=True)
    assert best is not None
    (points,) = pareto(ship, OBJECTIVES, 2, networks=["unity2"], along=True, whole=True).fronts.values()
    assert points[-1].values[1] <= 1.002 * best[1]


def test_a_click_means_the_nearest_point_and_nothing_far_from_all(found: Pareto) -> None:
    (point,) = found.fronts["classic3"]
    x, y = point.values[0] / ARCSEC, point.values[1]
    assert nearest(found, 1.01 * x, 0.99 * y) == ("classic3", point)
    with pytest.raises(InputError, match="near a point"):
        nearest(found, 10.0 * x, 10.0 * y)
    at_zero = replace(point, values=(0.0, *point.values[1:]))  # as with all errors 0
    assert nearest(replace(found, fronts={"none": (at_zero,)} | found.fronts), x, y) == ("classic3", point)
    with pytest.raises(InputError, match="near a point"):
        nearest(replace(found, fronts={"none": (at_zero,)}), x, y)
    assert read_place("3.5 0.1") == (3.5, 0.1)
    for bad in ("", "1", "1 -2", "nan 1", "a b", "1 2 3", "0 1", "1e999 1"):
        with pytest.raises(InputError):
            read_place(bad)


def test_a_point_changes_one_network_and_the_fronts_still_fit(ship: Scenario, found: Pareto) -> None:
    task = ParetoQuestion(scenario=ship, x=OBJECTIVES[0], y=OBJECTIVES[1], method=2)
    (point,) = found.fronts["classic3"]
    changed = with_network(ship, 2, point.network)
    assert changed.method[2].name == "classic3"  # "complementary" before: a name made from the network
    assert changed.method[2].network.id == "classic3" and changed.method[:2] == ship.method[:2]
    assert measured(changed, OBJECTIVES, 2) == pytest.approx(point.values)
    assert task.fits(changed) and task.fits(ship)
    louder = ship.model_copy(update={"reference": ship.reference.model_copy(update={"noise_mps": 1.0})})
    assert not task.fits(louder)
    with pytest.raises(InputError, match="no method with a network"):
        with_network(ship, 0, point.network)


def test_it_is_told_which_requirements_a_search_keeps() -> None:
    told = requirements_told(limits(settling_s=60.0, position_rms_m=100.0, tilt_max_arcsec=20.0))
    assert told == (
        "Requirements that are kept: settling ≤ 60 min, ensemble position RMS ≤ 100 m. "
        "Judged by runs alone: largest tilt of this run ≤ 20 arcsec."
    )
    assert requirements_told(()) == "No requirement is to be kept."


def test_the_optimal_network_is_a_dashed_reference_or_it_is_said_why_not(ship: Scenario) -> None:
    run = simulate(ship)
    reference = optimal_reference(ship)
    assert reference.network is not None and "optimal for these sensors" in reference.label
    traces = [t for t in bode(run, reference=reference)["data"] if t["legendgroup"] == "reference"]
    assert {trace["yaxis"] for trace in traces} == {"y", "y2", "y3", "y4"}
    omega, drawn = (np.array(values_of(traces[0][axis]), dtype=float) for axis in "xy")
    h = reference.network.response(omega)
    np.testing.assert_allclose(drawn, 20.0 * np.log10(np.abs(h)), atol=1e-4)
    figures = OptimalNetwork().with_sensors(ship.figures())
    np.testing.assert_allclose(reference.network.num, figures.transfer(ship.omega_s).num)
    silent = optimal_reference(load("zha-fast"))
    assert silent.network is None
    assert silent.label == "no optimal H: no random error of gyros and accelerometers and log"
    (name,) = {t["name"] for t in bode(run, reference=silent)["data"] if t["legendgroup"] == "reference"}
    assert name == silent.label

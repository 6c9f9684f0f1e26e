"""Presets of single items of the papers: each is the scenario from which the report makes its exhibit."""

from itertools import combinations
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from navcore.analysis import analyse
from navcore.engine.simulation import simulate
from navcore.foundation.units import DEG_PER_HOUR
from navcore.mechanization.recorder import PHI_E
from navcore.scenario.file import load
from navcore.scenario.model import Scenario
from tools.papers import liu_fig_11, liu_switching, sun_vehicle, zha_drive
from tools.papers.runs import Runs, scenario_of
from tools.papers.zha_roll import LAB_TILT, LABORATORY


def content(scenario: Scenario) -> dict[str, Any]:
    """What decides the run: all but titles, and of the view nothing."""
    data = scenario.canonical()
    return {key: value for key, value in data.items() if key not in ("title", "source", "view")}


def unnamed(scenario: Scenario) -> list[dict[str, Any]]:
    return [{**method, "name": ""} for method in scenario.canonical()["method"]]


@pytest.fixture
def unrun(monkeypatch: pytest.MonkeyPatch) -> Runs:
    """Runs of the exhibits that carry the scenario and nothing else."""
    for module in (liu_switching, liu_fig_11, sun_vehicle):
        monkeypatch.setattr(module, "simulate", lambda scenario: SimpleNamespace(scenario=scenario))
    return Runs()


def test_liu_step_is_the_scenario_of_figure_7(unrun: Runs) -> None:
    assert content(load("liu-step")) == content(liu_switching.fig_7(unrun).scenario)


def test_liu_switch_has_the_five_ways_to_come_back_of_figure_7(unrun: Runs) -> None:
    ways = [("hard", {}), ("keep", {}), ("ramp", {}), ("ramp", {"form": "as_printed"}), ("bumpless", {})]
    exhibits = [liu_switching.switched(unrun, name, **more).scenario for name, more in ways]
    preset = load("liu-switch")
    assert unnamed(preset) == [unnamed(scenario)[0] for scenario in exhibits]
    for scenario in exhibits:
        assert content(preset) | {"method": []} == content(scenario) | {"method": []}


def test_liu_days_is_the_scenario_of_figures_11_and_12(unrun: Runs) -> None:
    assert content(load("liu-days")) == content(liu_fig_11.long_run(unrun, 1).scenario)


def test_sun_vehicle_is_the_scenario_of_section_5_2(unrun: Runs) -> None:
    assert content(load("sun-vehicle")) == content(sun_vehicle.drive(unrun, 1).scenario)


def test_zha_laboratory_is_the_scenario_of_figure_5() -> None:
    assert content(load("zha-laboratory")) == content(scenario_of("zha-external", (*LABORATORY, LAB_TILT)))


def test_the_six_drives_of_zha_are_six_drives() -> None:
    """Not one drive with other seeds: roads, lengths and random errors differ, all else is the same."""
    drives = [content(load(name)) for name in zha_drive.PRESETS]
    for one, other in combinations(drives, 2):
        assert one["motion"] != other["motion"] and one["run"]["seed"] != other["run"]["seed"]
    for drive in drives:
        assert 2.0 <= drive["run"]["duration_h"] <= 3.0
        for block in ("imu", "reference", "method"):
            assert drive[block] == drives[0][block]
    assert len({drive["run"]["duration_h"] for drive in drives}) >= 5


@pytest.mark.parametrize("name", zha_drive.PRESETS)
def test_each_drive_of_zha_starts_levelled(name: str) -> None:
    """The initial tilt is what the accelerometers' biases leave: phi_E = -nabla_N/g, phi_N = nabla_E/g."""
    scenario = load(name)
    heading = np.radians(scenario.canonical()["motion"]["leg"][0]["heading_deg"])
    x, y, _ = 1e-6 * np.array(scenario.imu.accel_bias_ug)
    east, north = x * np.cos(heading) + y * np.sin(heading), y * np.cos(heading) - x * np.sin(heading)
    expected = np.degrees([-north, east]) * 60.0
    assert scenario.initial_error.attitude_arcmin[:2] == pytest.approx(expected, abs=0.04)


def test_k1_and_k2_leave_the_tilt_of_zha_8_and_k3_takes_it_out() -> None:
    scenario = load("zha-gains")
    drift = 0.01 * DEG_PER_HOUR
    run = simulate(scenario)
    for method in run.methods[1:]:
        network = method.method.network
        k1, k2, k3 = (getattr(network, name) for name in ("k1", "k2", "k3"))
        steady = 0.0 if k3 else -k1 / ((1.0 + k2) * scenario.omega_s**2) * drift
        assert method.rows[-1, PHI_E] == pytest.approx(steady, rel=2e-3, abs=1e-12), method.method.name
    alone = run.methods[1].method.network.transfer(scenario.omega_s)
    assert analyse(alone).damping_ratio == pytest.approx(0.7, rel=2e-3)

"""A voyage like a recorded one: legs in the place of the track, the fitted log, an IMU of the list."""

from pathlib import Path

import numpy as np
import pytest

from navcore.design.budget import budget
from navcore.engine.simulation import simulate
from navcore.fitting.course import fit_legs
from navcore.fitting.voyage import voyage_like
from navcore.foundation.assets import asset_path
from navcore.foundation.errors import InputError
from navcore.motion.legs import LegsMotion
from navcore.motion.truth import VE, VN
from navcore.questions.voyage import VoyageQuestion
from navcore.scenario.file import load
from navcore.scenario.model import Scenario
from tests.own_ins import on_ins
from tests.unit.test_own_ins_faults import recorded

COURSES = {
    "kind": "legs",
    "heading_deg": 40.0,
    "leg": [
        {"duration_s": 5400.0, "speed_mps": 6.0},
        {"duration_s": 5400.0, "heading_deg": 130.0, "turn_dps": 0.5},
        {"duration_s": 7200.0, "heading_deg": 250.0, "turn_dps": 0.5, "speed_mps": 8.0},
        {"duration_s": 7200.0, "heading_deg": 350.0, "turn_dps": 0.5},
    ],
}
SHIP = Path(__file__).parents[2] / "examples" / "voyage" / "ship.toml"


def test_legs_that_were_sailed_are_found_again() -> None:
    scenario = Scenario.parse({"motion": COURSES, "site": {"lat_deg": 54.0}})
    truth = scenario.motion.truth(2521, 10.0, scenario.site.site(), scenario.earth).values
    legs = fit_legs(np.arange(2521) * 10.0, truth[:, [VE, VN]], 0.5)
    assert [round(leg.heading_deg or 0.0) for leg in legs] == [40, 130, 250, 350]
    assert [leg.speed_mps for leg in legs] == pytest.approx([6.0, 6.0, 8.0, 8.0], abs=0.15)
    starts = np.cumsum([0.0, *(leg.duration_s for leg in legs[:-1])])
    assert starts == pytest.approx([0.0, 5400.0, 10800.0, 18000.0], abs=180.0)


def test_more_legs_follow_a_track_more_closely() -> None:
    t = np.arange(0.0, 7200.0, 10.0)
    heading = 3.0 * t / 7200.0
    velocity = 7.0 * np.column_stack([np.sin(heading), np.cos(heading)])
    few, many = (len(fit_legs(t, velocity, within)) for within in (1.0, 0.2))
    assert 1 < few < many
    assert len(fit_legs(t, velocity, 0.2, most=5)) == 5
    assert len(fit_legs(t, np.tile([3.0, 4.0], (len(t), 1)), 0.2)) == 1


def test_a_voyage_like_the_example_has_its_course_and_its_log() -> None:
    scenario = load(str(SHIP))
    found = voyage_like(scenario, hours=12.0)
    made = found.scenario
    assert isinstance(made.motion, LegsMotion) and made.motion.repeat == 3
    assert made.run.duration_h == 12.0 and made.reference.kind == "log"
    assert made.reference.delay_s == pytest.approx(20.0, abs=1.5)
    assert made.method == scenario.method and made.requirement == scenario.requirement
    assert made.imu == scenario.imu and made.initial_error == scenario.initial_error
    assert found.end_m < 500.0 and found.position_max_m < 1000.0 and found.velocity_rms_mps < 1.0
    run = simulate(made)
    assert run.status == "ok"
    recorded_run = simulate(scenario)
    assert run.truth[0, :2] == pytest.approx(recorded_run.truth[0, :2], abs=1e-5)
    assert budget(made).methods


def test_a_voyage_like_that_of_a_ships_own_ins() -> None:
    folder = asset_path("recordings")
    names = {"ins": "own-ins.csv", "log": "own-ins-log.csv", "truth": "own-ins-gnss.csv"}
    files = {kind: str(folder / name) for kind, name in names.items()}
    methods = [{"name": "unity2", "damping": "external", "network": "unity2"}]
    found = voyage_like(on_ins(files, methods))
    made = found.scenario
    assert not made.on_ins and made.run.duration_h == pytest.approx(6.0, abs=0.01)
    assert isinstance(made.motion, LegsMotion)
    assert made.motion.leg[0].heading_deg == pytest.approx(40.0, abs=1.0)
    assert made.motion.leg[0].speed_mps == pytest.approx(6.0, abs=0.2)
    # tools.own_ins_lesson gives the log these errors; on so few speeds bias and scale are hardly told apart
    at_7_mps = made.reference.bias_mps[1] + 7e-6 * made.reference.scale_ppm
    assert at_7_mps == pytest.approx(0.1 + 7.0 * 0.003, abs=0.02)
    assert made.reference.noise_mps == pytest.approx(0.05, rel=0.1)
    assert made.imu == Scenario().imu
    without = voyage_like(on_ins(files, methods, truth=False))
    assert without.velocity_rms_mps < 1.0


def test_a_log_that_does_not_follow_the_ship_is_no_scale_error(tmp_path: Path) -> None:
    files = recorded(tmp_path)
    scenario = on_ins(files, [{"name": "unity2", "damping": "external", "network": "unity2"}], truth=False)
    with pytest.raises(InputError, match="no scale error"):
        voyage_like(scenario)


def test_the_question_writes_a_scenario_that_runs(tmp_path: Path) -> None:
    question = VoyageQuestion.ask({"scenario": str(SHIP), "hours": 2.0, "imu": "Honeywell HG9900"})
    with pytest.raises(InputError, match="accel_vrw_ugpshz"):
        question.answer()
    question = VoyageQuestion.ask({"scenario": str(SHIP), "hours": 2.0})
    answer = question.answer()
    path = tmp_path / "voyage.toml"
    question.write(answer, path)
    assert load(str(path)) == answer.scenario
    assert answer.plays() and set(answer.played(0)) == {"voyage.toml"}
    assert answer.document()["legs"] == answer.legs and "log" in answer.document()


def test_what_has_no_track_is_refused() -> None:
    with pytest.raises(InputError, match=r"motion\.kind"):
        voyage_like(load("zha-fast"))

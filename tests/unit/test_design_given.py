"""Errors that are given as numbers add up with their signs in a budget, as they do in a run."""

from typing import Any

import numpy as np
import pytest

from navcore import budget, simulate
from navcore.design.figures import mean_figures
from navcore.design.ship import Ship
from navcore.scenario.model import Scenario

CLASSIC = {"damping": "external", "network": {"id": "classic2"}}
NORTHWARD = {"kind": "legs", "leg": [{"duration_s": 1e6, "speed_mps": 10.0, "heading_deg": 0.0}]}
TURNING = {
    "kind": "legs",
    "leg": [
        {"duration_s": 7200.0, "speed_mps": 6.0, "heading_deg": 30.0},
        {"duration_s": 7200.0, "heading_deg": 140.0, "speed_mps": 8.0},
        {"duration_s": 1e6, "heading_deg": 300.0},
    ],
}


def scenario(hours: float = 12.0, **blocks: Any) -> Scenario:
    run = {"duration_h": hours, "output_step_s": 60.0, "earth": "wgs84"}
    site = {"lat_deg": 45.0, "lon_deg": 10.0}
    return Scenario.parse({"run": run, "site": site, **blocks})


def root_mean_squares(made: Scenario) -> list[list[float]]:
    """Tilt, velocity, heading and position of each method, in runs."""
    return [list(vars(mean_figures(m.t_s, m.rows[:, :7] ** 2)).values()) for m in simulate(made).methods]


def figures(made: Scenario, **options: Any) -> list[list[float]]:
    return [list(vars(method.total.rms).values()) for method in budget(made, **options).methods]


@pytest.mark.parametrize("current", [-0.2, 0.2])
def test_a_current_that_cancels_the_scale_error_cancels_it_in_the_budget(current: float) -> None:
    log = {"kind": "log", "frame": "enu", "scale_ppm": 20_000.0, "current_mps": [0.0, -current]}
    made = scenario(motion=NORTHWARD, reference=log, method=[CLASSIC])
    (tilt, velocity, _, position), ran = figures(made)[0], root_mean_squares(made)[0]
    if current < 0.0:
        assert velocity < 0.01 and position < 200.0
    else:
        assert velocity > 0.02 and position > 300.0
        assert [tilt, velocity, position] == pytest.approx([ran[0], ran[1], ran[3]], rel=0.02)


def test_the_budget_of_given_numbers_is_the_run() -> None:
    """Nothing is random: biases, errors at the start, scale, current, tide, events, with both signs."""
    log = {
        "kind": "log",
        "frame": "body",
        "bias_mps": [0.15, -0.1],
        "scale_ppm": 8000.0,
        "current_mps": [-0.2, 0.3],
        "tide_mps": [0.3, -0.2],
        "tide_phase_deg": 70.0,
        "event": [{"t_h": 3.0, "duration_s": 100.0, "accel_mps2": [0.003, -0.002]}],
    }
    made = scenario(
        motion=TURNING,
        imu={
            "gyro_bias_dph": [0.01, -0.006, 0.004],
            "accel_bias_ug": [30.0, -50.0, 0.0],
            "gyro_scale_ppm": [20.0, -10.0, 30.0],
        },
        initial_error={
            "attitude_arcmin": [0.3, -0.2, 3.0],
            "velocity_mps": [0.1, 0.2],
            "position_arcsec": [3.0, -4.0],
        },
        reference=log,
        method=[
            CLASSIC,
            {"name": "c", "damping": "external", "network": {"id": "compass", "sigma": 0.0015, "xi": 0.7}},
            {"name": "u", "damping": "external", "network": {"id": "unity2"}, "azimuth": {"id": "unity2"}},
            {"name": "free"},
        ],
    )
    for method, ran in zip(figures(made), root_mean_squares(made), strict=True):
        assert method == pytest.approx(ran, rel=0.02)


def test_a_stated_deviation_counts_in_variance_and_a_number_with_its_sign() -> None:
    """The same sizes: two numbers that act against each other, then two deviations."""
    log = {"kind": "log", "frame": "enu"}
    numbers = scenario(reference={**log, "bias_mps": [0.1, 0.0], "current_mps": [0.1, 0.0]}, method=[CLASSIC])
    stated = scenario(reference={**log, "bias_std_mps": 0.1, "current_mps": [0.1, 0.0]}, method=[CLASSIC])
    assert figures(numbers)[0][1] < 1e-6 < 1e-3 < figures(stated)[0][1]
    drawn = Ship(numbers, drawn=True)  # as the seeds of a design draw it
    assert drawn.along(numbers.method[0]).total[-1, 3] > 1e-6


@pytest.mark.parametrize("stated", [False, True])
def test_a_policy_has_the_constants_in_its_budget_that_other_methods_have(stated: bool) -> None:
    """A policy that never switches is its network: by runs it has the errors that the covariance has."""
    never = {"name": "never", "policy": {"id": "threshold", "limit_mps": 50.0}}
    constants = (
        {
            "imu": {"gyro_bias_std_dph": 0.01, "accel_bias_std_ug": 50.0},
            "initial_error": {"level_std_arcmin": 1.0, "velocity_std_mps": 0.2},
        }
        if stated
        else {
            "imu": {"gyro_bias_dph": [0.01, -0.02, 0.01], "accel_bias_ug": [50.0, 20.0, 0.0]},
            "initial_error": {"attitude_arcmin": [1.0, -1.0, 0.0], "velocity_mps": [0.2, 0.0]},
        }
    )
    made = scenario(6.0, reference={"kind": "log"}, method=[CLASSIC, CLASSIC | never], **constants)
    seeds = 300 if stated else 2
    covariance, runs = figures(made, seeds=seeds)
    ratio = np.array(runs) / np.array(covariance)
    # the deviation of 300 draws is known to 4.1 %
    assert np.all(np.abs(ratio - 1.0) < (4.0 * 0.041 if stated else 0.01))


def test_what_an_alignment_leaves_is_in_the_budget_of_a_policy() -> None:
    never = {"name": "never", "policy": {"id": "threshold", "limit_mps": 50.0}}
    made = Scenario.parse(
        {
            "run": {"fidelity": "strapdown", "duration_h": 2.0, "rate_hz": 10.0, "output_step_s": 60.0},
            "site": {"lat_deg": 45.0},
            "alignment": {"kind": "compass", "duration_s": 600.0},
            "imu": {"gyro_bias_dph": [0.01, 0.02, 0.005], "accel_bias_ug": [40.0, 30.0, 0.0]},
            "reference": {"kind": "log"},
            "method": [CLASSIC, CLASSIC | never],
        }
    )
    covariance, runs = figures(made, seeds=2)
    assert runs == pytest.approx(covariance, rel=0.01)

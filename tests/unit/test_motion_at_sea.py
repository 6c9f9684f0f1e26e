"""Waves on a course: those of the motion `waves` where it is steady, met anew after each turn."""

from typing import Any

import numpy as np
import pytest

from navcore.engine.simulation import simulate
from navcore.foundation.earth import WGS84
from navcore.foundation.errors import InputError
from navcore.foundation.units import DEG
from navcore.motion import LegsMotion, ProfileMotion, WavesMotion
from navcore.motion.truth import AE, AN, AU, HEADING, HEIGHT, LAT, PITCH, ROLL, VE, VN, VU, Site
from navcore.scenario.model import Scenario

SITE = Site(75.0 * DEG, 0.3, 0.0)
SEA: dict[str, Any] = {"height_m": 3.0, "peak_period_s": 9.0, "direction_deg": 300.0}
STEADY = {"duration_s": 1e4, "speed_mps": 4.0, "heading_deg": 40.0}


@pytest.mark.parametrize(
    "motion",
    [
        LegsMotion(leg=(STEADY,), waves=SEA),
        ProfileMotion(point=({"speed_mps": 4.0, "course_deg": 40.0},), waves=SEA),
    ],
    ids=["legs", "profile"],
)
def test_a_steady_course_has_the_waves_of_the_motion_waves(motion: LegsMotion | ProfileMotion):
    found = motion.truth(2401, 0.25, SITE, WGS84).values
    meant = WavesMotion(**SEA, speed_mps=4.0, heading_deg=40.0).truth(2401, 0.25, SITE, WGS84).values
    for column in (PITCH, ROLL, HEADING, HEIGHT, VU, AU):
        scale = np.ptp(meant[:, column])
        assert scale > 0.0
        assert np.abs(found[:, column] - meant[:, column]).max() < 0.01 * scale
    assert found[:, LAT] == pytest.approx(meant[:, LAT], abs=1e-9)
    assert found[:, [VE, VN]] == pytest.approx(meant[:, [VE, VN]], abs=1e-3)
    assert np.abs(found[:, [AE, AN]]).max() < 2e-3


def test_waves_are_met_as_the_heading_lets_them():
    legs = ({"duration_s": 1200.0, "speed_mps": 4.0, "heading_deg": 300.0}, {"duration_s": 1200.0})
    legs = (*legs[:1], legs[1] | {"heading_deg": 30.0})
    values = LegsMotion(leg=legs, waves=SEA | {"spread_deg": 0.0}).truth(9601, 0.25, SITE, WGS84).values
    ahead, abeam = values[:4000], values[5600:]
    assert ahead[:, PITCH].std() > 5.0 * abeam[:, PITCH].std()
    assert abeam[:, ROLL].std() > 5.0 * ahead[:, ROLL].std()
    crossings = [np.count_nonzero(np.diff(np.sign(part[:, HEIGHT]))) for part in (ahead, abeam)]
    assert crossings[0] > 1.2 * crossings[1]


def test_a_calm_sea_leaves_a_course_as_it_is():
    calm = LegsMotion(leg=(STEADY, {"heading_deg": 90.0}))
    assert np.array_equal(
        calm.truth(600, 1.0, SITE, WGS84).values, calm.calm_truth(600, 1.0, SITE, WGS84).values
    )


def test_both_fidelities_agree_on_survey_lines_in_waves():
    data: dict[str, Any] = {
        "run": {"duration_h": 0.7, "rate_hz": 50.0, "step_s": 0.5},
        "site": {"lat_deg": 70.0},
        "motion": {
            "kind": "legs",
            "leg": [{"duration_s": 600.0, "speed_mps": 4.0}, {"duration_s": 600.0, "heading_deg": 180.0}],
            "repeat": 2,
            "waves": SEA,
        },
        "imu": {"gyro_bias_dph": [0.02, -0.02, 0.02], "accel_bias_ug": [30.0, 30.0, 30.0]},
        "reference": {"kind": "log", "frame": "body", "bias_mps": [0.1, 0.1]},
        "method": [{"damping": "external", "network": {"id": "classic2"}}],
    }
    linear = simulate(Scenario.parse(data)).methods[0].rows
    data["run"]["fidelity"] = "strapdown"
    full = simulate(Scenario.parse(data)).methods[0].rows
    scale = np.abs(linear[:, :5]).max(axis=0)
    assert (np.abs(full[:, :5] - linear[:, :5]).max(axis=0) < 0.05 * scale).all()


@pytest.mark.parametrize(
    ("waves", "run", "field"),
    [
        ({"height_m": -1.0}, {}, "motion.waves.height_m"),
        ({"height_m": 20.0, "peak_period_s": 4.0, "pitch_gain": 5.0}, {}, "motion.waves.height_m"),
        ({"height_m": 0.5, "peak_period_s": 3.0}, {"fidelity": "strapdown", "rate_hz": 10.0}, "run.rate_hz"),
    ],
)
def test_what_cannot_be_is_refused(waves: dict[str, Any], run: dict[str, Any], field: str):
    motion = {"kind": "legs", "leg": [{"speed_mps": 4.0}], "waves": waves}
    with pytest.raises(InputError) as refused:
        Scenario.parse({"motion": motion, "run": run})
    assert [fault.field for fault in refused.value.faults] == [field]


def test_waves_too_short_for_the_step_are_refused():
    motion = {"kind": "legs", "leg": [{"speed_mps": 4.0}], "waves": SEA}
    with pytest.raises(InputError) as refused:
        simulate(Scenario.parse({"motion": motion, "run": {"duration_h": 0.1, "step_s": 10.0}}))
    assert refused.value.faults[0].field == "motion.waves.peak_period_s"


def test_an_alignment_lies_stopped_in_the_same_sea():
    motion = LegsMotion(leg=(STEADY,), waves=SEA, roll_deg=2.0)
    before = motion.before_start(motion.truth(1, 0.1, SITE, WGS84).values[0], 600.0)
    assert isinstance(before, WavesMotion)
    meant = WavesMotion(**SEA, heading_deg=40.0, roll_deg=2.0)
    found = before.truth(600, 0.5, SITE, WGS84).values
    assert found == pytest.approx(meant.truth(600, 0.5, SITE, WGS84).values, abs=1e-9)

"""Changes of depth of a course: heights, what the level channels feel, and what is refused."""

from typing import Any

import numpy as np
import pytest

from navcore.design.ship import Ship
from navcore.engine.simulation import simulate
from navcore.foundation.earth import WGS84
from navcore.foundation.errors import InputError
from navcore.mechanization.trajectory import coefficients
from navcore.motion import LegsMotion
from navcore.motion.truth import AE, AN, AU, HEIGHT, LAT, VE, VN, VU, Site, Truth
from navcore.scenario.model import Scenario

SITE = Site(1.0, 0.3, 0.0)
LEGS: list[dict[str, Any]] = [
    {"duration_s": 1200.0, "speed_mps": 2.5, "heading_deg": 30.0, "depth_m": 50.0},
    {"duration_s": 1200.0, "depth_m": 250.0, "dive_mps": 1.0},
    {"duration_s": 1200.0, "heading_deg": 120.0, "depth_m": 20.0},
]


def test_the_depth_is_reached_at_its_speed():
    values = LegsMotion(leg=LEGS).truth(3601, 1.0, SITE, WGS84).values
    assert values[[0, 1199, 1300, 1400, 2399, 2400, 2860, 3600], HEIGHT] == pytest.approx(
        [-50.0, -50.0, -150.0, -250.0, -250.0, -250.0, -20.0, -20.0], abs=0.02
    )
    assert values[:, VU].min() == pytest.approx(-2.0, rel=1e-3)
    assert values[:, VU].max() == pytest.approx(1.0, rel=1e-3)
    steps = np.diff(values[:, HEIGHT])
    assert steps == pytest.approx(0.5 * (values[1:, VU] + values[:-1, VU]), abs=1e-3)
    assert np.diff(values[:, VU]) == pytest.approx(0.5 * (values[1:, AU] + values[:-1, AU]), abs=3e-4)


def test_the_course_stays():
    dived = LegsMotion(leg=LEGS).truth(3601, 1.0, SITE, WGS84).values
    shallow = [{name: leg[name] for name in leg if name not in ("depth_m", "dive_mps")} for leg in LEGS]
    level = LegsMotion(leg=shallow).truth(3601, 1.0, SITE, WGS84).values
    assert dived[:, [VE, VN]] == pytest.approx(level[:, [VE, VN]], abs=2e-3)
    assert dived[:, LAT] == pytest.approx(level[:, LAT], abs=1e-9)
    at_no_depth = LegsMotion(leg=[leg | {"depth_m": 0.0} for leg in shallow])
    assert np.array_equal(at_no_depth.truth(3601, 1.0, SITE, WGS84).values, level)


def test_the_level_channels_feel_the_vertical_speed():
    values = LegsMotion(leg=LEGS).truth(3601, 1.0, SITE, WGS84).values
    half = coefficients(Truth(1.0, values), WGS84, True).half
    row = int(np.argmin(values[:, VU]))
    coriolis = 2.0 * 7.292115e-5 * np.cos(values[row, LAT]) * values[row, VU]
    turning = half["earth_u"][row] + half["w_u"][row]
    assert half["f_e"][row] - values[row, AE] + turning * values[row, VN] == pytest.approx(coriolis, rel=5e-3)
    assert abs(half["f_n"][row] - values[row, AN] - turning * values[row, VE]) < 0.01 * abs(coriolis)


def test_both_fidelities_and_the_budget_agree():
    data: dict[str, Any] = {
        "run": {"duration_h": 2.0, "rate_hz": 50.0, "vertical": "altimeter"},
        "site": {"lat_deg": 60.0},
        "motion": {"kind": "legs", "leg": LEGS, "repeat": 2},
        "imu": {"gyro_bias_dph": [0.02, 0.0, 0.0]},
        "reference": {"kind": "log"},
        "method": [{"name": "free"}, {"damping": "external", "network": {"id": "classic2"}}],
    }
    full = simulate(Scenario.parse(data | {"run": data["run"] | {"fidelity": "strapdown"}})).methods
    del data["run"]["vertical"]
    scenario = Scenario.parse(data)
    for linear, complete in zip(simulate(scenario).methods, full, strict=True):
        scale = np.abs(linear.rows[:, :5]).max(axis=0)
        assert (np.abs(complete.rows[:, :5] - linear.rows[:, :5]).max(axis=0) < 0.03 * scale).all()
        assert complete.navigation is not None
    expected = Ship(scenario).along(scenario.method[1])
    run = simulate(scenario).methods[1].rows
    places = np.rint(expected.t_s / 10.0).astype(int)
    velocity = np.sqrt(expected.total[:, 3])
    assert velocity == pytest.approx(np.abs(run[places, 3]), abs=0.04 * velocity.max())


@pytest.mark.parametrize(
    ("leg", "run", "field", "allowed"),
    [
        ({"depth_m": -5.0}, {}, "motion.leg.1.depth_m", "must be >= 0 and <= 12000 (m)"),
        ({"depth_m": 400.0, "duration_s": 60.0}, {}, "motion.leg.1.depth_m", "takes 800 s"),
        ({"depth_m": 4.0, "dive_mps": 0.0}, {}, "motion.leg.1.dive_mps", "must be > 0 and <= 20 (m/s)"),
        ({"depth_m": 40.0}, {"fidelity": "strapdown"}, "run.vertical", 'must be "altimeter"'),
    ],
)
def test_what_cannot_be_is_refused(leg: dict[str, Any], run: dict[str, Any], field: str, allowed: str):
    with pytest.raises(InputError) as refused:
        Scenario.parse({"run": run, "motion": {"kind": "legs", "leg": [{}, leg]}})
    (fault,) = refused.value.faults
    assert fault.field == field
    assert allowed in str(fault.allowed)


def test_waves_fade_with_depth():
    waves = {"height_m": 3.0, "peak_period_s": 9.0}
    rolls = [
        LegsMotion(leg=[{"duration_s": 1e4, "speed_mps": 2.0, "depth_m": depth}], waves=waves)
        .truth(2401, 0.25, SITE, WGS84)
        .values[:, 11]
        for depth in (0.0, 20.0, 200.0)
    ]
    size = [roll.std() for roll in rolls]
    assert 0.2 * size[0] < size[1] < 0.7 * size[0]
    assert size[2] < 1e-3 * size[0]

"""Signs and sizes that a run must have, from closed formulas: what golden files alone would notice."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from navcore.engine.run import MethodRun
from navcore.engine.simulation import simulate
from navcore.foundation.earth import EARTH_RATE, WGS84
from navcore.foundation.units import ARCMIN, ARCSEC, DEG, MICRO_G
from navcore.mechanization.recorder import NAMES
from navcore.mechanization.trajectory import coefficients
from navcore.motion.inertial import inertial_signals
from navcore.motion.truth import AE, AN, AU, COLUMNS, HEIGHT, LAT, VE, VN, VU, Truth
from navcore.scenario.model import Scenario
from navcore.sensors.log import reference_errors
from navcore.sensors.reference import Reference

CLASSIC = {"damping": "external", "network": {"id": "classic2"}}
COMPASS = {"damping": "external", "network": {"id": "compass"}}
BOTH = pytest.mark.parametrize("fidelity", ["error_model", "strapdown"])
DRIVE = {"kind": "legs", "heading_deg": 90.0, "leg": [{"duration_s": 7200.0, "speed_mps": 10.0}]}


def run_of(given: dict[str, Any]) -> MethodRun:
    [method] = simulate(Scenario.parse(given)).methods
    assert method.status == "ok"
    return method


def column(method: MethodRun, name: str) -> np.ndarray:
    return method.rows[:, NAMES.index(name)]


def given(fidelity: str, duration_s: float, **blocks: Any) -> dict[str, Any]:
    run = {"fidelity": fidelity, "duration_h": duration_s / 3600.0, "output_step_s": 1.0, "rate_hz": 20.0}
    run |= blocks.pop("run", {})
    return {"run": run, "site": {"lat_deg": 45.0, "lon_deg": 0.0}} | blocks


# ---------------------------------------------------------------- the log


def recorded_log(folder: Path, columns: str, rows: np.ndarray) -> str:
    path = folder / "log.csv"
    lines = [columns, *(",".join(f"{value:.9g}" for value in row) for row in rows)]
    path.write_text("\n".join(lines) + "\n", "utf-8")
    return str(path)


@BOTH
def test_a_method_is_undamped_in_a_recorded_gap_from_its_first_missing_reading_on(fidelity, tmp_path):
    """A gap is longer than three intervals and than 5 s; the whole recording is at hand."""
    t = np.concatenate([np.arange(0.0, 101.0), np.arange(160.0, 301.0)])
    log = recorded_log(tmp_path, "t_s,ve_mps,vn_mps", np.column_stack([t, 0.0 * t, 0.0 * t]))
    method = run_of(given(fidelity, 300.0, reference={"kind": "file", "file": log}, method=[CLASSIC]))
    undamped = method.t_s[method.law_series[:, 1] < 0.5]
    np.testing.assert_allclose([undamped[0], undamped[-1]], [101.0, 159.0])
    assert len(undamped) == 59


def test_a_log_that_turns_with_the_ship_is_turned_by_the_heading_of_its_own_time(tmp_path):
    """5 m/s ahead while the recorded heading turns by 0.5 deg/s: V_r is right to the millimetre a second."""
    t = np.arange(0.0, 301.0)
    heading = 10.0 + 0.5 * t
    log = recorded_log(tmp_path, "t_s,speed_mps,heading_deg", np.column_stack([t, 5.0 + 0.0 * t, heading]))
    reference = {"kind": "file", "file": log, "frame": "enu"}
    standing = Truth(1.0, np.zeros((1, COLUMNS)))
    errors = reference_errors(Reference.model_validate(reference), standing, 300.0, 1)
    wanted = 5.0 * np.column_stack([np.sin(heading * DEG), np.cos(heading * DEG)])
    np.testing.assert_allclose(errors.error, wanted, atol=1e-3)


@BOTH
def test_a_body_log_is_turned_by_the_computed_heading(fidelity):
    """dV_rE = +phi_U V_N, dV_rN = -phi_U V_E (theory.md 2): 30' at 10 m/s east is -0.087 m/s north."""
    tilt = {"attitude_arcmin": [0.0, 0.0, 30.0]}
    log = {"kind": "log", "frame": "body"}
    for heading, quantity, sign in ((90.0, "dvn_mps", -1.0), (0.0, "dve_mps", 1.0)):
        motion = DRIVE | {"heading_deg": heading}
        scenario = given(fidelity, 3600.0, motion=motion, initial_error=tilt, reference=log, method=[COMPASS])
        method = run_of(scenario)
        late = method.t_s > 1800.0
        phi_u = column(method, "phi_u_rad")[late]
        wanted = sign * phi_u * 10.0
        np.testing.assert_allclose(column(method, quantity)[late], wanted, atol=0.05 * np.abs(wanted).max())


def test_the_variation_policy_waits_until_its_windows_are_full():
    """Liu's s compares two means; before n + t0 = 100 s there is no earlier one, and s is 0."""
    log = {"kind": "log", "bias_mps": [1.0, 0.0], "event": [{"t_h": 40.0 / 3600.0, "duration_s": 1.0,
           "accel_mps2": [1.0, 0.0]}]}  # fmt: skip
    policy = {"policy": {"id": "variation"}, "network": {"id": "complementary"}, "damping": "external"}
    method = run_of(given("error_model", 400.0, reference=log, method=[policy]))
    measure, damped = method.law_series[:, 3], method.law_series[:, 1] > 0.5
    assert np.all(measure[method.t_s < 99.0] == 0.0)
    assert np.all(damped[method.t_s < 99.0])
    # the mean over 20 s has stepped by 1 m/s against that of 80 s before: s is 1 until the step is 80 s old
    assert measure[method.t_s == 110.0][0] == pytest.approx(1.0, abs=0.05)
    assert measure[method.t_s == 150.0][0] == pytest.approx(0.0, abs=0.05)


# ---------------------------------------------------------------- Coriolis and the vertical channel


def test_specific_force_is_acceleration_plus_coriolis_minus_gravity():
    """f = a + (2 omega_ie + omega_en) x V - g, all three components, from a cross product written out."""
    row = np.zeros((1, COLUMNS))
    row[0, [LAT, HEIGHT]] = 0.7, 3000.0
    row[0, [VE, VN, VU]] = 200.0, -120.0, 30.0
    row[0, [AE, AN, AU]] = 0.3, -0.2, 0.1
    m, n = (radius + 3000.0 for radius in WGS84.radii(0.7))
    earth = EARTH_RATE * np.array([0.0, math.cos(0.7), math.sin(0.7)])
    transport = np.array([120.0 / m, 200.0 / n, 200.0 * math.tan(0.7) / n])
    wanted = row[0, [AE, AN, AU]] + np.cross(2.0 * earth + transport, row[0, [VE, VN, VU]])
    wanted[2] += WGS84.gravity(0.7, 3000.0)
    c = coefficients(Truth(1.0, row), WGS84, coupled=True).half[0]
    np.testing.assert_allclose([c["f_e"], c["f_n"], c["f_u"]], wanted, rtol=1e-13)
    # level and pointing north the body axes are E, N, U
    np.testing.assert_allclose(inertial_signals(Truth(1.0, row), WGS84)[0, 3:], wanted, rtol=1e-13)


@pytest.mark.parametrize("heading", [90.0, 270.0])
def test_a_ship_under_way_keeps_its_height(heading):
    """The vertical Coriolis term (Eoetvoes): 1 mm/s^2 at 10 m/s, with the wrong sign 10 m of height."""
    motion = DRIVE | {"heading_deg": heading}
    method = run_of(given("strapdown", 1200.0, motion=motion, run={"vertical": "altimeter"}))
    assert method.navigation is not None
    dvu, dheight = method.navigation[:, 9], method.navigation[:, 10]
    assert np.abs(dheight).max() < 0.01
    assert np.abs(dvu).max() < 1e-4


def test_the_altimeter_damps_the_height_as_a_third_order_loop_of_100_s():
    """A bias b of the accelerometer drives b s/(s + 1/100 s)^3: the height errs by b t^2/2 e^(-t/100 s)."""
    method = run_of(
        given("strapdown", 1500.0, run={"vertical": "altimeter"}, imu={"accel_bias_ug": [0.0, 0.0, 1000.0]})
    )
    assert method.navigation is not None
    t, bias = method.t_s, 1000.0 * MICRO_G
    wanted = 0.5 * bias * t**2 * np.exp(-t / 100.0)
    np.testing.assert_allclose(method.navigation[:, 10], wanted, atol=0.02 * wanted.max())


# ---------------------------------------------------------------- metres


@BOTH
def test_an_error_of_position_is_in_metres_at_the_height_of_the_ship(fidelity):
    """dlat_m = (M + h) dL, dlon_m = (N + h) cos L dlambda (theory.md 11): 12 km add 0.19 %."""
    scenario = given(fidelity, 10.0, initial_error={"position_arcsec": [600.0, -600.0]})
    scenario["site"]["height_m"] = 12_000.0
    method = run_of(scenario)
    m, n = (radius + 12_000.0 for radius in WGS84.radii(45.0 * DEG))
    north, east = m * 600.0 * ARCSEC, -n * math.cos(45.0 * DEG) * 600.0 * ARCSEC
    assert column(method, "dlat_m")[0] == pytest.approx(north, rel=1e-6)
    assert column(method, "dlon_m")[0] == pytest.approx(east, rel=1e-6)
    assert column(method, "position_m")[0] == pytest.approx(math.hypot(north, east), rel=1e-6)


@BOTH
def test_at_height_the_schuler_period_is_that_of_the_height(fidelity):
    """(R + h) and g(h) both count: 12 km lengthen it by 0.28 %."""
    scenario = given(fidelity, 12_000.0, initial_error={"attitude_arcmin": [0.0, 1.0, 0.0]})
    scenario["site"] |= {"lat_deg": 0.0, "height_m": 12_000.0}
    method = run_of(scenario)
    phi = column(method, "phi_n_rad")
    assert np.abs(phi).max() == pytest.approx(ARCMIN, rel=1e-2)
    falls = np.flatnonzero((phi[:-1] > 0.0) & (phi[1:] <= 0.0))
    crossing = [t + phi[t] / (phi[t] - phi[t + 1]) for t in falls]
    wanted = 2.0 * math.pi * math.sqrt((WGS84.radii(0.0)[1] + 12_000.0) / WGS84.gravity(0.0, 12_000.0))
    # on the equator the Earth's rate does not enter the east channel
    assert crossing[1] - crossing[0] == pytest.approx(wanted, rel=1e-4)

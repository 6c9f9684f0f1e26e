"""Figures of the papers by runs: Zhao 2015, 8, 9 and 12; Zha 2019, 1; Liu 2021, 4.

Zhao: what is left of the Schuler and 24 h swing after averaging. Figure 8: initial errors on a fast vehicle.
Figure 9: the same with sensor errors; the claim for the tilt needs quiet sensors. Figure 12: turntable, full
strapdown mechanization, forecast from a disturbed alignment; at 20 Hz instead of 100: the table swings with
0.05 Hz, and the noise of a second is the same. Zha: tilt from a gyro drift, 10 min with fast damping against
more than a Schuler period. Liu: the overshoot follows the change of the log's error (theory.md 9.3).
"""

import math

import numpy as np
import pytest

from navcore.analysis import initial_tilt_response, time_response
from navcore.averaging import Averaging
from navcore.averaging.lines import line_amplitudes, line_phases
from navcore.engine.run import MethodRun, Run
from navcore.engine.simulation import simulate
from navcore.foundation.earth import SPHERE, WGS84
from navcore.foundation.units import ARCSEC, DEG, DEG_PER_HOUR, HOUR
from navcore.mechanization.recorder import D_LON, DV_E, NAMES, PHI_E, PHI_N, POSITION
from navcore.mechanization.strapdown.records import NAVIGATION
from navcore.motion.truth import HEADING, VE, VN
from navcore.scenario.file import load
from navcore.scenario.model import Scenario
from tests.averaging import averaged, made, peaks
from tools.papers.measure import last_above

LEVEL = pytest.mark.parametrize("quantity", ["phi_e_rad", "phi_n_rad", "dve_mps", "dvn_mps"])
SLOW = pytest.mark.parametrize("quantity", ["phi_u_rad", "dlat_m"])
SLOWER = "run.rate_hz=20"
_UNITS = np.array([ARCSEC] * 3 + [1.0] * 4)

Lines = dict[str, dict[str, np.ndarray]]
"""Method -> quantity -> amplitude of both Schuler lines and of the 24 h line; arc-seconds, m/s, m."""
PEAKS = ["tilt_max_arcsec", "velocity_max_mps", "heading_max_arcmin", "position_max_m"]


def lines_of(run: Run) -> Lines:
    phases = line_phases(run.t_s, run.truth, run.scenario.earth)
    lines = {}
    for method in run.methods:
        fit = line_amplitudes(method.t_s, method.rows[:, :POSITION] / _UNITS, phases)
        lines[method.method.name] = dict(zip(NAMES[:POSITION], fit.amplitude, strict=True))
    return lines


def run_preset(name: str, *overrides: str) -> Run:
    return simulate(load(name, list(overrides)))


def schuler(lines: Lines, method: str, quantity: str) -> float:
    """Largest Schuler swing that both lines together make."""
    return float(np.sum(lines[method][quantity][:2]))


@pytest.fixture(scope="module")
def initial() -> Run:
    return run_preset("zhao-initial")


@pytest.fixture(scope="module")
def fig_8(initial) -> Lines:
    return lines_of(initial)


@pytest.fixture(scope="module")
def fig_9() -> Lines:
    return lines_of(run_preset("zhao-sensors"))


@pytest.fixture(scope="module")
def quiet() -> Lines:
    return lines_of(run_preset("zhao-sensors", "imu.gyro_arw_dpsh=0", "imu.accel_vrw_ugpshz=0"))


@pytest.fixture(scope="module")
def noisy() -> Lines:
    """The printed 0.005 read per root hour, 600 times the preset's."""
    return lines_of(run_preset("zhao-sensors", "imu.gyro_arw_dpsh=0.005"))


@pytest.fixture(scope="module")
def turntable() -> Run:
    return run_preset("zhao-turntable", SLOWER)


@pytest.fixture(scope="module")
def fig_12(turntable) -> Lines:
    return lines_of(turntable)


@SLOW
@pytest.mark.parametrize(("figure", "limit"), [("fig_8", 1e-3), ("fig_9", 0.35), ("fig_12", 0.1)])
def test_24_h_oscillation_of_heading_and_latitude_falls(request, figure, limit, quantity):
    lines = request.getfixturevalue(figure)
    assert lines["Zhao"][quantity][2] < limit * lines["free"][quantity][2]


# ---------------------------------------------------------------- figure 8


def test_the_vehicle_is_zhaos(initial):
    truth = initial.truth
    assert (truth[:, VE].min(), truth[:, VE].max()) == pytest.approx((0.0, 300.0), abs=1e-6)
    assert (truth[:, VN].min(), truth[:, VN].max()) == pytest.approx((0.0, 30.0), abs=1e-6)
    assert truth[:, HEADING].max() == pytest.approx(90.0 * DEG)
    quarter = np.searchsorted(initial.t_s, 21_600.0)
    assert truth[quarter, VE] == pytest.approx(150.0, rel=1e-9)  # 150 (1 - cos 2 pi t/24 h)
    assert initial.scenario.initial_error.attitude_arcmin == (0.6, 0.6, 7.0)
    assert initial.scenario.run.duration_h == 24.0


@LEVEL
def test_schuler_oscillation_falls_to_the_foucault_remainder_and_four_copies_take_it_too(fig_8, quantity):
    # 6.6 % stays at 45.78 deg, theory.md section 5
    left = schuler(fig_8, "Zhao", quantity)
    assert left / schuler(fig_8, "free", quantity) == pytest.approx(0.066, abs=0.003)
    assert schuler(fig_8, "four copies", quantity) < 0.05 * left


def test_eight_copies_leave_no_oscillation_on_a_fast_vehicle(initial):
    eight = next(m for m in initial.methods if m.method.name == "eight copies")
    for quantity in ("phi_e_rad", "phi_n_rad", "phi_u_rad"):
        assert eight.errors[quantity]["max_abs"] < 0.01 * ARCSEC
    assert eight.errors["dlat_m"]["max_abs"] < 0.5
    # the longitude error is a constant angle: its length shrinks with cos L on the way north
    angle = eight.rows[:, D_LON] / np.cos(initial.truth[:, 0])
    assert np.ptp(angle) < 1e-2 * np.abs(angle).max()


def test_the_phase_of_the_24_h_line_follows_the_vehicle_round_the_earth(initial):
    # Zhao: "the period of oscillation errors that relate to the rotation of the Earth is smaller than 24 h"
    free, earth = initial.methods[0].rows[:, :3] / ARCSEC, initial.scenario.earth
    followed, at_rest = (
        line_amplitudes(initial.t_s, free, line_phases(initial.t_s, truth, earth)).residual_rms[2]
        for truth in (initial.truth, initial.truth[:1])
    )
    assert followed < 0.5 * at_rest


# ---------------------------------------------------------------- figure 9


@LEVEL
def test_schuler_oscillation_from_biases_falls_like_that_from_initial_errors(quiet, quantity):
    free = schuler(quiet, "free", quantity)
    assert schuler(quiet, "Zhao", quantity) < 0.08 * free
    assert schuler(quiet, "four copies", quantity) < 0.025 * free


@LEVEL
def test_noise_after_the_start_passes_through_every_average(noisy, fig_9, quiet, quantity):
    # sixty arc-seconds of tilt, in four and eight copies as in two: averaging changes the state at t = 0 only
    eight = schuler(noisy, "eight copies", quantity)
    for method in ("Zhao", "four copies", "eight copies"):
        assert schuler(noisy, method, quantity) > 10.0 * schuler(quiet, method, quantity)
        assert schuler(noisy, method, quantity) == pytest.approx(eight, rel=0.05)
    # with the random walks a sample, as the preset has them, the figure comes out
    assert schuler(fig_9, "Zhao", quantity) < 0.1 * schuler(fig_9, "free", quantity)


# ---------------------------------------------------------------- figure 12


def test_the_setting_is_the_papers(turntable):
    scenario = turntable.scenario
    assert scenario.run.duration_h == 25.0
    assert scenario.alignment.duration_s == 600.0
    assert [motion.t_s for motion in scenario.alignment.motion] == [-500.0, -402.0]
    assert scenario.initial_error.attitude_arcmin == (0.15, 0.14, 1.3)


def test_the_disturbed_seconds_are_left_out_of_the_forecast(turntable):
    zhao = next(m for m in turntable.methods if m.method.name == "Zhao")
    assert any("18 s of 600 s were left out" in text for text in zhao.warnings)


@LEVEL
def test_schuler_oscillation_is_halved(fig_12, quantity):
    assert schuler(fig_12, "Zhao", quantity) < 0.6 * schuler(fig_12, "free", quantity)


@pytest.fixture(scope="module")
def calm() -> Lines:
    return lines_of(run_preset("zhao-turntable", SLOWER, "alignment.motion=[]"))


@LEVEL
def test_a_disturbed_alignment_is_as_good_as_a_calm_one(fig_12, calm, quantity):
    assert schuler(fig_12, "Zhao", quantity) == pytest.approx(schuler(calm, "Zhao", quantity), rel=0.1)


def test_navigation_stays_at_the_table(turntable):
    for method in turntable.methods:
        assert method.status == "ok"
        assert method.navigation is not None
        longitude = method.navigation[:, NAVIGATION.index("lon_rad")]
        assert abs(longitude - turntable.truth[0, 1]).max() < 0.005


# ---------------------------------------------------------------- Zha 2019, figure 1


DRIFT = 0.01 * DEG_PER_HOUR


@pytest.fixture(scope="module")
def zha() -> Run:
    return simulate(load("zha-fast"))


@pytest.fixture(scope="module")
def zha_methods(zha) -> dict[str, MethodRun]:
    return {m.method.network.id: m for m in zha.methods}


def test_the_setting_is_zhas(zha):
    assert zha.scenario.imu.gyro_bias_dph == (0.01, 0.0, 0.0)
    assert zha.scenario.run.duration_h == 4.0
    gains = zha.scenario.method[2].network.gains(zha.scenario.omega_s)
    np.testing.assert_allclose(gains, (0.0264, 202.520, 0.904534), rtol=1e-5)  # theory.md 9.2


def test_free_tilt_swings_with_the_drift_over_the_schuler_frequency(zha, zha_methods):
    free = zha_methods["none"]
    expected = -DRIFT / zha.scenario.omega_s * np.sin(zha.scenario.omega_s * free.t_s)
    np.testing.assert_allclose(free.rows[:, PHI_E], expected, atol=1e-6 * DRIFT / zha.scenario.omega_s)


@pytest.mark.parametrize("network_id", ["classic2", "compass"])
def test_the_sampled_loop_follows_the_continuous_one(zha_methods, network_id):
    method = zha_methods[network_id]
    expected = DRIFT * time_response(method.network, "eps", "phi", method.t_s)
    worst = np.max(np.abs(method.rows[:, PHI_E] - expected))
    # the correction is held over 1 s: half a step of delay
    assert worst < 5e-3 * np.max(np.abs(expected))


def test_fast_damping_is_done_in_ten_minutes_and_classic_takes_an_hour(zha_methods):
    settled = {name: last_above(m.t_s, m.rows[:, PHI_E], 0.02) / 60.0 for name, m in zha_methods.items()}
    assert 8.0 < settled["compass"] < 10.0
    assert 60.0 < settled["classic2"] < 80.0  # the abstract says 1 h
    assert settled["none"] > 230.0


def test_to_half_a_percent_as_zha_counts_classic_takes_more_than_a_schuler_period(zha, zha_methods):
    """From an initial tilt down to 0.5 % (sigma t = 5.25; theory.md section 8)."""
    period = 2.0 * math.pi / zha.scenario.omega_s
    time = np.arange(0.0, 20000.0)
    response = {
        name: initial_tilt_response(zha_methods[name].network, time) for name in ("classic2", "compass")
    }
    assert last_above(time, response["classic2"], 0.005) > period
    assert last_above(time, response["compass"], 0.005) == pytest.approx(600.0, abs=30.0)


# ---------------------------------------------------------------- Liu 2021, figure 4


CHANGE_MPS = (1.0, 0.5, 1.0, 1.5)
PEAKS_MPS = (0.7269, 0.3636, 0.7271, 1.0907)


@pytest.fixture(scope="module")
def liu() -> Run:
    return simulate(load("liu-overshoot"))


def overshoot(method: MethodRun, column: int) -> float:
    """Largest departure from the value at 5 h."""
    after = method.rows[method.t_s >= 5.0 * HOUR, column]
    return float(np.max(np.abs(after - after[0])))


def test_the_setting_is_lius(liu):
    scenario = liu.scenario
    assert scenario.run.duration_h == 10.0
    assert scenario.imu.gyro_bias_dph == (1e-4, 1e-4, 1e-4)
    assert scenario.imu.accel_bias_ug == (10.0, 10.0, 10.0)
    for method in scenario.method:
        assert method.network.damping_coefficient() == 1.3
        assert method.event[0].t_h == 5.0
    changes = [m.event[0].accel_mps2[0] * m.event[0].duration_s for m in scenario.method[:4]]
    np.testing.assert_allclose(changes, CHANGE_MPS)


def test_nothing_differs_before_the_event(liu):
    before = [m.rows[m.t_s <= 5.0 * HOUR] for m in liu.methods]
    for other in before[1:]:
        np.testing.assert_array_equal(other, before[0])


def test_peaks_of_the_independent_implementation(liu):
    found = [overshoot(method, DV_E) for method in liu.methods]
    np.testing.assert_allclose(found[:4], PEAKS_MPS, rtol=1e-3)  # 1 % is asked
    assert found[4] == pytest.approx(0.006, abs=5e-4)  # printed with one digit


def test_overshoot_is_proportional_to_the_change(liu):
    tilt = [overshoot(m, PHI_N) / c for m, c in zip(liu.methods, CHANGE_MPS, strict=False)]
    np.testing.assert_allclose(tilt, tilt[0], rtol=5e-3)


def test_the_velocity_goes_against_the_logs_error(liu):
    for method in liu.methods[:4]:
        after = method.rows[method.t_s >= 5.0 * HOUR, DV_E]
        assert np.min(after - after[0]) < -5.0 * np.max(after - after[0])


def test_the_other_channel_does_not_notice(liu):
    for method in liu.methods[1:]:
        np.testing.assert_array_equal(method.rows[:, DV_E + 1], liu.methods[0].rows[:, DV_E + 1])


# ---------------------------------------------------------------- Zhao 2015, eq. 17


@pytest.mark.known(
    "oracle", PEAKS, kinds=["averaging"], fidelities=["error_model"], source="an independent program"
)
@pytest.mark.parametrize(
    ("quantity", "peak"),
    [
        ("dve_mps", 0.556),
        ("dvn_mps", 0.730),
        ("phi_e_rad", 3.48),
        ("phi_n_rad", 3.95),
        ("dlat_m", 1470.0),
        ("phi_u_rad", 48.8),
    ],
)
def test_schuler_average_and_earth_average(schuler_and_earth, quantity, peak):
    # 1 % is asked; what is left is the rounding of the printed figures
    assert schuler_and_earth[quantity] == pytest.approx(peak, rel=2e-3)


@pytest.fixture(scope="module")
def schuler_and_earth():
    return peaks(averaged(made(Averaging(variant="schuler", earth=True))))


def test_cascade_of_four_copies():
    left = peaks(averaged(made(Averaging(variant="cascade", earth=False))))
    assert left["phi_e_rad"] == pytest.approx(0.022, abs=5e-4)
    assert left["phi_n_rad"] == pytest.approx(0.665, abs=5e-4)


@pytest.mark.parametrize("earth", [SPHERE, WGS84], ids=["sphere", "wgs84"])
def test_eight_copies_leave_nothing_but_the_longitude_drift(earth):
    run = averaged(made(Averaging(variant="cascade", earth=True), earth=earth), earth=earth)
    left = peaks(run)
    assert max(left[name] for name in ("phi_e_rad", "phi_n_rad", "phi_u_rad")) < 0.01
    assert max(left["dve_mps"], left["dvn_mps"]) < 1e-5
    assert left["dlat_m"] < 0.5
    longitude = run.recorder.rows[:, 6]
    assert abs(longitude[0]) > 6000.0
    assert np.ptp(longitude) < 0.5


# theory.md section 7, zhao-initial: 2", 2", 0.1 m/s, 0.6', 0.6', 7'; section 9.4: sphere, 45.7796 N, 24 h
SCENARIO = Scenario.parse(
    {
        "run": {"duration_h": 24.0, "earth": "sphere"},
        "site": {"lat_deg": 45.7796, "lon_deg": 126.6705},
        "initial_error": {
            "attitude_arcmin": [0.6, 0.6, 7.0],
            "velocity_mps": [0.1, 0.1],
            "position_arcsec": [2.0, 2.0],
        },
    }
)


@pytest.fixture(scope="module")
def free_errors() -> dict[str, dict[str, float]]:
    return simulate(SCENARIO).methods[0].errors


@pytest.mark.known(
    "oracle", PEAKS, kinds=["free"], fidelities=["error_model"], source="an independent program"
)
@pytest.mark.parametrize(
    ("quantity", "unit", "peak"),
    [
        ("dve_mps", 1.0, 2.132),
        ("dvn_mps", 1.0, 2.476),
        ("phi_e_rad", ARCSEC, 52.9),
        ("phi_n_rad", ARCSEC, 53.5),
        ("dlat_m", 1.0, 9815.0),
        ("phi_u_rad", ARCSEC, 440.0),
    ],
)
def test_peaks_without_averaging(free_errors, quantity, unit, peak):
    # 0.5 % is asked; what is left is the rounding of the printed figures
    assert free_errors[quantity]["max_abs"] / unit == pytest.approx(peak, rel=1e-3)

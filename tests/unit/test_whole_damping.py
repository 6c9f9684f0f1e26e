"""Whole damping: a network in the azimuth channel (at-sea eigenvalues, closed forms, both fidelities)."""

import math
from typing import Any, ClassVar

import numpy as np
import pytest

from navcore.analysis.held_log import held_log
from navcore.analysis.whole_system import whole_system
from navcore.damping.gyrocompass import Gyrocompass
from navcore.damping.internal import Internal
from navcore.engine.drivers.batch import run_batches
from navcore.engine.run import Run
from navcore.engine.simulation import simulate
from navcore.foundation.earth import EARTH_RATE, SPHERE
from navcore.foundation.errors import InputError
from navcore.foundation.parameters import Parameters, quantity
from navcore.foundation.units import ARCMIN, DEG
from navcore.networks import parse_network
from navcore.networks.azimuth_loop import AzimuthGains, azimuth_gains, azimuth_polynomial
from navcore.quantities import NAMES
from navcore.scenario.file import load
from navcore.scenario.model import Scenario
from schuler_bench.editing.edits import with_choice
from schuler_bench.views.method.view import azimuth_fields, own_fields

COMPLEMENTARY, UNITY2 = {"id": "complementary", "zeta": 0.5, "eta": 0.5}, {"id": "unity2", "zeta": 0.5}


def made(*methods: dict[str, Any], hours: float = 48.0, **blocks: dict[str, Any]) -> Scenario:
    run = {"duration_h": hours, "fidelity": "error_model", "earth": "sphere", "output_step_s": 60.0}
    data: dict[str, Any] = {
        "site": {"lat_deg": 45.0, "lon_deg": 0.0},
        "run": run | blocks.pop("run", {}),
        "reference": {"kind": "log", "rate_hz": 1.0} | blocks.pop("reference", {}),
        "method": [{"damping": "external", "network": COMPLEMENTARY} | one for one in methods],
    }
    return Scenario.model_validate(data | blocks)


def raise_faults(scenario: Scenario) -> None:
    if faults := list(scenario.faults()):
        raise InputError(faults)


def columns(run: Run, name: str) -> list[np.ndarray]:
    return [method.rows[:, NAMES.index(name)] for method in run.methods]


# ------------------------------------------------------------ poles


@pytest.mark.known(
    "oracle",
    ["growth_per_s"],
    kinds=["whole"],
    fidelities=["loop"],
    source="figures of an independent program",
)
@pytest.mark.parametrize(
    ("level", "azimuth", "modes", "growth"),
    [
        (COMPLEMENTARY, COMPLEMENTARY, [(0.3986, 1.2448), (0.3942, 1.2724), (0.3902, 1.2971)], -2.385e-5),
        (COMPLEMENTARY, UNITY2, [(0.5400, 1.1342), (0.5484, 1.1162), (0.5574, 1.0991)], -4.463e-5),
        ({"id": "classic2"}, UNITY2, [(0.4473, 1.2821), (0.4181, 1.3101), (0.3873, 1.3366)], -3.994e-5),
        ({"id": "none"}, UNITY2, [(0.5015, 1.1975), (0.4989, 1.1995), (0.4976, 1.2020)], 1.576e-5),
    ],
)
def test_slow_mode_and_growth_are_those_of_an_independent_program(level, azimuth, modes, growth) -> None:
    network = parse_network(level).transfer(SPHERE.schuler_frequency(0.0))
    slow = parse_network(azimuth).at_earth_rate()
    for lat_deg, (ratio, frequency) in zip((20.0, 45.0, 70.0), modes, strict=True):
        mode = whole_system(network, lat_deg * DEG, azimuth=slow).slow_mode
        assert mode is not None
        assert (mode.damping_ratio, abs(mode.eigenvalue) / EARTH_RATE) == pytest.approx(
            (ratio, frequency), abs=1e-4
        )
    whole = whole_system(network, 45.0 * DEG, azimuth=slow)
    assert max(mode.growth for mode in whole.modes) == pytest.approx(growth, rel=1e-3)
    assert whole.stable == (growth < 0.0)
    sampled = held_log(network, 1.0, 1.0, 45.0 * DEG, azimuth=slow)
    assert sampled.growth_per_s == pytest.approx(growth, rel=2e-3)


def test_a_classic_network_of_the_azimuth_is_that_of_the_level_channels_in_units_of_its_frequency() -> None:
    level = parse_network("classic3").transfer(1.2400e-3)
    slow = parse_network("classic3").at_earth_rate()
    assert slow.poles / EARTH_RATE == pytest.approx(level.poles / 1.2400e-3)
    assert slow.zeros / EARTH_RATE == pytest.approx(level.zeros / 1.2400e-3)
    assert parse_network(UNITY2).at_earth_rate().h_slope == pytest.approx(12179.0, abs=1.0)


# ------------------------------------------------------------ closed forms


def test_an_east_gyro_bias_turns_the_heading_to_where_it_settles() -> None:
    # phi_U -> -eps_E/(Omega cos L): 3.23 arcmin for 0.01 deg/h at 45 deg, as without damping
    scenario = made({"azimuth": UNITY2}, hours=72.0, imu={"gyro_bias_dph": [0.01, 0.0, 0.0]})
    (heading,) = columns(simulate(scenario), "phi_u_rad")
    wanted = -0.01 * DEG / 3600.0 / (EARTH_RATE * math.cos(45.0 * DEG))
    assert heading[-1] == pytest.approx(wanted, rel=1e-3)


@pytest.mark.known(
    "oracle",
    ["position_final_m"],
    kinds=["whole"],
    fidelities=["error_model", "strapdown"],
    source="closed form",
)
@pytest.mark.parametrize("fidelity", ["error_model", "strapdown"])
def test_a_standing_error_of_the_log_leaves_a_latitude_of_609_m(fidelity: str) -> None:
    sampling = {"rate_hz": 10.0} if fidelity == "strapdown" else {}
    run = {"fidelity": fidelity, **sampling}
    scenario = made({"azimuth": UNITY2}, hours=72.0, run=run, reference={"bias_mps": [0.0, 0.1]})
    (latitude,) = columns(simulate(scenario), "dlat_m")
    slope = parse_network(UNITY2).at_earth_rate().h_slope
    assert latitude[-1] == pytest.approx(slope * 0.1 * 0.5, rel=2e-2)


def test_a_steady_speed_costs_the_internal_form_30_km_and_the_external_one_nothing() -> None:
    # dL R = -Y'(0) V_N cos^2 L
    scenario = made(
        {"name": "internal", "damping": "internal", "azimuth": UNITY2},
        {"name": "external", "azimuth": UNITY2},
        hours=30.0,
        motion={"kind": "legs", "leg": [{"duration_s": 108000.0, "speed_mps": 5.0, "heading_deg": 0.0}]},
    )
    internal, external = columns(simulate(scenario), "dlat_m")
    slope = parse_network(UNITY2).at_earth_rate().h_slope
    lat = 45.0 * DEG + 5.0 * 30.0 * 3600.0 / SPHERE.radii(0.0)[0]  # where the ship has come to
    assert internal[-1] == pytest.approx(-slope * 5.0 * math.cos(lat) ** 2, rel=0.02)
    assert abs(external[-1]) < 1e-6 * abs(internal[-1])


@pytest.mark.parametrize("damping", ["external", "internal"])
def test_both_fidelities_agree_within_2_percent_of_the_peak_under_way(damping: str) -> None:
    legs = [
        {"duration_s": 21600.0, "speed_mps": 6.0, "heading_deg": 30.0},
        {"duration_s": 21600.0, "heading_deg": 200.0},
        {"duration_s": 21600.0, "heading_deg": 90.0},
    ]

    def errors(fidelity: str) -> np.ndarray:
        scenario = made(
            {"damping": damping, "azimuth": UNITY2},
            hours=18.0,
            run={"fidelity": fidelity, "rate_hz": 10.0},
            motion={"kind": "legs", "leg": legs},
            imu={"gyro_bias_dph": [0.01, -0.01, 0.01], "accel_bias_ug": [30.0, -20.0, 0.0]},
            reference={"bias_mps": [0.1, -0.05]},
        )
        (method,) = simulate(scenario).methods
        assert method.status == "ok"
        return method.rows[:, :7]

    linear, full = errors("error_model"), errors("strapdown")
    peak = np.max(np.abs(full), axis=0)
    assert np.all(np.max(np.abs(linear - full), axis=0) <= 0.02 * peak)


def test_the_azimuth_network_damps_the_24_h_oscillation_that_level_networks_leave() -> None:
    scenario = made(
        {"name": "level"},
        {"name": "whole", "azimuth": UNITY2},
        hours=96.0,
        initial_error={"attitude_arcmin": [0.0, 0.0, 10.0]},
    )
    level, whole = columns(simulate(scenario), "phi_u_rad")
    last = len(level) * 3 // 4
    assert np.ptp(whole[last:]) < 1e-2 * np.ptp(level[last:])


def test_a_restart_after_an_outage_agrees_in_both_fidelities() -> None:
    outage = [{"t_h": 6.0, "duration_s": 7200.0}, {"t_h": 12.0, "duration_s": 3600.0}]

    def errors(fidelity: str, switching: str) -> np.ndarray:
        scenario = made(
            {"azimuth": UNITY2, "switching": {"id": switching}},
            hours=18.0,
            run={"fidelity": fidelity, "rate_hz": 10.0},
            imu={"gyro_bias_dph": [0.01, 0.01, 0.01]},
            reference={"bias_mps": [0.05, 0.1], "outage": outage},
        )
        (method,) = simulate(scenario).methods
        return method.rows[:, :7]

    for switching in ("hard", "keep", "ramp", "bumpless"):
        linear, full = errors("error_model", switching), errors("strapdown", switching)
        peak = np.max(np.abs(full), axis=0)
        assert np.all(np.max(np.abs(linear - full), axis=0) <= 0.02 * peak), switching


# ------------------------------------------------------------ what does not go together


@pytest.mark.parametrize(
    ("method", "blocks", "field", "told"),
    [
        ({"damping": "free", "network": {"id": "none"}}, {}, "method.0.azimuth", "internal"),
        ({}, {"run": {"fidelity": "channel"}}, "method.0.damping", "error_model"),
        ({"gyrocompass": {"sigma": 0.002, "xi": 0.707}}, {}, "method.0.azimuth.id", "gyrocompass"),
        (
            {"gyrocompass": {"sigma": 0.5, "xi": 0.707}, "azimuth": {"id": "none"}},
            {},
            "method.0.gyrocompass.sigma",
            "<= 0.1",
        ),
        ({"gyrocompass": {}, "damping": "internal"}, {}, "method.0.gyrocompass", "external"),
        (
            {"gyrocompass": {"k4": 0.5}, "azimuth": {"id": "none"}},
            {},
            "method.0.gyrocompass.k4",
            "<= 0.2",
        ),
        (
            {"gyrocompass": {}, "azimuth": {"id": "none"}, "policy": {"id": "states"}},
            {},
            "method.0.policy.id",
            "no internal damping",
        ),
        ({"damping": "internal", "policy": {"id": "states"}}, {}, "method.0.policy.id", "external"),
        (
            {"policy": {"id": "states"}, "switching": {"id": "bumpless"}},
            {},
            "method.0.switching.id",
            "hard or step",
        ),
        (
            {
                "policy": {"id": "states"},
                "azimuth": {"id": "custom", "zeros": [-1e-4], "poles": [-2e-4], "gain": 1.0},
            },
            {},
            "method.0.azimuth.id",
            "Y(0)",
        ),
        ({}, {"site": {"lat_deg": 86.0, "lon_deg": 0.0}}, "method.0.damping", "85"),
        (
            {
                "damping": "internal",
                "azimuth": {"id": "custom", "zeros": [-1e-4], "poles": [-2e-4], "gain": 1.0},
            },
            {},
            "method.0.azimuth.id",
            "Y(0)",
        ),
    ],
)
def test_what_an_azimuth_network_does_not_go_with_is_refused(method, blocks, field: str, told: str) -> None:
    with pytest.raises(InputError) as caught:
        raise_faults(made({"azimuth": UNITY2} | method, **blocks))
    assert field in str(caught.value) and told in str(caught.value)


@pytest.mark.parametrize(
    ("method", "told"),
    [
        ({"network": {"id": "none"}}, "without level damping"),
        ({"damping": "internal"}, "12179 s"),
        ({"network": {"id": "compass", "sigma": 0.0015, "xi": 0.7}}, 'realisation = "network"'),
    ],
)
def test_what_the_user_should_know_of_an_azimuth_network_is_told(method, told: str) -> None:
    (run,) = simulate(made({"azimuth": UNITY2} | method, hours=1.0)).methods
    assert any("azimuth" in text and told in text for text in run.warnings), run.warnings


def test_a_batch_of_strapdown_runs_ends_where_single_runs_end() -> None:
    scenarios = [
        made(
            {"azimuth": UNITY2},
            hours=3.0,
            run={"fidelity": "strapdown", "rate_hz": 10.0, "seed": seed},
            imu={"gyro_bias_dph": [0.01, 0.01, 0.01], "gyro_arw_dpsh": 0.001},
            reference={"noise_mps": 0.1},
        )
        for seed in (1, 2)
    ]
    (batch,) = run_batches(scenarios, lambda _: False)
    single = [columns(simulate(scenario), "position_m")[0][-1] for scenario in scenarios]
    assert batch.position_m == pytest.approx(single, rel=1e-9)


# ------------------------------------------------------------ gyrocompass during navigation


COMPASS = {"id": "compass", "sigma": 0.0015, "xi": 0.7}
GYROCOMPASS = {"sigma": 0.002, "xi": 0.707}


@pytest.mark.known(
    "oracle",
    ["heading_max_arcmin", "heading_rms_arcmin"],
    kinds=["gyrocompass"],
    fidelities=["error_model", "strapdown"],
    source="figures of an independent integration, and closed forms",
)
@pytest.mark.parametrize(
    ("blocks", "arcmin"),
    [
        ({"reference": {"bias_mps": [0.0, 0.1]}}, -1.0146),
        ({"imu": {"gyro_bias_dph": [0.01, 0.0, 0.0]}}, -3.2330),
        ({"imu": {"gyro_bias_dph": [0.0, 0.0, 0.01]}}, -0.1661),
        ({"imu": {"accel_bias_ug": [50.0, 0.0, 0.0]}}, 0.1719),
    ],
    ids=["log", "east gyro", "up gyro", "east accelerometer"],
)
@pytest.mark.parametrize("fidelity", ["error_model", "strapdown"])
def test_a_gyrocompass_settles_where_an_independent_integration_does(blocks, arcmin, fidelity: str) -> None:
    method = {"network": COMPASS, "gyrocompass": GYROCOMPASS}
    run = {"fidelity": fidelity, "rate_hz": 10.0}
    (heading,) = columns(simulate(made(method, hours=3.0, run=run, **blocks)), "phi_u_rad")
    assert heading[-1] / ARCMIN == pytest.approx(arcmin, rel=1e-2)


def test_the_whole_system_with_a_gyrocompass_has_its_poles_and_the_sampled_law_agrees() -> None:
    omega_s = SPHERE.schuler_frequency(0.0)
    network = parse_network(COMPASS).transfer(omega_s)
    gains = azimuth_gains(0.002, 0.707, omega_s, omega_s**2 * 6378137.0)
    whole = whole_system(network, 45.0 * DEG, azimuth=gains)
    assert whole.stable
    wanted = max(np.roots([1.0, 0.004, 0.002**2 / 0.707**2]), key=lambda root: root.imag)
    nearest = min(abs(mode.eigenvalue - wanted) for mode in whole.modes)
    assert nearest < 0.2 * abs(wanted)
    sampled = held_log(network, 1.0, 1.0, 45.0 * DEG, azimuth=gains)
    assert sampled.growth_per_s <= 0.0
    for period_s, status in ((400.0, "ok"), (600.0, "diverged")):
        growth = held_log(network, period_s, 1.0, 45.0 * DEG, azimuth=gains).growth_per_s
        method = {"network": COMPASS, "gyrocompass": GYROCOMPASS}
        start = {"attitude_arcmin": [0.0, 0.0, 10.0]}
        (run,) = simulate(
            made(method, hours=12.0, reference={"rate_hz": 1.0 / period_s}, initial_error=start)
        ).methods
        assert (run.status, growth > 0.0) == (status, status == "diverged")


def test_gains_of_one_s_own_take_the_place_of_those_of_a_decay_rate() -> None:
    """Deng 2019, section II B: K_U1 to K_U4; the whole system's poles are those of the loop with them."""
    omega_s = SPHERE.schuler_frequency(0.0)
    gravity = omega_s**2 * 6378137.0
    own = Gyrocompass(sigma=0.002, xi=0.707, k3=4e-12, k4=0.006)
    gains, usual = own.gains(omega_s, gravity), azimuth_gains(0.002, 0.707, omega_s, gravity)
    assert gains == usual._replace(k3=4e-12, k4=0.006)
    poles = np.roots(azimuth_polynomial(gains, omega_s, gravity)) * omega_s
    whole = whole_system(parse_network(COMPASS).transfer(omega_s), 5.0 * DEG, azimuth=gains)
    for pole in poles[poles.imag >= 0.0]:
        assert min(abs(mode.eigenvalue - pole) for mode in whole.modes) < 0.05 * abs(pole)
    alone = usual._replace(k1=0.0, k4=1e-3)
    s = np.roots(azimuth_polynomial(usual, omega_s, gravity)) * omega_s
    assert np.poly(s) == pytest.approx(np.polymul(*[[1.0, 0.004, 0.002**2 / 0.707**2]] * 2), rel=1e-6)
    assert np.roots(azimuth_polynomial(alone, omega_s, gravity)).real.max() > 0.0
    method = {"network": COMPASS, "gyrocompass": {"k1": 0.0, "k4": 1e-3}}
    (told,) = [text for text in run_warnings(method) if "K_U" in text]
    assert "unstable" in told
    start = {"attitude_arcmin": [0.0, 0.0, 10.0]}
    blocks = [{"network": COMPASS, "gyrocompass": each} for each in (at_the_site()._asdict(), GYROCOMPASS)]
    given, left = columns(simulate(made(*blocks, hours=2.0, initial_error=start)), "phi_u_rad")
    assert given == pytest.approx(left, rel=1e-9) and np.ptp(given) > 5.0 * ARCMIN


def at_the_site() -> AzimuthGains:
    omega_s = made({"network": COMPASS}).omega_s
    return azimuth_gains(0.002, 0.707, omega_s, omega_s**2 * 6378137.0)


def run_warnings(method: dict[str, Any]) -> tuple[str, ...]:
    (run,) = simulate(made(method, hours=0.1)).methods
    return run.warnings


def test_the_page_offers_an_azimuth_network_where_one_can_be_chosen() -> None:
    """In the fidelity "channel" it offered eight, and refused each of them."""
    of_channels, whole = load("zha-fast"), load("sikuliaq-like")
    assert of_channels.run.fidelity == "channel" and azimuth_fields(of_channels, 2) == []
    offered = {spec.path[-2:] for spec in azimuth_fields(whole, 2)}
    assert ("azimuth", "id") in offered
    chosen = with_choice(whole, ("method", 2, "azimuth", "id"), "unity2")
    assert {spec.path[-1] for spec in azimuth_fields(chosen, 2)} > {"id", "zeta"}


def test_parameters_of_a_kind_s_own_have_controls() -> None:
    """They had some only where the kind named itself among the blocks, which no recipe says."""

    class Delay(Parameters):
        delay_s: float = quantity(3.0, unit="s", ge=0.0, le=60.0, slider=(0.0, 10.0), label="delay")

    class Delayed(Internal):
        id: ClassVar[str] = "delayed"
        settings: ClassVar[type[Parameters] | None] = Delay

    (spec,) = own_fields(Delayed(), ("method", 1))
    assert spec.path == ("method", 1, "delayed", "delay_s") and spec.label == "delay (s)"
    assert own_fields(Internal(), ("method", 1)) == []

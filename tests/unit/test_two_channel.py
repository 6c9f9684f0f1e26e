"""The optimum of both level channels: against scipy on a model of our own, one channel's, and runs."""

import json
import math
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from scipy.linalg import expm, solve_continuous_are, solve_continuous_lyapunov
from scipy.signal import tf2ss

from navcore.analysis.report import network_report
from navcore.analysis.two_channel import Deviations, TwoChannel, both_law, both_plant, two_channel
from navcore.design.floor import steady_floor
from navcore.foundation.earth import EARTH_RATE, SEMI_MAJOR_AXIS, SPHERE
from navcore.foundation.units import ARCMIN, ARCSEC
from navcore.networks import parse_network
from navcore.networks.lqg import ControlProblem
from navcore.networks.optimal import EXAMPLE_SHIP
from navcore.scenario.model import Scenario
from navcore.scenario.stochastic import stochastic_model
from schuler_bench.cli import main

GRAVITY = SPHERE.gravity(0.0, 0.0)
OMEGA_S = SPHERE.schuler_frequency(0.0)
TIME_S, ANGLE = 1000.0, 1e-4
"""Units of the model below, others than the program's: s and rad, beside m/s."""


def found(spec: str = 'id = "optimal"', lat_deg: float = 45.0) -> TwoChannel:
    parameters = parse_network(spec)
    problem = parameters.control_problem()
    assert problem is not None
    answer = two_channel(parameters.transfer(OMEGA_S), problem, math.radians(lat_deg))
    assert answer is not None
    return answer


def own_model(lat: float) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, float]:
    """Model of theory.md 2 and 14 for the example ship, written down once more: A, B, C, W, V.

    States dV_E, dV_N, dL, phi_E, phi_N, phi_U, drifts of gyros E N U, accelerometers E N, log E N.
    """
    s, c, r, g = EARTH_RATE * math.sin(lat), EARTH_RATE * math.cos(lat), SEMI_MAJOR_AXIS, GRAVITY
    A = np.zeros((13, 13))
    A[0, [1, 4, 9]] = 2.0 * s, -g, 1.0
    A[1, [0, 3, 10]] = -2.0 * s, g, 1.0
    A[2, 1] = 1.0 / r
    A[3, [1, 4, 5, 6]] = -1.0 / r, s, -c, -1.0
    A[4, [0, 2, 3, 7]] = 1.0 / r, -s, -s, -1.0
    A[5, [0, 2, 3, 8]] = math.tan(lat) / r, c, c, -1.0
    B, C, W = np.zeros((13, 4)), np.zeros((2, 13)), np.zeros(13)
    B[4, 0], B[3, 1], B[0, 2], B[1, 3] = 1.0 / r, -1.0 / r, OMEGA_S, OMEGA_S
    C[0, [0, 11]] = C[1, [1, 12]] = 1.0, -1.0
    W[:2], W[3:6] = EXAMPLE_SHIP.accel_white**2, EXAMPLE_SHIP.gyro_white**2
    for places, sigma, tau in (
        (slice(6, 9), EXAMPLE_SHIP.gyro_drift, EXAMPLE_SHIP.gyro_tau_s),
        (slice(9, 11), EXAMPLE_SHIP.accel_drift, EXAMPLE_SHIP.accel_tau_s),
        (slice(11, 13), EXAMPLE_SHIP.log_drift, EXAMPLE_SHIP.log_tau_s),
    ):
        A[range(13)[places], range(13)[places]] = -1.0 / tau
        W[places] = 2.0 * sigma**2 / tau
    unit = np.ones(13)
    unit[2:9] = ANGLE
    unit[6:9] /= TIME_S
    unit[9:11] /= TIME_S
    scaled = A * unit / unit[:, None] * TIME_S
    noise = EXAMPLE_SHIP.log_noise**2 / EXAMPLE_SHIP.log_rate_hz / TIME_S
    return scaled, B / unit[:, None] * TIME_S, C * unit, np.diag(W / unit**2 * TIME_S), noise


def deviations(P: np.ndarray) -> list[float]:
    size = np.sqrt(np.diag(P))
    return [*(ANGLE * size[[3, 4, 5]]), *size[:2]]


@pytest.mark.parametrize("feedback", [False, True])
@pytest.mark.parametrize(("lat_deg", "q"), [(45.0, 1.0), (-20.0, 0.5), (70.0, 0.0)])
def test_floor_and_optimum_are_scipys_on_a_model_of_our_own(lat_deg: float, q: float, feedback: bool) -> None:
    A, B, C, W, V = own_model(math.radians(lat_deg))
    P = solve_continuous_are(A.T, C.T, W, V * np.eye(2))
    if not feedback:
        B = B[:, :2]
    # phi over 1/sqrt(g R), the cost's unit of a tilt at 1 m/s
    tilt = (ANGLE * math.sqrt(GRAVITY * SEMI_MAJOR_AXIS)) ** 2
    weight = np.diag([q, q, 0.0, tilt, tilt, *[0.0] * 8])
    X = solve_continuous_are(A, B, weight, 0.01 * np.eye(B.shape[1]))
    gain = P @ C.T / V
    driven = solve_continuous_lyapunov(A - B @ B.T @ X / 0.01, -V * gain @ gain.T)
    realisation = "feedback" if feedback else "network"
    ours = found(f'id = "optimal", q = {q}, realisation = "{realisation}"', lat_deg)
    assert list(ours.floor) == pytest.approx(deviations(P), rel=1e-5)
    assert list(ours.both_channels) == pytest.approx(deviations(P + driven), rel=1e-5)


def test_the_network_on_each_channel_is_scipys_state_space_on_that_model() -> None:
    lat = math.radians(45.0)
    A, B, C, W, V = own_model(lat)
    network = parse_network('id = "optimal"').transfer(OMEGA_S)
    den = network.den * TIME_S ** -np.arange(len(network.den))[::-1].astype(float)
    num = network.num * TIME_S ** -np.arange(len(network.num))[::-1].astype(float)
    assert num[0] == pytest.approx(den[0], rel=1e-9), "H tends to 1"
    Az, Bz, Cz, Dz = tf2ss((num - den)[1:], den)  # H - 1, of V_c - V_r
    n = len(Az)
    closed = np.zeros((13 + 2 * n, 13 + 2 * n))
    noise = np.zeros((13 + 2 * n, 2))
    closed[:13, :13] = A
    for k in range(2):
        z = slice(13 + k * n, 13 + (k + 1) * n)
        closed[:13, :13] += float(Dz[0, 0]) * np.outer(B[:, k], C[k])
        closed[:13, z] = np.outer(B[:, k], Cz[0])
        closed[z, :13], closed[z, z] = np.outer(Bz[:, 0], C[k]), Az
        noise[:13, k], noise[z, k] = float(Dz[0, 0]) * B[:, k], Bz[:, 0]
    density = V * noise @ noise.T
    density[:13, :13] += W
    ours = found().one_channel
    assert ours is not None
    assert list(ours) == pytest.approx(deviations(solve_continuous_lyapunov(closed, -density)), rel=1e-4)


def test_on_the_equator_the_channel_that_the_earth_does_not_turn_is_one_channel() -> None:
    ours = found(lat_deg=0.0)
    sensors = {
        "gyro_arw_dpsh": 0.003, "gyro_instability_dph": 0.003, "gyro_tau_s": 3600.0,
        "accel_vrw_ugpshz": 10.0, "accel_instability_ug": 10.0, "accel_tau_s": 3600.0,
    }  # fmt: skip
    log = {"kind": "log", "noise_mps": 0.2, "rate_hz": 1.0, "drift_mps": 0.1, "drift_tau_s": 600.0}
    model = stochastic_model(Scenario.parse({"imu": sensors, "reference": log}))
    floor = steady_floor(model, OMEGA_S)
    assert floor.tilt_rad is not None and floor.tilt_rad / ARCSEC == pytest.approx(4.699, abs=1e-3)
    assert ours.floor.tilt_n_rad == pytest.approx(floor.tilt_rad, rel=1e-6)
    assert ours.one_channel is not None
    # a network has four states at most, the law of one channel five
    assert ours.one_channel.tilt_n_rad == pytest.approx(ours.both_channels.tilt_n_rad, rel=1e-3)


def test_knowing_the_earths_rotation_costs_nothing_and_holds_the_heading() -> None:
    for lat in (-45.0, 20.0, 70.0):
        ours = found(lat_deg=lat)
        one = ours.one_channel
        assert one is not None

        def cost(of: Deviations) -> float:
            tilt = (of.tilt_e_rad**2 + of.tilt_n_rad**2) * GRAVITY * SEMI_MAJOR_AXIS
            return tilt + of.velocity_e_mps**2 + of.velocity_n_mps**2

        assert cost(ours.floor) < cost(ours.both_channels) < cost(one)
        assert one.heading_rad > 2.0 * ours.both_channels.heading_rad > 2.0 * ours.floor.heading_rad


def test_the_documents_table_is_what_the_command_prints() -> None:
    text = (Path(__file__).parents[2] / "docs" / "design.md").read_text("utf-8")
    ours = found()
    for words, row in (
        ("floor of both channels", ours.floor),
        ("optimum of both channels", ours.both_channels),
        ("`optimal` on each channel", ours.one_channel),
    ):
        (line,) = (one for one in text.splitlines() if one.startswith(f"| {words} |"))
        printed = [float(cell) for cell in line.split("|")[2:-1]]
        assert row is not None
        units = ARCSEC, ARCSEC, ARCMIN, 1.0, 1.0
        values = [value / unit for value, unit in zip(row, units, strict=True)]
        assert printed == pytest.approx(values, abs=1e-3, rel=1e-3)


def test_a_network_that_lets_the_24_h_mode_grow_has_no_steady_state_beside_the_optimum() -> None:
    ours = found('id = "optimal", q = 0')
    assert ours.one_channel is None and ours.both_channels.tilt_e_rad < 1.05 * ours.floor.tilt_e_rad


LAW = """
import json, math
import numpy as np
from scipy.linalg import expm
import navcore
from navcore.law.hosted import Commands, UserLaw

A, B, K, OMEGA_S = (np.array(one) for one in json.loads({law!r}))
n = len(A)
step = np.zeros((n + 2, n + 2))
step[:n, :n], step[:n, n:] = A * OMEGA_S, B * OMEGA_S
moved = expm(step)

@navcore.register
class Both(UserLaw):
    id = "both"

    def start(self, at):
        x, held = np.zeros(n), np.zeros(2)

        def step(given):
            nonlocal x
            if given.log_valid == 1:
                held[:] = given.log_e_mps - given.v_e_mps, given.log_n_mps - given.v_n_mps
            after = moved[:n, :n] @ x + moved[:n, n:] @ held
            c = 0.5 * (K @ x + K @ after)
            x = after
            return Commands(given.v_e_mps + c[0], given.v_n_mps + c[1], OMEGA_S * c[2], OMEGA_S * c[3])

        return step

scenario = navcore.Scenario.parse({{
    "run": {{"duration_h": 12.0, "output_step_s": 600.0, "earth": "sphere"}},
    "site": {{"lat_deg": 50.0}},
    "initial_error": {{"attitude_arcmin": [1.0, -2.0, 30.0], "velocity_mps": [0.4, -0.2]}},
    "reference": {{"kind": "log", "bias_mps": [0.3, 0.1]}},
    "method": [{{"damping": "both"}}],
}})
(done,) = navcore.simulate(scenario).methods
assert done.status == "ok"
print(json.dumps(done.rows[:, :7].tolist()))
"""


@pytest.mark.slow
@pytest.mark.parametrize("feedback", [False, True])
def test_a_run_of_the_error_model_under_the_law_of_both_channels_is_its_linear_system(feedback: bool) -> None:
    """The law, in Python, on the engine's error model: errors of the start and of a biased log, over 12 h."""
    lat = math.radians(50.0)
    system = both_plant(EXAMPLE_SHIP, OMEGA_S, lat)
    law, _ = both_law(ControlProblem(EXAMPLE_SHIP, 0.01, 1.0, feedback), system)
    text = json.dumps([law.A.tolist(), law.B.tolist(), law.K.tolist(), OMEGA_S])
    out = subprocess.check_output([sys.executable, "-c", LAW.format(law=text)], text=True)
    rows = np.array(json.loads(out))
    A, B, C, _, _ = own_model(lat)
    n = len(law.A)
    closed = np.zeros((13 + n, 13 + n))
    closed[:13, :13], closed[:13, 13:] = A, B @ law.K
    closed[13:, :13], closed[13:, 13:] = -law.B @ C * OMEGA_S * TIME_S, law.A * OMEGA_S * TIME_S
    closed[11, 11] = closed[12, 12] = 0.0  # the log's error stands
    x = np.zeros(13 + n)
    x[:2], x[11:13] = (0.4, -0.2), (0.3, 0.1)
    x[3:6] = np.radians([1.0 / 60.0, -2.0 / 60.0, 0.5]) / ANGLE
    moved, expected = expm(closed * 600.0 / TIME_S), []
    for _ in rows:
        expected.append([*(ANGLE * x[3:6]), *x[:2]])
        x = moved @ x
    largest = np.abs(expected).max(axis=0)
    assert (np.abs(rows[:, :5] - expected).max(axis=0) < 0.01 * largest).all()


def test_the_command_says_it_of_optimal_alone(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["network", 'id = "optimal"', "--lat", "0"]) == 0
    said = capsys.readouterr().out
    assert "optimum of both channels" in said and "latitude 0°, standard deviations" in said
    assert main(["network", 'id = "optimal", q = 0', "--json"]) == 0
    told = json.loads(capsys.readouterr().out)["two_channel"]
    assert told["one_channel"] is None and set(told["floor"]) == set(Deviations._fields)
    assert "two_channel" not in network_report(parse_network('id = "classic2"'))

"""The filter of `bridge` against the channel that it models, and gains in force against the network's own."""

import math

import numpy as np
import pytest
from pydantic import ValidationError

from navcore.foundation.compiled import plain
from navcore.law.policy import POLICIES
from navcore.law.switching.bridge import _amplitude
from navcore.networks import parse_network
from navcore.networks.discrete import discretise
from tests.law_run import OMEGA_S, LawRun

LATEST = 900
BIAS = (0.5, -0.3)


def bridged_for(calls: int) -> tuple[LawRun, np.ndarray, list[bool]]:
    """A channel that swings with 1 m/s, without noise: law, true v and w (2, 2), level known at each call."""
    run = LawRun({"id": "complementary", "zeta": 0.5}, {"id": "constant"}, {"id": "bridge"})
    cos, sin = math.cos(OMEGA_S), math.sin(OMEGA_S)
    true, known = np.array([[1.0, 0.2], [-0.4, 0.7]]), []
    for call in range(calls):
        c = run.step(BIAS[0] - true[0, 0], BIAS[1] - true[1, 0])[:2]
        known.append(bool(run.value("switchings.bridge.known")))
        if call + 1 < calls:
            v, w = true[:, 0] + c, true[:, 1]
            true = np.column_stack([cos * v + sin * w - c, cos * w - sin * v])
    return run, true, known


@pytest.fixture(scope="module")
def bridged() -> tuple[LawRun, np.ndarray, list[bool]]:
    return bridged_for(1500)


def test_the_filter_finds_velocity_tilt_and_level_of_its_own_channel(bridged) -> None:
    run, true, _ = bridged
    z = run.s["switchings"]["bridge"]["z"]
    assert z[:, :2] == pytest.approx(true, abs=0.01)
    assert z[:, 2] == pytest.approx(BIAS, abs=0.01)
    P = run.s["switchings"]["bridge"]["P"]
    assert np.all(np.linalg.eigvalsh(P) > 0.0) and np.abs(P - P.T).max() < 1e-12
    assert 0.0 < P[2, 2] < 0.01


def test_the_level_is_taken_after_fifteen_minutes_of_a_trusted_log(bridged) -> None:
    run, _, known = bridged
    assert known.index(True) == LATEST - 1 and all(known[LATEST - 1 :])
    assert run.s["switchings"]["bridge"]["level"] == pytest.approx(BIAS, abs=0.05)


def left_of_a_swing(start: tuple[float, float], begun: int, calls: int) -> float:
    """Share of a channel's swing that the network leaves when it is fed with -v from a call on."""
    network = discretise(parse_network({"id": "complementary", "zeta": 0.5}).transfer(OMEGA_S), 1.0)
    cos, sin = math.cos(OMEGA_S), math.sin(OMEGA_S)
    (v, w), x = start, np.zeros(network.order)
    for call in range(calls - 1):
        u = -v if call >= begun else 0.0
        c = u - float(network.C @ x + network.D * u)
        x = x + network.dA @ x + network.B * u
        v, w = cos * (v + c) + sin * w - c, cos * w - sin * (v + c)
    return math.hypot(v, w) / math.hypot(*start)


def test_the_swing_is_damped_as_by_a_log_without_error_from_550_s_on() -> None:
    """For a ninth of a Schuler period a swing cannot be told from an offset of the log: it stands until then.

    After 6000 s the east swing is therefore at 0.52 of its beginning; with a perfect log it would be at 0.36.
    """
    _, true, _ = bridged_for(6000)
    for (v, w), start in zip(true, ((1.0, 0.2), (-0.4, 0.7)), strict=True):
        expected = left_of_a_swing(start, 550, 6000)
        assert math.hypot(v, w) / math.hypot(*start) == pytest.approx(expected, rel=0.01)


def test_the_weight_grows_from_12_to_24_times_the_variance() -> None:
    """theory.md 12: a = clip(q/12 - 1, 0, 1)."""
    P = np.diag([0.01, 0.03, 1.0])  # mean variance of v and w: 0.02
    for square, expected in ((0.2, 0.0), (0.24, 0.0), (0.36, 0.5), (0.48, 1.0), (5.0, 1.0)):
        z = math.sqrt(square / 4.0) * np.array([[-1.0, 1.0, 9.0], [1.0, -1.0, 9.0]])
        assert plain(_amplitude)(z, P) == pytest.approx(expected, abs=1e-9)


def test_the_compass_in_network_form_runs_the_network() -> None:
    network = {"id": "compass", "realisation": "network"}
    run = LawRun(network, {"id": "constant"}, {"id": "hard"})
    discrete = discretise(parse_network(network).transfer(OMEGA_S), 1.0)
    assert run.s["network"]["D"] == pytest.approx(1.0 - discrete.D, rel=1e-12)
    assert run.s["network"]["B"][0] == pytest.approx(discrete.B[0], rel=1e-12)
    assert run.law.p["feedback_k1"] == 0.0


def test_the_schedule_ends_with_the_feedback_of_its_last_gains() -> None:
    """c = -K2 d + P, P' = -K3 d: over a held step the mean of P is half a step behind."""
    k1, k2, k3 = 7.68e-3, 6.68, 0.4
    run = LawRun(
        {"id": "compass"}, {"id": "schedule", "to": [k1, k2, k3], "duration_s": 10.0}, {"id": "hard"}
    )
    for _ in range(20):
        run.step(0.1)
    assert run.value("network.D") == pytest.approx(-k2 - 0.5 * k3, rel=1e-12)
    assert run.value("network.B") == pytest.approx(-k3, rel=1e-12)
    assert run.value("feedback_gain") == pytest.approx(k1, rel=1e-12)


GAINS = {"k1": 2.0e-3, "k2": 3.0, "k3": 1.0e-3}


def test_a_schedule_that_stays_at_its_gains_is_the_compass_with_them_in_network_form() -> None:
    network = {"id": "compass", "realisation": "network", **GAINS}
    gains = list(GAINS.values())
    stays = LawRun(network, {"id": "schedule", "from": gains, "to": gains}, {"id": "hard"})
    constant = LawRun(network, {"id": "constant"}, {"id": "hard"})
    for d in np.sin(0.05 * np.arange(100)):
        expected = constant.step(float(d), float(d) - 0.2)
        assert np.any(expected != 0.0)
        assert stays.step(float(d), float(d) - 0.2) == pytest.approx(expected, rel=1e-9, abs=1e-12)


def test_a_schedule_rests_where_a_constant_difference_moves_it_no_more() -> None:
    gains = list(GAINS.values())
    run = LawRun(
        {"id": "compass", "realisation": "network"},
        {"id": "schedule", "from": gains, "to": gains},
        {"id": "hard"},
    )
    run.step(0.1)
    network = run.s["network"]  # dA is A - I
    assert network["steady"][0] == pytest.approx(-network["B"][0] / network["dA"][0, 0], rel=1e-9)


@pytest.mark.parametrize("step_s", [0.2, 1.0])
def test_the_feedback_form_opposes_the_difference(step_s) -> None:
    """c = -K2 d + P, P' = -K3 d: the first step, from rest, holds the mean of P over half a step."""
    run = LawRun({"id": "compass", **GAINS}, {"id": "constant"}, {"id": "hard"}, step_s=step_s)
    k2, k3 = GAINS["k2"], GAINS["k3"]
    assert run.step(0.5, -0.2)[:2] == pytest.approx([-(k2 + 0.5 * k3 * step_s) * d for d in (0.5, -0.2)])
    assert run.value("feedback_gain") == 0.0 and run.law.p["feedback_k1"] == pytest.approx(GAINS["k1"])


def test_a_network_without_velocity_feedback_asks_for_no_acceleration() -> None:
    run = LawRun({"id": "complementary"}, {"id": "constant"}, {"id": "hard"})
    for d in (0.3, -0.1, 0.2):
        c_e, _, a_e, a_n = run.step(d, 0.1)
        assert c_e != 0.0 and (a_e, a_n) == (0.0, 0.0)
    network = run.law.s["network"]
    assert not network["E"].any() and network["F"] == 0.0


def test_gains_that_would_make_h_zero_are_refused_and_k3_zero_alone_is_not() -> None:
    schedule = POLICIES["schedule"]
    with pytest.raises(ValidationError, match="H would be zero"):
        schedule.model_validate({"id": "schedule", "from": [1e-3, -1.0, 0.0]})
    for gains in ([1e-3, 1.0, 0.0], [1e-3, -1.0, 1e-3]):
        assert schedule.model_validate({"id": "schedule", "to": gains}).packed(1.0)["last"] == tuple(gains)


def test_a_schedule_without_k1_has_no_state_to_rest_in() -> None:
    gains = [0.0, 1.0, 1e-3]
    run = LawRun(
        {"id": "compass", "realisation": "network"},
        {"id": "schedule", "from": gains, "to": gains},
        {"id": "hard"},
    )
    run.step(0.1)
    assert run.value("network.steady") == 0.0


def test_the_gains_of_a_schedule_pass_without_a_jump_in_network_form() -> None:
    """A steady difference of 1 m/s: halfway through the passage the gains are the mean of both ends."""
    first, last = (4.0e-3, 3.0, 2.0e-3), (2.0e-3, 2.0, 1.0e-3)
    run = LawRun(
        {"id": "compass", "realisation": "network"},
        {"id": "schedule", "from": list(first), "to": list(last), "duration_s": 100.0},
        {"id": "hard"},
    )
    found = np.array([run.step(1.0)[0] for _ in range(201)])
    # c = -K2 u + v; v' = -K1 v + (K1 (1 + K2) - K3) u, with the gains of each moment
    v, expected = 0.0, []
    for k in range(201):
        share = min(k / 100.0, 1.0)
        k1, k2, k3 = (a + share * (b - a) for a, b in zip(first, last, strict=True))
        expected.append(v - k2)
        v += -k1 * v + k1 * (1.0 + k2) - k3
    assert found == pytest.approx(np.array(expected), abs=0.02)
    assert np.abs(np.diff(found)).max() < 0.05


def test_at_a_constant_velocity_no_acceleration_is_measured() -> None:
    run = LawRun({"id": "classic2"}, {"id": "acceleration"}, {"id": "hard"})
    for _ in range(40):
        run.step(0.1, v_c=(3.0, 4.0))
    assert run.value("measure") == 0.0

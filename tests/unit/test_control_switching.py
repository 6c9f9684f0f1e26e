"""Every switching method against a sequence computed by hand; re-tuning keeps the correction continuous."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from navcore.law.law import Law
from navcore.law.records import Sensed
from navcore.law.switching import SWITCHINGS
from navcore.law.tuned_network import retune, tune
from navcore.networks import parse_network
from navcore.networks.discrete import discretise
from tests.law_run import OMEGA_S, LawRun, call_law, sampled_radius

COMPLEMENTARY = {"id": "complementary", "zeta": 0.5}
THRESHOLD = {"id": "threshold", "limit_mps": 1.0}
TUNABLE = [
    COMPLEMENTARY,
    {"id": "complementary", "eta": 0.8},
    {"id": "unity2"},
    {"id": "unity2", "zeta2": 1.3, "r": 2.0},
    {"id": "unity2", "alpha": 0.004},
    {"id": "pole2"},
    {"id": "pole2", "variant": "as_printed"},
]


def matrices(law: Law) -> tuple[np.ndarray, np.ndarray, np.ndarray, float, np.ndarray]:
    """The discrete network in the state: dA, B, C, D, steady state."""
    n, net = int(law.p["order"]), law.s["network"]
    return net["dA"][:n, :n], net["B"][:n], net["C"][:n], float(net["D"]), net["steady"][:n]


def response(dA: np.ndarray, B: np.ndarray, C: np.ndarray, D: float, omega: np.ndarray) -> np.ndarray:
    z = np.expm1(1j * omega)
    return np.array([C @ np.linalg.solve(zk * np.eye(len(B)) - dA, B) + D for zk in z])


@pytest.mark.parametrize("network", TUNABLE, ids=str)
@pytest.mark.parametrize("step_s", [1.0, 0.005])
def test_a_tuned_network_is_the_network_with_that_coefficient(network, step_s):
    run = LawRun(network, {"id": "constant"}, {"id": "step"}, step_s=step_s)
    omega = OMEGA_S * step_s * np.geomspace(0.01, 100.0, 40)
    for xi in (0.04, 0.12, 0.5, 0.99):
        tune(run.law.p, run.s, xi)
        got = response(*matrices(run.law)[:4], omega)
        d = discretise(run.network.with_damping(xi).transfer(OMEGA_S), step_s)
        expected = 1.0 - d.response(omega / step_s)
        assert np.abs(got - expected).max() < 1e-9 * np.abs(expected).max()
        dA, B, _, _, steady = matrices(run.law)
        assert np.abs(dA @ steady + B).max() < 1e-12 * np.abs(steady).max()


@given(
    st.sampled_from(TUNABLE), st.floats(0.04, 0.99), st.floats(0.04, 0.99), st.floats(-3.0, 3.0),
    st.integers(0, 2**31),
)  # fmt: skip
@settings(max_examples=150, deadline=None)
def test_retuning_keeps_the_correction_and_what_is_at_rest(network, before, after, u, seed):
    """The correction for the present input stays to rounding; a network at rest stays at rest."""
    run = LawRun(network, {"id": "constant"}, {"id": "step"})
    p, s = run.law.p, run.s
    tune(p, s, before)
    n = int(p["order"])
    s["x"][0, :n] = np.random.default_rng(seed).normal(0.0, 1.0, n)
    _, _, C, D, _ = matrices(run.law)
    c = C @ s["x"][0, :n] + D * u
    size = np.abs(C) @ np.abs(s["x"][0, :n]) + abs(D * u)
    retune(p, s, after, u, u)
    _, _, C, D, _ = matrices(run.law)
    assert abs(C @ s["x"][0, :n] + D * u + s["offset"][0] - c) <= 1e-11 * (size + 1.0)
    tune(p, s, before)
    s["offset"][0] = 0.0
    s["x"][0, :n] = matrices(run.law)[4] * u
    retune(p, s, after, u, u)
    assert s["x"][0, :n] == pytest.approx(matrices(run.law)[4] * u, abs=1e-12)
    h0 = run.network.with_damping(after).transfer(OMEGA_S).h0
    assert abs(matrices(run.law)[2] @ s["x"][0, :n] + matrices(run.law)[3] * u - (1.0 - h0) * u) < 1e-10


@given(st.lists(st.tuples(st.sampled_from(TUNABLE[2:]), st.floats(0.04, 0.99)), min_size=2, max_size=40))
@settings(max_examples=60, deadline=None)
def test_no_retuning_however_fast_excites_a_two_pole_network(steps):
    """(X_1 - u)^2 + X_2^2 never grows under a constant input, whatever xi does at each step."""
    network = steps[0][0]
    run = LawRun(network, {"id": "constant"}, {"id": "step"})
    p, s, u = run.law.p, run.s, 1.0
    energy = 1.0
    for _, xi in steps:
        retune(p, s, xi, u, u)
        for _ in range(20):
            dA, B, _, _, _ = matrices(run.law)
            s["x"][0, :2] += dA @ s["x"][0, :2] + B * u
            now = float((s["x"][0, 0] - u) ** 2 + s["x"][0, 1] ** 2)
            assert now <= energy * (1.0 + 1e-3) + 1e-12
            energy = min(energy, max(now, 1e-12)) if now < energy else energy


def test_a_retuned_correction_fades_into_the_new_networks_in_100_s():
    run = LawRun({"id": "unity2"}, {"id": "adaptive", "lowpass_s": 1e-3}, {"id": "hard"})
    run.series([0.0] * 5)
    before = run.step(0.0)[0]
    jump = run.step(1.0)[0]
    assert before == 0.0 and abs(jump) < 0.5, "the correction has not jumped with xi and the log"
    offset = run.value("offset")
    run.series([1.0] * 100)
    assert run.value("offset") == pytest.approx(offset * math.exp(-1.0), rel=1e-9)


def test_hard_clears_and_corrects_nothing_while_undamped():
    run = LawRun(COMPLEMENTARY, THRESHOLD, {"id": "hard"})
    run.series([0.5] * 200)
    assert run.step(0.5)[0] != 0.0
    assert np.all(run.series([2.0] * 5, "damped", "xi", "correction") == 0.0)
    fresh = LawRun(COMPLEMENTARY, THRESHOLD, {"id": "hard"})
    for _ in range(20):
        assert run.step(0.7)[0] == fresh.step(0.7)[0]


def test_keep_runs_on_masked():
    """Away and back, the network has seen all of it: as if it had been damped all along."""
    run = LawRun(COMPLEMENTARY, THRESHOLD, {"id": "keep"})
    always = LawRun(COMPLEMENTARY, {"id": "constant"}, {"id": "keep"})
    for d in [0.5] * 200 + [2.0] * 50:
        c, c_always = run.step(d), always.step(d)
        assert c[0] == (c_always[0] if d < 1.0 else 0.0)
    assert run.step(0.5)[0] == always.step(0.5)[0]


def test_keep_stands_still_without_a_log():
    run = LawRun(COMPLEMENTARY, THRESHOLD, {"id": "keep"})
    run.series([0.5] * 200)
    before = run.s["x"][0].copy()
    run.series([0.5] * 10, valid=False)
    assert run.s["x"][0] == pytest.approx(before, abs=0.0)


def test_ramp_raises_the_coefficient_and_freezes_the_correction():
    """Liu's fig. 10: xi e^-49, xi e^-48, ... xi, each second, from the switch on; c_k stays undamped."""
    run = LawRun(COMPLEMENTARY, THRESHOLD, {"id": "ramp"})
    assert np.all(run.series([0.5] * 300, "xi") == 0.5), "the start is no switch"
    frozen = run.value("correction")
    assert frozen != 0.0
    for _ in range(200):
        assert run.step(2.0)[0] == frozen
        assert run.value("xi") == 0.0
    xi = run.series([0.5] * 60, "xi")[:, 0]
    expected = [0.5 * math.exp(-max(49 - m, 0)) for m in range(60)]
    assert xi == pytest.approx(expected, rel=1e-12)
    assert xi[0] == pytest.approx(0.5 * 5.2e-22, rel=0.01)


def test_a_second_event_within_the_ramp_begins_it_anew():
    run = LawRun(COMPLEMENTARY, THRESHOLD, {"id": "ramp", "duration_s": 10.0})
    run.series([0.5] * 3 + [2.0] * 3 + [0.5] * 5 + [2.0])
    xi = run.series([0.5] * 12, "xi")[:, 0]
    assert xi == pytest.approx([0.5 * math.exp(-max(9 - m, 0)) for m in range(12)], rel=1e-12)


def liu_19(differences: np.ndarray, zetas: np.ndarray) -> np.ndarray:
    """Corrections of Liu's recursion (17)-(19) from rest, T = 1 s, in long double."""
    u = 1.0 / np.tan(np.longdouble(0.5) * np.longdouble(OMEGA_S))
    c, r, out = [np.longdouble(0)] * 4, [np.longdouble(0)] * 4, []
    for difference, zeta in zip(np.longdouble(differences), np.longdouble(zetas), strict=True):
        d1, d2, d3 = (1 + zeta) * u**3, (3 + 4 * zeta) * u**2, (2 * zeta + 1) * u
        now = 4 * (u**4 + d1 - d3 - 1) * c[0] - 2 * (3 * u**4 - d2 + 3) * c[1]
        now += 4 * (u**4 - d1 + d3 - 1) * c[2] - (u**4 - 2 * d1 + d2 - 2 * d3 + 1) * c[3]
        now += 2 * zeta * u * (difference + 2 * r[0] - 2 * r[2] - r[3])
        now /= u**4 + 2 * d1 + d2 + 2 * d3 + 1
        c, r = [now, *c[:3]], [difference, *r[:3]]
        out.append(float(now))
    return np.array(out)


@pytest.mark.parametrize("form", ["state", "as_printed"])
def test_lius_recursion_never_sees_what_stands_during_the_ramp(form):
    """A standing 0.5 m/s at re-engagement, then +0.3 m/s: Liu 19 answers to the 0.3 alone.

    So printed, the ramp is a restart at the steady state; with the filter's *states* cleared, as his text
    has it, the 0.5 m/s arrives as a step.
    """
    again = np.where(np.arange(1500) < 300, 0.5, 0.8)
    run = LawRun(COMPLEMENTARY, THRESHOLD, {"id": "ramp", "form": form})
    run.series([0.0, 2.0])
    got = run.series(again, "correction")[:, 0]
    zetas = 0.5 * np.exp(-np.clip(49.0 - np.arange(1500.0), 0.0, None))
    printed = liu_19(again, zetas)
    step = liu_19(np.where(np.arange(1500) < 300, 0.0, 0.3), np.full(1500, 0.5))
    assert np.abs(printed - step).max() < 1e-4 * np.abs(step).max()
    whole = liu_19(again, np.full(1500, 0.5))
    expected = printed if form == "as_printed" else whole
    assert np.abs(got - expected).max() < 0.01 * np.abs(expected).max()
    assert np.abs(whole).max() > 2.0 * np.abs(printed).max()


def test_step_moves_by_a_tenth_every_two_minutes():
    run = LawRun(COMPLEMENTARY, THRESHOLD, {"id": "step"})
    seen = run.series([0.5] * 300, "xi", "damped")
    assert np.all(seen == [0.5, 1.0]), "the start is no switch"
    away = run.series([2.0] * 700, "xi", "damped")
    assert away[::120, 0] == pytest.approx([0.4, 0.3, 0.2, 0.1, 0.0, 0.0], abs=1e-12)
    assert away[119, 0] == pytest.approx(0.4) and away[479, 1] == 1.0 and away[480, 1] == 0.0
    back = run.series([0.5] * 700, "xi", "damped")
    assert back[::120, 0] == pytest.approx([0.1, 0.2, 0.3, 0.4, 0.5, 0.5], abs=1e-12)
    assert np.all(back[:, 1] == 1.0)


def test_step_without_a_log_is_undamped_at_once():
    run = LawRun(COMPLEMENTARY, THRESHOLD, {"id": "step"})
    run.series([0.5] * 10)
    assert run.series([0.5], "xi", "damped", valid=False).tolist() == [[0.0, 0.0]]
    assert run.series([0.5], "xi", "damped").tolist() == [[0.1, 1.0]]


def test_step_follows_the_adaptive_law_by_a_tenth_at_a_time():
    run = LawRun({"id": "unity2"}, {"id": "adaptive", "lowpass_s": 1e-3}, {"id": "step"})
    assert run.series([0.0], "xi")[0, 0] == 0.99
    xi = run.series([10.0] * 1500, "xi")[:, 0]
    steps = np.diff(np.concatenate([[0.99], xi]))
    assert steps.min() == pytest.approx(-0.1) and xi[-1] == 0.04
    moves = np.flatnonzero(steps)
    assert len(moves) == 10 and np.all(np.diff(moves) == 120)


def test_bumpless_restores_the_state_of_before_moved_by_the_change_of_the_mean():
    """n = 4 s, memory = 6 s: by hand, with the network's own matrices."""
    block = {"id": "bumpless", "n_s": 4.0, "memory_s": 6.0}
    run = LawRun(COMPLEMENTARY, THRESHOLD, block)
    d = discretise(parse_network(COMPLEMENTARY).transfer(OMEGA_S), 1.0)
    rng = np.random.default_rng(4)
    quiet = 0.5 + rng.normal(0.0, 0.05, 80)
    x, states = np.zeros(4), []
    for k, u in enumerate(quiet):
        c = run.step(u)[0]
        states.append(x.copy())  # before this sample
        if k < 3:
            assert c == 0.0 and run.value("damped") == 0.0, "not yet n differences"
            continue
        if k == 3:
            x = d.steady_state(float(np.mean(quiet[:4])))
            states[-1] = x.copy()
        c_expected = -d.C @ x + (1.0 - d.D) * u
        assert c == pytest.approx(c_expected, abs=1e-15)
        x = x + d.dA @ x + d.B * u
    frozen = run.value("correction")
    event = [2.0, 1.9, 2.1]
    for u in event:
        assert run.step(u)[0] == frozen
    # the switch came with sample 80: 6 s before it is sample 74, and its mean that of samples 71..74
    x0, m0 = states[74], np.mean(quiet[71:75])
    m1 = np.mean([*event, -0.5])
    c = run.step(-0.5)[0]
    x = x0 + d.steady_state(1.0) * (m1 - m0)
    assert c == pytest.approx(-d.C @ x + (1.0 - d.D) * -0.5, abs=1e-14)
    assert run.s["x"][0, :4] == pytest.approx(x + d.dA @ x - 0.5 * d.B, abs=1e-13)


def test_bumpless_keeps_what_it_put_aside_when_the_memory_reaches_into_an_event():
    block = {"id": "bumpless", "n_s": 2.0, "memory_s": 20.0}
    run = LawRun(COMPLEMENTARY, THRESHOLD, block)
    run.series([0.5] * 100)
    run.series([2.0] * 5)
    one = run.s["switchings"]["bumpless"]["x"].copy()
    run.series([0.6] * 8)  # damped again, but 20 s before the next event lies the first
    run.series([2.0] * 5)
    assert run.s["switchings"]["bumpless"]["x"] == pytest.approx(one, abs=0.0)
    assert np.any(one != 0.0)


def test_bumpless_waits_for_a_mean_after_a_gap():
    run = LawRun(COMPLEMENTARY, {"id": "constant"}, {"id": "bumpless", "n_s": 5.0, "memory_s": 10.0})
    run.series([0.5] * 50)
    assert not run.series([0.5] * 5, "damped", valid=False).any()
    assert run.series([0.9] * 8, "damped")[:, 0].tolist() == [0, 0, 0, 0, 1, 1, 1, 1]
    # 0.4 m/s have come for good: at rest with the new difference, as it was with the old one
    c = run.series([0.9] * 2000, "correction")[:, 0]
    assert np.abs(c).max() < 1e-9


@pytest.mark.parametrize("policy", [{"id": "constant"}, {"id": "threshold"}], ids=lambda p: p["id"])
@pytest.mark.parametrize("damping", ["external", "internal"])
@pytest.mark.parametrize(
    "network", [COMPLEMENTARY, {"id": "compass"}, {"id": "classic2"}], ids=lambda n: n["id"]
)
def test_the_plain_step_gives_what_the_full_one_gives(policy, damping, network):
    runs = [LawRun(network, policy, {"id": "hard"}, damping) for _ in range(2)]
    runs[1].law.p["plain"] = False
    rng = np.random.default_rng(5)
    for k in range(400):
        d, v, valid = rng.normal(0.3, 0.2, 2), (5.0 + 0.01 * k, -2.0), not 200 <= k < 230
        results = [run.step(*d, valid=valid, v_c=v) for run in runs]
        assert np.array_equal(results[0], results[1])
    for name in ("damped", "wanted", "xi", "measure", "correction", "difference", "valid", "x"):
        assert np.array_equal(runs[0].s[name], runs[1].s[name]), name


def test_sampled_radius_knows_a_stable_loop_from_an_unstable_one():
    stable = parse_network({"id": "unity2", "zeta": 0.5})
    assert 0.99 < sampled_radius(stable, OMEGA_S, 1.0) < 1.0
    unstable = parse_network({"id": "pole2", "xi": 0.06, "variant": "as_printed"})
    assert 1.0 < sampled_radius(unstable, OMEGA_S, 1.0) < 1.01
    decay = math.exp(-0.5 * 1.2 * OMEGA_S)  # the pair at 1.2 omega_s with damping 0.5
    assert sampled_radius(stable, OMEGA_S, 1.0) == pytest.approx(decay, abs=5e-6)


def test_law_step_of_a_free_method_does_nothing():
    run = LawRun(COMPLEMENTARY, {"id": "variation"}, {"id": "bumpless"}, damping="free")
    assert call_law(run.law, Sensed(1.0, 2.0, 0.2)) == (0.0, 0.0, 0.0, 0.0)


@pytest.mark.parametrize("switching", list(SWITCHINGS))
def test_north_is_switched_as_east(switching: str) -> None:
    """What the log says of one channel alone gives in the other, said of that alone, the same correction."""
    policy = {"id": "threshold", "limit_mps": 0.5}
    east, north = (LawRun({"id": "complementary"}, policy, {"id": switching}) for _ in range(2))
    t = np.arange(400)
    differences = 0.3 * np.sin(0.02 * t) + np.where((t > 250) & (t < 300), 1.0, 0.0)
    found = np.array([[*east.step(d, 0.0), east.value("damped")] for d in differences])
    other = np.array([[*north.step(0.0, d), north.value("damped")] for d in differences])
    assert np.all(found[:, [1, 3]] == 0.0) and np.ptp(found[250:, 0]) > 1e-5
    assert other[:, [1, 0, 3, 2, 4]] == pytest.approx(found, rel=1e-12, abs=1e-15)
    if switching not in ("keep", "step"):
        assert set(found[200:, 4]) == {0.0, 1.0}

"""Every policy against a sequence computed by hand."""

import math

import numpy as np
import pytest

from navcore.engine.simulation import simulate
from navcore.foundation.compiled import inlined
from navcore.foundation.records import REAL, new_record, record_type
from navcore.foundation.units import DEG, KNOT
from navcore.law.dispatch import Choice, dispatch
from navcore.law.policy import POLICIES
from navcore.law.policy.adaptive import SUN_TABLE, law_coefficient
from navcore.law.policy.schedule import Schedule
from navcore.law.policy.variation import Variation
from navcore.law.records import Law, Watched
from navcore.law.switching import SWITCHINGS
from navcore.networks import parse_network
from navcore.scenario.model import Scenario
from tests.law_run import LawRun

CLASSIC = {"id": "classic2"}
HARD = {"id": "hard"}
COMPASS = parse_network({"id": "compass"})


def coefficient(run: LawRun, difference: float, unit: float = KNOT) -> float:
    """What the adaptive law answers to a difference in knots."""
    p = run.law.p
    return law_coefficient(p["policies"]["adaptive"], float(p["tuning"]["low"]), difference * unit)


@pytest.mark.parametrize("registry", [POLICIES, SWITCHINGS], ids=["policies", "switchings"])
def test_every_entry_of_a_registry_goes_by_its_own_name_and_is_compiled(registry):
    assert all(kind.model_fields["id"].default == id for id, kind in registry.items())
    assert all(hasattr(kind, "decide") or hasattr(kind, "switch") for kind in registry.values())


def test_a_dispatch_calls_the_function_of_the_number_with_its_own_records():
    kind = record_type(one=record_type(a=REAL), two=record_type(a=REAL))
    law = Law(new_record(record_type(part=kind)), new_record(record_type(part=kind)), np.zeros(1))
    law.p["part"]["one"]["a"], law.p["part"]["two"]["a"] = 10.0, 20.0

    @inlined
    def first(own, memory, law, x):
        memory.a += 1.0
        return own.a + x

    @inlined
    def second(own, memory, law, x):
        memory.a += 2.0
        return own.a - x

    call = dispatch("part", [Choice(0, "one", first), Choice(3, "two", second)], -1.0)
    assert [call(number, law, 1.0) for number in (0, 3, 3, 1)] == [11.0, 19.0, 19.0, -1.0]
    assert [float(law.s["part"][name]["a"]) for name in ("one", "two")] == [1.0, 4.0]


def test_what_is_monitored_is_named_with_its_unit_and_thresholds():
    assert Watched._fields == ("wanted", "damped", "xi", "measure")
    for id, kind in POLICIES.items():
        block = kind.model_validate({"id": id})
        assert all(limit.unit == block.measure.unit for limit in block.limits()), id
        assert bool(block.limits()) == (
            id in ("threshold", "yaw_rate", "acceleration", "variation", "mobility")
        )
    shown = {limit.name: limit.value for limit in Variation().limits()}
    assert shown == {"a": 0.25, "b": 0.35, "c": 0.45}


def test_variation_follows_lius_figure_9_step_by_step():
    """n = t0 = one sample, so s is the difference's own change; count 3."""
    block = {"id": "variation", "n_s": 1.0, "t0_s": 1.0, "count": 3}
    wanted_s = [0.5, 0.5, 0.3, 0.5, 0.46, 0.5, 0.3, 0.1, 0.2, 0.5, 0.25, 0.2, 0.1, 0.3]
    #      wish   u    u    -    u    u     u    -    d    d    u    d     d    d    -
    counts = [1, 2, 0, 1, 2, 0, 0, 1, 2, 0, 1, 2, 0, 0]
    wishes = [0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 1, 1, 1, 1]
    states = [1, 1, 1, 1, 1, 0, 0, 0, 0, 0, 0, 0, 1, 1]
    run = LawRun(CLASSIC, block, HARD)
    differences = np.concatenate([[0.0], np.cumsum(wanted_s)])
    seen = run.series(differences, "measure", "policies.variation.count", "wanted", "damped")
    assert seen[0].tolist() == [0.0, 0.0, 1.0, 1.0], "nothing to compare with yet"
    assert seen[1:, 0] == pytest.approx(wanted_s, abs=1e-12)
    assert seen[1:, 1].tolist() == counts
    assert seen[1:, 2].tolist() == wishes
    assert seen[1:, 3].tolist() == states


def test_variation_takes_windows_of_n_and_t0_and_the_larger_channel():
    """n = 2, t0 = 3: a step of 1 in the east gives 0.5, 1, 1, 0.5, 0; one of 2 in the north twice that."""
    block = {"id": "variation", "n_s": 2.0, "t0_s": 3.0, "count": 2}
    run = LawRun(CLASSIC, block, HARD)
    seen = [
        (run.step(0.0 if k < 7 else 1.0, 0.0 if k < 20 else 2.0), run.value("measure"), run.value("damped"))
        for k in range(30)
    ]
    measure = np.array([row[1] for row in seen])
    assert measure[:7] == pytest.approx(0.0)
    assert measure[7:13] == pytest.approx([0.5, 1.0, 1.0, 0.5, 0.0, 0.0])
    assert measure[20:26] == pytest.approx([1.0, 2.0, 2.0, 1.0, 0.0, 0.0])
    assert [row[2] for row in seen[7:14]] == [1, 0, 0, 0, 0, 1, 1]


def test_variation_needs_a_log_without_gaps_as_long_as_its_windows():
    run = LawRun(CLASSIC, {"id": "variation", "n_s": 2.0, "t0_s": 3.0, "count": 1}, HARD)
    run.series(np.zeros(10), "measure")
    gap = run.series(np.full(3, 5.0), "measure", "damped", valid=False)
    assert np.all(gap == 0.0)
    back = run.series(np.full(12, 5.0), "measure", "damped")
    assert np.all(back == [0.0, 1.0]), "what the log did during the gap is no variation"


@pytest.mark.parametrize("b", [0.26, 0.35, 0.44])
@pytest.mark.parametrize("s", [0.251, 0.299, 0.35, 0.401, 0.449])
def test_variation_keeps_either_state_between_a_and_c_wherever_b_is(b, s):
    """Liu's list below (16): the largest membership would damp at 0.251 m/s and undamp at 0.449 m/s."""
    block = {"id": "variation", "n_s": 1.0, "t0_s": 1.0, "count": 1, "b": b}
    ramp = np.arange(10)
    run = LawRun(CLASSIC, block, HARD)
    kept = run.series(s * ramp, "measure", "damped")
    assert kept[2:] == pytest.approx(np.array([[s, 1.0]] * 8))
    run.series([0.0, 5.0], "damped")
    assert run.value("damped") == 0.0
    kept = run.series(5.0 + s * ramp[1:], "measure", "damped")
    assert kept == pytest.approx(np.array([[s, 0.0]] * 9))
    run.series([5.0 + s * 9.0] * 2, "damped")
    assert run.value("damped") == 1.0


def test_yaw_rate_counts_turns_over_the_window_across_north():
    """1 deg a second through north from 355 deg; window 4 s, limit 3 deg."""
    run = LawRun(CLASSIC, {"id": "yaw_rate", "window_s": 4.0, "limit_deg": 3.0}, HARD)
    headings = [355.0] * 3 + [(355.0 + k) % 360.0 for k in range(1, 11)] + [5.0] * 6
    seen = []
    for heading in headings:
        run.step(0.0, heading=heading * DEG)
        seen.append([run.value("measure") / DEG, run.value("damped")])
    change, damped = np.array(seen).T
    assert change == pytest.approx([0, 0, 0, 1, 2, 3, 4, 4, 4, 4, 4, 4, 4, 3, 2, 1, 0, 0, 0], abs=1e-9)
    # exactly 3 deg is left out: it lies on the limit to rounding
    assert damped[change < 2.5].all() and not damped[change > 3.5].any()


@pytest.mark.parametrize("fidelity", ["error_model", "strapdown"])
def test_yaw_rate_looks_at_the_heading_that_the_ship_has(fidelity):
    """A gyro with 10 deg/h about the vertical turns the computed heading of a ship that lies still."""
    method = {"damping": "external", "network": {"id": "classic2"},
              "policy": {"id": "yaw_rate", "window_s": 600.0, "limit_deg": 1.0}}  # fmt: skip
    run = {"duration_h": 0.5, "fidelity": fidelity, "output_step_s": 60.0, "rate_hz": 10.0}
    for drift, share in ((10.0, (0.1, 0.5)), (0.0, (1.0, 1.0))):
        data = {"run": run, "imu": {"gyro_bias_dph": [0.0, 0.0, drift]}, "reference": {"kind": "log"}}
        found = simulate(Scenario.parse({**data, "method": [method]})).methods[0]
        assert share[0] <= found.law_in_force.damped_share <= share[1]
        turned = abs(found.rows[-1, 2] - found.rows[-11, 2])
        assert found.law_series[-1, 3] == pytest.approx(turned, rel=1e-3, abs=1e-9)


def test_yaw_rate_sees_a_whole_turn():
    run = LawRun(CLASSIC, {"id": "yaw_rate", "window_s": 60.0, "limit_deg": 5.0}, HARD)
    for k in range(61):
        run.step(0.0, heading=(6.0 * k % 360.0) * DEG)
    assert run.value("measure") == pytest.approx(2.0 * math.pi)


def test_acceleration_is_averaged_over_what_is_there():
    run = LawRun(CLASSIC, {"id": "acceleration", "mean_s": 4.0, "limit_mps2": 0.02}, HARD)
    seen = []
    speed = 7.0
    for a in [0.0, 0.0, 0.04, 0.04, 0.04, 0.04, 0.0, 0.0, 0.0, 0.0, 0.0]:
        speed += a
        run.step(0.0, v_c=(0.6 * speed, -0.8 * speed))
        seen.append([run.value("measure"), run.value("damped")])
    mean, damped = np.array(seen).T
    assert mean == pytest.approx([0, 0, 0.04 / 3, 0.02, 0.03, 0.04, 0.03, 0.02, 0.01, 0, 0], abs=1e-12)
    assert damped[[0, 1, 2, 4, 5, 6, 8, 9, 10]].tolist() == [1, 1, 1, 0, 0, 0, 1, 1, 1]


def test_adaptive_law_meets_suns_table_and_is_monotone_between():
    run = LawRun({"id": "unity2"}, {"id": "adaptive"}, HARD)
    for row in SUN_TABLE:
        assert coefficient(run, row.difference_kn) == pytest.approx(row.xi, abs=1e-12)
    fine = [coefficient(run, kn) for kn in np.linspace(0.0, 5.0, 2001)]
    assert np.all(np.diff(fine) <= 1e-15)
    assert fine[-1] == 0.04


@pytest.mark.parametrize(
    ("knots", "xi"), [(0.0, 0.8101), (0.5, 0.3144), (1.5, 0.04), (3.0, 0.1429), (9.0, 0.99)]
)
def test_adaptive_quadratic_is_clamped_and_says_so(knots, xi):
    run = LawRun({"id": "unity2"}, {"id": "adaptive", "law": "quadratic"}, HARD)
    assert coefficient(run, knots) == pytest.approx(xi, abs=1e-4)
    assert "between 0.95 and 2.77 kn, where it is negative" in run.policy.warnings(run.network)[0]


@pytest.mark.parametrize(
    ("knots", "xi"), [(0.0, 0.8101), (0.1, 0.9277), (0.15, 0.9888), (0.16, 0.99), (3.0, 0.99)]
)
def test_sun_9_as_printed_rises_with_the_difference_and_says_so(knots, xi):
    run = LawRun({"id": "unity2"}, {"id": "adaptive", "law": "as_printed"}, HARD)
    assert coefficient(run, knots) == pytest.approx(xi, abs=1e-4)
    assert "held at ζ = 0.99 from a difference of 0.15 kn on" in run.policy.warnings(run.network)[0]


def test_adaptive_takes_the_users_table_in_any_order():
    table = [[2.0, 0.1], [0.0, 0.9], [1.0, 0.5]]
    run = LawRun({"id": "none"}, {"id": "adaptive", "table": table}, HARD)
    assert [coefficient(run, kn) for kn in (0.0, 1.0, 2.0, 7.0)] == pytest.approx([0.9, 0.5, 0.1, 0.1])


def test_adaptive_follows_the_low_passed_norm_of_the_difference():
    """From (0.3, 0.4) m/s to zero: the norm falls as 0.5 e^(-t/100 s)."""
    run = LawRun({"id": "unity2"}, {"id": "adaptive"}, HARD)
    run.step(0.3, 0.4)
    assert run.value("measure") == pytest.approx(0.5)
    for k in range(1, 400):
        run.step(0.0, 0.0)
        assert run.value("measure") == pytest.approx(0.5 * math.exp(-k / 100.0), rel=1e-12)
        assert run.value("xi") == coefficient(run, run.value("measure"), unit=1.0)


@pytest.mark.parametrize("realisation", ["feedback", "network"])
def test_schedule_moves_the_gains_in_60_s_and_again_after_a_gap(realisation):
    """Zha 4.2 with a constant difference of 1 m/s: a = K1, c = -K2 + integral part."""
    run = LawRun({"id": "compass", "realisation": realisation}, {"id": "schedule"}, HARD)
    first, last = np.array([0.0264, 156.063, 0.904]), np.array([7.68e-3, 6.68, 7.68e-3])
    for begin in range(2):
        integral = 0.0
        for m in range(100):
            k1, k2, k3 = first + min(m / 60.0, 1.0) * (last - first)
            c, _, a, _ = run.step(1.0)
            if realisation == "feedback":
                assert a == pytest.approx(k1, rel=1e-12)
                assert c == pytest.approx(integral - 0.5 * k3 - k2, rel=1e-12), (begin, m)
                integral -= k3
            else:
                # v' = -K1 v + (K1 - K3 + K1 K2) u, within 0.7 % of the correction
                assert a == 0.0
                assert c == pytest.approx(integral + 0.5 * (k1 - k3 + k1 * k2 - k1 * integral) - k2, abs=1.0)
                integral += k1 - k3 + k1 * k2 - k1 * integral
        run.step(1.0, valid=False)
        assert run.value("damped") == 0.0


def test_schedules_correction_has_no_jump_within_a_passage():
    """It moves by what the gains move in a step, so half the step gives half of it."""
    largest = []
    for step_s in (1.0, 0.5):
        run = LawRun({"id": "compass", "realisation": "network"}, {"id": "schedule"}, HARD, step_s=step_s)
        c = [run.step(1.0)[0] for _ in range(round(100.0 / step_s))]
        largest.append(np.max(np.abs(np.diff(c))))
    assert largest[0] < 8.0  # of a correction of 150 m/s
    assert largest[1] == pytest.approx(0.5 * largest[0], rel=0.05)


def test_schedule_warns_of_gains_on_the_way_that_are_unstable():
    assert Schedule().warnings(COMPASS) == ()
    for gains, stable in (
        ([7.68e-3, 1.0, 1.0], False),
        ([1e-2, -1.5, -1e-2], False),
        ([1e-2, 1.0, -1e-6], False),
        ([-1e-6, 1.0, 1e-6], False),
        ([1e-2, -0.95, 1e-4], True),  # next to each limit
        ([1e-6, 1.0, 1e-7], True),
    ):
        schedule = POLICIES["schedule"].model_validate({"id": "schedule", "from": gains, "to": gains})
        assert [("unstable" in text) for text in schedule.warnings(COMPASS)] == [True] * (not stable)

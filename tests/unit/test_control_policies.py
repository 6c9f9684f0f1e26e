"""Every policy against a sequence computed by hand."""

from __future__ import annotations

import ast
import inspect
import math
from typing import Any

import numpy as np
import pytest

from navcore.control import policy as policies
from navcore.control import switching as switchings
from navcore.control.layout import COUNT, DAMPED, MEASURE, MONITORED, WANTED, XI
from navcore.control.policy import POLICIES
from navcore.control.policy.adaptive import SUN_TABLE, law_coefficient
from navcore.control.policy.schedule import Schedule
from navcore.control.policy.variation import Variation, membership
from navcore.control.switching import SWITCHINGS
from navcore.units import DEG, KNOT
from tests.law_run import LawRun

CLASSIC = {"id": "classic2"}
HARD = {"id": "hard"}


def dispatched(module, name: str) -> dict[int, str]:
    """Code -> function called, as the source of the compiled dispatch has it; -1 is the last resort."""
    tree: Any = ast.parse(inspect.getsource(getattr(module, name).py_func)).body[0]
    found: dict[int, str] = {}

    def called(body: list[Any]) -> str:
        return next(n.func.id for s in body for n in ast.walk(s) if isinstance(n, ast.Call))  # pyright: ignore[reportAttributeAccessIssue]

    def look(body: list[Any]) -> None:
        for statement in body:
            if isinstance(statement, ast.If):
                test: Any = statement.test
                found[test.comparators[0].value] = called(statement.body)
                look(statement.orelse)
            elif isinstance(statement, ast.Return | ast.Expr) and isinstance(statement.value, ast.Call):
                found[-1] = called([statement])

    look(tree.body)
    return found


@pytest.mark.parametrize(
    ("module", "name", "registry"),
    [(policies, "decide", POLICIES), (switchings, "switch", SWITCHINGS)],
    ids=["policies", "switchings"],
)
def test_registry_and_dispatch_are_equal(module, name, registry):
    codes = {kind.code: f"{name}_{id}" for id, kind in registry.items()}
    assert sorted(codes) == list(range(len(registry)))
    assert all(kind.model_fields["id"].default == id for id, kind in registry.items())
    found = dispatched(module, name)
    found[0] = found.pop(-1)
    assert found == codes


def test_what_is_monitored_is_named_with_its_unit_and_thresholds():
    assert MONITORED == (WANTED, DAMPED, XI, MEASURE)
    for id, kind in POLICIES.items():
        block = kind.model_validate({"id": id})
        assert all(limit.unit == block.measure.unit for limit in block.limits()), id
        assert bool(block.limits()) == (id in ("threshold", "yaw_rate", "acceleration", "variation"))
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
    seen = run.series(differences, MEASURE, COUNT, WANTED, DAMPED)
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
        (run.step(0.0 if k < 7 else 1.0, 0.0 if k < 20 else 2.0), *run.s[[MEASURE, DAMPED]])
        for k in range(30)
    ]
    measure = np.array([row[1] for row in seen])
    assert measure[:7] == pytest.approx(0.0)
    assert measure[7:13] == pytest.approx([0.5, 1.0, 1.0, 0.5, 0.0, 0.0])
    assert measure[20:26] == pytest.approx([1.0, 2.0, 2.0, 1.0, 0.0, 0.0])
    assert [row[2] for row in seen[7:14]] == [1, 0, 0, 0, 0, 1, 1]


def test_variation_needs_a_log_without_gaps_as_long_as_its_windows():
    run = LawRun(CLASSIC, {"id": "variation", "n_s": 2.0, "t0_s": 3.0, "count": 1}, HARD)
    run.series(np.zeros(10), MEASURE)
    gap = run.series(np.full(3, 5.0), MEASURE, DAMPED, valid=False)
    assert np.all(gap == 0.0)
    back = run.series(np.full(12, 5.0), MEASURE, DAMPED)
    assert np.all(back == [0.0, 1.0]), "what the log did during the gap is no variation"


def test_membership_is_that_of_lius_figure_8():
    degrees = membership([0.0, 0.25, 0.30, 0.35, 0.40, 0.45, 9.0], Variation())
    expected = [[1, 0, 0], [1, 0, 0], [0.5, 0.5, 0], [0, 1, 0], [0, 0.5, 0.5], [0, 0, 1], [0, 0, 1]]
    assert degrees == pytest.approx(np.array(expected, dtype=float))
    assert degrees.sum(axis=-1) == pytest.approx(1.0)


def test_yaw_rate_counts_turns_over_the_window_across_north():
    """1 deg a second through north from 355 deg; window 4 s, limit 3 deg."""
    run = LawRun(CLASSIC, {"id": "yaw_rate", "window_s": 4.0, "limit_deg": 3.0}, HARD)
    headings = [355.0] * 3 + [(355.0 + k) % 360.0 for k in range(1, 11)] + [5.0] * 6
    seen = []
    for heading in headings:
        run.step(0.0, heading=heading * DEG)
        seen.append([run.s[MEASURE] / DEG, run.s[DAMPED]])
    change, damped = np.array(seen).T
    assert change == pytest.approx([0, 0, 0, 1, 2, 3, 4, 4, 4, 4, 4, 4, 4, 3, 2, 1, 0, 0, 0], abs=1e-9)
    # exactly 3 deg is left out: it lies on the limit to rounding
    assert damped[change < 2.5].all() and not damped[change > 3.5].any()


def test_yaw_rate_sees_a_whole_turn():
    run = LawRun(CLASSIC, {"id": "yaw_rate", "window_s": 60.0, "limit_deg": 5.0}, HARD)
    for k in range(61):
        run.step(0.0, heading=(6.0 * k % 360.0) * DEG)
    assert run.s[MEASURE] == pytest.approx(2.0 * math.pi)


def test_acceleration_is_averaged_over_what_is_there():
    run = LawRun(CLASSIC, {"id": "acceleration", "mean_s": 4.0, "limit_mps2": 0.02}, HARD)
    seen = []
    for a in [0.0, 0.0, 0.04, 0.04, 0.04, 0.04, 0.0, 0.0, 0.0, 0.0, 0.0]:
        run.step(0.0, accel=a)
        seen.append([run.s[MEASURE], run.s[DAMPED]])
    mean, damped = np.array(seen).T
    assert mean == pytest.approx([0, 0, 0.04 / 3, 0.02, 0.03, 0.04, 0.03, 0.02, 0.01, 0, 0], abs=1e-15)
    assert damped[[0, 1, 2, 4, 5, 6, 8, 9, 10]].tolist() == [1, 1, 1, 0, 0, 0, 1, 1, 1]


def test_adaptive_law_meets_suns_table_and_is_monotone_between():
    p = LawRun({"id": "unity2"}, {"id": "adaptive"}, HARD).law.p
    for row in SUN_TABLE:
        assert law_coefficient(p, row.difference_kn * KNOT) == pytest.approx(row.xi, abs=1e-12)
    fine = [law_coefficient(p, kn * KNOT) for kn in np.linspace(0.0, 5.0, 2001)]
    assert np.all(np.diff(fine) <= 1e-15)
    assert fine[-1] == 0.04


@pytest.mark.parametrize(
    ("knots", "xi"), [(0.0, 0.8101), (0.5, 0.3144), (1.5, 0.04), (3.0, 0.1429), (9.0, 0.99)]
)
def test_adaptive_quadratic_is_clamped_and_says_so(knots, xi):
    run = LawRun({"id": "unity2"}, {"id": "adaptive", "law": "quadratic"}, HARD)
    assert law_coefficient(run.law.p, knots * KNOT) == pytest.approx(xi, abs=1e-4)
    assert "negative between 0.95 and 2.77 kn" in run.policy.warnings()[0]


def test_adaptive_takes_the_users_table_in_any_order():
    table = [[2.0, 0.1], [0.0, 0.9], [1.0, 0.5]]
    p = LawRun({"id": "none"}, {"id": "adaptive", "table": table}, HARD).law.p
    assert [law_coefficient(p, kn * KNOT) for kn in (0.0, 1.0, 2.0, 7.0)] == pytest.approx(
        [0.9, 0.5, 0.1, 0.1]
    )


def test_adaptive_follows_the_low_passed_norm_of_the_difference():
    """From (0.3, 0.4) m/s to zero: the norm falls as 0.5 e^(-t/100 s)."""
    run = LawRun({"id": "unity2"}, {"id": "adaptive"}, HARD)
    run.step(0.3, 0.4)
    assert run.s[MEASURE] == pytest.approx(0.5)
    for k in range(1, 400):
        run.step(0.0, 0.0)
        assert run.s[MEASURE] == pytest.approx(0.5 * math.exp(-k / 100.0), rel=1e-12)
        assert run.s[XI] == law_coefficient(run.law.p, run.s[MEASURE])


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
        assert run.s[DAMPED] == 0.0


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
    assert Schedule().warnings() == ()
    odd = POLICIES["schedule"].model_validate({"id": "schedule", "to": [7.68e-3, 1.0, 1.0]})
    assert "unstable" in odd.warnings()[0]

"""What dominates a result: the period by least squares, the source by running the sources apart."""

import math
from dataclasses import replace

import numpy as np
import pytest

from navcore.averaging.lines import line_phases
from navcore.design.dominance import HEADING, POSITION, TILT, swing, why
from navcore.engine.run import Run
from navcore.engine.simulation import simulate
from navcore.mechanization.recorder import PHI_E, PHI_N
from navcore.questions.why import WhyQuestion
from navcore.scenario.file import load
from navcore.scenario.model import Scenario
from schuler_bench.jobs.asking import Asker
from schuler_bench.views.metrics.view import cause_text, why_html

DAY = {"run": {"duration_h": 30.0, "step_s": 10.0, "output_step_s": 60.0}}


def run_of(**blocks):
    return simulate(Scenario.parse(DAY | blocks))


def made_of(values) -> Run:
    """A run whose tilts are ``values(time, phases)``."""
    run = run_of()
    method = run.methods[0]
    rows = method.rows.copy()
    rows[:, [PHI_E, PHI_N]] = 0.0
    rows[:, PHI_E] = values(run.t_s, line_phases(run.t_s, run.truth, run.scenario.earth))
    return replace(run, methods=(replace(method, rows=rows),))


@pytest.mark.parametrize(
    ("values", "part", "beats"),
    [
        (lambda t, p: np.ones(len(t)), "constant", False),
        (lambda t, p: t - t.mean(), "drift", False),
        (lambda t, p: np.sin(p[:, 0]) + 0.1, "schuler", False),
        (lambda t, p: np.sin(p[:, 0]) + np.sin(p[:, 1]), "schuler", True),
        (lambda t, p: np.cos(p[:, 2]), "earth", False),
        (lambda t, p: np.random.default_rng(1).normal(size=len(t)), "other", False),
        (lambda t, p: np.sin(2.0 * math.pi * t / 600.0), "other", False),
    ],
)
def test_what_a_curve_is_made_of(values, part: str, beats: bool) -> None:
    run = made_of(values)
    found = swing(run, run.methods[0], ("phi_e_rad", "phi_n_rad"))
    assert found is not None
    assert found.largest == part
    assert found.shares[part] > 0.9
    assert sum(found.shares.values()) == pytest.approx(1.0)
    if part == "schuler":
        assert found.beats == beats


def test_shares_of_a_sum_are_its_mean_squares() -> None:
    run = made_of(lambda t, p: 1.0 + 2.0 * np.sin(p[:, 0]))
    found = swing(run, run.methods[0], ("phi_e_rad", "phi_n_rad"))
    assert found.shares["constant"] == pytest.approx(1.0 / 3.0, abs=0.03)
    assert found.shares["schuler"] == pytest.approx(2.0 / 3.0, abs=0.03)


def test_nothing_is_said_of_an_error_that_is_zero() -> None:
    run = run_of()
    assert swing(run, run.methods[0], ("dlat_m", "dlon_m")) is None
    assert why(run).methods == (("free", ()),)


def test_free_and_damped_have_different_causes() -> None:
    run = run_of(
        imu={"gyro_bias_dph": [0.0, 0.01, 0.0]},
        reference={"kind": "log", "bias_mps": [2.0, 2.0]},
        method=[
            {"name": "free"},
            {
                "name": "damped",
                "damping": "external",
                "network": {"id": "compass", "sigma": 0.004, "xi": 0.7},
            },
        ],
    )
    told = why(run)
    causes = {name: {cause.quantity: cause for cause in found} for name, found in told.methods}
    assert causes["free"][TILT].source == "gyro bias"
    assert causes["free"][POSITION].source == "gyro bias"
    assert causes["damped"][POSITION].source == "log bias"
    assert causes["damped"][POSITION].share > 0.5
    assert set(causes["damped"]) == {POSITION, TILT, HEADING}
    text = cause_text(causes["free"][TILT], told)
    assert text.startswith("tilt all from gyro bias, ")
    assert told.schuler_s == pytest.approx(84.4 * 60.0, rel=0.005)
    assert told.complete


def test_a_single_channel_has_neither_heading_nor_a_day() -> None:
    run = simulate(load("zha-fast"))
    told = dict(why(run).methods)
    free = {cause.quantity: cause for cause in told["free"]}
    assert HEADING not in free
    assert free[TILT].swing.largest == "schuler"
    assert "earth" not in free[TILT].swing.shares


def test_a_strapdown_run_says_that_it_used_the_linear_model() -> None:
    run = run_of(
        run={"duration_h": 0.1, "fidelity": "strapdown", "rate_hz": 20.0},
        imu={"gyro_bias_dph": [0.0, 1.0, 0.0]},
    )
    told = why(run)
    assert any("linear error model" in remark for remark in told.remarks)
    assert {cause.source for cause in told.methods[0][1]} == {"gyro bias"}


def test_a_recorded_imu_is_told_by_its_periods_alone() -> None:
    run = run_of(imu={"gyro_bias_dph": [0.0, 0.01, 0.0]})
    imu = run.scenario.imu.model_copy(update={"file": "recorded.csv"})
    told = why(replace(run, scenario=run.scenario.model_copy(update={"imu": imu})))
    assert any("recorded IMU" in remark for remark in told.remarks)
    (_, causes), *_ = told.methods
    assert causes and all(cause.source == "" for cause in causes)
    assert "from" not in cause_text(causes[0], told)


def test_cancelled_it_is_not_complete() -> None:
    run = run_of(imu={"gyro_bias_dph": [0.0, 0.01, 0.0]}, method=[{"name": "a"}, {"name": "b"}])
    fractions: list[float] = []
    told = why(run, fractions.append, lambda: len(fractions) >= 1)
    assert not told.complete and fractions == [0.5]


def test_the_line_is_marked_while_it_is_of_another_run() -> None:
    run, later = (
        run_of(imu={"gyro_bias_dph": [0.0, 0.01, 0.0]}),
        run_of(imu={"gyro_bias_dph": [0.0, 0.02, 0.0]}),
    )
    explainer = Asker(lambda: None, WhyQuestion)
    assert 'data-fits="0"' in why_html(explainer, run)
    explainer.result, explainer.asked = why(run), WhyQuestion.of(run)
    html = why_html(explainer, run)
    assert 'data-fits="1"' in html and "sb-old" not in html and "from gyro bias" in html
    summary = html.partition("</summary>")[0]
    assert summary.startswith("<details") and "free: position error all from gyro bias" in summary
    old = why_html(explainer, later)
    assert 'data-fits="0"' in old and 'class="sb-old"' in old and "of an earlier run" in old
    explainer.fraction = 0.25
    assert "25 %" in why_html(explainer, later)
    explainer.words, explainer.result = ("failed",), None
    assert "could not be found" in why_html(explainer, later)

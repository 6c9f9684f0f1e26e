"""Liu 2021, figure 7: overshoot of a step of the log's error against that of a switch."""

from __future__ import annotations

import pytest

from tests.acceptance.papers import verdicts
from tests.papers.liu_fig_7 import FIGURE_7
from tests.papers.liu_switching import fig_7, overshoot, switched
from tests.papers.runs import Runs


@pytest.fixture(scope="module")
def runs() -> Runs:
    return Runs()


def test_overshoot_of_a_step(runs):
    assert overshoot(fig_7(runs), 0) == pytest.approx(0.115, abs=5e-4)
    assert overshoot(fig_7(runs), 2) == pytest.approx(0.115 * 0.45 / 0.25, abs=1e-3)


def test_clearing_the_filter_acts_like_a_step_of_the_whole_error(runs):
    assert overshoot(switched(runs, "hard")) == pytest.approx(0.228, abs=5e-4)
    assert overshoot(switched(runs, "hard")) == pytest.approx(2.0 * overshoot(fig_7(runs), 0), rel=0.01)


def test_the_ramp_alone_softens_nothing_and_lius_recursion_does(runs):
    assert overshoot(switched(runs, "ramp")) == pytest.approx(overshoot(switched(runs, "hard")), rel=1e-3)
    assert overshoot(switched(runs, "ramp", form="as_printed")) < 1e-3


@pytest.mark.parametrize("switching", ["keep", "bumpless"])
def test_a_filter_that_is_not_cleared_makes_no_overshoot(runs, switching):
    assert overshoot(switched(runs, switching)) < 1e-4


def test_what_is_claimed(runs):
    assert verdicts(FIGURE_7, runs) == ["differs", "agrees"]

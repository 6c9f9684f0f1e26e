"""Policies as detectors of a wrong log: counts by hand, a delay by closed form, what is refused."""

from typing import Any

import numpy as np
import pytest

from navcore import detect
from navcore.design.detector import Counts, Detector, Point, count_switches
from navcore.foundation.errors import InputError
from navcore.scenario.model import Scenario

ACCELERATION, LIMIT = 0.01, 0.5
"""Of the event, m/s^2, and of the policy, m/s."""


def quiet(event: list[dict[str, Any]], policy: dict[str, Any]) -> Scenario:
    """A ship without any other error than the events of its log."""
    return Scenario.parse(
        {
            "run": {"duration_h": 1.0, "step_s": 1.0},
            "reference": {"kind": "log", "rate_hz": 1.0, "event": event},
            "method": [
                {"name": "free"},
                {"damping": "external", "network": {"id": "complementary"}, "policy": policy},
            ],
        }
    )


EVENT = {"t_h": 0.5, "duration_s": 120.0, "accel_mps2": [0.0, ACCELERATION]}


def test_counts_by_hand() -> None:
    t = np.arange(20.0)
    wrong = (t >= 5.0) & (t < 10.0) | (t >= 15.0) & (t < 18.0)
    off = (t >= 2.0) & (t < 3.0) | (t >= 7.0) & (t < 12.0)
    found = count_switches(t, off, wrong, after_s=1.0)
    assert (found.events, found.missed, found.delays_s, found.false_switches) == (2, 1, (2.0,), 1)
    assert (found.wrong_s, found.off_wrong_s) == (8.0, 3.0)  # the last step has no length
    assert (found.right_s, found.off_right_s) == (9.0, 2.0)  # 0-5, 11-15; off in 2 and 11
    without = count_switches(t, off, wrong, used=t >= 7.0, after_s=1.0)
    assert (without.events, without.false_switches, without.delays_s) == (2, 0, (2.0,))
    both = found + found
    assert (both.events, both.delays_s, both.hit_rate) == (4, (2.0, 2.0), 3.0 / 8.0)


def test_a_perfect_detector_has_an_area_of_one_and_chance_a_half() -> None:
    perfect = Detector("a", "threshold", Counts(), (Point(1.0, 1.0, 0.0),))
    chance = Detector("a", "threshold", Counts(), (Point(0.5, 0.7, 0.7), Point(1.0, 0.3, 0.3)))
    assert perfect.area == pytest.approx(1.0)
    assert chance.area == pytest.approx(0.5)
    assert Detector("a", "threshold", Counts()).area is None


def test_the_delay_is_that_of_the_closed_form() -> None:
    """The difference grows by the acceleration; what the loop follows of it in a minute is below 3 %."""
    found = detect(quiet([EVENT], {"id": "threshold", "limit_mps": LIMIT}), seeds=1, points=3)
    (one,) = found.methods
    assert one.counts.missed == 0 and one.counts.false_switches == 0
    (delay,) = one.counts.delays_s
    assert LIMIT / ACCELERATION <= delay <= 1.05 * LIMIT / ACCELERATION + 1.0
    assert [point.factor for point in one.curve] == pytest.approx([0.1, 1.0, 10.0])
    hits = [point.hit_rate for point in one.curve]
    assert hits[0] > hits[1] > hits[2] == 0.0
    assert hits[1] == one.counts.hit_rate


def test_the_log_is_wrong_from_a_bound_too() -> None:
    scenario = quiet([EVENT], {"id": "threshold", "limit_mps": LIMIT})
    found = detect(scenario, seeds=1, points=0, wrong_mps=0.8)
    (delay,) = found.methods[0].counts.delays_s
    assert delay == 0.0  # off from 0.5 m/s on
    with pytest.raises(InputError, match="never exceeds"):
        detect(scenario, seeds=1, points=0, wrong_mps=5.0)


@pytest.mark.parametrize(
    ("event", "policy", "words"),
    [([], {"id": "threshold"}, "no event"), ([EVENT], {"id": "constant"}, "no method has a policy")],
)
def test_what_cannot_be_judged_is_refused(event: Any, policy: Any, words: str) -> None:
    with pytest.raises(InputError, match=words):
        detect(quiet(event, policy), seeds=1)

"""Clocks of logs: planted times are found beside tides, and none where there is none."""

from functools import lru_cache

import numpy as np
import pytest
from scipy.ndimage import uniform_filter1d
from scipy.signal import lfilter

from navcore.io.agreement import findings
from navcore.io.clocks import _half_width
from navcore.io.series import Recording, Series

_HOURS = 8.0
TIDES = (0.0, 0.3, 0.6, 1.0, 1.5)


@lru_cache
def _ship() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Times, speed through the water and heading of a ship that now and then turns and changes its speed."""
    random = np.random.default_rng(3)
    t = np.arange(0.0, _HOURS * 3600.0)
    speed, heading, at = np.full(t.size, 6.0), np.full(t.size, 0.7), 0.0
    while at < t[-1]:
        at += random.uniform(1200.0, 5400.0)
        heading[int(at) :] += random.uniform(-1.5, 1.5)
        speed[int(at) :] = random.uniform(2.0, 8.0)
    return t, uniform_filter1d(speed, 60), uniform_filter1d(heading, 60)


def _recording(late_s: float, tide: float, *, changes: float = 1.0) -> Recording:
    """The log has noise of 0.05 m/s and a drift of 0.1 m/s at 600 s, the velocity over ground 0.03 m/s."""
    t, speed, heading = _ship()
    speed = 6.0 + changes * (speed - 6.0)
    random, w, rho = np.random.default_rng(5), 2.0 * np.pi / 44714.0, np.exp(-1.0 / 600.0)
    current = np.column_stack([0.3 + tide * np.sin(w * t + 0.5), 0.6 * tide * np.cos(w * t) - 0.2])
    over = speed[:, None] * np.column_stack([np.sin(heading), np.cos(heading)]) + current
    over += random.normal(0.0, 0.03, over.shape)
    drift = lfilter([1.0], [1.0, -rho], random.normal(0.0, 0.1 * np.sqrt(1.0 - rho**2), t.size))
    log = 1.004 * speed + drift + random.normal(0.0, 0.05, t.size)
    valid = np.ones(t.size, bool)
    water = np.column_stack([np.zeros(t.size), log])
    return Recording(
        velocity=Series(t, over, valid, "track.csv", "columns"),
        water=Series(t + late_s, water, valid, "log.csv", "columns"),
        heading=Series(t, heading[:, None] % (2.0 * np.pi), valid, "heading.csv", "columns"),
    )


@pytest.mark.parametrize("tide", TIDES)
@pytest.mark.parametrize("late_s", [12.0, -12.0, -60.0, 282.0, 600.0])
def test_the_clock_of_a_log_is_told_beside_a_tide(late_s: float, tide: float) -> None:
    (found,) = findings(_recording(late_s, tide))
    assert found.stream == "water" and found.late_s == pytest.approx(late_s, abs=3.0)


@pytest.mark.parametrize("tide", TIDES)
def test_a_log_in_time_has_no_clock_told(tide: float) -> None:
    assert findings(_recording(0.0, tide)) == []


@pytest.mark.parametrize("tide", [0.0, 1.0])
def test_a_log_whose_speed_does_not_change_says_nothing_of_its_clock(tide: float) -> None:
    assert findings(_recording(120.0, tide, changes=0.0)) == []


@pytest.mark.filterwarnings("error")
def test_a_shift_between_two_that_cannot_be_judged_is_known_to_a_step() -> None:
    """A damaged file gave a mean of nothing, with a warning of numpy on the terminal."""
    assert _half_width(np.array([np.inf, 1.0, np.inf]), 1) == 1.0

"""Motions `profile` and `swing`: formulas, consistent derivatives, what a field means, what is refused."""

import math
import re
from typing import Any

import numpy as np
import pytest
from pydantic import ValidationError

from navcore.foundation.earth import WGS84
from navcore.foundation.errors import InputError
from navcore.foundation.parameters import Parameters
from navcore.foundation.units import DEG, KNOT
from navcore.motion import MotionParameters, ProfileMotion, WavesMotion
from navcore.motion.static import StaticMotion
from navcore.motion.swing import Oscillation, SwingMotion
from navcore.motion.truth import (
    AE,
    AN,
    AU,
    COLUMNS,
    HEADING,
    HEADING_RATE,
    HEIGHT,
    LAT,
    LON,
    PITCH,
    PITCH_RATE,
    ROLL,
    ROLL_RATE,
    VE,
    VN,
    VU,
    Site,
    Truth,
)
from tests.motions import MANOEUVRES, SUN, ZHAO

SITE = Site(45.78 * DEG, 126.7 * DEG, 0.0)
DAY = 86400.0


def profile(*points: dict[str, Any], **fields: Any) -> ProfileMotion:
    return ProfileMotion.model_validate({"point": list(points), **fields})


def values(motion: ProfileMotion, until: float, step: float) -> np.ndarray:
    return motion.truth(round(until / step) + 1, step, SITE, WGS84).values


def test_against_zhao_2015() -> None:
    rows = values(ZHAO, DAY, 1.0)
    phase = 2.0 * np.pi * np.arange(len(rows)) / DAY
    np.testing.assert_allclose(rows[:, VE], 150.0 * (1.0 - np.cos(phase)), atol=1e-11)
    np.testing.assert_allclose(rows[:, VN], 15.0 * (1.0 - np.cos(phase)), atol=1e-12)
    np.testing.assert_allclose(rows[:, AE], 150.0 * 2.0 * np.pi / DAY * np.sin(phase), atol=1e-14)
    np.testing.assert_allclose(rows[:, HEADING], math.atan2(10.0, 1.0), rtol=1e-14)
    assert not rows[:, [VU, HEADING_RATE, PITCH]].any()


def test_against_sun_2017() -> None:
    rows = values(SUN, 36300.0, 1.0)
    speed = np.hypot(rows[:, VE], rows[:, VN]) / KNOT
    rate = np.hypot(rows[:, AE], rows[:, AN]) / KNOT * 60.0
    at = np.array([0, 36000, 36060, 36120, 36180, 36240, 36300])
    np.testing.assert_allclose(speed[at], [2, 2, 3, 6, 9, 10, 10], rtol=1e-12)
    np.testing.assert_allclose(rate[at], [0, 0, 2, 4, 2, 0, 0], atol=1e-12)
    np.testing.assert_allclose(rows[:, HEADING], 45.0 * DEG, rtol=1e-14)
    np.testing.assert_allclose(rows[:, VE], rows[:, VN], rtol=1e-12)


@pytest.mark.parametrize("shape", ["raised_cosine", "half_sine", "triangle"])
def test_rates_are_derivatives(shape: str) -> None:
    h = 1e-2
    rows = values(MANOEUVRES.model_copy(update={"shape": shape}), 620.0, h)
    for column, rate in ((VE, AE), (VN, AN), (PITCH, PITCH_RATE), (ROLL, ROLL_RATE), (HEADING, HEADING_RATE)):
        numeric = (rows[2:, column] - rows[:-2, column]) / (2.0 * h)
        # Where a rate has a corner or a jump of its slope the difference sees half of it.
        assert np.abs(numeric - rows[1:-1, rate]).max() < 0.02 * np.abs(rows[:, rate]).max()
        assert np.median(np.abs(numeric - rows[1:-1, rate])) < 1e-6 * np.abs(rows[:, rate]).max()
        assert np.abs(np.diff(rows[:, rate])).max() < 0.05 * np.abs(rows[:, rate]).max()


@pytest.mark.parametrize(
    ("motion", "end"), [(ZHAO, DAY), (SUN, 40000.0), (MANOEUVRES, 900.0)], ids=["zhao", "sun", "manoeuvres"]
)
def test_position_against_an_independent_integration(motion: ProfileMotion, end: float) -> None:
    """Within 0.1 mm of scipy's eighth-order integrator, whatever the step."""
    from scipy.integrate import solve_ivp

    step = end / 1000.0
    rows = values(motion, end, step)
    assert np.abs(values(motion, end, 2.0 * step)[:, :2] - rows[::2, :2]).max() < 1e-15
    knots = sorted({0.0, end, *(p.t_s for p in motion.point if p.t_s < end)})
    knots = sorted({*knots, *((a + b) / 2.0 for a, b in zip(knots, knots[1:], strict=False))})
    legs, _ = motion.table()

    def velocity(t: float) -> tuple[float, float]:
        leg = legs[np.searchsorted(legs[:, 0], t, side="right") - 1]
        tau = min((t - leg[0]) / leg[3], 1.0) if leg[3] else 1.0
        done = {
            "raised_cosine": tau - math.sin(2.0 * math.pi * tau) / (2.0 * math.pi),
            "half_sine": 0.5 * (1.0 - math.cos(math.pi * tau)),
            "triangle": 2.0 * tau**2 if tau < 0.5 else 1.0 - 2.0 * (1.0 - tau) ** 2,
        }[motion.shape]
        speed, course = leg[1] + done * leg[2], leg[4] + done * leg[5]
        return speed * math.sin(course), speed * math.cos(course)

    def rate(t: float, x: np.ndarray) -> list[float]:
        v_e, v_n = velocity(t)
        m, n = WGS84.radii(x[0] + SITE.lat)
        return [v_n / m, v_e / (n * math.cos(x[0] + SITE.lat))]

    x = np.zeros(2)
    for a, b in zip(knots, knots[1:], strict=False):
        inside = np.nextafter(b, a)
        x = solve_ivp(rate, (a, inside), x, method="DOP853", rtol=1e-12, atol=1e-16, max_step=600.0).y[:, -1]
    metres = (rows[-1, [LAT, LON]] - [SITE.lat, SITE.lon] - x) * 6.4e6
    assert np.abs(metres).max() < 1e-4


def test_what_a_point_leaves_out_is_as_before() -> None:
    rows = values(
        profile(
            {"speed_mps": 4.0, "course_deg": 350.0, "pitch_deg": 2.0},
            {"t_s": 100.0, "course_deg": 20.0},
            {"t_s": 200.0, "speed_kn": 10.0, "roll_deg": 6.0},
        ),
        250.0,
        50.0,
    )
    speed = np.hypot(rows[:, VE], rows[:, VN])
    np.testing.assert_allclose(speed[[0, 2, 4, 5]], [4.0, 4.0, 10.0 * KNOT, 10.0 * KNOT])
    # 30 deg to starboard, through north, not wrapped.
    np.testing.assert_allclose(rows[[0, 1, 2, 5], HEADING] / DEG, [350.0, 365.0, 380.0, 380.0])
    np.testing.assert_allclose(rows[:, PITCH] / DEG, 2.0)
    np.testing.assert_allclose(rows[:, ROLL] / DEG, [0.0, 0.0, 0.0, 3.0, 6.0, 6.0], atol=1e-12)


def test_from_rest_the_course_is_that_of_the_next_point_and_at_rest_it_stays() -> None:
    motion = profile(
        {"velocity_mps": [0.0, 0.0]},
        {"t_s": 100.0, "velocity_mps": [0.0, 5.0]},
        {"t_s": 200.0, "velocity_mps": [0.0, 0.0]},
        {"t_s": 300.0},
        {"t_s": 400.0, "velocity_mps": [5.0, 0.0]},
        heading_deg=77.0,
    )
    rows = values(motion, 400.0, 50.0)
    np.testing.assert_allclose(rows[:, HEADING] / DEG, [0, 0, 0, 0, 0, 0, 0, 45, 90], atol=1e-12)
    assert rows[0, AE] == rows[0, AN] == 0.0


def test_the_bow_may_point_elsewhere() -> None:
    motion = ZHAO.model_copy(update={"bow": "heading", "heading_deg": 30.0})
    rows = values(motion, DAY, 600.0)
    np.testing.assert_allclose(rows[:, HEADING], 30.0 * DEG)
    np.testing.assert_allclose(rows[1:-1, VE] / rows[1:-1, VN], 10.0)


@pytest.mark.parametrize(
    ("points", "fields", "field", "words"),
    [
        ([], {}, "point", "at least one"),
        ([{"t_s": 5.0}], {}, "point.0.t_s", "must be 0"),
        ([{}, {"t_s": 10.0}, {"t_s": 10.0}], {}, "point.2.t_s", r"must be > 10 \(s\)"),
        ([{"speed_mps": 1.0, "speed_kn": 2.0}], {}, "point.0.speed_kn", "not both"),
        ([{"speed_mps": 1.0, "velocity_mps": [1.0, 0.0]}], {}, "point.0.speed_mps", "not both"),
        ([{"course_deg": 1.0, "velocity_mps": [1.0, 0.0]}], {}, "point.0.course_deg", "not both"),
        ([{"velocity_mps": [400.0, 400.0]}], {}, "point.0.velocity_mps", "<= 500"),
        ([{"heading_deg": 4.0}], {}, "point.0.heading_deg", "no effect"),
    ],
)
def test_impossible_profiles_are_refused_by_point_and_field(
    points: list[Any], fields: dict[str, Any], field: str, words: str
) -> None:
    with pytest.raises(ValidationError, match=rf"{re.escape(field)}( = |: ).*{words}") as caught:
        profile(*points, **fields)
    assert caught.value.error_count() == 1


@pytest.mark.parametrize(
    ("motion", "lat_deg", "field"),
    [
        (profile({"speed_mps": 100.0}, {"t_s": 3600.0, "speed_mps": 300.0}), 80.0, "point.1"),
        (WavesMotion(speed_mps=50.0), 88.0, "speed_mps"),
    ],
)
def test_a_course_over_the_pole_is_refused(motion: MotionParameters, lat_deg: float, field: str) -> None:
    with pytest.raises(InputError, match=r"89\.5°") as caught:
        motion.rows(86401, 0.5, Site(lat_deg * DEG, 0.0, 0.0), WGS84)
    assert caught.value.faults[0].field == field


# ---------------------------------------------------------------- swing


SWING_SITE = Site(math.radians(45.78), math.radians(126.7), 3.0)
DENG: dict[str, Any] = {
    "roll_deg": 6.0,
    "roll": {"amplitude_deg": 12.0, "frequency_hz": 0.125},
    "pitch_deg": 8.0,
    "pitch": {"amplitude_deg": 10.0, "frequency_hz": 0.2},
    "heading_deg": 75.0,
    "heading": {"amplitude_deg": 6.0, "frequency_hz": 0.15, "phase_deg": 30.0},
}


def test_deng_swing_follows_its_formula_for_a_day() -> None:
    values = SwingMotion(**DENG).truth(172_801, 0.5, SWING_SITE, WGS84).values
    t = np.arange(172_801) * 0.5
    for column, rate, mean, amplitude, frequency, phase in (
        (PITCH, PITCH_RATE, 8.0, 10.0, 0.2, 0.0),
        (ROLL, ROLL_RATE, 6.0, 12.0, 0.125, 0.0),
        (HEADING, HEADING_RATE, 75.0, 6.0, 0.15, 30.0),
    ):
        # Whole cycles are taken off in integers: 20 cycles of 1/20 Hz are 400 s, and so on.
        angle = 2.0 * np.pi * np.mod(frequency * np.mod(t, 400.0), 1.0) + math.radians(phase)
        expected = np.radians(mean + amplitude * np.sin(angle))
        assert np.all(np.abs(values[:, column] - expected) <= 1e-10)
        w = 2.0 * np.pi * frequency
        assert np.all(np.abs(values[:, rate] - np.radians(amplitude) * w * np.cos(angle)) <= 1e-10)


def test_the_place_does_not_move() -> None:
    values = SwingMotion(**DENG).truth(101, 0.5, SWING_SITE, WGS84).values
    for column, value in ((LAT, SWING_SITE.lat), (LON, SWING_SITE.lon), (HEIGHT, SWING_SITE.height)):
        assert (values[:, column] == value).all()
    assert not values[:, VE : AU + 1].any()
    assert AE == VE + 3


def _refused(step_s: float, **fields: Any) -> InputError:
    with pytest.raises(InputError) as caught:
        SwingMotion(**fields).truth(11, step_s, SWING_SITE, WGS84)
    return caught.value


def test_a_swing_too_fast_for_the_step_is_refused_by_name() -> None:
    fast = {"amplitude_deg": 1.0, "frequency_hz": 0.26}
    error = _refused(0.5, roll=fast, heading=fast)
    assert [fault.field for fault in error.faults] == ["roll.frequency_hz", "heading.frequency_hz"]
    assert error.faults[0].value == 0.26
    assert "must be <= 0.25 (Hz)" in error.faults[0].allowed


def test_the_fastest_swing_and_a_swing_of_no_size_are_taken() -> None:
    SwingMotion(roll={"amplitude_deg": 1.0, "frequency_hz": 0.25}).truth(11, 0.5, SWING_SITE, WGS84)
    SwingMotion(roll={"amplitude_deg": 0.0, "frequency_hz": 50.0}).truth(11, 0.5, SWING_SITE, WGS84)
    SwingMotion(roll={"amplitude_deg": 1.0, "frequency_hz": 50.0}).truth(11, 0.0025, SWING_SITE, WGS84)


def test_pitch_beyond_the_vertical_is_refused() -> None:
    SwingMotion(pitch_deg=-60.0, pitch={"amplitude_deg": 29.0})
    with pytest.raises(ValueError, match=r"pitch\.amplitude_deg = 30\.0: must be <= 29 \(°\)"):
        SwingMotion(pitch_deg=-60.0, pitch={"amplitude_deg": 30.0})


@pytest.mark.parametrize(
    ("model", "field", "value"),
    [
        *((Oscillation, "amplitude_deg", value) for value in (-1.0, 91.0)),
        (Oscillation, "frequency_hz", -0.1),
        (Oscillation, "phase_deg", 400.0),
        *((StaticMotion, "pitch_deg", value) for value in (89.1, math.nan)),
        (StaticMotion, "roll_deg", -180.1),
        (StaticMotion, "heading_deg", 361.0),
    ],
)
def test_fields_out_of_range_are_refused(model: type[Parameters], field: str, value: float) -> None:
    with pytest.raises(ValueError, match=field):
        model.model_validate({field: value})


def test_rows_of_a_truth_are_those_asked_for_and_the_last_answer_is_kept() -> None:
    truth = Truth(0.5, np.arange(60.0).reshape(4, COLUMNS))
    first = truth.at(np.array([0, 2]))
    assert np.array_equal(first, truth.values[[0, 2]])
    assert truth.at(np.array([0, 2])) is first
    assert np.array_equal(truth.at(np.array([1, 3])), truth.values[[1, 3]])
    assert np.array_equal(truth.at(np.array([0, 2])), first)
    with pytest.raises(ValueError, match="read-only"):
        first[0, 0] = 1.0
    (whole,) = truth.stretches  # short: one stretch
    assert whole == pytest.approx((*truth.values[:, [LAT, VE, VN]].mean(axis=0), 2.0))
    still = Truth(0.5, truth.values[:1])
    assert np.array_equal(still.at(np.arange(3)), np.repeat(truth.values[:1], 3, axis=0))

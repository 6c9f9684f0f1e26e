"""Motion `legs`: what each field means, what is refused; position against independent integrations."""

import math
from typing import Any

import numpy as np
import pytest

from navcore.foundation.earth import SPHERE, WGS84, Earth
from navcore.foundation.errors import InputError
from navcore.foundation.units import DEG, KNOT
from navcore.motion.course import COURSE_CHANGE, COURSE_TIME, SPEED_CHANGE, SPEED_TIME, lay_course
from navcore.motion.legs import LegsMotion
from navcore.motion.truth import AE, AN, HEADING, HEADING_RATE, LAT, LON, PITCH, ROLL, VE, VN, Site

SITE = Site(math.radians(40.0), math.radians(-70.0), 0.0)


def _values(*legs: dict[str, Any], until: float = 400.0, step: float = 0.5, **fields: Any) -> np.ndarray:
    count = round(until / step) + 1
    return LegsMotion(leg=legs, **fields).truth(count, step, SITE, WGS84).values


def _speed(values: np.ndarray) -> np.ndarray:
    return values[:, VE] * np.sin(values[:, HEADING]) + values[:, VN] * np.cos(values[:, HEADING])


def _acceleration(values: np.ndarray) -> np.ndarray:
    return values[:, AE] * np.sin(values[:, HEADING]) + values[:, AN] * np.cos(values[:, HEADING])


def test_first_leg_gives_the_initial_speed_and_heading() -> None:
    values = _values({"speed_mps": 7.0, "heading_deg": 45.0}, heading_deg=300.0, pitch_deg=1.0, roll_deg=-2.0)
    assert _speed(values) == pytest.approx(np.full(801, 7.0))
    assert values[:, HEADING] == pytest.approx(np.full(801, 45.0 * DEG))
    assert values[:, VE] == pytest.approx(np.full(801, 7.0 * math.sin(45.0 * DEG)))
    assert (values[:, PITCH] == 1.0 * DEG).all()
    assert (values[:, ROLL] == -2.0 * DEG).all()


def test_without_a_heading_the_motion_has_it() -> None:
    assert _values({"speed_kn": 10.0}, heading_deg=300.0)[0, HEADING] == pytest.approx(300.0 * DEG)


def test_knots_and_metres_a_second_are_the_same_speed() -> None:
    knots = _values({"duration_s": 100.0, "speed_kn": 10.0}, {"speed_kn": 12.0})
    metres = _values({"duration_s": 100.0, "speed_mps": 10.0 * KNOT}, {"speed_mps": 12.0 * KNOT})
    assert knots == pytest.approx(metres, rel=1e-13)
    assert _speed(knots)[-1] == pytest.approx(12.0 * 1852.0 / 3600.0)


def test_a_speed_is_reached_at_a_mean_of_a_tenth_by_default() -> None:
    values = _values({"duration_s": 100.0, "speed_mps": 5.0}, {"speed_mps": 8.0})
    speed = _speed(values)
    assert speed[200] == pytest.approx(5.0)
    assert speed[230] == pytest.approx(6.5)  # half way after 15 of 30 s
    assert 7.99 < speed[259] < 8.0
    assert speed[260:] == pytest.approx(np.full(541, 8.0))
    assert _acceleration(values).max() == pytest.approx(0.2)


def test_a_given_acceleration_sets_the_time_whatever_its_sign() -> None:
    for accel in (0.3, -0.3):
        values = _values({"duration_s": 100.0, "speed_mps": 8.0}, {"speed_mps": 5.0, "accel_mps2": accel})
        speed = _speed(values)
        assert speed[210] == pytest.approx(6.5)
        assert speed[220:] == pytest.approx(np.full(581, 5.0))
        assert _acceleration(values).min() == pytest.approx(-0.6)


def test_acceleration_alone_acts_over_the_whole_leg() -> None:
    # Sun's profile: 2 kn, then the acceleration rises to 4 kn/min and falls to 0 within 4 min.
    mean = 2.0 * KNOT / 60.0
    values = _values(
        {"duration_s": 60.0, "speed_kn": 2.0, "heading_deg": 45.0},
        {"duration_s": 240.0, "accel_mps2": mean},
        {"duration_s": 10.0},
    )
    speed = _speed(values) / KNOT
    assert speed[120] == pytest.approx(2.0)
    assert speed[360] == pytest.approx(6.0)
    assert _acceleration(values)[360] == pytest.approx(4.0 * KNOT / 60.0)
    assert speed[600:] == pytest.approx(np.full(201, 10.0))


def test_in_the_first_leg_acceleration_and_turn_start_from_its_speed_and_heading() -> None:
    leg = {"duration_s": 200.0, "speed_mps": 3.0, "accel_mps2": 0.02, "heading_deg": 10.0, "turn_dps": -0.5}
    values = _values(leg)
    assert _speed(values)[[0, 400]] == pytest.approx([3.0, 7.0])
    assert values[[0, 400, 800], HEADING] == pytest.approx(np.radians([10.0, -90.0, -90.0]))


@pytest.mark.parametrize(
    ("start", "leg", "end", "time"),
    [
        (10.0, {"heading_deg": 70.0}, 70.0, 60.0),
        (10.0, {"heading_deg": 350.0}, -10.0, 20.0),
        (350.0, {"heading_deg": 10.0}, 370.0, 20.0),
        (10.0, {"heading_deg": 190.0}, 190.0, 180.0),
        (200.0, {"heading_deg": 20.0}, 380.0, 180.0),
        (10.0, {"heading_deg": 70.0, "turn_dps": 3.0}, 70.0, 20.0),
        (10.0, {"heading_deg": 70.0, "turn_dps": -3.0}, -290.0, 100.0),
        (10.0, {"heading_deg": 350.0, "turn_dps": 2.0}, 350.0, 170.0),
        (10.0, {"heading_deg": 190.0, "turn_dps": -1.0}, -170.0, 180.0),
        (10.0, {"heading_deg": 370.0 - 360.0, "turn_dps": -1.0}, 10.0, 0.0),
        (10.0, {"heading_deg": -350.0}, 10.0, 0.0),
        (10.0, {"duration_s": 120.0, "turn_dps": -0.25}, -20.0, 120.0),
    ],
)
def test_turns(start: float, leg: dict[str, Any], end: float, time: float) -> None:
    first = {"duration_s": 100.0, "speed_mps": 6.0, "heading_deg": start}
    values = _values(first, leg)
    heading = values[:, HEADING] / DEG
    assert heading[:201] == pytest.approx(np.full(201, start))
    done = 200 + round(2.0 * time)
    assert heading[done:] == pytest.approx(np.full(801 - done, end))
    if time:
        assert heading[200 + round(time)] == pytest.approx(0.5 * (start + end))
        rate = values[:, HEADING_RATE] / DEG
        assert rate[200 + round(time)] == pytest.approx(2.0 * (end - start) / time)
    assert np.hypot(values[:, VE], values[:, VN]) == pytest.approx(np.full(801, 6.0))


def test_a_full_circle_is_not_turned_over_a_rounding_error() -> None:
    first = {"duration_s": 100.0, "speed_mps": 6.0, "heading_deg": 0.1}
    third = {"duration_s": 100.0, "turn_dps": 0.2 / 100.0}
    values = _values(first, third, {"duration_s": 10.0, "heading_deg": 0.1 + 0.2 - 1e-12, "turn_dps": 1.0})
    assert np.abs(values[:, HEADING]).max() < 0.4 * DEG


def test_acceleration_and_turn_rate_are_continuous() -> None:
    legs = (
        {"duration_s": 20.0, "speed_mps": 5.0, "heading_deg": 80.0},
        {"duration_s": 60.0, "speed_mps": 8.0, "heading_deg": 30.0},
        {"duration_s": 30.0, "accel_mps2": -0.1, "turn_dps": 2.0},
    )
    steps = [
        np.abs(np.diff(_values(*legs, until=120.0, step=h)[:, [AE, AN, HEADING_RATE]], axis=0)).max(axis=0)
        for h in (0.02, 0.01)
    ]
    assert steps[0] / steps[1] == pytest.approx([2.0, 2.0, 2.0], rel=0.02)


def test_astern_the_ship_moves_against_its_heading() -> None:
    values = _values({"duration_s": 50.0, "speed_mps": 0.0}, {"speed_mps": -2.0, "heading_deg": 0.0})
    assert values[-1, VN] == pytest.approx(-2.0)
    assert values[-1, LAT] < SITE.lat


def test_a_turn_on_the_spot_is_a_motion() -> None:
    turning = LegsMotion(leg=[{"duration_s": 5.0, "turn_dps": 1.0}]).truth(1001, 0.5, SITE, WGS84)
    assert turning.values.shape == (1001, 15)
    assert (turning.values[:, LAT] == SITE.lat).all()


RUN = {"duration_s": 60.0, "speed_mps": 5.0}


@pytest.mark.parametrize(
    ("legs", "field", "words"),
    [
        ([], "leg", "at least one"),
        ([{"speed_mps": 1.0, "speed_kn": 2.0}], "leg.0.speed_kn", "not both"),
        ([RUN, {"duration_s": 29.0, "speed_mps": 8.0}], "leg.1.speed_mps", "takes 30 s"),
        ([RUN, {"duration_s": 10.0, "speed_kn": 20.0}], "leg.1.speed_kn", "ends after 10 s"),
        ([RUN, {"speed_mps": 8.0, "accel_mps2": 0.0}], "leg.1.speed_mps", "never ends"),
        ([RUN, RUN, {"duration_s": 59.0, "heading_deg": -60.0}], "leg.2.heading_deg", "takes 60 s"),
        ([RUN, {"heading_deg": 60.0, "turn_dps": 0.0}], "leg.1.heading_deg", "never ends"),
        (
            [{"duration_s": 50.0, "speed_mps": 490.0, "accel_mps2": 1.0}],
            "leg.0.accel_mps2",
            "leads to 540 m/s",
        ),
        ([RUN, {"duration_s": 600.0, "accel_mps2": -0.1}], "leg.1.accel_mps2", "leads to -55 m/s"),
    ],
)
def test_impossible_legs_are_refused_by_leg_and_field(legs: list[Any], field: str, words: str) -> None:
    with pytest.raises(ValueError, match=words) as caught:
        LegsMotion(leg=legs)
    assert f"{field}" in str(caught.value)


def test_every_change_that_does_not_fit_is_named() -> None:
    short = {"duration_s": 1.0, "speed_mps": 9.0, "heading_deg": 90.0}
    with pytest.raises(ValueError, match=r"leg\.1\.speed_mps = 9\.0.*\n.*leg\.1\.heading_deg = 90\.0"):
        LegsMotion(leg=[RUN, short])


def test_a_change_that_just_fits_is_taken() -> None:
    values = _values(RUN, {"duration_s": 30.0, "speed_mps": 8.0, "heading_deg": 30.0})
    assert _speed(values)[-1] == pytest.approx(8.0)


@pytest.mark.parametrize(
    "leg",
    [
        {"duration_s": 0.0},
        {"speed_mps": 501.0},
        {"accel_mps2": -21.0},
        {"turn_dps": 61.0},
        {"heading_deg": 361.0},
    ],
)
def test_leg_fields_out_of_range_are_refused(leg: dict[str, float]) -> None:
    with pytest.raises(ValueError, match=f"leg.0.{next(iter(leg))}"):
        LegsMotion(leg=[leg])


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_the_leg_that_leads_to_a_pole_is_named(sign: float) -> None:
    motion = LegsMotion(
        leg=[
            {"duration_s": 3600.0, "speed_mps": 300.0, "heading_deg": 90.0},
            {"heading_deg": 90.0 - sign * 90.0},
        ]
    )
    site = Site(sign * 80.0 * DEG, 0.0, 0.0)
    with pytest.raises(InputError) as caught:
        motion.truth(20_001, 0.5, site, WGS84)
    (fault,) = caught.value.faults
    assert fault.field == "leg.1"
    assert "89.5° of latitude" in fault.allowed
    assert motion.truth(7201, 0.5, site, WGS84).values.shape == (7201, 15)


# ---------------------------------------------------------------- position along legs


DAY = 86400.0
NORTH_SEA = Site(57.0 * DEG, 3.0 * DEG, 25.0)
ISLAND = Site(-0.5 * DEG, 179.9 * DEG, 0.0)
"""South of the equator and west of the date line, both of which the patrol crosses."""
PATROL: list[dict[str, Any]] = [
    {"duration_s": 7200.0, "speed_mps": 9.0, "heading_deg": 20.0},
    {"duration_s": 3600.0, "heading_deg": 110.0, "speed_mps": 4.0},
    {"duration_s": 5000.0, "turn_dps": 0.4},
    {"duration_s": 600.0, "accel_mps2": 0.01, "turn_dps": -2.0},
    {"duration_s": 40.0, "heading_deg": 300.0, "turn_dps": 9.0},
    {"duration_s": 30.0, "speed_mps": 2.0, "accel_mps2": 1.0},
    {"duration_s": 20000.0, "speed_mps": 14.0},
    {"duration_s": 20000.0, "heading_deg": 200.0},
    {"duration_s": 20000.0, "heading_deg": 190.0, "speed_mps": 11.0, "turn_dps": -0.001},
]


def _reference(motion: LegsMotion, site: Site, end: float, earth: Earth) -> Any:
    """Position from scipy's eighth-order integrator over plain formulas of the legs, leg by leg."""
    from scipy.integrate import solve_ivp

    def rate(t: float, position: np.ndarray, leg: np.ndarray) -> list[float]:
        start, speed, faster, speed_time, heading, turned, turn_time = leg[:7]
        for_speed = min((t - start) / speed_time, 1.0) if speed_time else 1.0
        for_turn = min((t - start) / turn_time, 1.0) if turn_time else 1.0
        v = speed + faster * (for_speed - math.sin(2 * math.pi * for_speed) / (2 * math.pi))
        psi = heading + turned * (for_turn - math.sin(2 * math.pi * for_turn) / (2 * math.pi))
        root = math.sqrt(1.0 - earth.e2 * math.sin(position[0]) ** 2)
        meridian = 6378137.0 * (1.0 - earth.e2) / root**3 + site.height
        normal = 6378137.0 / root + site.height
        return [v * math.cos(psi) / meridian, v * math.sin(psi) / (normal * math.cos(position[0]))]

    legs = motion.table()
    times, positions, position = [0.0], [(site.lat, site.lon)], [site.lat, site.lon]
    for number, leg in enumerate(legs):
        last = legs[number + 1, 0] if number + 1 < len(legs) else end
        marks = sorted({leg[0], min(leg[0] + leg[3], last), min(leg[0] + leg[6], last), last})
        for a, b in zip(marks[:-1], marks[1:], strict=True):
            solution = solve_ivp(rate, (a, b), position, "DOP853", rtol=1e-13, atol=1e-15, args=(leg,))
            position = list(solution.y[:, -1])
            times.append(b)
            positions.append((position[0], position[1]))
    return np.array(times), np.array(positions)


def _metres(values: np.ndarray, reference: np.ndarray) -> float:
    north = (values[:, LAT] - reference[:, 0]) * 6.4e6
    east = (values[:, LON] - reference[:, 1]) * 6.4e6 * np.cos(reference[:, 0])
    return float(np.hypot(north, east).max())


@pytest.mark.parametrize("earth", [WGS84, SPHERE], ids=lambda earth: earth.name)
@pytest.mark.parametrize("site", [NORTH_SEA, ISLAND], ids=["North Sea", "date line"])
def test_against_dop853_over_a_day(site: Site, earth: Earth) -> None:
    motion = LegsMotion(leg=PATROL)
    times, reference = _reference(motion, site, DAY, earth)
    values = motion.truth(round(DAY / 5.0) + 1, 5.0, site, earth).values
    assert site is NORTH_SEA or (reference[:, 0].max() > 0.0 and reference[:, 1].max() > math.pi)
    on_grid = np.abs(times / 5.0 - np.rint(times / 5.0)) < 1e-9
    rows = np.rint(times[on_grid] / 5.0).astype(int)
    assert rows[-1] == 17280
    assert len(rows) > 9
    assert _metres(values[rows], reference[on_grid]) < 1e-5


def test_the_step_does_not_matter() -> None:
    motion = LegsMotion(leg=PATROL)
    whole, half = motion.truth(86401, 1.0, NORTH_SEA, WGS84), motion.truth(172_801, 0.5, NORTH_SEA, WGS84)
    assert np.abs(whole.values - half.values[::2]).max() < 1e-12
    odd = motion.truth(12_001, 0.7, NORTH_SEA, WGS84)
    assert np.abs(odd.values[::5] - motion.truth(2401, 3.5, NORTH_SEA, WGS84).values).max() < 1e-12


def test_a_shorter_course_is_the_beginning_of_a_longer_one() -> None:
    motion = LegsMotion(leg=PATROL)
    short, long = motion.truth(14_801, 0.5, NORTH_SEA, WGS84), motion.truth(60_001, 0.5, NORTH_SEA, WGS84)
    assert _metres(short.values, long.values[:14_801, [LAT, LON]]) < 1e-5


def test_between_nodes_position_velocity_and_acceleration_belong_together() -> None:
    h = 0.05
    motion = LegsMotion(leg=PATROL[3:6])
    values = motion.truth(round(700.0 / h) + 1, h, NORTH_SEA, WGS84).values
    legs, t = motion.table(), np.arange(len(values)) * h
    # The third derivative of the velocity jumps where a change begins or ends; the numeric one errs there.
    edges = np.concatenate([legs[:, 0], legs[:, 0] + legs[:, 3], legs[:, 0] + legs[:, 6]])
    smooth = (np.abs(t[:, None] - edges).min(axis=1) > 2.5 * h)[2:-2]
    sin_lat = np.sin(values[:, LAT])
    root = np.sqrt(1.0 - WGS84.e2 * sin_lat**2)
    meridian, normal = 6378137.0 * (1.0 - WGS84.e2) / root**3 + 25.0, 6378137.0 / root + 25.0

    def derivative(x: np.ndarray) -> np.ndarray:
        return (8.0 * (x[3:-1] - x[1:-3]) - (x[4:] - x[:-4])) / (12.0 * h)

    inner = slice(2, -2)
    north = derivative(values[:, LAT]) * meridian[inner]
    east = derivative(values[:, LON]) * (normal * np.cos(values[:, LAT]))[inner]
    # The polynomial's own slope: 2e-6 m over a fraction of a second.
    assert np.abs(north - values[inner, VN]).max() < 3e-5
    assert np.abs(east - values[inner, VE]).max() < 3e-5
    for velocity, acceleration in ((VE, AE), (VN, AN), (HEADING, HEADING_RATE)):
        assert np.abs(derivative(values[:, velocity]) - values[inner, acceleration])[smooth].max() < 2e-6


def test_near_the_pole_nodes_draw_together() -> None:
    legs = LegsMotion(leg=[{"speed_mps": 300.0, "heading_deg": 90.0}]).table()
    polar = lay_course(legs, 3600.0, Site(89.4 * DEG, 0.0, 0.0), WGS84)
    tropical = lay_course(legs, 3600.0, Site(0.0, 0.0, 0.0), WGS84)
    assert tropical.nodes.shape[0] == 61
    assert polar.nodes.shape[0] > 1000


@pytest.mark.parametrize("heading", [*range(7, 360, 31), 60, 123.456, -60])
def test_what_a_leg_keeps_is_no_change_however_it_is_rounded(heading: float) -> None:
    knots = 10.0 * heading / 360.0
    turning = {"duration_s": 500.0, "heading_deg": heading, "speed_kn": knots, "depth_m": 0.3}
    kept = {"duration_s": 500.0, "heading_deg": heading, "speed_mps": knots * KNOT, "depth_m": 0.3}
    motion = LegsMotion(
        leg=[{"duration_s": 100.0, "depth_m": 0.1}, turning, kept, turning],
        repeat=5,
        repeat_from=1,
    )
    fastest = max(frequency for _, frequency in motion.calm_frequencies())
    assert fastest < 1.0
    assert not motion.table()[2:, [SPEED_CHANGE, SPEED_TIME, COURSE_CHANGE, COURSE_TIME]].any()
    assert not motion.depths()[2:, 2:].any()

"""Position along `legs` against independent integrations: within 0.01 mm over 24 h, whatever the step."""

import math
from typing import Any

import numpy as np
import pytest

from navcore.foundation.earth import SPHERE, WGS84, Earth
from navcore.foundation.units import DEG
from navcore.motion.course import lay_course
from navcore.motion.legs import LegsMotion
from navcore.motion.truth import AE, AN, HEADING, HEADING_RATE, LAT, LON, VE, VN, Site

DAY = 86400.0
SITE = Site(57.0 * DEG, 3.0 * DEG, 25.0)
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
@pytest.mark.parametrize("site", [SITE, ISLAND], ids=["North Sea", "date line"])
def test_against_dop853_over_a_day(site: Site, earth: Earth) -> None:
    motion = LegsMotion(leg=PATROL)
    times, reference = _reference(motion, site, DAY, earth)
    values = motion.truth(round(DAY / 5.0) + 1, 5.0, site, earth).values
    assert site is SITE or (reference[:, 0].max() > 0.0 and reference[:, 1].max() > math.pi)
    on_grid = np.abs(times / 5.0 - np.rint(times / 5.0)) < 1e-9
    rows = np.rint(times[on_grid] / 5.0).astype(int)
    assert rows[-1] == 17280
    assert len(rows) > 9
    assert _metres(values[rows], reference[on_grid]) < 1e-5


def test_the_step_does_not_matter() -> None:
    motion = LegsMotion(leg=PATROL)
    whole, half = motion.truth(86401, 1.0, SITE, WGS84), motion.truth(172_801, 0.5, SITE, WGS84)
    assert np.abs(whole.values - half.values[::2]).max() < 1e-12
    odd = motion.truth(12_001, 0.7, SITE, WGS84)
    assert np.abs(odd.values[::5] - motion.truth(2401, 3.5, SITE, WGS84).values).max() < 1e-12


def test_a_shorter_course_is_the_beginning_of_a_longer_one() -> None:
    motion = LegsMotion(leg=PATROL)
    short, long = motion.truth(14_801, 0.5, SITE, WGS84), motion.truth(60_001, 0.5, SITE, WGS84)
    assert _metres(short.values, long.values[:14_801, [LAT, LON]]) < 1e-5


def test_between_nodes_position_velocity_and_acceleration_belong_together() -> None:
    h = 0.05
    motion = LegsMotion(leg=PATROL[3:6])
    values = motion.truth(round(700.0 / h) + 1, h, SITE, WGS84).values
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

"""The whole system of a ship under way, and of a log that the computed heading turns."""

import math
from typing import Any

import numpy as np
import pytest

from navcore.analysis.held_log import Stretch, growth_along, held_log, period_map
from navcore.analysis.whole_matrix import Course, free_matrix, system_matrix, up_rate
from navcore.design.azimuth import azimuth_form
from navcore.design.azimuth import up_rate as maps_up_rate
from navcore.design.form import law_form
from navcore.design.maps import INPUTS, LoopModel, call_map, system_matrices
from navcore.design.measures import Setting
from navcore.design.ship import Ship
from navcore.engine import environment as stage_environment
from navcore.engine.measures import metrics
from navcore.engine.simulation import simulate
from navcore.foundation.earth import EARTH_RATE, SPHERE, WGS84
from navcore.foundation.units import DEG
from navcore.mechanization.trajectory import coefficients, table_of
from navcore.motion.truth import COLUMNS, HEIGHT, LAT, VE, VN, Truth
from navcore.networks import parse_network
from navcore.networks.azimuth_loop import azimuth_gains
from navcore.networks.base import LinearNetwork
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario

OMEGA_S = SPHERE.schuler_frequency(0.0)


def network(text: str) -> LinearNetwork:
    """H(s) on the sphere."""
    return parse_network(text).transfer(OMEGA_S)


COMPASS = network('id = "compass", sigma = 0.0088, xi = 0.7')
Y = parse_network('id = "unity2", zeta = 0.5').at_earth_rate()
WEST = Course(-7.0, 0.0, True)


def growth_at(own: LinearNetwork, lat_deg: float, course: Course, azimuth: Any = None) -> float:
    """Growth at a constant velocity, 1/s, with a law that reads the log each second."""
    stretch = Stretch(lat_deg * DEG, course.v_e, course.v_n, 86400.0)
    return growth_along(own, 1.0, 1.0, (stretch,), azimuth=azimuth, turned=course.turned)


@pytest.mark.parametrize("velocity", [(0.0, 0.0), (-7.0, 0.0), (4.0, 9.0), (3.0, -200.0)])
def test_the_model_under_way_is_that_of_the_design_maps(velocity: tuple[float, float]) -> None:
    lat, height, omega_s = -0.9, 30.0, 1.24e-3
    row = np.zeros((1, COLUMNS))
    row[0, [LAT, HEIGHT, VE, VN]] = lat, height, *velocity
    half = table_of(coefficients(Truth(0.5, row), WGS84, True).half)
    units = np.ones(6)
    units[:2] = WGS84.gravity(lat, height) / omega_s
    seven = np.delete(np.delete(system_matrices(half)[0], 3, 0), 3, 1)
    course = Course(*velocity, False)
    expected = seven / units[:, None] * units / omega_s
    assert free_matrix(lat, omega_s, WGS84, height, course) == pytest.approx(expected, rel=1e-9, abs=1e-12)
    up = np.delete(maps_up_rate(half)[0], 3) * units / omega_s
    assert up_rate(lat, omega_s, WGS84, height, course) == pytest.approx(up, rel=1e-9)


@pytest.mark.parametrize("azimuth", [None, Y], ids=["level", "whole"])
def test_velocity_feedback_on_a_log_in_the_ships_axes_grows_on_a_westerly_course(azimuth: Any) -> None:
    def growth(course: Course, own: Any = COMPASS) -> float:
        return growth_at(own, 45.0, course, azimuth)

    assert 1.0 / growth(WEST) / 3600.0 == pytest.approx(37.7, abs=0.1)
    assert growth(WEST) == pytest.approx(
        math.sqrt(7.0 * EARTH_RATE * math.cos(0.25 * math.pi) / 6.371e6), rel=0.1
    )
    assert growth(WEST._replace(v_e=7.0)) <= 0.0 and growth(WEST._replace(turned=False)) <= 0.0
    slow = growth_at(COMPASS, 70.0, WEST, azimuth)
    assert slow == pytest.approx(math.sqrt(7.0 * EARTH_RATE * math.cos(70.0 * DEG) / 6.371e6), rel=0.25)


def test_what_grows_only_as_the_latitude_changes_is_no_growth() -> None:
    north = Course(0.0, 7.0, True)
    matrix = system_matrix(COMPASS, 45.0 * DEG, course=north)
    assert np.linalg.eigvals(matrix).real.max() * OMEGA_S == pytest.approx(7.0 / 6.371e6, rel=0.01)
    assert growth_at(COMPASS, 45.0, north) == 0.0
    for text in ("classic2", "complementary"):
        own = network(f'id = "{text}"')
        at_rest = growth_at(own, 45.0, WEST._replace(v_e=0.0))
        assert growth_at(own, 45.0, WEST) == pytest.approx(at_rest, rel=0.05)


def test_an_integrator_that_idles_is_no_mode() -> None:
    """A gyrocompass takes the place of the north network, whose integrator of the feedback then idles."""
    gains = azimuth_gains(0.002, 0.707, OMEGA_S, 9.8)
    exact = np.linalg.eigvals(system_matrix(COMPASS, 45.0 * DEG, azimuth=gains)).real.max() * OMEGA_S
    assert exact < -1e-7
    assert held_log(COMPASS, 1.0, 1.0, 45.0 * DEG, azimuth=gains).growth_per_s == pytest.approx(
        exact, rel=1e-3
    )


@pytest.mark.parametrize("text", ['id = "compass"', 'id = "complementary"'])
@pytest.mark.parametrize("velocity", [(-7.0, 0.0), (-5.0, 5.0), (3.0, -4.0)])
def test_the_sampled_map_under_way_has_the_modes_of_the_system_matrix(
    text: str, velocity: tuple[float, float]
) -> None:
    """L_r included: with Y and a log that is turned it is a state."""
    course, own = Course(*velocity, True), network(text)
    period = period_map(own, 1.0, 1, 0.8, azimuth=Y, course=course)
    factors = np.linalg.eigvals(period)
    rates = np.log(factors[np.abs(factors) > 0.5].astype(complex))
    exact = np.linalg.eigvals(system_matrix(own, 0.8, azimuth=Y, course=course)) * OMEGA_S
    for mode in exact[np.abs(exact) < 0.3 * OMEGA_S]:
        assert np.abs(rates - mode).min() < 1e-3 * abs(mode) + 1e-10


def test_growth_along_a_motion_is_that_of_its_stretches() -> None:
    """Twice the same stretch grows as one does; west for a day, then east for a day, grows less."""
    west, east = Stretch(45.0 * DEG, -7.0, 0.0, 86400.0), Stretch(45.0 * DEG, 7.0, 0.0, 86400.0)
    alone = growth_along(COMPASS, 1.0, 1.0, (west,), turned=True)
    assert growth_along(COMPASS, 1.0, 1.0, (west, west), turned=True) == pytest.approx(alone, rel=1e-6)
    both = growth_along(COMPASS, 1.0, 1.0, (west, east), turned=True)
    assert both < 0.5 * alone


def test_a_limit_on_growth_is_judged_along_the_motion() -> None:
    leg = {"duration_s": 7200.0, "speed_mps": 7.0, "heading_deg": 270.0}
    made = Scenario.parse(
        {
            "run": {"duration_h": 2.0},
            "site": {"lat_deg": -45.0},
            "motion": {"kind": "legs", "leg": [leg]},
            "reference": {"kind": "log", "frame": "body"},
            "requirement": [{"quantity": "growth_per_s", "at_most": 1e-9}],
            "method": [{"damping": "external", "network": {"id": "compass", "sigma": 0.0088, "xi": 0.7}}],
        }
    )
    run = simulate(made).methods[0]
    assert run.growth_per_s == pytest.approx(7.36e-6, rel=0.01)
    assert not metrics(simulate(made))["methods"][0]["requirements"][0]["met"]
    assert Setting(Ship(made), made.method[0]).growth_per_s == pytest.approx(run.growth_per_s, rel=1e-3)


def test_a_gyrocompass_reads_the_turned_log_in_its_own_channel() -> None:
    gains = azimuth_gains(0.002, 0.707, OMEGA_S, 9.8)
    plain, turned = (
        system_matrix(COMPASS, 0.8, azimuth=gains, course=WEST._replace(turned=on)) for on in (False, True)
    )
    free = np.zeros(len(plain))
    free[:6] = free_matrix(0.8, OMEGA_S, course=WEST)[:, 1]
    v_e = -7.0 / (SPHERE.gravity(0.8) / OMEGA_S)
    assert (turned - plain)[:, 5] == pytest.approx((plain[:, 1] - free) * v_e, rel=1e-9, abs=1e-15)
    assert not np.delete(turned - plain, 5, 1).any()


@pytest.mark.parametrize(
    ("heading", "frame", "grows"), [(270.0, "body", True), (90.0, "body", False), (270.0, "enu", False)]
)
def test_a_long_run_grows_as_the_verdict_on_the_moving_ship_says(
    heading: float, frame: str, grows: bool
) -> None:
    hours = 150.0
    leg = {"duration_s": hours * 3600.0, "speed_mps": 7.0, "heading_deg": heading}
    data = {
        "schema": 1,
        "run": {"duration_h": hours, "earth": "sphere", "output_step_s": 3600.0},
        "site": {"lat_deg": 45.0},
        "motion": {"kind": "legs", "heading_deg": heading, "leg": [leg]},
        "reference": {"kind": "log", "frame": frame},
        "initial_error": {"attitude_arcmin": [0.0, 0.0, 5.0]},
        "method": [{"damping": "external", "network": {"id": "compass", "sigma": 0.0088, "xi": 0.7}}],
    }
    run = simulate(Scenario.parse(data)).methods[0]
    assert any("whole system under way" in text for text in run.warnings) == grows
    heading_error = np.abs(run.rows[:, 2])
    assert heading_error[-1] < 2.0 * heading_error[0] or grows
    if grows:
        rate = math.log(heading_error[-1] / heading_error[-51]) / (50.0 * 3600.0)
        assert rate == pytest.approx(run.growth_per_s, rel=0.02)
        words = "at the mean velocity, 7 m/s on course 270°, the errors grow, e-folding time 1.6 days"
        assert any(words in text for text in run.warnings)


@pytest.mark.parametrize("text", ['id = "unity2"', 'id = "compass"'])
def test_whole_damping_with_a_turned_log_has_the_slow_modes_of_the_design_maps(text: str) -> None:
    lat, parameters, course = 0.8, parse_network(text), Course(-5.0, 9.0, True)
    row = np.zeros((1, COLUMNS))
    row[0, [LAT, VE, VN]] = lat, course.v_e, course.v_n
    half = table_of(coefficients(Truth(0.5, row), SPHERE, True).half)
    method = Method(damping="external", network=parameters, azimuth=parse_network("unity2"))
    loop = LoopModel(
        law_form(method, OMEGA_S), OMEGA_S, 1.0, 1, True, True, np.zeros(INPUTS), azimuth_form(Y, True, 1.0)
    )
    factors = np.linalg.eigvals(call_map(loop, half, True, True).Phi[0])
    rates = np.log(factors[np.abs(factors) > 0.5].astype(complex))
    found = np.linalg.eigvals(system_matrix(parameters.transfer(OMEGA_S), lat, azimuth=Y, course=course))
    slow = found[(np.abs(found) > 1e-5) & (np.abs(found) < 0.3)] * OMEGA_S
    assert len(slow) == 4
    for mode in slow:
        assert np.abs(rates - mode).min() < 1e-3 * abs(mode)


def test_the_growth_along_a_long_motion_needs_neither_its_course_nor_each_of_its_rows(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The budget of the page laid the whole motion out for each method: 500 MB on a track of 16 MiB."""
    leg = {"duration_s": 86400.0, "speed_mps": 7.0, "heading_deg": 270.0}
    made = Scenario.parse(
        {
            "site": {"lat_deg": -45.0},
            "motion": {"kind": "legs", "leg": [leg]},
            "reference": {"kind": "log", "frame": "body"},
            "run": {"duration_h": 24.0},
            "method": [{"damping": "external", "network": {"id": "compass", "sigma": 0.0088, "xi": 0.7}}],
        }
    )
    exact, rows = Setting(Ship(made), made.method[0]).growth_per_s, []
    sample = stage_environment.truth_of
    monkeypatch.setattr(stage_environment, "_MOST_SHARED", 1000)
    monkeypatch.setattr(stage_environment, "_MOST_AVERAGED", 1000)
    monkeypatch.setattr(
        stage_environment, "truth_of", lambda *given: rows.append(found := sample(*given)) or found
    )
    ship = Ship(made)
    assert Setting(ship, made.method[0]).growth_per_s == pytest.approx(exact, rel=1e-3)
    assert "course" not in vars(ship)
    assert [len(truth.values) <= 1001 for truth in rows] == [True]

"""From a point of the pole map, or typed numbers, to a scenario with that pair; else why not."""

from __future__ import annotations

import numpy as np
import pytest

from app.editing.placing import (
    handle_of,
    pair_at,
    read_drag,
    read_point,
    typed_pair,
    with_nearest_pair,
    with_pair,
)
from navcore.analysis import analyse
from navcore.foundation.errors import InputError
from navcore.scenario.model import Scenario
from tests.unit.figures_runs import THREE, scenario

NETWORKS = [{"id": "compass"}, {"id": "unity2"}, {"id": "pole2"}, {"id": "complementary"}]


def with_network(network: dict, **more: object) -> Scenario:
    method = {"name": "m", "damping": "external", "network": network} | more
    return scenario(method=[*THREE, method])


@pytest.mark.parametrize("network", NETWORKS[:2], ids=lambda n: n["id"])
def test_a_picked_point_becomes_a_pole(network: dict) -> None:
    point = -0.8 + 1.1j
    placed = with_pair(with_network(network), 3, *pair_at(point))
    assert placed.note == ""
    made = placed.scenario
    poles = analyse(made.method[3].network.transfer(made.omega_s)).poles / made.omega_s
    assert np.abs(poles - point).min() < 1e-6
    assert np.abs(poles - point.conjugate()).min() < 1e-6
    assert made.method[:3] == with_network(network).method[:3]
    assert "m: pair at ζ = 0.588, ω = 1.36 ωₛ" in placed.words


def test_below_the_real_axis_it_is_the_same_pair() -> None:
    assert pair_at(-0.6 - 0.8j) == pair_at(-0.6 + 0.8j) == (pytest.approx(0.6), pytest.approx(1.0))


@pytest.mark.parametrize("network", NETWORKS[2:], ids=lambda n: n["id"])
def test_a_network_whose_pair_stays_at_omega_s_takes_the_damping_and_says_so(network: dict) -> None:
    placed = with_pair(with_network(network), 3, 0.4, 2.0)
    assert "always lies at ωₛ" in placed.note
    assert "ζ = 0.4, ω = 1 ωₛ" in placed.words
    assert analyse(placed.scenario.method[3].network.transfer(placed.scenario.omega_s)).damping_ratio == (
        pytest.approx(0.4)
    )


@pytest.mark.parametrize(
    ("index", "said"),
    [
        (0, "free runs without its network"),
        (
            1,
            "no parameter that puts a pair at ζ = 0.5, ω = 1.2 ωₛ; its least damped pair stays at ζ = 0.699",
        ),
    ],
)
def test_what_cannot_be_placed_says_why_and_where_the_pair_is(index: int, said: str) -> None:
    with pytest.raises(InputError) as refused:
        with_pair(scenario(), index, 0.5, 1.2)
    assert said in str(refused.value)


def test_a_limit_of_the_slope_refuses_what_lets_the_24_h_mode_grow() -> None:
    made = with_network({"id": "unity2", "zeta2": 0.3})
    with pytest.raises(InputError) as refused:
        with_pair(made, 3, 0.5, 1.2, 0.0)
    told = str(refused.value)
    assert "m, H'(0) = " in told and "must be <= 0 (s)" in told and "the 24 h mode grows" in told
    assert "use complementary, or unity2 with a pair below ωₛ" in told
    placed = with_pair(made, 3, 0.5, 0.8, 0.0)
    assert placed.scenario.method[3].network.transfer(made.omega_s).h_slope < 0.0
    with pytest.raises(InputError, match=r"m, H\(0\) = "):
        with_pair(with_network({"id": "compass"}), 3, 0.5, 1.2, 0.0)


def test_out_of_the_parameters_range_is_said_with_the_range() -> None:
    with pytest.raises(InputError) as refused:
        with_pair(scenario(), 2, 0.5, 4e4)
    assert "compass, sigma" in str(refused.value) and "<= 1 (1/s)" in str(refused.value)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "two numbers"),
        ("1", "two numbers"),
        ("a b", "two numbers"),
        ("nan 1", "within"),
        ("0 0", "not at 0"),
        ("1e9 0", "within"),
        ("1 2 3", "two numbers"),
        ("-1 " + "9" * 400, "within"),
    ],
)
def test_hostile_points_are_refused(text: str, said: str) -> None:
    with pytest.raises(InputError, match=said):
        pair_at(read_point(text))


def test_the_right_half_plane_is_refused_with_what_is_nearest() -> None:
    with pytest.raises(InputError) as refused:
        pair_at(read_point("0.5 1"))
    assert "grows without bound" in str(refused.value) and "ζ = 0.01" in str(refused.value)


@pytest.mark.parametrize(
    "pair", [(0.0, 1.0), (1.5, 1.0), (float("nan"), 1.0), (0.5, 0.0), (0.5, float("inf"))]
)
def test_typed_numbers_are_checked(pair: tuple[float, float]) -> None:
    with pytest.raises(InputError):
        typed_pair(*pair)
    assert typed_pair(0.5, 1.2) == (0.5, 1.2)


@pytest.mark.parametrize("network", NETWORKS, ids=lambda n: n["id"])
def test_a_handle_gives_the_network_back(network: dict) -> None:
    made = with_network(network)
    handle = handle_of(made, 3)
    assert (handle["method"], handle["name"]) == (3, "m")
    placed = with_nearest_pair(made, 3, *handle["pair"])
    assert placed.note == ""
    after, before = placed.scenario.method[3].network, made.method[3].network
    assert dict(after) == {
        name: pytest.approx(value, rel=1e-12) if isinstance(value, float) else value for name, value in before
    }


def test_a_handle_out_of_reach_stands_still_at_the_range_and_says_so() -> None:
    made = with_network({"id": "unity2"})
    placed = with_nearest_pair(made, 3, 0.4, 1.001)
    assert placed.scenario.method[3].network.model_dump()["r"] == 1.01
    assert placed.note == "the parameters allow ζ = 0.01…1, ω = 0.1…0.99 or 1.01…10 ωₛ"
    fast = with_nearest_pair(with_network({"id": "compass"}), 3, 0.5, 1e5)
    assert fast.scenario.method[3].network.model_dump()["sigma"] == pytest.approx(1.0)
    assert fast.note == "the parameters allow ζ = 0.01…1, ζ ω = 1e-05…1 1/s"


@pytest.mark.parametrize(
    ("network", "more", "why"),
    [
        ({"id": "classic2"}, {}, "No handle for m: its coefficients are fixed."),
        ({"id": "pole2", "variant": "as_printed"}, {}, "the printed variant moves its pair"),
        ({"id": "custom"}, {}, "its zeros and poles are given one by one"),
        ({"id": "optimal"}, {}, "its poles follow from the sensors, ρ and q"),
        ({"id": "compass", "k1": 0.1, "k2": 0.01, "k3": 1e-9}, {}, "its gains give three real poles"),
        ({"id": "compass"}, {"damping": "free"}, "it runs without its network"),
    ],
)
def test_a_network_without_a_handle_says_why(network: dict, more: dict, why: str) -> None:
    handle = handle_of(with_network(network, **more), 3)
    assert "pair" not in handle
    assert why in handle["told"]


@pytest.mark.parametrize(
    "text",
    ["", "1 2 0.5", "1 2 0.5 -1 0", "1 2 inf 1 0", "1 2 0.5 1e9 0", "1 2 0 1 1", "x 2 0.5 1 1", "1 " * 500],
)
def test_hostile_places_of_a_handle_are_ignored(text: str) -> None:
    assert read_drag(text) is None


def test_a_method_that_the_shown_run_lacks_has_no_handle() -> None:
    assert handle_of(scenario(), 99) == {}

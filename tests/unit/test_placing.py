"""From a point of the pole map, or typed numbers, to a scenario with that pair; else why not."""

from typing import Any

import numpy as np
import pytest

from navcore.analysis import analyse
from navcore.foundation.earth import EARTH_RATE
from navcore.foundation.errors import InputError
from navcore.law.policy.constant import Constant
from navcore.scenario.file import load
from navcore.scenario.model import Scenario
from schuler_bench.editing.placing import (
    handle_of,
    pair_at,
    read_drag,
    read_point,
    typed_pair,
    with_nearest_pair,
    with_pair,
)
from schuler_bench.views.poles.grid import locus_fields
from tests.unit.figures_runs import THREE, scenario

NETWORKS = ["compass", "unity2", "pole2", "complementary"]


def with_network(id: str, /, damping: str = "external", **parameters: Any) -> Scenario:
    """Scenario whose fourth method, "m", has this network."""
    method = {"name": "m", "damping": damping, "network": {"id": id, **parameters}}
    return scenario(method=[*THREE, method])


@pytest.mark.parametrize("id", NETWORKS[:2])
def test_a_picked_point_becomes_a_pole(id: str) -> None:
    point, before = -0.8 + 1.1j, with_network(id)
    placed = with_pair(before, 3, *pair_at(point))
    made = placed.scenario
    poles = analyse(made.method[3].network.transfer(made.omega_s)).poles / made.omega_s
    assert max(np.abs(poles - end).min() for end in (point, point.conjugate())) < 1e-6
    assert made.method[:3] == before.method[:3]
    assert placed.note == "" and "m: pair at ζ = 0.588, ω = 1.36 ωₛ" in placed.words


def test_below_the_real_axis_it_is_the_same_pair() -> None:
    assert pair_at(-0.6 - 0.8j) == pair_at(-0.6 + 0.8j) == (pytest.approx(0.6), pytest.approx(1.0))


@pytest.mark.parametrize("id", NETWORKS[2:])
def test_a_network_whose_pair_stays_at_omega_s_takes_the_damping_and_says_so(id: str) -> None:
    placed = with_pair(with_network(id), 3, 0.4, 2.0)
    assert "always lies at ωₛ" in placed.note and "ζ = 0.4, ω = 1 ωₛ" in placed.words
    loop = analyse(placed.scenario.method[3].network.transfer(placed.scenario.omega_s))
    assert loop.damping_ratio == pytest.approx(0.4)


@pytest.mark.parametrize(
    ("index", "ratio", "words"),
    [
        (0, 1.2, ["free runs without its network"]),
        (
            1,
            1.2,
            [
                "no parameter that puts a pair at ζ = 0.5, ω = 1.2 ωₛ; "
                "its least damped pair stays at ζ = 0.699"
            ],
        ),
        (2, 4e4, ["compass, sigma", "<= 1 (1/s)"]),
    ],
)
def test_what_cannot_be_placed_says_why_and_where_the_pair_is(
    index: int, ratio: float, words: list[str]
) -> None:
    with pytest.raises(InputError) as refused:
        with_pair(scenario(), index, 0.5, ratio)
    assert [word for word in words if word not in str(refused.value)] == []


def test_what_a_policy_sets_has_neither_handle_nor_locus() -> None:
    before = load("sun-ship")
    adaptive = before.method[3]
    assert adaptive.policy.id == "adaptive"
    told = 'policy "adaptive" sets ζ while it runs'
    assert handle_of(before, 3)["told"] == f"No handle for {adaptive.name}: {told}."
    for placing in (with_pair, with_nearest_pair):
        with pytest.raises(InputError, match=told):
            placing(before, 3, 0.5, 1.0)
    always = adaptive.model_copy(update={"policy": Constant()})
    assert "zeta" not in locus_fields(adaptive) and "zeta" in locus_fields(always)


def test_a_limit_of_the_slope_refuses_what_lets_the_24_h_mode_grow() -> None:
    made = with_network("unity2", zeta2=0.3)
    words = r"m, H'\(0\) = .*must be <= 0 \(s\).*the 24 h mode grows.*"
    with pytest.raises(InputError, match=words + "use complementary, or unity2 with a pair below ωₛ"):
        with_pair(made, 3, 0.5, 1.2, 0.0)
    placed = with_pair(made, 3, 0.5, 0.8, 0.0)
    assert placed.scenario.method[3].network.transfer(made.omega_s).h_slope < 0.0
    with pytest.raises(InputError, match=r"m, H\(0\) = "):
        with_pair(with_network("compass"), 3, 0.5, 1.2, 0.0)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "two numbers"),
        ("1", "two numbers"),
        ("a b", "two numbers"),
        ("nan 1", "within"),
        ("0 0", "not at 0"),
        ("1e9 0", "within"),
        ("1 2 3", "two numbers"),
        ("-1 " + "9" * 400, "within"),
        ("0.5 1", "grows without bound.*ζ = 0.01"),
    ],
)
def test_hostile_points_and_the_right_half_plane_are_refused(text: str, words: str) -> None:
    with pytest.raises(InputError, match=words):
        pair_at(read_point(text))


@pytest.mark.parametrize(
    "pair", [(0.0, 1.0), (1.5, 1.0), (float("nan"), 1.0), (0.5, 0.0), (0.5, float("inf"))]
)
def test_typed_numbers_are_checked(pair: tuple[float, float]) -> None:
    with pytest.raises(InputError):
        typed_pair(*pair)
    assert typed_pair(0.5, 1.2) == (0.5, 1.2)


@pytest.mark.parametrize("id", NETWORKS)
def test_a_handle_gives_the_network_back(id: str) -> None:
    before = with_network(id)
    handle = handle_of(before, 3)
    placed = with_nearest_pair(before, 3, *handle["pair"])
    assert (handle["method"], handle["name"], placed.note) == (3, "m", "")
    after = dict(placed.scenario.method[3].network)
    numbers = {name: value for name, value in before.method[3].network if isinstance(value, float)}
    assert after == dict(before.method[3].network) | {
        name: pytest.approx(value, rel=1e-12) for name, value in numbers.items()
    }


@pytest.mark.parametrize(
    ("id", "pair", "parameter", "value", "note"),
    [
        ("unity2", (0.4, 1.001), "r", 1.01, "ζ = 0.01…1, ω = 0.1…0.99 or 1.01…10 ωₛ"),
        ("compass", (0.5, 1e5), "sigma", pytest.approx(1.0), "ζ = 0.01…1, ζ ω = 1e-05…1 1/s"),
    ],
)
def test_a_handle_out_of_reach_stands_still_at_the_range_and_says_so(
    id: str, pair: tuple[float, float], parameter: str, value: Any, note: str
) -> None:
    placed = with_nearest_pair(with_network(id), 3, *pair)
    assert getattr(placed.scenario.method[3].network, parameter) == value
    assert placed.note == f"the parameters allow {note}"


@pytest.mark.parametrize(
    ("id", "more", "why"),
    [
        ("classic2", {}, "No handle for m: its coefficients are fixed."),
        ("pole2", {"variant": "as_printed"}, "the printed variant moves its pair"),
        ("custom", {}, "its zeros and poles are given one by one"),
        ("optimal", {}, "its poles follow from the sensors, ρ and q"),
        ("compass", {"k1": 0.1, "k2": 0.01, "k3": 1e-9}, "its gains give three real poles"),
        ("compass", {"damping": "free"}, "it runs without its network"),
    ],
)
def test_a_network_without_a_handle_says_why(id: str, more: dict[str, Any], why: str) -> None:
    handle = handle_of(with_network(id, **more), 3)
    assert "pair" not in handle and why in handle["told"]


@pytest.mark.parametrize(
    "text",
    ["", "1 2 0.5", "1 2 0.5 -1 0", "1 2 inf 1 0", "1 2 0.5 1e9 0", "1 2 0 1 1", "x 2 0.5 1 1", "1 " * 500],
)
def test_hostile_places_of_a_handle_are_ignored(text: str) -> None:
    assert read_drag(text) is None


def test_a_method_that_the_shown_run_lacks_has_no_handle() -> None:
    assert handle_of(scenario(), 99) == {}


def test_the_pair_of_an_azimuth_network_is_placed_in_units_of_the_earths_rate() -> None:
    scenario = load("sea-whole")
    index = next(i for i, method in enumerate(scenario.method) if method.azimuth.id == "unity2")
    level = scenario.method[index].network
    handle = handle_of(scenario, index, "azimuth")
    assert handle["unit"] == "Ω" and handle["omega_s"] == EARTH_RATE
    assert handle["pair"][0] == pytest.approx(0.5)
    placed = with_nearest_pair(scenario, index, 0.8, handle["pair"][1], block="azimuth")
    method = placed.scenario.method[index]
    assert analyse(method.azimuth.at_earth_rate()).damping_ratio == pytest.approx(0.8, rel=1e-6)
    assert method.network == level and "Ω" in placed.words
    bare = next(i for i, one in enumerate(scenario.method) if one.azimuth.id == "none" and not one.undamped)
    with pytest.raises(InputError, match="network"):
        with_pair(scenario, bare, 0.8, 1.0, block="azimuth")
    assert "told" in handle_of(scenario, bare, "azimuth")

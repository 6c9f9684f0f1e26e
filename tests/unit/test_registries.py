"""The contract of every registry entry: networks, motions, policies and switchings hold the same promises."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from navcore.analysis import analyse
from navcore.analysis.placement import place
from navcore.foundation.earth import WGS84
from navcore.foundation.errors import InputError
from navcore.foundation.registry import registry
from navcore.law.policy import POLICIES
from navcore.law.switching import SWITCHINGS
from navcore.motion import MOTIONS, MotionParameters
from navcore.motion.kinematics import KINDS, Kinematics
from navcore.motion.truth import (
    COLUMNS,
    HEADING,
    HEADING_RATE,
    HEIGHT,
    LAT,
    LON,
    PITCH,
    ROLL,
    VE,
)
from navcore.networks import NETWORKS, NetworkParameters
from navcore.scenario.model import Scenario
from schuler_bench.contract import checks
from tests.motions import MANOEUVRES, SEA, circle_track
from tests.strapdown import DENG_SWING, DRIVE, SITE

pytestmark = pytest.mark.contract

REGISTRIES: dict[str, dict[str, Any]] = {
    "network": NETWORKS,
    "motion": MOTIONS,
    "policy": POLICIES,
    "switching": SWITCHINGS,
}
FIELD = checks.NAMED_BY
ENTRIES = [(part, name) for part, members in REGISTRIES.items() for name in members]
FILES = {"file", "map"}
"""Named in the scenario's text; recordings are also chosen in the tab Files, maps are not yet."""
OWN_NETWORK = {"schedule": "compass", "mobility": "compass", "adaptive": "unity2"}
"""Networks of the policies that do not go with any network that can be re-tuned."""
MOVING = {"swing": DENG_SWING, "legs": DRIVE, "profile": MANOEUVRES, "waves": SEA}
"""Motions whose defaults rest."""
OMEGA_S = 1.24e-3

each_entry = pytest.mark.parametrize(
    ("part", "name"), ENTRIES, ids=[f"{part}-{name}" for part, name in ENTRIES]
)
each_network = pytest.mark.parametrize("name", NETWORKS)
each_motion = pytest.mark.parametrize("name", MOTIONS)


def moving(name: str, folder: Path) -> MotionParameters:
    """One motion of a kind that moves, if any of the kind does."""
    if name == "track":
        return circle_track(folder)
    return MOVING.get(name) or MOTIONS[name].model_validate({"kind": name})


def scenario_of(part: str, name: str, folder: Path, fidelity: str = "error_model") -> Scenario:
    """A short scenario in which the entry stands, with its defaults where these can run."""
    block: dict[str, Any] = {FIELD[part]: name}
    method: dict[str, Any] = {
        "damping": "external",
        "network": {"id": OWN_NETWORK.get(name, "complementary")},
    }
    data: dict[str, Any] = {
        "run": {"duration_h": 0.02, "fidelity": fidelity, "output_step_s": 1.0},
        "imu": {"gyro_bias_dph": [0.01, 0.01, 0.01]},
        "reference": {"kind": "log"},
        "method": [method],
    }
    if part == "motion":
        data["motion"] = moving(name, folder).model_dump(mode="json", exclude_none=True)
        data["run"]["step_s"] = 0.5
    else:
        method[part] = block
    return Scenario.parse(data)


@each_entry
def test_every_field_has_help_and_a_unit_or_a_list_of_words(part: str, name: str) -> None:
    checks.fields_are_told(REGISTRIES[part][name], FIELD[part])


@each_entry
def test_it_survives_being_written_and_read(part: str, name: str, tmp_path: Path) -> None:
    again = checks.survives_being_written(scenario_of(part, name, tmp_path))
    entry = again.motion if part == "motion" else getattr(again.method[0], part)
    assert type(entry) is REGISTRIES[part][name]


@each_entry
def test_it_stands_in_guide_schema_and_form(part: str, name: str) -> None:
    checks.stands_in_guide_schema_and_form(part, name, REGISTRIES[part][name])


@each_entry
@pytest.mark.parametrize("fidelity", ["error_model", "strapdown"])
def test_it_runs_in_both_fidelities(part: str, name: str, fidelity: str, tmp_path: Path) -> None:
    checks.runs(scenario_of(part, name, tmp_path, fidelity))


@each_network
def test_a_network_tells_what_it_is_and_what_follows(name: str) -> None:
    parameters: NetworkParameters = NETWORKS[name].model_validate({"id": name})
    checks.network_of(parameters)
    checks.alternatives_follow(parameters)


@each_network
def test_a_network_that_says_so_can_be_placed(name: str) -> None:
    parameters = NETWORKS[name].model_validate({"id": name})
    pair_now = parameters.main_pair(OMEGA_S)
    assert (pair_now is not None) == bool(parameters.placeable)
    if not parameters.placeable:
        assert parameters.no_handle
        with pytest.raises(InputError, match="cannot be placed"):
            place(parameters, 0.5, 1.5 * OMEGA_S, OMEGA_S)
        return
    placed = place(parameters, 0.5, 1.5 * OMEGA_S, OMEGA_S)
    pair = complex(-placed.damping_ratio, math.sqrt(1.0 - placed.damping_ratio**2)) * placed.frequency
    poles = analyse(placed.parameters.transfer(OMEGA_S)).poles
    assert np.abs(poles - pair).min() < 1e-9 * abs(pair)


@each_motion
def test_truth_is_consistent_with_its_derivatives(name: str, tmp_path: Path) -> None:
    checks.truth_is_consistent(moving(name, tmp_path))


@each_motion
def test_truth_does_not_depend_on_the_grid(name: str, tmp_path: Path) -> None:
    checks.truth_does_not_depend_on_the_grid(moving(name, tmp_path))


@each_motion
def test_a_motion_says_what_happens_before_the_start(name: str, tmp_path: Path) -> None:
    # a ship stopped in the same sea meets other waves
    checks.motion_stands_before_the_start(moving(name, tmp_path), same_attitude=name != "waves")


@pytest.mark.parametrize(
    ("motion", "attitude_deg"),
    [
        ({"kind": "static", "pitch_deg": 6.0, "roll_deg": 8.0, "heading_deg": 75.0}, (6.0, 8.0, 75.0)),
        ({"kind": "legs", "leg": [{"heading_deg": 33.0}, {"duration_s": 5.0}]}, (0.0, 0.0, 33.0)),
        ({"kind": "profile", "point": [{"pitch_deg": 3.0}, {"t_s": 9.0}]}, (3.0, 0.0, 0.0)),
        ({"kind": "waves", "height_m": 0.0, "heading_deg": 20.0}, (0.0, 0.0, 20.0)),
        ({"kind": "swing", "pitch_deg": 2.0,
          "pitch": {"amplitude_deg": 10.0, "frequency_hz": 0.0, "phase_deg": 90.0}}, (12.0, 0.0, 0.0)),
    ],
)  # fmt: skip
def test_at_rest_one_row_stands_for_all_times(
    motion: dict[str, Any], attitude_deg: tuple[float, ...]
) -> None:
    truth = MOTIONS[motion["kind"]].model_validate(motion).truth(1001, 0.5, SITE, WGS84)
    assert truth.constant and truth.values.shape == (1, COLUMNS) and truth.step_s == 0.5
    row = truth.values[0]
    assert tuple(row[[LAT, LON, HEIGHT]]) == (SITE.lat, SITE.lon, SITE.height)
    assert row[[PITCH, ROLL, HEADING]] == pytest.approx(np.radians(attitude_deg), rel=1e-15)
    assert not row[VE:PITCH].any() and not row[HEADING + 1 : HEADING_RATE + 1].any()


@each_motion
def test_how_fast_a_motion_is_names_fields_of_its_own(name: str, tmp_path: Path) -> None:
    checks.frequencies_name_fields(moving(name, tmp_path))


def test_every_way_to_tell_a_motion_is_used_and_no_other_is_taken_for_rest(tmp_path: Path) -> None:
    told = {moving(name, tmp_path).kinematics(10.0, SITE, WGS84).kind for name in MOTIONS}
    assert told == set(KINDS)
    with pytest.raises(ValueError, match="no compiled loop"):
        Kinematics(len(KINDS), np.zeros(15))


@pytest.mark.parametrize(
    ("place", "said"),
    [
        ("navcore.networks.base:LinearNetwork", "is no NetworkParameters"),
        ("navcore.networks.base:NetworkParameters", "must be a Literal"),
        ("navcore.networks.undamped:UndampedNetwork", "used twice"),
    ],
)
def test_a_registry_refuses_what_is_no_entry(place: str, said: str) -> None:
    with pytest.raises(TypeError, match=said):
        registry(NetworkParameters, "id", "navcore.networks.undamped:UndampedNetwork", place)

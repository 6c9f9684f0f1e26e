"""The contract of every registry entry: networks, motions, policies and switchings hold the same promises."""

import math
from pathlib import Path
from typing import Any, get_args, get_origin

import numpy as np
import pytest

from navcore.analysis import analyse
from navcore.analysis.placement import place
from navcore.engine.simulation import simulate
from navcore.foundation.earth import WGS84
from navcore.foundation.errors import InputError
from navcore.foundation.parameters import Parameters, allowed_range, element_of, extra_of
from navcore.foundation.registry import blocks_of, registry
from navcore.law.policy import POLICIES
from navcore.law.switching import SWITCHINGS
from navcore.motion import MOTIONS, MotionParameters
from navcore.motion.kinematics import KINDS, Kinematics
from navcore.motion.truth import (
    AE,
    COLUMNS,
    HEADING,
    HEADING_RATE,
    HEIGHT,
    LAT,
    LON,
    PITCH,
    ROLL,
    VE,
    VN,
    VU,
)
from navcore.networks import NETWORKS, NetworkParameters
from navcore.scenario.file import parse_toml, to_toml
from navcore.scenario.frozen import frozen
from navcore.scenario.guide import guide
from navcore.scenario.model import Scenario
from navcore.scenario.schema_file import schema_text
from schuler_bench.editing import form
from schuler_bench.views.explain.view import explanation
from tests.motions import MANOEUVRES, SEA, circle_track
from tests.strapdown import DENG_SWING, DRIVE, SITE

pytestmark = pytest.mark.contract

REGISTRIES: dict[str, dict[str, Any]] = {
    "network": NETWORKS,
    "motion": MOTIONS,
    "policy": POLICIES,
    "switching": SWITCHINGS,
}
FIELD = {"network": "id", "motion": "kind", "policy": "id", "switching": "id"}
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


def models(part: str, name: str) -> list[type[Parameters]]:
    """Class of an entry and of the blocks inside it."""
    model = REGISTRIES[part][name]
    return [model, *blocks_of(model)]


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
    for model in models(part, name):
        assert (model.__doc__ or "").strip()
        for field, info in model.model_fields.items():
            if (model is REGISTRIES[part][name] and field == FIELD[part]) or info.annotation in blocks_of(
                model
            ):
                continue
            assert info.description, f"{name}.{field} has no help"
            assert not info.is_required()
            told = extra_of(info)
            words = get_origin(info.annotation) or info.annotation in (bool, str)
            assert "unit" in told or "label" in told or words, f"{name}.{field} has neither unit nor label"
            if "slider" in told:
                sliders = told["slider"] if isinstance(told["slider"][0], list | tuple) else [told["slider"]]
                ranged = info if len(sliders) == 1 else element_of(info)
                for low, high in sliders:
                    assert low < high and {">", "<"} <= set(allowed_range(ranged)), f"{name}.{field}"
                low, high = sliders[0]
                assert not isinstance(info.default, float) or low <= info.default <= high, f"{name}.{field}"


@each_entry
def test_it_survives_being_written_and_read(part: str, name: str, tmp_path: Path) -> None:
    scenario = scenario_of(part, name, tmp_path)
    again = Scenario.parse(parse_toml(to_toml(scenario), "text"))
    assert again == frozen(scenario)
    entry = again.motion if part == "motion" else getattr(again.method[0], part)
    assert type(entry) is REGISTRIES[part][name]


@each_entry
def test_it_stands_in_guide_schema_and_form(part: str, name: str) -> None:
    model = REGISTRIES[part][name]
    heading = f'[motion] kind = "{name}"' if part == "motion" else f'{part} = {{ id = "{name}" }}'
    section = guide().split(f"## `{heading}`")[1].split("\n## ")[0]
    assert f'"{name}"' in schema_text()
    shown = {spec.path[-1 if isinstance(spec.path[-1], str) else -2] for spec in form.fields(model, ("x",))}
    blocks = {field for fields in blocks_of(model).values() for field, _ in fields}
    for field, info in model.model_fields.items():
        if field == FIELD[part]:
            continue
        assert f"| `{info.alias or field}` |" in section
        own_block = field in blocks or get_args(info.annotation)[:1] and "network" in field
        assert field in shown or own_block or field in FILES, f"the page shows no control for {field}"
        if field in shown:
            told = explanation(f"{part}.{name}.{field}")
            assert told is not None and told.source, f"the page does not explain {field}"


@each_entry
@pytest.mark.parametrize("fidelity", ["error_model", "strapdown"])
def test_it_runs_in_both_fidelities(part: str, name: str, fidelity: str, tmp_path: Path) -> None:
    (method,) = simulate(scenario_of(part, name, tmp_path, fidelity)).methods
    assert method.status == "ok"
    assert np.isfinite(method.rows).all()


@each_network
def test_a_network_tells_what_it_is_and_what_follows(name: str) -> None:
    parameters: NetworkParameters = NETWORKS[name].model_validate({"id": name})
    assert parameters.title
    assert parameters.source
    values = parameters.values(OMEGA_S)
    for group in parameters.alternatives:
        for field in group:
            assert field in type(parameters).model_fields
            assert field in values, f"{name}.{field} has no value, though it follows from the others"
    for group in parameters.alternatives[1:]:
        data = {
            field: value for field, value in values.items() if field not in sum(parameters.alternatives, ())
        }
        again = NETWORKS[name].model_validate(data | {field: plain(values[field]) for field in group})
        for found, wanted in zip(
            (again.transfer(OMEGA_S).num, again.transfer(OMEGA_S).den),
            (parameters.transfer(OMEGA_S).num, parameters.transfer(OMEGA_S).den),
            strict=True,
        ):
            np.testing.assert_allclose(found, wanted, rtol=1e-6)


def plain(value: Any) -> Any:
    """As TOML would hold it."""
    if isinstance(value, complex):
        return [value.real, value.imag]
    return [plain(item) for item in value] if isinstance(value, list | tuple) else value


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
    step, earth = 0.05, WGS84
    rows = moving(name, tmp_path).rows(16001, step, SITE, earth)
    if len(rows) == 1:
        assert name == "static"
        return
    meridian, prime_vertical = np.array([earth.radii(lat) for lat in rows[:, LAT]]).T
    rates = {
        LAT: rows[:, VN] / (meridian + rows[:, HEIGHT]),
        LON: rows[:, VE] / ((prime_vertical + rows[:, HEIGHT]) * np.cos(rows[:, LAT])),
        HEIGHT: rows[:, VU],
    }
    rates |= {VE + i: rows[:, AE + i] for i in range(3)}
    rates |= {PITCH + i: rows[:, PITCH + 3 + i] for i in range(3)}
    assert (PITCH + 2, PITCH + 5) == (HEADING, HEADING_RATE)
    for column, rate in rates.items():
        told = np.gradient(rows[:, column], step)[1:-1]
        size = max(float(np.abs(rate).max()), 1e-12)
        np.testing.assert_allclose(told, rate[1:-1], rtol=0, atol=0.03 * size, err_msg=f"column {column}")


@each_motion
def test_truth_does_not_depend_on_the_grid(name: str, tmp_path: Path) -> None:
    motion = moving(name, tmp_path)
    fine, coarse = motion.rows(4801, 0.25, SITE, WGS84), motion.rows(1201, 1.0, SITE, WGS84)
    np.testing.assert_allclose(fine[::4] if len(fine) > 1 else fine, coarse, rtol=0, atol=1e-11)


@each_motion
def test_a_motion_says_what_happens_before_the_start(name: str, tmp_path: Path) -> None:
    motion = moving(name, tmp_path)
    row = motion.rows(2, 1.0, SITE, WGS84)[0]
    before = motion.before_start(row, 120.0)
    rows = before.rows(1201, 0.1, SITE, WGS84)
    assert np.abs(rows[:, [VE, VN]]).max() == 0.0
    if name != "waves":  # a ship stopped in the same sea meets other waves
        np.testing.assert_allclose(rows[-1, [PITCH, ROLL]], row[[PITCH, ROLL]], atol=1e-9)
        assert math.remainder(rows[-1, HEADING] - row[HEADING], 2.0 * math.pi) == pytest.approx(0.0, abs=1e-9)


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
    motion = moving(name, tmp_path)
    for field, frequency in motion.frequencies():
        place: Any = motion
        for part in field.split("."):
            place = place[int(part)] if part.isdigit() else getattr(place, part)
        assert 0.0 < frequency < math.inf


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

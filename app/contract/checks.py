"""Checks of one class: what the page, the files and both fidelities expect of it.

A check raises `AssertionError` with what is wrong; it is a plain function, so that any test can call it.
"""

from __future__ import annotations

import json
import math
from typing import Any, get_args, get_origin

import numpy as np

from navcore.analysis import analyse
from navcore.analysis.report import network_report
from navcore.engine.simulation import simulate
from navcore.foundation.assets import asset_path
from navcore.foundation.earth import SPHERE, WGS84
from navcore.foundation.parameters import Parameters, allowed_range, element_of, extra_of
from navcore.foundation.registry import blocks_of
from navcore.io.formats import Candidate
from navcore.motion import MotionParameters
from navcore.motion.truth import (
    AE,
    HEADING,
    HEIGHT,
    LAT,
    LON,
    PITCH,
    ROLL,
    VE,
    VN,
    VU,
    Site,
)
from navcore.networks import NetworkParameters
from navcore.networks.discrete import discretise
from navcore.scenario.file import parse_toml, to_toml
from navcore.scenario.frozen import frozen
from navcore.scenario.guide import guide
from navcore.scenario.model import Scenario
from navcore.scenario.schema_file import schema_text
from schuler_bench.editing import form
from schuler_bench.views.explain.view import explanation

NAMED_BY = {"network": "id", "motion": "kind", "policy": "id", "switching": "id"}
"""Blocks of a scenario that a registry fills, and the field that names the entry."""
OMEGA_S = SPHERE.schuler_frequency(0.0)
SITE = Site(math.radians(32.0), math.radians(118.0), 15.0)
_FILES = {"file", "map"}
"""Named in the scenario's text; recordings are also chosen in the tab Files, maps are not yet."""
_LARGE = 1e-300


def require(condition: object, why: str) -> None:
    """Raise `AssertionError` unless the condition holds: also where Python leaves ``assert`` out."""
    if not condition:
        raise AssertionError(why)


# ---------------------------------------------------------------- parameters


def fields_are_told(model: type[Parameters], named_by: str = "") -> None:
    """Every field has a help, a default, and a unit or a label; its slider lies within its range.

    Parameters
    ----------
    model : type
        The class; the blocks inside it are looked at too.
    named_by : str
        Field that names the entry, of which nothing is told.
    """
    blocks = blocks_of(model)
    for one in (model, *blocks):
        require((one.__doc__ or "").strip(), f"{one.__name__} has no docstring")
        for field, info in one.model_fields.items():
            place = f"{one.__name__}.{field}"
            if (one is model and field == named_by) or info.annotation in blocks:
                continue
            require(info.description, f"{place} has no help")
            require(not info.is_required(), f"{place} has no default")
            told = extra_of(info)
            words = get_origin(info.annotation) or info.annotation in (bool, str)
            require("unit" in told or "label" in told or words, f"{place} has neither unit nor label")
            if "slider" in told:
                _slider_fits(place, info, told["slider"])


def _slider_fits(place: str, info: Any, slider: Any) -> None:
    sliders = slider if isinstance(slider[0], list | tuple) else [slider]
    ranged: Any = info if len(sliders) == 1 else element_of(info)
    for low, high in sliders:
        limited = {">", "<"} <= set(allowed_range(ranged))
        require(low < high and limited, f"{place} has a slider, and no range or one the wrong way round")
    low, high = sliders[0]
    default = info.default
    require(
        not isinstance(default, float) or low <= default <= high,
        f"{place}: the default {default} lies outside its slider {low}..{high}",
    )


def stands_in_guide_schema_and_form(part: str, name: str, model: type[Parameters]) -> None:
    """Guide and schema name each field; the page has a control for it, and an explanation with a source.

    Parameters
    ----------
    part : {"network", "motion", "policy", "switching"}
        Block of the scenario.
    name : str
        As a scenario names the entry.
    model : type
        The class.
    """
    own = NAMED_BY[part]
    heading = f'[motion] kind = "{name}"' if part == "motion" else f'{part} = {{ id = "{name}" }}'
    found = guide().split(f"## `{heading}`")
    require(len(found) == 2, f"the guide has no section {heading}")
    section = found[1].split("\n## ")[0]
    require(f'"{name}"' in schema_text(), f"the JSON Schema does not name {name}")
    shown = {spec.path[-1 if isinstance(spec.path[-1], str) else -2] for spec in form.fields(model, ("x",))}
    blocks = {field for fields in blocks_of(model).values() for field, _ in fields}
    for field, info in model.model_fields.items():
        if field == own:
            continue
        require(f"| `{info.alias or field}` |" in section, f"the guide does not name {name}.{field}")
        inner = field in blocks or (get_args(info.annotation)[:1] and "network" in field)
        require(field in shown or inner or field in _FILES, f"the page shows no control for {name}.{field}")
        if field in shown:
            told = explanation(f"{part}.{name}.{field}")
            require(
                told is not None and told.source,
                f"the page does not explain {name}.{field}: give the class a source",
            )


# ---------------------------------------------------------------- scenarios


def survives_being_written(scenario: Scenario) -> Scenario:
    """Written as TOML and read again the scenario is the same; return the one that was read."""
    again = Scenario.parse(parse_toml(to_toml(scenario), "text"))
    require(again == frozen(scenario), "written as TOML and read again the scenario is another one")
    return again


def runs(scenario: Scenario) -> None:
    """All methods run to the end, with numbers everywhere, and a second time to the same numbers."""
    first, second = simulate(scenario), simulate(scenario)
    for one, other in zip(first.methods, second.methods, strict=True):
        require(one.status == "ok", f"{one.method.name}: {one.status}: {one.reason}")
        require(np.isfinite(one.rows).all(), f"{one.method.name}: gives what is no number")
        same = np.array_equal(one.rows, other.rows)
        require(same, f"{one.method.name}: gives other numbers when it runs again: it keeps state or draws")
        shared = [text for text in one.warnings if "keeps state" in text]
        require(not shared, f"{one.method.name}: {' '.join(shared)}")


# ---------------------------------------------------------------- networks


def network_of(parameters: NetworkParameters, omega_s: float = OMEGA_S) -> None:
    """Poles, stability, discrete form and report of a network agree with its H(s).

    Parameters
    ----------
    parameters : NetworkParameters
        Of the class.
    omega_s : float
        Schuler frequency, rad/s.
    """
    network = parameters.transfer(omega_s)
    require(parameters.title, f"{type(parameters).__name__} has no title")
    require(parameters.source, f"{type(parameters).__name__} has no source")
    loop = analyse(network)
    require(len(loop.poles) == network.order + 2, "the loop has not as many poles as states")
    sizes = np.maximum(np.abs(loop.poles), _LARGE)
    require(
        not loop.stable or float(np.max(loop.poles.real / sizes)) <= 1e-8,
        "a stable loop has a pole right of 0",
    )
    for step_s in (10.0, 1.0, 0.005):
        _has_its_response(network, step_s)
    document = json.loads(json.dumps(network_report(parameters), allow_nan=False))
    require(document["id"] == parameters.id, "the report names another network")


def _has_its_response(network: Any, step_s: float) -> None:
    """The form that runs has the response of H at the frequencies that the bilinear form stands for."""
    discrete = discretise(network, step_s)
    omega = np.geomspace(1e-2, 1e2, 60) * network.omega_s
    omega = omega[omega * step_s < 3.0]
    half = 0.5 * network.omega_s * step_s
    exact = network.response(network.omega_s * np.tan(0.5 * omega * step_s) / math.tan(half))
    scale = np.maximum(np.abs(exact), 1e-6 * np.max(np.abs(exact)))
    off = float(np.max(np.abs(discrete.response(omega) - exact) / scale))
    require(off < 1e-6, f"at a step of {step_s:g} s the network runs with a response that is {off:.1g} off")


def alternatives_follow(parameters: NetworkParameters, omega_s: float = OMEGA_S) -> None:
    """Fields that stand for each other follow from each other, and make the same network."""
    model = type(parameters)
    values = parameters.values(omega_s)
    every = sum(parameters.alternatives, ())
    for group in parameters.alternatives:
        for field in group:
            require(field in model.model_fields, f"alternatives name {field}, which is no field")
            require(field in values, f"{field} has no value, though it follows from the others")
    for group in parameters.alternatives[1:]:
        kept = {field: value for field, value in values.items() if field not in every}
        again = model.model_validate(kept | {field: as_in_toml(values[field]) for field in group})
        for name in ("num", "den"):
            found, wanted = (getattr(one.transfer(omega_s), name) for one in (again, parameters))
            require(np.allclose(found, wanted, rtol=1e-6), f"{', '.join(group)} make another network")


def as_in_toml(value: Any) -> Any:
    """Return a value as TOML would hold it."""
    if isinstance(value, complex):
        return [value.real, value.imag]
    return [as_in_toml(item) for item in value] if isinstance(value, list | tuple) else value


# ---------------------------------------------------------------- motions


def truth_is_consistent(motion: MotionParameters, step_s: float = 0.05, count: int = 16001) -> None:
    """Position, velocity and attitude change as their rates say; a motion at rest has one row."""
    rows = motion.rows(count, step_s, SITE, WGS84)
    if len(rows) == 1:
        return
    meridian, prime_vertical = np.array([WGS84.radii(lat) for lat in rows[:, LAT]]).T
    rates = {
        LAT: rows[:, VN] / (meridian + rows[:, HEIGHT]),
        LON: rows[:, VE] / ((prime_vertical + rows[:, HEIGHT]) * np.cos(rows[:, LAT])),
        HEIGHT: rows[:, VU],
    }
    rates |= {VE + i: rows[:, AE + i] for i in range(3)}
    rates |= {PITCH + i: rows[:, PITCH + 3 + i] for i in range(3)}
    for column, rate in rates.items():
        told = np.gradient(rows[:, column], step_s)[1:-1]
        size = max(float(np.abs(rate).max()), 1e-12)
        off = float(np.max(np.abs(told - rate[1:-1])))
        require(off <= 0.03 * size, f"column {column} of the truth does not change as its rate says")


def truth_does_not_depend_on_the_grid(motion: MotionParameters) -> None:
    """The same times have the same truth, however many others are asked for."""
    fine, coarse = motion.rows(4801, 0.25, SITE, WGS84), motion.rows(1201, 1.0, SITE, WGS84)
    same = fine[::4] if len(fine) > 1 else fine
    require(np.allclose(same, coarse, rtol=0.0, atol=1e-11), "the truth depends on the grid of times")


def motion_stands_before_the_start(motion: MotionParameters, same_attitude: bool = True) -> None:
    """Before the start the vehicle stands, with the attitude of the start."""
    row = motion.rows(2, 1.0, SITE, WGS84)[0]
    rows = motion.before_start(row, 120.0).rows(1201, 0.1, SITE, WGS84)
    require(np.abs(rows[:, [VE, VN]]).max() == 0.0, "the vehicle moves before the start")
    if same_attitude:
        turned = abs(math.remainder(rows[-1, HEADING] - row[HEADING], 2.0 * math.pi))
        off = max(float(np.abs(rows[-1, [PITCH, ROLL]] - row[[PITCH, ROLL]]).max()), turned)
        require(off <= 1e-9, "before the start the attitude is another one")


def frequencies_name_fields(motion: MotionParameters) -> None:
    """What a motion says of how fast it is names fields of its own."""
    for field, frequency in motion.frequencies():
        place: Any = motion
        for part in field.split("."):
            place = place[int(part)] if part.isdigit() else getattr(place, part)
        require(0.0 < frequency < math.inf, f"{field} moves at {frequency} Hz")


# ---------------------------------------------------------------- import formats


def takes_no_other_file(format: Any) -> None:
    """It recognises none of the recordings that the program brings along."""
    for path in sorted(asset_path("recordings").rglob("*")):
        if path.is_file():
            taken = format.recognises(Candidate(path))
            require(not taken, f"{format.__name__} takes {path.name}, which is of another format")

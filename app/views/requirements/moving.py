"""What the moving part of a report needs to run the error model in the browser, packed for its WebAssembly.

The program is ``assets/moving/error_model.c``. It is given what the engine has at hand: coefficients along
the motion, errors of the sensors and the log, and the law of each method, for the network's parameter at each
position of its slider. A report is one file that is sent about, so the model runs at a step at which all of
it is small; the server's run at that step is what it equals.
"""

from __future__ import annotations

import gzip
import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from navcore.design.vary import network_not_in_force
from navcore.engine.drivers.common import law_of, network_of, seen_by
from navcore.engine.environment import Environment, environment
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.law.law import Law
from navcore.law.records import AS_PRINTED, FREE
from navcore.mechanization.trajectory import table_of
from navcore.quantities import COMPONENTS
from navcore.scenario.frozen import frozen
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario
from navcore.sensors.base import ReferenceErrors
from schuler_bench.editing import edits, form
from schuler_bench.editing.form import FieldSpec, Path
from schuler_bench.plots import style

LARGEST_BYTES = 900_000
"""Of the packed numbers as text: a report stays below 1.5 MB."""
_QUICK_STEPS, _MOST_STEPS = 12_000, 40_000
"""Of all methods together, some 2 and 7 ms in a browser: a finer step only up to the first."""
_STEPS_S, _HALVED = (1.0, 2.0, 5.0, 10.0), 6
_ROWS, _POSITIONS = 600, 40
_SAME = 1e-11
"""Of the largest number: how far an error may be from growing with its slider in proportion."""
_SLIDERS: tuple[tuple[str, str, tuple[int, ...]], ...] = (
    ("initial_error", "attitude_arcmin", (0, 1, 2)),
    ("initial_error", "velocity_mps", (0, 1)),
    ("imu", "gyro_bias_dph", (0, 1, 2)),
    ("imu", "accel_bias_ug", (0, 1)),
    ("reference", "bias_mps", (0, 1)),
)
"""Fields with which the errors grow in proportion: a slider each."""


@dataclass(frozen=True)
class Moving:
    """Numbers of a moving report.

    Attributes
    ----------
    scenario : Scenario
        As the browser runs it: its step, and the methods that move.
    header : dict
        Sizes, methods, sliders; arrays as [first number, count] of ``numbers``.
    numbers : ndarray
        All arrays, one behind the other.
    left_out : tuple of (str, str)
        Methods that do not move, and why.
    """

    scenario: Scenario
    header: dict[str, Any]
    numbers: np.ndarray
    left_out: tuple[tuple[str, str], ...]

    def packed(self) -> bytes:
        """Return the numbers as little-endian doubles, gzip; the same bytes at each time."""
        return gzip.compress(self.numbers.astype("<f8").tobytes(), mtime=0)


def moving_of(scenario: Scenario) -> Moving:
    """Pack the error model of a scenario.

    Parameters
    ----------
    scenario : Scenario
        Complete and checked.

    Raises
    ------
    InputError
        None of its methods moves, or no step makes it small enough.
    """
    left_out: list[tuple[str, str]] = []
    kept: list[Method] = []
    for method in scenario.method:
        reason = _unmoved(scenario, method)
        if reason:
            left_out.append((method.name, reason))
        else:
            kept.append(method)
    if not kept:
        reason = Text("has no method that moves: {reason}", reason=left_out[0][1])
        raise InputError(Fault("", "method", None, reason))
    for step_s, duration_h in _choices(scenario, len(kept)):
        try:
            found = _packed(_at_step(scenario, kept, step_s, duration_h), tuple(left_out))
        except InputError:  # of a rate or motion that goes with shorter steps only
            continue
        if len(found.packed()) * 4 / 3 <= LARGEST_BYTES:
            return found
    allowed = Text("is too long for an error model that moves within a report")
    raise InputError(Fault("", "run.duration_h", scenario.run.duration_h, allowed))


def _choices(scenario: Scenario, methods: int) -> Iterator[tuple[float, float]]:
    """Steps (s) and durations (h) in order of preference: the whole run, then parts from its start."""
    finest, whole_h = scenario.run.step_s, scenario.run.duration_h
    steps_s = (finest, *(one for one in _STEPS_S if one > finest))
    whole = [(step_s, whole_h) for step_s in steps_s]
    parts = [(steps_s[-1], whole_h / 2**halved) for halved in range(_HALVED + 1)]
    for most, choices in ((_QUICK_STEPS, whole), (_MOST_STEPS, parts)):
        for step_s, duration_h in choices:
            if duration_h * 3600.0 / step_s * methods <= most:
                yield step_s, duration_h


def _unmoved(scenario: Scenario, method: Method) -> str:
    """Say why a method does not move; empty where it does."""
    if scenario.on_ins:
        return Text("it runs along the output of an INS")
    if method.kind.carrying != "law":
        return Text("it is carried out in another way than by a law in one loop")
    if not method.kind.uses_network:
        return ""
    if method.policy.id not in _LIMITS or not method.switching.plain:
        return Text(
            "policies constant and threshold with hard switching move, not {policy} with {switching}",
            policy=method.policy.id,
            switching=method.switching.id,
        )
    if method.kind.azimuth(method, scenario.omega_s) is not None:
        return Text("its azimuth channel does not move")
    return ""


_LIMITS = {
    "constant": lambda law: -1.0,
    "threshold": lambda law: float(law.p["policies"]["threshold"]["limit"]),
}
"""Difference to the log beyond which a policy does not damp, m/s; below 0: it always damps."""


def _at_step(scenario: Scenario, methods: list[Method], step_s: float, duration_h: float) -> Scenario:
    """The scenario on the error model, with these methods, at another step and for another time."""
    steps = int(duration_h * 3600.0 / step_s + 1e-9)
    every = max(1, math.ceil(steps / _ROWS))
    steps -= steps % every
    one = frozen(scenario).canonical()
    names = [method.name for method in methods]
    one["method"] = [
        block for block, method in zip(one["method"], scenario.method, strict=True) if method.name in names
    ]
    one["view"] = {}
    one.pop("requirement", None)
    one["run"] |= {
        "step_s": step_s,
        "output_step_s": step_s * every,
        "duration_h": steps * step_s / 3600.0,
    }
    if scenario.strapdown:
        one["run"]["fidelity"] = "error_model"
    return Scenario.parse(one)


@dataclass
class _Numbers:
    """Collects arrays in one."""

    parts: list[np.ndarray] = field(default_factory=list)
    size: int = 0

    def put(self, values: Any) -> tuple[int, int]:
        """Add an array; return its place and its size."""
        flat = np.ascontiguousarray(values, dtype=float).ravel()
        place = self.size, len(flat)
        self.parts.append(flat)
        self.size += len(flat)
        return place


def _packed(scenario: Scenario, left_out: tuple[tuple[str, str], ...]) -> Moving:
    env, numbers = environment(scenario), _Numbers()
    steps, along = env.steps, len(env.coefficients.half) > 1 or len(env.coefficients.law) > 1
    half, motion = table_of(env.coefficients.half), env.coefficients.law
    rows = 2 * steps + 1 if along else 1
    shared = numbers.put(_log(env.reference, steps, scenario.run.step_s))
    header: dict[str, Any] = {
        "steps": steps,
        "step_s": scenario.run.step_s,
        "every": round(scenario.run.output_step_s / scenario.run.step_s),
        "along": int(along),
        "coefficients": numbers.put(np.broadcast_to(half, (rows, half.shape[1]))),
        "motion": numbers.put(
            np.broadcast_to(np.column_stack([motion["v_e"], motion["v_n"]]), (steps + 1 if along else 1, 2))
        ),
        "sensors": numbers.put(_sensors(env)),
        "start": numbers.put(scenario.initial_error.state()),
        "components": list(COMPONENTS),
        "methods": [_method(scenario, env, place, numbers, shared) for place in range(len(scenario.method))],
        "sliders": list(_sliders(scenario, env, numbers)),
    }
    return Moving(scenario, header, np.concatenate(numbers.parts), left_out)


def _sensors(env: Environment) -> np.ndarray:
    """Errors of gyros and level accelerometers over each step, shape (steps, 5)."""
    shape = (env.steps, 3)
    gyro, accel = (
        np.broadcast_to(one[: env.steps] if len(one) > 1 else one, shape)
        for one in (env.sensors.gyro, env.sensors.accel)
    )
    return np.column_stack([gyro, accel[:, :2]])


def _log(log: ReferenceErrors, steps: int, step_s: float) -> np.ndarray:
    """The log at each step, shape (steps + 1, 4): new epoch, its error east and north, valid."""
    t_s = np.arange(steps + 1) * step_s
    found = np.zeros((steps + 1, 4))
    if not len(log.time_s):
        return found
    newest = np.searchsorted(log.time_s, t_s + 1e-9, side="right") - 1
    known = np.maximum(newest, 0)
    found[:, 0] = np.diff(newest, prepend=-1) > 0
    found[:, 1:3] = log.error[known]
    found[:, 3] = (newest >= 0) & log.valid[known] & (t_s - log.time_s[known] <= log.hold_s)
    return found


def _method(
    scenario: Scenario, env: Environment, place: int, numbers: _Numbers, shared: tuple[int, int]
) -> dict[str, Any]:
    """A method: its log, its color, and its law at each position of its slider."""
    method, step_s = scenario.method[place], scenario.run.step_s
    log = seen_by(method, env.reference)
    spec = _parameter(scenario, place)
    values: list[float] = []
    present = 0.0
    laws = [numbers.put(_law(scenario, method, log.body_frame))]
    if spec is not None:
        present = float(edits.value_at(scenario, spec.path))
        for value in _positions(spec, present):
            try:
                changed = scenario if value == present else edits.with_value(scenario, spec.path, value)
                packed = _law(changed, changed.method[place], log.body_frame)
            except InputError:  # a network that cannot be, or cannot run
                continue
            values.append(value)
            laws.append(numbers.put(packed))
    return {
        "name": method.name,
        "color": style.method_color(place),
        "log": numbers.put(_log(log, env.steps, step_s)) if method.event else shared,
        "laws": laws[1:] or laws,
        "values": values,
        "present": values.index(present) if values else 0,
        "label": "" if spec is None or not values else str(spec.label),
        "field": "" if spec is None or not values else ".".join(map(str, spec.path)),
    }


def _parameter(scenario: Scenario, place: int) -> FieldSpec | None:
    """The first parameter of a method's network that acts and has a slider."""
    method = scenario.method[place]
    if not method.kind.uses_network:
        return None
    path: Path = ("method", place, "network")
    for spec in form.fields(type(method.network), path):
        value = edits.value_at(scenario, spec.path)
        unused = network_not_in_force(method, f"network.{spec.path[-1]}")
        if spec.slider is not None and isinstance(value, float) and not unused:
            return spec
    return None


def _positions(spec: FieldSpec, present: float) -> list[float]:
    """Values at the positions of a slider, the present one among them."""
    assert spec.slider is not None
    slider = spec.slider.reaching(present, spec.allowed)
    low, high = slider.ends
    found = {slider.value(low + (high - low) * k / _POSITIONS) for k in range(_POSITIONS + 1)}
    nearest = min(found, key=lambda value: abs(slider.position(value) - slider.position(present)))
    return sorted((found - {nearest}) | {present})


def _law(scenario: Scenario, method: Method, ship_axes: bool) -> np.ndarray:
    """The law of a method as the program takes it."""
    law: Law = law_of(method, network_of(scenario, method), scenario.run.step_s)
    p, network = law.p, law.s["network"]
    free = int(p["damping"]) == FREE
    order = 0 if free else int(p["order"])
    head = [
        float(p["damping"]),
        order,
        -1.0 if free else _LIMITS[method.policy.id](law),
        0.0 if free else float(p["feedback_k1"]),
        float(p["feeds_back"]),
        float(p["realisation"] == AS_PRINTED),
        float(ship_axes),
        float(network["D"]),
        float(network["F"]),
    ]
    rows = (network[name][:order] for name in ("steady", "B", "C", "E"))
    return np.concatenate([head, *rows, network["dA"][:order, :order].ravel()])


def _sliders(scenario: Scenario, env: Environment, numbers: _Numbers) -> Iterator[dict[str, Any]]:
    """Sliders of constant errors: what a unit of each adds to sensors, log and start."""
    for block, name, elements in _SLIDERS:
        specs = {spec.path: spec for spec in form.fields(type(getattr(scenario, block)), (block,))}
        for element in elements:
            spec = specs.get((block, name, element))
            if spec is None or spec.slider is None:
                continue
            present = float(edits.value_at(scenario, spec.path))
            slider = spec.slider.reaching(present, spec.allowed)
            try:
                ends = [
                    _errors(edits.with_value(scenario, spec.path, value))
                    for value in (slider.low, slider.high)
                ]
            except InputError:  # there is no such error here
                continue
            added = [(high - low) / (slider.high - slider.low) for low, high in zip(*ends, strict=True)]
            if not any(np.any(one) for one in added) or not _grows(
                _errors(scenario), ends[0], added, present, slider.low
            ):
                continue
            yield {
                "field": ".".join(map(str, spec.path)),
                "label": str(spec.label),
                "low": slider.low,
                "high": slider.high,
                "present": present,
                **{
                    key: numbers.put(one)
                    for key, one in zip(("sensors", "log", "start"), added, strict=True)
                    if np.any(one)
                },
            }


def _errors(scenario: Scenario) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Errors of the sensors and of the log at each step, and at the start."""
    env = environment(scenario)
    log = _log(env.reference, env.steps, scenario.run.step_s)[:, 1:3]
    return _sensors(env), log, np.array(scenario.initial_error.state())


def _grows(
    now: tuple[np.ndarray, ...],
    at_low: tuple[np.ndarray, ...],
    added: list[np.ndarray],
    present: float,
    low: float,
) -> bool:
    """Whether errors grow with a slider in proportion, from its lowest value to the present one."""
    for one, first, each in zip(now, at_low, added, strict=True):
        most = float(np.max(np.abs(first), initial=0.0))
        if np.any(np.abs(first + (present - low) * each - one) > _SAME * max(most, 1e-300)):
            return False
    return True

"""Form of a box beside an INS: the law together with the error propagation along the INS's output."""

from __future__ import annotations

import numpy as np

from navcore.engine.drivers.common import law_of, network_of, seen_by
from navcore.engine.drivers.outside import prepared
from navcore.engine.environment import Environment, environment
from navcore.engine.simulation import simulate
from navcore.exporting.form import Form
from navcore.exporting.law_form import reading_of
from navcore.exporting.outside_step import Box, Output, outside_step
from navcore.exporting.program import constants_of, inputs_of, place_of, read_program
from navcore.exporting.records import BOX, BOX_STATE
from navcore.exporting.replay_outside import OUTSIDE_INPUTS, OUTSIDE_OUTPUTS, replayed_outside
from navcore.exporting.step import NO_SAMPLE, NOT_YET, SAMPLE, Reading
from navcore.exporting.subject import Subject
from navcore.exporting.values import Group, Value
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.records import new_record
from navcore.foundation.text import Text
from navcore.law.law import Law
from navcore.motion.truth import HEADING, LAT, LON, VE, VN
from navcore.quantities import COMPONENTS
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario

_WHOLE = ("log_valid",)


def outside_form(subject: Subject) -> Form:
    """Form of the box; its vectors are the output of the scenario's INS, or of one that runs free in it.

    Raises
    ------
    InputError
        The method is none that a law carries out.
    """
    if subject.method.kind.carrying != "law":
        allowed = Text("has no law that acts from outside: choose a method with a network")
        raise InputError(Fault("", "--outside", subject.method.label(), allowed))
    placed, env, own = _environment(subject)
    method, step_s = placed.method[0], subject.step_s
    law, reading = _law(placed, method, step_s), reading_of(placed, method, env.reference, step_s)
    own_law, own_reading = (
        _law(placed, own or method, step_s),
        reading_of(placed, own or method, env.reference, step_s),
    )
    earth = placed.earth
    parameters = new_record(
        BOX,
        step=step_s,
        e2=earth.e2,
        g_equator=earth.g_equator,
        k_gravity=earth.somigliana_k,
        height=placed.site.height_m,
        ship_axes=env.reference.body_frame,
        own_law=own is not None,
    )
    memory = new_record(BOX_STATE)
    roots = {"box": memory.copy()}
    arguments: list[Value] = [Group((constants_of("box", parameters), place_of("box", memory)), Box)]
    for prefix, one, heard in (("", law, reading), ("own", own_law, own_reading)):
        names = [f"{prefix}{'_' * bool(prefix)}{name}" for name in ("p", "s", "ring", "log")]
        roots |= {names[1]: one.s.copy(), names[2]: one.ring.copy(), names[3]: heard.s.copy()}
        places = place_of(names[1], one.s), place_of(names[2], one.ring)
        arguments.append(Group((constants_of(names[0], one.p), *places), Law))
        arguments.append(Group((constants_of(names[3], heard.p), place_of(names[3], heard.s)), Reading))
    program = read_program(outside_step, roots, [*arguments, inputs_of(Output, _WHOLE)])
    given = _inputs(placed, env, method)
    expected = replayed_outside(Box(parameters, memory), law, reading, own_law, own_reading, given)
    notes = _notes(env.reference.body_frame)
    return Form(
        subject,
        program,
        OUTSIDE_INPUTS,
        OUTSIDE_OUTPUTS,
        given,
        expected,
        env.reference.hold_s,
        notes,
        _USAGE,
    )


_USAGE = (
    "A box beside an INS: in each call give what the INS gives out, and the log; take the damped output.",
    "It belongs to the same time: the box adds no delay. Attitude: C_b^n becomes (I - [phi x]) C_b^n.",
)


def _law(scenario: Scenario, method: Method, step_s: float) -> Law:
    return law_of(method, network_of(scenario, method), step_s)


def _environment(subject: Subject) -> tuple[Scenario, Environment, Method | None]:
    """Scenario with its site, what all methods share, and the method that the INS itself ran."""
    scenario = subject.scenario
    if not scenario.on_ins:
        return scenario, environment(scenario), None
    placed, env, _ = prepared(scenario)
    own = placed.designed(placed.ins.damping)
    return placed, env, own if own.kind.uses_network else None


def _inputs(scenario: Scenario, env: Environment, method: Method) -> np.ndarray:
    """Output of the INS and the log at each call, shape (calls, 8)."""
    steps = np.arange(env.steps + 1)
    t_s, track = steps * scenario.run.step_s, env.truth_half.at(2 * steps)
    inputs = np.zeros((len(steps), len(OUTSIDE_INPUTS)))
    inputs[:, :5] = track[:, [VE, VN, LAT, LON, HEADING]]
    if not scenario.on_ins:
        inputs[:, :5] += _free_errors(scenario, env)
    log = seen_by(method, env.reference)
    newest = np.searchsorted(log.time_s, t_s + 1e-9, side="right") - 1
    fresh, known = np.diff(newest, prepend=-1) > 0, np.maximum(newest, 0)
    word = np.where(fresh, np.where(log.valid[known], SAMPLE, NO_SAMPLE), NOT_YET)
    velocity = track[:, [VE, VN]] + log.error[known]
    if log.body_frame:
        sin, cos = np.sin(track[:, HEADING]), np.cos(track[:, HEADING])
        east, north = velocity.T
        velocity = np.column_stack([east * cos - north * sin, east * sin + north * cos])
    inputs[:, 5:7] = np.where((word == SAMPLE)[:, None], velocity, 0.0)
    inputs[:, 7] = word
    return inputs


def _free_errors(scenario: Scenario, env: Environment) -> np.ndarray:
    """Errors of a free INS in the scenario: velocity, latitude, longitude, heading, shape (calls, 5)."""
    free = scenario.model_copy(update={"method": (Method(name="free"),), "requirement": ()})
    _, _, heading, east, north, lat, lon = simulate(free).methods[0].rows.T[: len(COMPONENTS)]
    half = env.coefficients.half[::2] if len(env.coefficients.half) > 1 else env.coefficients.half
    return np.column_stack([east, north, lat / half["m"], lon / half["n_cos"], heading])


def _notes(ship_axes: bool) -> dict[str, str]:
    """What the inputs and outputs of a box are."""
    side, ahead = ("to starboard", "forward") if ship_axes else ("east", "north")
    return {
        "v_e_mps": "velocity of the INS, east",
        "v_n_mps": "velocity of the INS, north",
        "lat_rad": "latitude of the INS",
        "lon_rad": "longitude of the INS",
        "yaw_rad": "heading of the INS, clockwise from north",
        "log_e_mps": f"velocity of the log, {side}",
        "log_n_mps": f"velocity of the log, {ahead}",
        "v_e_out_mps": "damped velocity, east",
        "v_n_out_mps": "damped velocity, north",
        "lat_out_rad": "damped latitude",
        "lon_out_rad": "damped longitude",
        "yaw_out_rad": "damped heading",
    } | {
        name: f"damped minus given attitude, about {axis}"
        for name, axis in zip(COMPONENTS, ("east", "north", "up"), strict=False)
    }

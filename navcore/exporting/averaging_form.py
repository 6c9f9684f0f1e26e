"""Form of half-period averaging: the copies of the navigation go in, their means come out."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from navcore.averaging.error_model import states_ahead
from navcore.engine.drivers.averaging import plan_of
from navcore.engine.drivers.common import law_of, network_of
from navcore.engine.environment import environment
from navcore.exporting.averaging_step import Averages, Copy, averaged
from navcore.exporting.form import Form
from navcore.exporting.ir import Num, Var
from navcore.exporting.program import read_program
from navcore.exporting.subject import Subject
from navcore.exporting.values import Group
from navcore.law.called import Given
from navcore.mechanization.error_model import ErrorModelRun
from navcore.mechanization.recorder import make_recorder
from navcore.motion.truth import HEADING, LAT, LON, PITCH, ROLL, VE, VN
from navcore.quantities import COMPONENTS
from navcore.scenario.model import Scenario
from navcore.sensors.base import ReferenceErrors


def averaging_form(subject: Subject) -> Form:
    """Form of an averaging method; its vectors are those of the linear error model."""
    scenario = subject.scenario
    env = environment(scenario)
    plan = plan_of(scenario, subject.method, env.truth_half.values[0])
    level, slow = plan.copies.level, plan.copies.slow
    copies = _copies(scenario, subject, env, plan)
    names = [f"copy{i}_{name}" for i in range(len(copies)) for name in Copy._fields]
    groups = tuple(
        Group(tuple(Var(f"copy{i}_{name}", "real") for name in Copy._fields), Copy)
        for i in range(len(copies))
    )
    arguments = [Group(groups), *(Group(tuple(map(Num, one))) for one in (level, slow))]
    program = read_program(averaged, {}, arguments)
    given = np.zeros((len(copies[0].v_e_mps), len(Given._fields) + len(names)))
    main = copies[0]
    for name in ("v_e_mps", "v_n_mps", "lat_rad", "yaw_rad"):
        given[:, Given._fields.index(name)] = getattr(main, name)
    given[:, len(Given._fields) :] = np.column_stack([column for one in copies for column in one])
    expected = _expected(copies, level, slow)
    inputs = (*Given._fields, *names)
    notes = {
        f"copy{i}_{name}": f"of the copy {ahead:.0f} s ahead" if i else "of the main navigation"
        for i, ahead in enumerate(plan.copies.ahead_s)
        for name in Copy._fields
    }
    return Form(
        subject, program, inputs, Averages._fields, given, expected, 0.0, notes, _usage(plan.copies.ahead_s)
    )


def _usage(ahead_s: tuple[float, ...]) -> tuple[str, ...]:
    """What the copies are."""
    return (
        "Several copies of the navigation run undamped. Each begins from the state after alignment; before",
        "navigation starts, copy i runs ahead on the forecast of the sensors for the time below, so that its",
        "oscillations stand half a period further. In each call give the outputs of all copies; give out the",
        "means.",
        *(f"copy {i}: {ahead:.3f} s ahead" for i, ahead in enumerate(ahead_s)),
    )


def _copies(scenario: Scenario, subject: Subject, env: Any, plan: Any) -> list[Copy]:
    """Outputs of each copy along the scenario, each field of shape (calls,)."""
    step_s = subject.step_s
    law = law_of(subject.method, network_of(scenario, subject.method), step_s)
    start = np.array(scenario.initial_error.state())
    states = states_ahead(start, plan.copies.ahead_s, plan.forecast, plan.standing, scenario.earth, law)
    truth = env.truth_half.at(2 * np.arange(env.steps + 1))
    none = ReferenceErrors(np.zeros(0), np.zeros((0, 2)), np.zeros(0, bool), False, 0.0)
    found = []
    for state in states:
        recorder = make_recorder(env.steps, step_s, step_s)
        run = ErrorModelRun(
            step_s, env.steps, env.coefficients, env.sensors, none, law, state.copy(), recorder
        )
        while not run.advance(env.steps + 1):
            pass
        errors = dict(zip(COMPONENTS, recorder.rows.T, strict=False))
        half = env.coefficients.half[::2]
        metres = np.broadcast_to(half["m"], len(truth)), np.broadcast_to(half["n_cos"], len(truth))
        found.append(_outputs(truth, errors, metres))
    return found


def _outputs(truth: np.ndarray, errors: dict[str, np.ndarray], metres: tuple[np.ndarray, np.ndarray]) -> Copy:
    """Outputs of a navigation with these errors."""
    east, north, heading, v_east, v_north, lat, lon = (errors[name] for name in COMPONENTS)
    sin, cos = np.sin(truth[:, HEADING]), np.cos(truth[:, HEADING])
    return Copy(
        truth[:, VE] + v_east,
        truth[:, VN] + v_north,
        truth[:, PITCH] - (east * cos - north * sin),
        truth[:, ROLL] - (east * sin + north * cos) / np.cos(truth[:, PITCH]),
        truth[:, HEADING] + heading,
        truth[:, LAT] + lat / metres[0],
        truth[:, LON] + lon / metres[1],
    )


def _expected(copies: list[Copy], level: tuple[int, ...], slow: tuple[int, ...]) -> np.ndarray:
    """Outputs of each call: the means of the copies' small differences, as the program averages errors."""

    def mean(name: str, group: tuple[int, ...], angle: bool) -> np.ndarray:
        values = np.array([getattr(copies[i], name) for i in group])
        if not angle:
            return values.mean(axis=0)
        off = values - values[0]
        return values[0] + (off - 2.0 * math.pi * np.round(off / (2.0 * math.pi))).mean(axis=0)

    zero = np.zeros(len(copies[0].v_e_mps))
    columns = [copies[0].v_e_mps, copies[0].v_n_mps, zero, zero, zero, zero]
    columns += [mean(name, level, False) for name in ("v_e_mps", "v_n_mps")]
    columns += [mean(name, level, True) for name in ("pitch_rad", "roll_rad")]
    columns += [mean(name, slow, True) for name in ("yaw_rad", "lat_rad", "lon_rad")]
    return np.column_stack(columns)

"""Error sources that are constant or known in shape: each is one response of the linear error model.

What the scenario gives as a number (a bias, an initial error, scale factors, misalignments, current, tide,
events, delay) is one column with its sign. A bias or initial error with a stated standard deviation counts by
that, axis by axis; in the ensembles of a design every bias and initial error does (design.md, shares).
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from navcore.design.course import Course, log_axes
from navcore.design.maps import ACCEL, ERRORS, GYRO, INPUTS, LOG, MOTION, UP, LoopModel
from navcore.mechanization.trajectory import named
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario
from navcore.scenario.start import aligned_errors, independent_errors
from navcore.scenario.stochastic import CONSTANTS, StochasticModel, stated_constants
from navcore.sensors.imu import imu_errors
from navcore.sensors.log_errors.events import event_velocity
from navcore.sensors.reference import Reference
from navcore.sensors.simulated_log import mean_rounding_of, simulated_errors

_INITIAL = {
    "initial_tilt": (4, 5),
    "initial_heading": (6,),
    "initial_velocity": (0, 1),
    "initial_position": (2, 3),
}


TOLD = (*_INITIAL, "gyro_bias", "accel_bias", "log_bias")
"""Sources with a shape of their own that the Kalman filter is told of."""


@dataclass(frozen=True, eq=False)
class Column:
    """One response.

    Attributes
    ----------
    source : str
        Columns of one name are shown as one.
    start : ndarray, shape (7,)
        Errors at t = 0.
    drive : ndarray, shape (k, INPUTS) or (1, INPUTS)
        Mean input in each interval, navigation frame, SI.
    given : bool
        The scenario gives this error as a number: such columns add up with their signs. Else it is that of
        one standard deviation, and the columns add up in variance.
    """

    source: str
    start: np.ndarray
    drive: np.ndarray
    given: bool = True


def shared_columns(
    scenario: Scenario, course: Course, model: StochasticModel, drawn: bool = False
) -> tuple[Column, ...]:
    """Responses that all methods share: everything but log events of a method's own and its manoeuvres.

    Parameters
    ----------
    scenario : Scenario
        Complete and checked.
    course : Course
        Of `navcore.design.course.course`.
    model : StochasticModel
        Of the scenario.
    drawn : bool
        Every bias and initial error counts by its standard deviation, as it is drawn for the seeds of a
        design; else only one whose standard deviation the scenario states.
    """
    stated = frozenset(source for source, *_ in CONSTANTS) if drawn else stated_constants(scenario)
    return tuple(
        column
        for column in (
            *_initial(scenario, model, stated),
            *_biases(scenario, course, model, stated),
            *_known_parts(scenario, course),
            *_log_bias(scenario, course, model, stated),
            *_log_shapes(scenario, course),
        )
        if column.start.any() or column.drive.any()
    )


def own_columns(method: Method, course: Course, loop: LoopModel) -> Iterator[Column]:
    """Responses of one method: its own log events, and what its law makes of the ship's manoeuvres."""
    if method.event and loop.form.uses_log:
        t = np.arange(course.edges[-1] + 1) * course.step_s
        yield _column("log_events", LOG, course.log_counts * course.means(t, event_velocity(method.event, t)))
    if loop.form.self_referenced or loop.form.as_printed:
        motion = _column("motion", MOTION, -course.velocity)
        motion.drive[:, UP] = -named(course.half)["w_u"][course.kind]
        yield motion


def _column(source: str, inputs: slice, drive: np.ndarray) -> Column:
    whole = np.zeros((len(drive), INPUTS))
    whole[:, inputs] = drive
    return Column(source, np.zeros(ERRORS), whole)


def _initial(scenario: Scenario, model: StochasticModel, stated: frozenset[str]) -> Iterator[Column]:
    deviations = independent_errors(scenario, model.initial)
    numbers = independent_errors(scenario, np.array(scenario.initial_error.state()))
    for source, places in _INITIAL.items():
        for i in places:
            start = np.zeros(ERRORS)
            start[i] = (deviations if source in stated else numbers)[i]
            yield Column(source, start, np.zeros((1, INPUTS)), given=source not in stated)


def _biases(
    scenario: Scenario, course: Course, model: StochasticModel, stated: frozenset[str]
) -> Iterator[Column]:
    turn = course.turn.reshape(-1, 3, 3)
    none = np.zeros(3)
    gyros = _axes("gyro_bias", model.gyro_bias, scenario.imu.gyro().constant, stated)
    for bias in gyros:
        rate = turn @ bias
        yield replace(
            _column("gyro_bias", GYRO, rate),
            start=aligned_errors(scenario, rate[0], none),
            given="gyro_bias" not in stated,
        )
    for bias in _axes("accel_bias", model.accel_bias, scenario.imu.accel().constant, stated):
        force = turn @ bias
        yield replace(
            _column("accel_bias", ACCEL, force[:, :2]),
            start=aligned_errors(scenario, none, force[0]),
            given="accel_bias" not in stated,
        )


def _axes(
    source: str, deviations: np.ndarray, numbers: np.ndarray, stated: frozenset[str]
) -> Iterator[np.ndarray]:
    """Yield the constant errors of a sensor: each axis by itself, or where they are given all at once."""
    if source not in stated:
        yield numbers
        return
    for axis, deviation in enumerate(deviations):
        alone = np.zeros(len(deviations))
        alone[axis] = deviation
        yield alone


def _known_parts(scenario: Scenario, course: Course) -> Iterator[Column]:
    """Responses to the sensors' errors of a known shape along the true motion."""
    level = scenario.run.fidelity == "channel"
    step_s, rows = course.truth_step_s, len(course.truth.values)
    count = max(1, round(course.t_s[-1] / step_s)) if rows == 1 else (rows - 1) // 2
    for part in scenario.imu.all_parts():
        if not part.has_shape:
            continue
        errors = imu_errors((part,), course.truth, count, step_s, scenario.earth, 0, level_body=level)
        inputs, series = (GYRO, errors.gyro) if part.sensor == "gyro" else (ACCEL, errors.accel[:, :2])
        yield _column(part.source, inputs, course.means(np.arange(len(series)) * step_s, series))


def _log_bias(
    scenario: Scenario, course: Course, model: StochasticModel, stated: frozenset[str]
) -> Iterator[Column]:
    axes = log_axes(scenario.reference.frame == "body", course.turn.reshape(-1, 3, 3))
    given = "log_bias" not in stated
    numbers = np.array(scenario.reference.bias_mps) if model.log_bias.any() else model.log_bias
    for bias in _axes("log_bias", model.log_bias, numbers, stated):
        yield replace(_column("log_bias", LOG, course.log_counts * (axes @ bias)), given=given)


def _log_shapes(scenario: Scenario, course: Course) -> Iterator[Column]:
    """Responses to the simulated log's errors of a known shape."""
    log, end_s = scenario.reference, float(course.t_s[-1])
    for part in log.all_parts() if log.kind == "log" else ():
        if not part.has_shape:
            continue
        quiet = Reference(kind="log", frame=log.frame, rate_hz=log.rate_hz)
        errors = simulated_errors(quiet, course.truth, end_s, 0, course.step_s, (part,))
        yield _column(part.source, LOG, course.log_counts * course.means(errors.time_s, errors.error))
    if log.kind == "log" and log.rounding > 0.0:
        times, errors = mean_rounding_of(log, course.truth, end_s, course.step_s)
        for error in errors:
            column = _column("log_resolution", LOG, course.log_counts * course.means(times, error))
            yield replace(column, given=len(errors) == 1)

"""Error sources that are constant or known in shape: each is one response of the linear error model.

Biases and initial errors count with their standard deviation, axis by axis. Scale factors, misalignments,
current, events and delay count with the numbers of the scenario as they stand, the tide with its amplitude
and an unknown phase.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from navcore.design.course import Course, log_axes
from navcore.design.maps import ACCEL, ERRORS, GYRO, INPUTS, LAW, RATE, LoopModel
from navcore.scenario.model import Method, Scenario
from navcore.scenario.start import aligned_errors, independent_errors
from navcore.scenario.stochastic import StochasticModel
from navcore.sensors.imu import Imu, imu_errors
from navcore.sensors.reference import Reference, event_velocity
from navcore.sensors.simulated_log import simulated_errors

_COUPLINGS = {
    "gyro_scale": ("gyro_scale_ppm", GYRO),
    "gyro_misalignment": ("gyro_misalignment_arcsec", GYRO),
    "accel_scale": ("accel_scale_ppm", ACCEL),
    "accel_misalignment": ("accel_misalignment_arcsec", ACCEL),
}
_INITIAL = {
    "initial_tilt": (4, 5),
    "initial_heading": (6,),
    "initial_velocity": (0, 1),
    "initial_position": (2, 3),
}


UNTOLD = (*_COUPLINGS, "log_scale", "log_current", "log_events", "log_delay", "log_tide")
"""Sources that the Kalman filter is not told of."""


@dataclass(frozen=True, eq=False)
class Column:
    """One response.

    Attributes
    ----------
    source : str
        Sources of one name add up in variance.
    start : ndarray, shape (7,)
        Errors at t = 0.
    drive : ndarray, shape (k, INPUTS) or (1, INPUTS)
        Mean input in each interval, navigation frame, SI.
    """

    source: str
    start: np.ndarray
    drive: np.ndarray


def shared_columns(scenario: Scenario, course: Course, model: StochasticModel) -> tuple[Column, ...]:
    """Responses that all methods share: everything but log events of a method's own and its manoeuvres."""
    return tuple(
        column
        for column in (
            *_initial(scenario, model),
            *_biases(scenario, course, model),
            *_couplings(scenario, course),
            *_log_bias(scenario, course, model),
            *_log_shapes(scenario, course),
        )
        if column.start.any() or column.drive.any()
    )


def own_columns(method: Method, course: Course, loop: LoopModel) -> Iterator[Column]:
    """Responses of one method: its own log events, and what its law makes of the ship's manoeuvres."""
    if method.event and method.damping == "external":
        t = np.arange(course.edges[-1] + 1) * course.step_s
        yield _column("log_events", LAW, course.means(t, event_velocity(method.event, t)))
    if loop.form.damping == "internal":
        yield _column("motion", LAW, -course.velocity)
    elif loop.form.as_printed:
        yield _column("motion", RATE, -course.velocity)


def _column(source: str, inputs: slice, drive: np.ndarray) -> Column:
    whole = np.zeros((len(drive), INPUTS))
    whole[:, inputs] = drive
    return Column(source, np.zeros(ERRORS), whole)


def _initial(scenario: Scenario, model: StochasticModel) -> Iterator[Column]:
    initial = independent_errors(scenario, model.initial)
    for source, places in _INITIAL.items():
        for i in places:
            start = np.zeros(ERRORS)
            start[i] = initial[i]
            yield Column(source, start, np.zeros((1, INPUTS)))


def _biases(scenario: Scenario, course: Course, model: StochasticModel) -> Iterator[Column]:
    turn = course.turn.reshape(-1, 3, 3)
    none = np.zeros(3)
    for axis in range(3):
        gyro = turn[:, :, axis] * model.gyro_bias[axis]
        accel = turn[:, :, axis] * model.accel_bias[axis]
        yield replace(_column("gyro_bias", GYRO, gyro), start=aligned_errors(scenario, gyro[0], none))
        yield replace(
            _column("accel_bias", ACCEL, accel[:, :2]), start=aligned_errors(scenario, none, accel[0])
        )


def _couplings(scenario: Scenario, course: Course) -> Iterator[Column]:
    """Scale factors and misalignments, element by element, along the true motion."""
    level = scenario.run.fidelity == "channel"
    for source, (field, inputs) in _COUPLINGS.items():
        values = getattr(scenario.imu, field)
        for i, value in enumerate(values):
            if value == 0.0:
                continue
            single = tuple(value if j == i else 0.0 for j in range(len(values)))
            imu = Imu.model_validate({field: single})
            step_s, rows = course.truth_step_s, len(course.truth.values)
            count = max(1, round(course.t_s[-1] / step_s)) if rows == 1 else (rows - 1) // 2
            errors = imu_errors(imu, course.truth, count, step_s, scenario.earth, 0, level_body=level)
            series = errors.gyro if inputs is GYRO else errors.accel[:, :2]
            yield _column(source, inputs, course.means(np.arange(len(series)) * step_s, series))


def _log_bias(scenario: Scenario, course: Course, model: StochasticModel) -> Iterator[Column]:
    axes = log_axes(scenario.reference.frame == "body", course.turn.reshape(-1, 3, 3))
    for axis in range(2):
        yield _column("log_bias", LAW, axes[:, :, axis] * model.log_bias[axis])


def _log_shapes(scenario: Scenario, course: Course) -> Iterator[Column]:
    log = scenario.reference
    if log.kind != "log":
        return
    shapes: dict[str, list[dict[str, Any]]] = {
        "log_scale": [{"scale_ppm": log.scale_ppm}],
        "log_current": [{"current_mps": log.current_mps}],
        "log_events": [{"event": log.event}],
        "log_delay": [{"delay_s": log.delay_s}],
    }
    phase = {"tide_period_h": log.tide_period_h}
    # an unknown phase: the mean of the squares of a sine and a cosine
    tide = [value / np.sqrt(2.0) for value in log.tide_mps]
    shapes["log_tide"] = [
        {**phase, "tide_mps": tuple(tide), "tide_phase_deg": degrees} for degrees in (0.0, 90.0)
    ]
    for source, settings in shapes.items():
        for fields in settings:
            if any(
                np.any(value)
                for name, value in fields.items()
                if name not in ("tide_period_h", "tide_phase_deg")
            ):
                yield _column(source, LAW, _log_series(scenario, course, fields))


def _log_series(scenario: Scenario, course: Course, fields: dict[str, Any]) -> np.ndarray:
    log = scenario.reference
    quiet = Reference(kind="log", frame=log.frame, rate_hz=log.rate_hz).model_copy(update=fields)
    errors = simulated_errors(quiet, course.truth, float(course.t_s[-1]), 0, course.step_s)
    return course.means(errors.time_s, errors.error)

"""By how much each error source contributes to one method's errors.

From the covariance of the error budget where that models the method: every source by its variance, as the
tab Design shows it. Where no covariance exists (the law looks at the data, a recorded log), the scenario is
run with one source at a time: the noise of a sensor is the same alone and in company, for it is seeded by
sensor. Where a policy switches on what it measures, the sources then do not simply add up.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from navcore.design.along import QUANTITIES
from navcore.design.seeds import no_covariance
from navcore.design.ship import Ship
from navcore.engine.simulation import simulate
from navcore.scenario.model import InitialError, Method, Scenario
from navcore.sensors.imu import Imu
from navcore.sensors.reference import Reference

_IMU_SOURCES = {
    "gyro bias": ("gyro_bias_dph",),
    "gyro noise": ("gyro_arw_dpsh", "gyro_instability_dph"),
    "gyro scale factor and misalignment": ("gyro_scale_ppm", "gyro_misalignment_arcsec"),
    "accelerometer bias": ("accel_bias_ug",),
    "accelerometer noise": ("accel_vrw_ugpshz", "accel_instability_ug"),
    "accelerometer scale factor and misalignment": ("accel_scale_ppm", "accel_misalignment_arcsec"),
    "IMU quantisation": ("gyro_lsb", "accel_lsb"),
}
_LOG_SOURCES = {
    "log bias": ("bias_mps", "scale_ppm"),
    "log noise": ("noise_mps",),
    "log drift": ("drift_mps",),
    "current and tide": ("current_mps", "tide_mps"),
    "log events": ("event",),
    "log delay and resolution": ("delay_s", "lsb_mps"),
}
RECORDED_LOG = "recorded log"
INITIAL = "initial error"
_WORDS = {
    "gyro_white": "gyro noise",
    "gyro_drift": "gyro noise",
    "gyro_scale": "gyro scale factor and misalignment",
    "gyro_misalignment": "gyro scale factor and misalignment",
    "accel_bias": "accelerometer bias",
    "accel_white": "accelerometer noise",
    "accel_drift": "accelerometer noise",
    "accel_scale": "accelerometer scale factor and misalignment",
    "accel_misalignment": "accelerometer scale factor and misalignment",
    "log_scale": "log bias",
    "log_white": "log noise",
    "log_current": "current and tide",
    "log_tide": "current and tide",
    "log_delay": "log delay and resolution",
}
"""Sources of the budget as the sources that are run apart are called; others by their own name."""


def contributions(
    ship: Ship,
    method: Method,
    progress: Callable[[float], None] = lambda fraction: None,
    cancelled: Callable[[], bool] = lambda: False,
) -> dict[str, np.ndarray]:
    """Mean squares over the run of a method's errors, by source; shape (7,), for `QUANTITIES`, squared.

    Parameters
    ----------
    ship : Ship
        The scenario.
    method : Method
        One of its methods.
    progress : callable
        Told the fraction done, 0..1.
    cancelled : callable
        When it says True the sources not yet run are left out.
    """
    imu, log = ship.scenario.imu, ship.scenario.reference
    rounded = any((*imu.gyro_lsb, *imu.accel_lsb, log.lsb_mps))
    if log.kind != "file" and not rounded and not no_covariance(ship.scenario, method):
        by_source = ship.along(method).variance
        if all(np.all(np.isfinite(variance)) for variance in by_source.values()):
            return _in_words(by_source)
    return _run_apart(ship.scenario, method, progress, cancelled)


def _in_words(by_source: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    squares: dict[str, np.ndarray] = {}
    for source, variance in by_source.items():
        if variance.any():
            words = INITIAL if source.startswith("initial") else _WORDS.get(source, source.replace("_", " "))
            squares[words] = squares.get(words, 0.0) + np.mean(variance, axis=0)
    return squares


def _run_apart(
    scenario: Scenario, method: Method, progress: Callable[[float], None], cancelled: Callable[[], bool]
) -> dict[str, np.ndarray]:
    squares, alone = {}, scenario.model_copy(update={"method": (method,)})
    sources = active_sources(alone)
    for done, source in enumerate(sources, start=1):
        errors = simulate(only(alone, source), cancelled=cancelled).methods[0].errors
        if cancelled():  # what was under way may have been stopped half-way
            break
        squares[source] = np.array([errors[name]["rms"] ** 2 for name in QUANTITIES])
        progress(done / len(sources))
    return squares


def active_sources(scenario: Scenario) -> tuple[str, ...]:
    """Names of the error sources that a scenario has switched on, in a fixed order."""
    return tuple(_active(scenario))


def _active(scenario: Scenario) -> Iterator[str]:
    if any(scenario.initial_error.state()):
        yield INITIAL
    for name, fields in _IMU_SOURCES.items():
        if _differ(scenario.imu, Imu(), fields):
            yield name
    if scenario.reference.kind == "file":
        yield RECORDED_LOG
    if scenario.reference.kind != "none":
        for name, fields in _LOG_SOURCES.items():
            by_method = name == "log events" and any(method.event for method in scenario.method)
            if by_method or _differ(scenario.reference, Reference(), fields):
                yield name


def _differ(block: Imu | Reference, default: Imu | Reference, fields: tuple[str, ...]) -> bool:
    return any(getattr(block, field) != getattr(default, field) for field in fields)


def only(scenario: Scenario, source: str) -> Scenario:
    """Give the scenario with all error sources but one switched off.

    Parameters
    ----------
    scenario : Scenario
        As set.
    source : str
        One of `active_sources`.
    """
    imu, log = Imu(), Reference()
    keep_imu = _IMU_SOURCES.get(source, ())
    off = {
        field: getattr(imu, field)
        for fields in _IMU_SOURCES.values()
        for field in fields
        if field not in keep_imu
    }
    keep_log = _LOG_SOURCES.get(source, ())
    quiet = {
        field: getattr(log, field)
        for fields in _LOG_SOURCES.values()
        for field in fields
        if field not in keep_log
    }
    if scenario.reference.kind == "file" and source != RECORDED_LOG:
        quiet |= {"kind": "log", "file": None}
    update = {
        "imu": scenario.imu.model_copy(update=off),
        "reference": scenario.reference.model_copy(update=quiet),
    }
    if source != INITIAL:
        update["initial_error"] = InitialError()
    if source != "log events":
        update["method"] = tuple(method.model_copy(update={"event": ()}) for method in scenario.method)
    return scenario.model_copy(update=update)

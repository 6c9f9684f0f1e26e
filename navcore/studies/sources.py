"""Which error source makes a result what it is: the same scenario, run with one source at a time.

The error model is linear in its sources while a method's policy does not switch, so that the errors of the
single sources add up to those of the whole, sample by sample: the noise of a sensor is the same alone and
in company (it is seeded by sensor). Where a policy switches on what it measures, they do not, and the share
that is left over says how far.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Hashable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from cachetools import LRUCache

from navcore.engine.run import Run
from navcore.mechanization.recorder import NAMES
from navcore.scenario.model import InitialError, Method, Scenario
from navcore.sensors.imu import Imu
from navcore.sensors.reference import Reference
from navcore.studies.alone import Alone

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
_apart: LRUCache[Hashable, tuple[Contribution, ...]] = LRUCache(512)
"""Contributions by scenario and method: methods do not see each other, an unchanged one is not run again."""
_lock = threading.Lock()
RECORDED_LOG = "recorded log"
INITIAL = "initial error"


@dataclass(frozen=True)
class Contribution:
    """What one source alone does to one method.

    Attributes
    ----------
    source : str
        In words.
    rms : ndarray, shape (8,)
        RMS over the run of the quantities of `navcore.mechanization.recorder.NAMES`, rad, m/s, m.
    """

    source: str
    rms: np.ndarray


@dataclass(frozen=True)
class Apart:
    """Contributions to one method, and what they leave over.

    Attributes
    ----------
    method : str
        Name.
    contributions : tuple of Contribution
        One for each source that is switched on.
    whole : ndarray, shape (8,)
        RMS with all sources together.
    """

    method: str
    contributions: tuple[Contribution, ...]
    whole: np.ndarray

    def shares(self, *quantities: str) -> list[tuple[str, float]]:
        """Share of each source in the sum of the mean squares of all sources, largest first.

        Parameters
        ----------
        *quantities : str
            Of `navcore.mechanization.recorder.NAMES`, in one unit: their mean squares are added.
        """
        columns = [NAMES.index(quantity) for quantity in quantities]
        squares = [float(np.sum(c.rms[columns] ** 2)) for c in self.contributions]
        total = sum(squares)
        if not total > 0.0:
            return []
        shares = [(c.source, part / total) for c, part in zip(self.contributions, squares, strict=True)]
        return sorted(shares, key=lambda share: -share[1])


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


def apart(
    scenario: Scenario,
    whole: Run,
    progress: Callable[[float], None] = lambda fraction: None,
    cancelled: Callable[[], bool] = lambda: False,
) -> tuple[Apart, ...]:
    """Run every source of a scenario by itself.

    Parameters
    ----------
    scenario : Scenario
        As set.
    whole : Run
        Its run with all sources.
    progress : callable
        Told the fraction done, 0..1.
    cancelled : callable
        When it says True the sources not yet run are left out.

    Returns
    -------
    tuple of Apart
        One for each method of the scenario.
    """
    shared = scenario.model_copy(update={"method": (), "title": "", "source": ""})
    files = scenario.reference.file is not None or hasattr(scenario.motion, "file")
    names = active_sources(scenario)
    keys = [None if files else (shared, names, method) for method in scenario.method]
    with _lock:
        known = [None if key is None else _apart.get(key) for key in keys]
    new = [method for method, found in zip(scenario.method, known, strict=True) if found is None]
    made = _run_apart(scenario, new, names, None if files else shared, progress, cancelled) if new else {}
    ended = not cancelled()
    parts = []
    for key, found, method in zip(keys, known, whole.methods, strict=True):
        contributions = made[method.method.name] if found is None else found
        if found is None and ended and key is not None:
            with _lock:
                _apart[key] = contributions
        parts.append(Apart(method.method.name, contributions, _rms(method.errors)))
    return tuple(parts)


def _run_apart(
    scenario: Scenario,
    methods: Sequence[Method],
    names: tuple[str, ...],
    shared: Scenario | None,
    progress: Callable[[float], None],
    cancelled: Callable[[], bool],
) -> dict[str, tuple[Contribution, ...]]:
    """Contributions to some methods of a scenario: name -> one for each source that came to its end."""
    alone = [Alone(scenario, method) for method in methods]
    found: dict[str, list[Contribution]] = {method.name: [] for method in methods}
    for index, name in enumerate(names):
        if cancelled():
            break
        part = only(scenario, name)
        key = None if shared is None else (shared, name)
        rms = [one.rms(part, key, cancelled) for one in alone]
        if cancelled():  # what was under way may have been stopped half-way
            break
        for method, value in zip(methods, rms, strict=True):
            found[method.name].append(Contribution(name, value))
        progress((index + 1) / len(names))
    return {name: tuple(contributions) for name, contributions in found.items()}


def _rms(errors: dict[str, dict[str, float]]) -> np.ndarray:
    return np.array([errors[name]["rms"] for name in NAMES])

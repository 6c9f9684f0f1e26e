"""By how much each error source contributes to one method's errors.

From the covariance of the error budget where that models the method: every source by its variance, as
the page shows it (Limits, Design). Where no covariance exists (the law looks at the data, a recorded log),
the scenario is run with one source at a time: the noise of a sensor is the same alone and in company, for it
is seeded by sensor. Where a policy switches on what it measures, the sources then do not simply add up.
"""

from collections.abc import Callable
from typing import TypeVar

import numpy as np

from navcore.design.seeds import no_covariance
from navcore.design.ship import Ship
from navcore.engine.simulation import simulate
from navcore.foundation.text import Text
from navcore.quantities import COMPONENTS
from navcore.scenario.initial_error import InitialError
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario
from navcore.sensors.imu import Imu
from navcore.sensors.reference import Reference

_Block = TypeVar("_Block", Imu, Reference)
RECORDED_LOG = Text("recorded log")
INITIAL = Text("initial error")
_EVENTS = Text("log events")


def contributions(
    ship: Ship,
    method: Method,
    progress: Callable[[float], None] = lambda fraction: None,
    cancelled: Callable[[], bool] = lambda: False,
) -> dict[str, np.ndarray]:
    """Mean squares over the run of a method's errors, by source; shape (7,), for `COMPONENTS`, squared.

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
    scenario = ship.given
    parts = (*scenario.imu.all_parts(), *scenario.reference.all_parts())
    rounded = any(np.any(part.lsb) for part in parts)
    if scenario.reference.kind != "file" and not rounded and not no_covariance(scenario, method):
        by_source = ship.along(method).variance
        if all(np.all(np.isfinite(variance)) for variance in by_source.values()):
            return _in_words(by_source, {part.source: part.label for part in parts})
    return _run_apart(scenario, method, progress, cancelled)


def _in_words(by_source: dict[str, np.ndarray], labels: dict[str, str]) -> dict[str, np.ndarray]:
    squares: dict[str, np.ndarray] = {}
    for source, variance in by_source.items():
        if variance.any():
            words = INITIAL if source.startswith("initial") else labels.get(source, source.replace("_", " "))
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
        squares[source] = np.array([errors[name]["rms"] ** 2 for name in COMPONENTS])
        progress(done / len(sources))
    return squares


def active_sources(scenario: Scenario) -> tuple[str, ...]:
    """Names of the error sources that a scenario has switched on, in a fixed order."""
    log = scenario.reference
    names = [INITIAL] if any(scenario.initial_error.state()) else []
    names += [part.label for part in scenario.imu.all_parts() if part.active]
    names += [RECORDED_LOG] if log.kind == "file" else []
    if log.kind != "none":
        own_events = any(method.event for method in scenario.method)
        names += [
            part.label for part in log.all_parts() if part.active or (own_events and part.label == _EVENTS)
        ]
    return tuple(dict.fromkeys(names))


def only(scenario: Scenario, source: str) -> Scenario:
    """Give the scenario with all error sources but one switched off.

    Parameters
    ----------
    scenario : Scenario
        As set.
    source : str
        One of `active_sources`.
    """
    quiet = _without(scenario.reference, source)
    if scenario.reference.kind == "file" and source != RECORDED_LOG:
        quiet = quiet.model_copy(update={"kind": "log", "file": None})
    update: dict[str, object] = {"imu": _without(scenario.imu, source), "reference": quiet}
    if source != INITIAL:
        update["initial_error"] = InitialError()
    if source != _EVENTS:
        update["method"] = tuple(method.model_copy(update={"event": ()}) for method in scenario.method)
    return scenario.model_copy(update=update)


def _without(block: _Block, source: str) -> _Block:
    """Switch off all parts of a block but those of one source."""
    off = {field for part in block.all_parts() if part.label != source for field in part.fields}
    return block.model_copy(update={field: type(block).model_fields[field].default for field in off})

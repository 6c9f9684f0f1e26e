"""The worst that a log within a bound can do to every method of a scenario (theory.md 21)."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from navcore.design.seeds import no_covariance
from navcore.design.ship import Ship
from navcore.design.worst.logs import LogError, worst_log
from navcore.design.worst.played import silent
from navcore.design.worst.result import MethodWorst, Worst
from navcore.design.worst.searched import Player, searched
from navcore.design.worst.weights import LogResponse, Weights, log_response
from navcore.foundation.progress import part_of
from navcore.law.policy.constant import Constant
from navcore.law.switching.hard import Hard
from navcore.networks.classic import Classic2Network
from navcore.quantities import COMPONENTS
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario

_TIMES = (1.0, 0.5)
"""Shares of the run at whose ends the worst logs are taken that a search begins with."""
_ROUNDS, _GAIN = 6, 1e-4
"""Times of an error that are looked at one after the other, and the gain that is worth another one."""
_LARGEST_TILT, _LARGEST_VELOCITY = 1.0, 1e5
"""Range of the linear model, rad and m/s (`navcore.mechanization.error_model`)."""


def worst(
    scenario: Scenario,
    log_max: float,
    log_rate: float | None = None,
    progress: Callable[[float], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> Worst:
    """Find the largest errors of every method under a log whose error is bounded.

    Parameters
    ----------
    scenario : Scenario
        Its motion, log rate and methods count; sensors, start and log have no other error.
    log_max : float
        Largest error of each axis of the log, m/s.
    log_rate : float, optional
        Largest change of that error, m/s^2.
    progress : callable, optional
        Told the fraction done, 0..1.
    cancelled : callable, optional
        Asked between methods and runs; what was found until then is given.

    Raises
    ------
    InputError
        The motion cannot be carried out.
    """
    quiet = silent(scenario)
    ship = Ship(quiet)
    stop = cancelled or (lambda: False)
    methods: list[MethodWorst] = []
    count = len(quiet.method)
    for k, (method, given) in enumerate(zip(quiet.method, scenario.method, strict=True)):
        if stop():
            break
        report = part_of(progress, k / count, (k + 1) / count)
        if not method.reads_log:
            methods.append(MethodWorst(method.name, "exact", np.zeros(len(COMPONENTS)), playable=False))
        elif no_covariance(quiet, method):
            told = scenario.model_copy(update={"method": (given,)})
            methods.append(_found(ship, method, told, log_max, log_rate, report, stop))
        else:
            methods.append(_exact(ship, method, log_max, log_rate))
        report(1.0)
    return Worst(log_max, log_rate, scenario.run.duration_h, methods, scenario, stopped=stop())


def _exact(ship: Ship, method: Method, log_max: float, log_rate: float | None) -> MethodWorst:
    with np.errstate(over="ignore", invalid="ignore"):  # an unstable loop: told by the size of what comes
        response = log_response(ship.scenario, method, ship.course, ship.model)
        edges = response.worst_edges(2.0 * log_max / log_rate if log_rate else 0.0).tolist()
        at = {edge: response.weights(edge) for edge in {edge for own in edges for edge in own}}
        if not all(np.isfinite(weights.of).all() for weights in at.values()):
            return MethodWorst(method.name, "exact", np.full(len(COMPONENTS), np.inf), playable=False)
        pairs = [_worst_of(response, at, k, {*own}, log_max, log_rate) for k, own in enumerate(edges)]
    largest = np.array([value for value, _ in pairs])
    if largest[:3].max() > _LARGEST_TILT or largest[3:5].max() > _LARGEST_VELOCITY:
        largest = np.full(len(COMPONENTS), np.inf)
    return MethodWorst(method.name, "exact", largest, tuple(log for _, log in pairs))


def _worst_of(
    response: LogResponse,
    at: dict[int, Weights],
    k: int,
    edges: set[int],
    log_max: float,
    log_rate: float | None,
) -> tuple[float, LogError]:
    """Largest value of one error and the log that makes it.

    Along a motion a log with a bounded rate may be worse at another time than one that may jump: where a log
    makes more of the error elsewhere, the worst log of that time is the next.
    """
    value, log = max(
        (worst_log(at[edge].of[k], at[edge].begin_s, log_max, log_rate) for edge in edges),
        key=lambda pair: pair[0],
    )
    for _ in range(_ROUNDS if log_rate is not None and not response.at_rest else 0):
        edge = max(1, int(np.argmax(np.abs(response.errors(log)[:, k]))))
        if edge not in at:
            at[edge] = response.weights(edge)
        better, other = worst_log(at[edge].of[k], at[edge].begin_s, log_max, log_rate)
        if better <= value * (1.0 + _GAIN):
            break
        value, log = better, other
    return value, log


def _found(
    ship: Ship,
    method: Method,
    told: Scenario,
    log_max: float,
    log_rate: float | None,
    report: Callable[[float], None],
    stop: Callable[[], bool],
) -> MethodWorst:
    player = Player(ship.scenario, method, told)
    known = _while_damped(ship, method)
    found = searched(player, known, 2.0 * np.pi / ship.scenario.omega_s, log_max, log_rate, report, stop)
    playable = method.kind.carrying != "filter"
    return MethodWorst(method.name, "found", found.largest, found.logs, playable, found.runs)


def _while_damped(ship: Ship, method: Method) -> list[Weights]:
    """Weights of the loop that is always damped; of a textbook network where the method has none."""
    update = {"policy": Constant(), "switching": Hard()}
    if not method.kind.uses_network:
        update |= {"damping": "external", "network": Classic2Network()}
    always = method.model_copy(update=update)
    if not always.kind.uses_log:
        return []
    response: LogResponse = log_response(ship.scenario, always, ship.course, ship.model)
    last = len(response.course.kind)
    with np.errstate(over="ignore", invalid="ignore"):
        found = [response.weights(max(1, round(share * last))) for share in _TIMES]
    return [weights for weights in found if np.isfinite(weights.of).all()]

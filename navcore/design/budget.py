"""The error budget of a scenario: every method by source, beside the floor (theory.md 15, 16)."""

from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import replace

import numpy as np

from navcore.design.constants import TOLD
from navcore.design.figures import Entry, Figures, Series, entry_of
from navcore.design.floor import steady_floor
from navcore.design.measures import Setting, growing
from navcore.design.result import Budget, MethodBudget, Shown, with_floor
from navcore.design.seeds import SEEDS, no_covariance, seed_variance
from navcore.design.ship import Ship
from navcore.design.stated import assumed_zero
from navcore.design.steady import instability, loops_of, steady_budget
from navcore.design.unmodelled import unmodelled_warnings
from navcore.design.untold import untold_errors
from navcore.foundation.errors import InputError
from navcore.foundation.text import Text
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario
from navcore.scenario.stochastic import require_sensors


def budget(
    scenario: Scenario,
    steady: bool = False,
    *,
    seeds: int = SEEDS,
    progress: Callable[[float], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> Budget:
    """Error budget of every method of a scenario by source, and the floor.

    Parameters
    ----------
    scenario : Scenario
        Complete and checked.
    steady : bool
        One level channel at rest at the site, random errors only, in the steady state; else along the
        scenario's motion, with biases, initial errors and everything else that the scenario gives.
    seeds : int
        Runs of a method that has no covariance.
    progress : callable, optional
        Told the fraction done, 0..1.
    cancelled : callable, optional
        Asked between methods and seeds.

    Raises
    ------
    InputError
        The motion cannot be carried out, or the scenario runs on ``[ins]``, whose sensors are not known.

    Examples
    --------
    >>> from navcore import budget, load
    >>> found = budget(load("sikuliaq-like"), steady=True)
    >>> found.floor.rms.tilt_rad < found.methods[1].total.rms.tilt_rad
    True
    """
    require_sensors(scenario)
    ship = Ship(scenario)
    scenario = ship.scenario
    unstated = assumed_zero(scenario, steady)
    if steady:
        found = steady_budget(scenario, ship.model, ship.recordings)
        pairs = zip(found.methods, scenario.method, strict=True)
        methods = tuple(_with_growth(ship, result, method) for result, method in pairs)
        return replace(found, methods=methods, assumed_zero=unstated)
    left_out = _warnings(ship)
    untold = any(column.source not in TOLD for column in ship.columns)
    done = [0.0] * (len(scenario.method) + 1)

    def report(index: int, fraction: float) -> None:
        done[index] = fraction
        if progress is not None:
            progress(sum(done) / len(done))

    def one(index: int, least: Future[Series | None]) -> MethodBudget:
        method = scenario.method[index]
        reason = no_covariance(scenario, method)
        own = least.result() if method.kind.covering == "filter" else None
        if own is not None:
            series, note = _of_filter(scenario, method, own, untold)
            result = _of_series(method, "covariance", series, (note, *left_out))
        elif reason:
            result = _from_seeds(scenario, method, reason, seeds, lambda f: report(index, f), cancelled)
        else:
            growth = instability(loops_of(scenario, method, ship.model)[1])
            if growth:
                result = _diverged(method, "covariance", (growth, *left_out))
            else:
                found = ship.along(method)
                series = Series(found.t_s, found.variance, found.total, found.given_total)
                result = _of_series(method, "covariance", series, left_out)
        report(index, 1.0)
        return replace(_with_growth(ship, result, method), reads_log=method.reads_log)

    with ThreadPoolExecutor(2) as pool:
        least = pool.submit(lambda: ship.floor_series)
        methods = tuple(pool.map(lambda index: one(index, least), range(len(scenario.method))))
        floor = least.result()
    report(len(scenario.method), 1.0)
    if floor is None:
        reason = ship.recordings.no_floor or steady_floor(ship.model, scenario.omega_s).reason
        return Budget(False, Entry(Figures(), Figures()), reason, None, methods, unstated)
    found = with_floor(False, entry_of(floor.t_s, floor.total), "", floor, methods)
    return replace(found, assumed_zero=unstated)


def _with_growth(ship: Ship, budget: MethodBudget, method: Method) -> MethodBudget:
    """Add what one level channel does not see: modes of the whole system that grow."""
    if budget.diverged or not method.kind.uses_network or method.policy.tunes:
        return budget
    return replace(budget, warnings=(*budget.warnings, *growing(Setting(ship, method))))


def _of_filter(scenario: Scenario, method: Method, own: Series, untold: bool) -> tuple[Series, str]:
    """Covariance of truth and estimate: the filter's own, and what errors do that it is not told of."""
    if not untold:
        return own, Text("its own covariance, which is the floor: it is told of every error of this scenario")
    errors = untold_errors(scenario, method, own.t_s)
    total = own.total + sum(errors.values()) ** 2
    sources = {name: error**2 for name, error in errors.items()}
    note = Text(
        "its own covariance, and what it is not told of: {sources}", sources=", ".join(sources) or "nothing"
    )
    given = np.sum(list(errors.values()), axis=0) ** 2 if len(errors) > 1 else None
    return Series(own.t_s, {"told": own.total, **sources}, total, given), note


def _warnings(ship: Ship) -> tuple[str, ...]:
    warnings = [*ship.recordings.notes, *unmodelled_warnings(ship.scenario)]
    if ship.scenario.alignment.kind == "compass":
        warnings.append(Text("alignment: what biases leave after it is in the budget, its own noise is not"))
    return tuple(warnings)


def _from_seeds(
    scenario: Scenario,
    method: Method,
    reason: str,
    seeds: int,
    report: Callable[[float], None],
    cancelled: Callable[[], bool] | None,
) -> MethodBudget:
    try:
        t_s, variance = seed_variance(scenario, method, seeds, report, cancelled)
    except InputError as error:  # it diverges
        return _diverged(
            method,
            "seeds",
            tuple(
                Text("{field}: {allowed}", field=fault.field, allowed=fault.allowed) for fault in error.faults
            ),
        )
    note = Text(
        "{reason}: there is no covariance; shown is the mean square of {seeds} seeds, not split by source",
        reason=reason,
        seeds=seeds,
    )
    return _of_series(method, "seeds", Series(t_s, {}, variance), (note,))


def _of_series(method: Method, kind: Shown, series: Series, warnings: tuple[str, ...]) -> MethodBudget:
    if not np.all(np.isfinite(series.total)):
        return _diverged(method, kind, warnings)
    total = entry_of(series.t_s, series.total)
    sources = {name: entry_of(series.t_s, values) for name, values in series.sources.items()}
    given = None if series.given is None else entry_of(series.t_s, series.given)
    return MethodBudget(method.name, kind, total, sources, given=given, warnings=warnings, series=series)


def _diverged(method: Method, kind: Shown, warnings: tuple[str, ...]) -> MethodBudget:
    empty = Entry(Figures(), Figures())
    all_warnings = (*warnings, Text("diverged: there is no budget along this run"))
    return MethodBudget(method.name, kind, empty, {}, warnings=all_warnings, diverged=True)

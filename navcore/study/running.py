"""The engine of a study: runs by number in, rows of results out."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import groupby
from typing import Any

import numpy as np

from navcore.engine.drivers.linear import all_but_methods
from navcore.engine.ensemble import Outcome, batch_outcomes, linear_outcomes, width_of
from navcore.engine.measures import measure, run_value, without_value
from navcore.engine.run import MethodRun, Run
from navcore.engine.simulation import simulate
from navcore.foundation.errors import InputError
from navcore.foundation.units import HOUR
from navcore.quantities import NAMES, QUANTITIES, value_unit
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario
from navcore.scenario.requirement import OF_THE_SETTING
from navcore.study.file import names_of
from navcore.study.model import series_column
from navcore.study.plan import Plan, Setting

Row = dict[str, Any]
Stopped = Callable[[], bool]
Result = MethodRun | Outcome
Engine = Callable[[Plan, range, Stopped], Iterator[tuple[int, list[Row]]]]
"""Function that carries runs out: `run_points`, here or on another machine."""


def run_points(plan: Plan, numbers: Iterable[int], stopped: Stopped) -> Iterator[tuple[int, list[Row]]]:
    """Run some of a study's runs.

    Parameters
    ----------
    plan : Plan
        The study.
    numbers : iterable of int
        Which runs, increasing; neighbours share truth, noise and equal methods.
    stopped : callable
        Asked between runs, and within a long one, whether to stop: then no more is yielded.

    Yields
    ------
    number : int
        In order.
    rows : list of dict
        One a method: column -> value, None where there is none. A run that diverges, and a setting that the
        scenario refuses, have rows as well, and their ``status`` says so.
    """
    single = _Single(_needs_runs(plan), stopped)

    def setting_of(number: int) -> Setting:
        return plan.at(number)[0]

    for setting, group in groupby(numbers, setting_of):
        members = list(group)
        try:
            scenario = plan.scenario_of(setting)
        except InputError as error:
            yield from ((number, _refused(plan, number, error)) for number in members)
            continue
        width = 0 if single.whole or scenario.on_ins else width_of(scenario)
        # one run of the error model alone may know methods of the run before
        if width and (scenario.strapdown or len(members) > 1):
            yield from _batches(plan, scenario, members, width, stopped)
        else:
            for number in members:
                try:
                    seeded = plan.seeded(scenario, plan.at(number)[1])
                    results = None if stopped() else single.results(seeded)
                except InputError as error:
                    yield number, _refused(plan, number, error)
                    continue
                if results is None:
                    return
                yield number, _rows(plan, number, seeded, results)


def _needs_runs(plan: Plan) -> bool:
    """Whether rows and the loop in force are asked for, which only a whole `Run` has."""
    limited = (one.quantity for one in plan.scenario.requirement)
    of_loops = any(QUANTITIES[key].kind is None for key in (*plan.study.output.metrics, *limited))
    return of_loops or bool(plan.study.output.series)


class _Single:
    """Runs one after the other; a method that comes out as in the run before is not run again."""

    def __init__(self, whole: bool, stopped: Stopped) -> None:
        self.whole, self._stopped = whole, stopped
        self._before: Run | None = None
        self._shared: Scenario | None = None
        self._known: dict[Method, Outcome] = {}

    def results(self, scenario: Scenario) -> Sequence[Result] | None:
        """Result of each method; None when it was stopped."""
        if self.whole or scenario.strapdown or scenario.on_ins:
            run = simulate(scenario, None, self._stopped, self._before)
            self._before = run
            return None if run.status == "stopped" else run.methods
        shared = all_but_methods(scenario)
        if shared != self._shared:
            self._shared, self._known = shared, {}
        found = linear_outcomes(scenario, self._known)
        self._known |= zip(scenario.method, found, strict=True)
        return found


def _batches(
    plan: Plan, scenario: Scenario, numbers: Sequence[int], width: int, stopped: Stopped
) -> Iterator[tuple[int, list[Row]]]:
    for first in range(0, len(numbers), width):
        some = numbers[first : first + width]
        seeded = [plan.seeded(scenario, plan.at(number)[1]) for number in some]
        try:
            found = batch_outcomes(seeded, lambda _: stopped())
        except InputError as error:
            yield from ((number, _refused(plan, number, error)) for number in some)
            continue
        if not found:
            return
        for number, one, results in zip(some, seeded, found, strict=True):
            yield number, _rows(plan, number, one, results)


def _rows(plan: Plan, number: int, scenario: Scenario, results: Sequence[Result]) -> list[Row]:
    setting, _ = plan.at(number)
    shared = {"run": number, "seed": scenario.run.seed, **plan.values(setting)}
    rows = [
        shared | {"method": method.name} | _judged(plan, scenario, result)
        for method, result in zip(scenario.method, results, strict=True)
    ]
    for one in scenario.refused:  # by increasing place
        rows.insert(one.place, shared | {"method": one.name} | _not_run(plan, one.reason))
    return rows


def _not_run(plan: Plan, reason: str) -> Row:
    """Columns of a method that is refused."""
    return {"status": "refused", "reason": reason, "met": False if plan.scenario.requirement else None}


def _refused(plan: Plan, number: int, error: InputError) -> list[Row]:
    """Rows of a run that cannot be carried out: a row for each method."""
    setting, seed = plan.at(number)
    reason = " ".join(str(error).split("\n"))
    shared = {"run": number, "seed": plan.scenario.run.seed + seed, **plan.values(setting)}
    shared |= _not_run(plan, reason)
    return [shared | {"method": name} for name in names_of(plan.scenario)]


def _judged(plan: Plan, scenario: Scenario, result: Result) -> Row:
    output = plan.study.output
    if isinstance(result, MethodRun):
        status, reason = result.status, result.reason or None
    else:
        status, reason = "ok" if result.ended else "diverged", None
    row: Row = {"status": status, "reason": reason}
    row |= {key: _finite(_value(result, key, 0.0) / value_unit(key)) for key in output.metrics}
    all_met = True
    for k, one in enumerate(scenario.requirement):
        value = _value(result, one.quantity, one.begins_s, one.bound_m) / value_unit(one.quantity)
        met = status == "ok" and one.met(value)
        all_met &= met
        row |= {f"requirement_{k}": _finite(value), f"requirement_{k}_met": met}
    row["met"] = all_met if scenario.requirement else None
    if isinstance(result, MethodRun):
        for hours in output.epochs_h:
            place = int(np.searchsorted(result.t_s, hours * HOUR))
            nearest = min((place - 1, place), key=lambda k: _distance(result.t_s, k, hours * HOUR))
            reached = _distance(result.t_s, nearest, hours * HOUR) <= scenario.run.output_step_s
            for name in output.series:
                value = float(result.rows[nearest, NAMES.index(name)]) if reached else math.inf
                row[series_column(name, hours)] = _finite(value)
    return row


def _distance(t_s: np.ndarray, place: int, at_s: float) -> float:
    return abs(float(t_s[place]) - at_s) if 0 <= place < len(t_s) else math.inf


def _value(result: Result, key: str, from_s: float, bound_m: float = math.inf) -> float:
    """Value of a quantity, SI; infinite where there is none or the run did not end well."""
    if isinstance(result, MethodRun):
        return measure(result, key, from_s, bound_m)
    assert key not in OF_THE_SETTING  # `_needs_runs`
    if not result.ended:
        return without_value(QUANTITIES[key])
    return run_value(QUANTITIES[key], result.spans, result.final_m, from_s, bound_m)


def _finite(value: float) -> float | None:
    return value + 0.0 if math.isfinite(value) else None

"""The runs of a study by number: which setting and seed each is; neighbours share as much as they can."""

from __future__ import annotations

import copy
import json
import math
from collections.abc import Iterator
from dataclasses import replace
from functools import lru_cache
from itertools import product
from typing import Any

import numpy as np

from navcore.engine.ensemble import drawn
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.foundation.units import HOUR
from navcore.scenario.file import set_field
from navcore.scenario.model import Scenario
from navcore.study.file import load, scenario_data
from navcore.study.model import Factor, Study
from navcore.study.sampling import drawn_value, unit_point

_CHECKED = (0.001, 0.999)
"""Parts of a distribution at which its values are checked before anything runs."""
MOST_POINTS = 10**9
RUN_S = 2e-3
STEP_NS, INPUT_NS = 75.0, 130.0
SAMPLE_NS, SAMPLE_INPUT_NS = 25.0, 30.0
"""Cost on one core (docs/scale.md): a run; a step of a method, and its inputs; likewise in strapdown."""

Setting = tuple[int, ...]
"""Number of the draw, and the number of its value for each factor of the grid."""


class Plan:
    """Runs of a study, numbered from 0.

    Parameters
    ----------
    study : Study
        From `navcore.study.file.load`.
    where : str
        Named in faults.

    Attributes
    ----------
    grid, random : list of Factor
        Factors with values and those with a distribution.
    shown : list of list
        Values of each factor of the grid, as they stand in the results.
    scenario : Scenario
        Of the first setting.
    refused : tuple of str
        Methods that a value of a factor refuses, each with the value and the reason; the others run there.

    Raises
    ------
    InputError
        The scenario, or a value of a factor, is wrong; the fault names the factor.
    """

    def __init__(self, study: Study, where: str = "") -> None:
        self.study, self.where = study, where
        self.grid = [factor for factor in study.factor if not factor.drawn]
        self.random = [factor for factor in study.factor if factor.drawn]
        self.shown = [_shown(factor) for factor in self.grid]
        self._data = scenario_data(study, where)
        self._made = lru_cache(maxsize=64)(self._make)
        self._refused: dict[str, str] = {}
        self._checked = [*self._check_values()]
        self.refused = (*self._refused.values(),)
        self.scenario = self.scenario_of((0,) * (len(self.grid) + 1))
        for i, hours in enumerate(study.output.epochs_h):
            if not 0.0 <= hours <= self.scenario.run.duration_h:
                end = Text("must be >= 0 and <= {end_h:g} (h)", end_h=self.scenario.run.duration_h)
                raise InputError(Fault(where, f"output.epochs_h.{i}", hours, end))
        # Slowest first: what changes the truth, seeds, what changes sensors, what changes methods alone, so
        # that neighbours share most. A batch of the strapdown takes seeds side by side: there they are last.
        rank = {-1: 4 if self.scenario.strapdown else 1, 0: min((f.depth for f in self.random), default=0)}
        rank |= {k: factor.depth for k, factor in enumerate(self.grid, 1)}
        sizes = {-1: study.seeds, 0: study.draws} | {k: len(f.values) for k, f in enumerate(self.grid, 1)}
        self._axes = sorted(sizes, key=lambda axis: rank[axis])
        self._sizes = [sizes[axis] for axis in self._axes]

    @property
    def runs(self) -> int:
        """Number of runs; each runs every method."""
        return math.prod(self._sizes)

    def at(self, number: int) -> tuple[Setting, int]:
        """Setting of a run, and what is added to ``run.seed``."""
        places = self.places(number)
        return tuple(places[axis] for axis in range(len(self.grid) + 1)), places[-1]

    def cells(self, numbers: np.ndarray) -> np.ndarray:
        """Return the number of the grid's combination, in the order of `combinations`, for each run, (n,)."""
        places = self.places(numbers.astype(np.int64))
        cell = np.zeros(len(numbers), np.int64)
        for k, factor in enumerate(self.grid, 1):
            cell = cell * len(factor.values) + places[k]
        return cell

    def places(self, left: Any) -> dict[int, Any]:
        """Numbers of the seed (-1), the draw (0) and each grid factor's value (1 ...) of runs."""
        places = {}
        for axis, size in zip(reversed(self._axes), reversed(self._sizes), strict=True):
            left, places[axis] = divmod(left, size)
        return places

    @property
    def cell_count(self) -> int:
        """Number of the grid's combinations."""
        return math.prod(len(factor.values) for factor in self.grid)

    def combinations(self) -> Iterator[dict[str, Any]]:
        """Yield the grid's combinations: column -> value in the results."""
        for values in product(*self.shown):
            yield dict(zip((factor.column for factor in self.grid), values, strict=True))

    def values(self, setting: Setting) -> dict[str, Any]:
        """Columns of the factors of a setting."""
        grid = {f.column: self.shown[k][setting[k + 1]] for k, f in enumerate(self.grid)}
        random = dict(zip((f.column for f in self.random), self._draw(setting[0]), strict=True))
        return {factor.column: (grid | random)[factor.column] for factor in self.study.factor}

    def scenario_of(self, setting: Setting) -> Scenario:
        """Scenario of a setting, with the seed of the file; raises `InputError`."""
        return self._made(setting)

    def seeded(self, scenario: Scenario, seed: int) -> Scenario:
        """Return the scenario of one run."""
        if self.study.constants:
            return drawn(scenario, seed)
        number = (scenario.run.seed + seed) % 2**31
        return scenario.model_copy(update={"run": scenario.run.model_copy(update={"seed": number})})

    def seconds(self) -> float:
        """Estimated cost of all runs on one core, s; of factors that change it the dearest value counts."""
        return self.runs * max(map(_run_seconds, self._checked))

    def _draw(self, number: int) -> list[float]:
        if not self.random:
            return []
        parts = unit_point(self.study.sample, len(self.random), number).tolist()
        return [drawn_value(factor, part) for factor, part in zip(self.random, parts, strict=True)]

    def _make(self, setting: Setting) -> Scenario:
        grid = [(f, f.values[place]) for f, place in zip(self.grid, setting[1:], strict=True)]
        return self._with([*grid, *zip(self.random, self._draw(setting[0]), strict=True)])

    def _with(self, values: list[tuple[Factor, Any]], changed: Factor | None = None) -> Scenario:
        """Scenario with values; a fault names the factor that set its field, else the changed one."""
        data = copy.deepcopy(self._data)
        try:
            for factor, value in values:
                for field, one in _assigned(factor, value):
                    fault = set_field(data, field, copy.deepcopy(one))
                    if fault:
                        raise InputError(Fault("", field, one, fault))
            return Scenario.parse(data, apart=True)
        except InputError as error:
            raise InputError(self._blamed(fault, values, changed) for fault in error.faults) from None

    def _blamed(self, fault: Fault, values: list[tuple[Factor, Any]], changed: Factor | None) -> Fault:
        for factor, value in values:
            if factor is changed or any(f"{fault.field}.".startswith(f"{field}.") for field in factor.fields):
                place = f"factor.{self.study.factor.index(factor)}"
                place += f".values.{factor.values.index(value)}" if factor.values else ""
                return Fault(self.where, place, value, str(fault))
        return replace(fault, where=self.where)

    def _check_values(self) -> Iterator[Scenario]:
        """Yield scenarios with one factor changed at a time; raises `InputError` that names the value."""
        usual = [(f, f.values[0]) if f.values else (f, drawn_value(f, 0.5)) for f in self.study.factor]
        always = self._with(usual)
        self._refused |= {one.name: one.line for one in always.refused}
        yield always
        for factor in self.study.factor:
            values = factor.values or [drawn_value(factor, part) for part in _CHECKED]
            for value, shown in zip(values, _shown(factor) or values, strict=True):
                scenario = self._with([(f, value if f is factor else one) for f, one in usual], factor)
                for one in scenario.refused:
                    told = Text(
                        "{name} is refused with {factor} = {value}: {reason}",
                        name=one.name,
                        factor=factor.column,
                        value=str(shown),
                        reason=one.reason,
                    )
                    self._refused.setdefault(one.name, told)
                yield scenario


def plan_of(source: str) -> Plan:
    """Read a study by its name or file and number its runs; raises `InputError`."""
    return Plan(load(source), source)


def require_affordable(plan: Plan, workers: int, most_h: float | None, default_h: float = 24.0) -> None:
    """Refuse a study of too many runs, or one that takes too long.

    Parameters
    ----------
    plan : Plan
        The study.
    workers : int
        Cores that it may use.
    most_h : float or None
        Hours that were asked for; None: ``default_h``, and no more than `MOST_POINTS` runs.

    Raises
    ------
    InputError
        With the estimate.
    """
    hours, most = plan.seconds() / workers / HOUR, default_h if most_h is None else most_h
    if hours <= most and (most_h is not None or plan.runs <= MOST_POINTS):
        return
    allowed = Text(
        "is {runs} runs, which take about {hours:.3g} h with {workers} workers; at most {most:g} h and, "
        "without --hours, {points:g} runs: ask for them by --hours",
        runs=plan.runs,
        hours=hours,
        workers=workers,
        most=most,
        points=MOST_POINTS,
    )
    raise InputError(Fault(plan.where, "", None, allowed))


def _assigned(factor: Factor, value: Any) -> Iterator[tuple[str, Any]]:
    for k, field in enumerate(factor.fields):
        yield field, value[k] if factor.values and len(factor.fields) > 1 else value


def _shown(factor: Factor) -> list[Any]:
    """Values of a grid as they stand in the results: labels, or all numbers, or all texts."""
    if factor.labels:
        return list(factor.labels)
    if all(isinstance(value, int | float) and not isinstance(value, bool) for value in factor.values):
        return [float(value) for value in factor.values]
    return [value if isinstance(value, str) else json.dumps(value, default=str) for value in factor.values]


def _run_seconds(scenario: Scenario) -> float:
    """Estimated cost of one run of all methods on one core, s."""
    methods = len(scenario.method)
    if scenario.strapdown:
        samples = scenario.run.duration_h * HOUR * scenario.run.rate_hz
        return RUN_S + 1e-9 * samples * (methods * SAMPLE_NS + SAMPLE_INPUT_NS)
    return RUN_S + 1e-9 * scenario.steps * (methods * STEP_NS + INPUT_NS)

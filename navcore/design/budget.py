"""The error budget of a scenario: every method by source, beside the floor (theory.md 15, 16)."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np

from navcore.design.along import along
from navcore.design.constants import shared_columns
from navcore.design.course import Course, course
from navcore.design.figures import Entry, Figures, Series, entry_of
from navcore.design.filter import filter_variance
from navcore.design.floor import steady_floor
from navcore.design.form import law_form
from navcore.design.level import constant_part, level, line_part, steady_parts
from navcore.design.scheduled import scheduled_times
from navcore.design.seeds import SEEDS, no_covariance, seed_variance
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.units import HOUR
from navcore.scenario.model import Method, Scenario
from navcore.scenario.stochastic import StochasticModel, stochastic_model

Shown = Literal["steady", "covariance", "seeds", "none"]


@dataclass(frozen=True)
class MethodBudget:
    """Budget of one method.

    Attributes
    ----------
    name : str
        Of the method.
    shown : {"steady", "covariance", "seeds", "none"}
        What the numbers are: one channel's steady state, the covariance along the run, or the mean square of
        several seeds.
    total : Entry
        All sources together.
    sources : dict of Entry
        Each source; with ``seeds`` there are none.
    constants : dict of Entry
        Steady state only: what biases leave, which is not in the total.
    warnings : tuple of str
        What is to be heeded.
    series : Series or None
        Along the run only.
    """

    name: str
    shown: Shown
    total: Entry
    sources: Mapping[str, Entry]
    constants: Mapping[str, Entry] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()
    series: Series | None = None

    @property
    def largest(self) -> str | None:
        """Source that contributes most to the tilt; None where there is none."""
        sizes = {name: entry.rms.tilt_rad or 0.0 for name, entry in self.sources.items()}
        best = max(sizes, key=lambda name: sizes[name], default=None)
        return best if best is not None and sizes[best] > 0.0 else None

    def as_dict(self) -> dict[str, Any]:
        """Return the document of interface.md."""
        return {
            "name": self.name,
            "shown": self.shown,
            **self.total.as_dict(),
            "sources": {name: entry.as_dict() for name, entry in self.sources.items()},
            **({"constants": {k: v.as_dict() for k, v in self.constants.items()}} if self.constants else {}),
            "warnings": list(self.warnings),
        }


@dataclass(frozen=True)
class Budget:
    """Budget of a scenario.

    Attributes
    ----------
    steady : bool
        One level channel at rest in the steady state, else along the scenario.
    floor : Entry
        The least that any causal linear damping can reach.
    floor_reason : str
        Why there is no floor; empty when there is one.
    floor_series : Series or None
        Along the run only.
    methods : tuple of MethodBudget
        In the scenario's order.
    """

    steady: bool
    floor: Entry
    floor_reason: str
    floor_series: Series | None
    methods: tuple[MethodBudget, ...]

    def as_dict(self) -> dict[str, Any]:
        """Return the document of interface.md."""
        floor = self.floor.as_dict()
        if self.floor_reason:
            floor["reason"] = self.floor_reason
        return {
            "steady": self.steady,
            "floor": floor,
            "methods": [
                {**method.as_dict(), "times_floor": self.times_floor(method)} for method in self.methods
            ],
        }

    def times_floor(self, method: MethodBudget) -> dict[str, float | None]:
        """Each figure of a method over that of the floor; None where one of them is missing or zero."""
        names = ("tilt_rad", "velocity_mps") + (() if self.steady else ("heading_rad", "position_m"))
        found = {}
        for name in names:
            own, least = getattr(method.total.rms, name), getattr(self.floor.rms, name)
            found[name.rsplit("_", 1)[0]] = own / least if own is not None and least else None
        return found


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
        The motion cannot be carried out, or a method diverges.

    Examples
    --------
    >>> from navcore import budget, load
    >>> found = budget(load("sikuliaq-like"), steady=True)
    >>> found.floor.rms.tilt_rad < found.methods[1].total.rms.tilt_rad
    True
    """
    model = stochastic_model(scenario)
    if steady:
        return steady_budget(scenario, model)
    return _along_budget(scenario, model, seeds, progress, cancelled)


def steady_budget(scenario: Scenario, model: StochasticModel) -> Budget:
    """Steady state of one level channel at rest; ``model`` may differ from that of the scenario."""
    found = steady_floor(model, scenario.omega_s)
    return Budget(
        steady=True,
        floor=Entry(Figures(found.tilt_rad, found.velocity_mps)),
        floor_reason=found.reason,
        floor_series=None,
        methods=tuple(_steady_method(scenario, method, model) for method in scenario.method),
    )


def _steady_method(scenario: Scenario, method: Method, model: StochasticModel) -> MethodBudget:
    if method.damping == "averaging":
        warning = "averaging combines several navigations: it has no steady state of one channel"
        return MethodBudget(method.name, "none", Entry(Figures()), {}, warnings=(warning,))
    if method.damping == "kalman":
        warning = "the Kalman filter has no network: its steady state is the floor"
        return MethodBudget(method.name, "none", Entry(Figures()), {}, warnings=(warning,))
    channel = level(law_form(method, scenario.omega_s), model, scenario.omega_s)
    parts = steady_parts(channel)
    if model.tide.any():
        amplitude = float(np.sqrt(np.mean(model.tide**2)))
        parts["log_tide"] = line_part(channel, amplitude, 2.0 * math.pi / model.tide_period_s)
    warnings = []
    if method.damping != "free" and method.policy.id not in ("constant", "schedule"):
        warnings.append(
            f'policy "{method.policy.id}" looks at the data: shown is the loop while it is damped'
        )
    missing = [name for name, part in parts.items() if part.tilt_rad is None or part.velocity_mps is None]
    growth = channel.growth_per_s()
    if missing and growth > 1e-9 * channel.omega_s:
        days = 1.0 / growth / (24.0 * HOUR)
        warnings.append(f"the loop is unstable (e-folding {days:.3g} days): no source has a steady state")
    elif missing:
        warnings.append(f"no steady state: {', '.join(missing)} drive a mode without decay")
    sources = {
        name: Entry(
            Figures(part.tilt_rad, part.velocity_mps),
            growth=None
            if part.tilt_growth is None and part.velocity_growth is None
            else Figures(part.tilt_growth, part.velocity_growth),
        )
        for name, part in parts.items()
    }
    total = Figures(
        _root_sum([part.tilt_rad for part in parts.values()]),
        _root_sum([part.velocity_mps for part in parts.values()]),
    )
    sizes = {"gyro_bias": model.gyro_bias[:2], "accel_bias": model.accel_bias[:2], "log_bias": model.log_bias}
    constants = {}
    for name, values in sizes.items():
        part = constant_part(channel, name.split("_")[0], float(np.sqrt(np.mean(values**2))))
        constants[name] = Entry(Figures(part.tilt_rad, part.velocity_mps))
    return MethodBudget(method.name, "steady", Entry(total), sources, constants, tuple(warnings))


def _root_sum(values: list[float | None]) -> float | None:
    known = [value for value in values if value is not None]
    return math.sqrt(sum(value * value for value in known)) if len(known) == len(values) else None


def _along_budget(
    scenario: Scenario,
    model: StochasticModel,
    seeds: int,
    progress: Callable[[float], None] | None,
    cancelled: Callable[[], bool] | None,
) -> Budget:
    times = tuple(time for method in scenario.method for time in scheduled_times(method))
    way = course(scenario, extra_s=times)
    columns = shared_columns(scenario, way, model)
    done = [0.0] * (len(scenario.method) + 1)

    def report(index: int, fraction: float) -> None:
        done[index] = fraction
        if progress is not None:
            progress(sum(done) / len(done))

    def one(index: int) -> MethodBudget:
        method = scenario.method[index]
        reason = no_covariance(scenario, method)
        if reason:
            found = _from_seeds(scenario, method, reason, seeds, lambda f: report(index, f), cancelled)
        else:
            result = along(scenario, method, way, model, columns)
            series = Series(result.t_s, result.variance, result.total)
            found = _of_series(method, "covariance", series, _warnings(scenario))
        report(index, 1.0)
        return found

    with ThreadPoolExecutor(2) as pool:
        least = pool.submit(_floor_along, scenario, way, model)
        methods = tuple(pool.map(one, range(len(scenario.method))))
        floor, reason = least.result()
    report(len(scenario.method), 1.0)
    if floor is None:
        return Budget(False, Entry(Figures(), Figures()), reason, None, methods)
    return Budget(False, entry_of(floor.t_s, floor.total), "", floor, methods)


def _warnings(scenario: Scenario) -> tuple[str, ...]:
    found = []
    if scenario.reference.kind == "file":
        found.append("reference.file: a recorded log has no stochastic model and counts as free of error")
    if any((*scenario.imu.gyro_lsb, *scenario.imu.accel_lsb)):
        found.append("imu.gyro_lsb, imu.accel_lsb: quantisation is not in the budget")
    if scenario.imu.file is not None:
        found.append("imu.file: a recorded IMU has no stochastic model and counts as free of error")
    if scenario.alignment.kind == "compass":
        found.append("alignment: what biases leave after it is in the budget, its own noise is not")
    return tuple(found)


def _floor_along(scenario: Scenario, way: Course, model: StochasticModel) -> tuple[Series | None, str]:
    if model.silent or not model.log:
        return None, steady_floor(model, scenario.omega_s).reason
    variance = filter_variance(scenario, way, model)
    return Series(way.t_s, {}, variance), ""


def _from_seeds(
    scenario: Scenario,
    method: Method,
    reason: str,
    seeds: int,
    report: Callable[[float], None],
    cancelled: Callable[[], bool] | None,
) -> MethodBudget:
    t_s, variance = seed_variance(scenario, method, seeds, report, cancelled)
    told = f"{reason}: there is no covariance; shown is the mean square of {seeds} seeds, not split by source"
    return _of_series(method, "seeds", Series(t_s, {}, variance), (told,))


def _of_series(method: Method, shown: Shown, series: Series, warnings: tuple[str, ...]) -> MethodBudget:
    if not np.all(np.isfinite(series.total)):
        raise InputError(
            Fault("", "method", method.name, "has no budget: the loop is unstable, errors overflow")
        )
    total = entry_of(series.t_s, series.total)
    sources = {name: entry_of(series.t_s, values) for name, values in series.sources.items()}
    return MethodBudget(method.name, shown, total, sources, warnings=warnings, series=series)

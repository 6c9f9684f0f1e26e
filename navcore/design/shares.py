"""Share of seeds on which a method meets all limits of a scenario (design.md, from limits to designs)."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from navcore.design.measures import Setting, measure
from navcore.design.ship import Ship
from navcore.engine.ensemble import Outcome
from navcore.engine.measures import finite, limit_document, run_value, without_value
from navcore.engine.verdicts import Judgement, judge, wilson
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.foundation.units import HOUR
from navcore.quantities import HEADING, QUANTITIES, value_unit
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario
from navcore.scenario.requirement import OF_THE_SETTING, Requirement

_NEAR = 0.1
"""Relative distance from a limit within which a seed counts in part."""


@dataclass(frozen=True)
class Limit:
    """One limit and what a method makes of it.

    Attributes
    ----------
    requirement : Requirement
    median : float or None
        Over the seeds, in the unit of the quantity's name; None where it is infinite.
    judgement : Judgement
        What the seeds say of it.
    """

    requirement: Requirement
    median: float | None
    judgement: Judgement

    @property
    def met(self) -> float:
        """Share of the seeds that meet this limit."""
        return self.judgement.met

    @property
    def ratio(self) -> float:
        """Median over the limit; infinite without a median, or where a limit of 0 is missed."""
        return self.requirement.times(self.median)

    def as_dict(self) -> dict[str, Any]:
        """Return the document of interface.md."""
        said = self.judgement
        seeds = {"median": self.median, "met": self.met, "low": said.low, "high": said.high}
        if said.verdict is None:
            return limit_document(self.requirement) | seeds
        value = {"value": finite(said.value), "verdict": said.verdict, "more_seeds": said.more}
        return limit_document(self.requirement) | seeds | value


@dataclass(frozen=True)
class Share:
    """One method.

    Attributes
    ----------
    method : Method
        Its setting.
    met : float
        Share of the seeds that meet all limits in the same run.
    low, high : float
        Wilson interval of it, 95 %.
    limits : tuple of Limit
        In the scenario's order.
    diverged : int
        Seeds on which it diverged.
    """

    method: Method
    met: float
    low: float
    high: float
    limits: tuple[Limit, ...]
    diverged: int

    @property
    def setting(self) -> str:
        """Parameters in words, and on how many seeds it diverges."""
        network = None if self.method.undamped else self.method.network
        blocks = {"": network, "azimuth.": self.method.azimuth, "gyrocompass.": self.method.gyrocompass}
        fields = {
            f"{block}{name}": value
            for block, settings in blocks.items()
            if settings is not None
            for name, value in settings.model_dump(exclude_none=True).items()
        }
        numbers = [f"{name} = {value:.4g}" for name, value in fields.items() if isinstance(value, float)]
        numbers += [f'{name} = "{fields[name]}"' for name in ("realisation",) if name in fields]
        words = ", ".join(numbers) or Text("no parameter")
        if not self.diverged:
            return words
        return Text("{words}, diverges on {seeds} seeds", words=words, seeds=self.diverged)

    @property
    def order(self) -> tuple[float, float]:
        """Key by which methods are ordered, best first."""
        return -self.met, max(limit.ratio for limit in self.limits)

    def as_dict(self) -> dict[str, Any]:
        """Return the document of interface.md."""
        network, azimuth = (
            each.model_dump(mode="json", exclude_none=True)
            for each in (self.method.network, self.method.azimuth)
        )
        return {
            "name": self.method.label(),
            "network": None if self.method.undamped else network,
            "azimuth": None if azimuth["id"] == "none" else azimuth,
            "met": self.met,
            "low": self.low,
            "high": self.high,
            "diverged": self.diverged,
            "limits": [limit.as_dict() for limit in self.limits],
        }


def require_limits(scenario: Scenario) -> None:
    """Refuse a scenario without limits, or with one that its run cannot be judged by.

    Raises
    ------
    InputError
        One fault a requirement.
    """
    faults = []
    if not scenario.requirement:
        allowed = Text("is needed: [[requirement]] with quantity and at_most")
        faults.append(Fault("", "requirement", None, allowed))
    end_h = scenario.run.duration_h
    for i, one in enumerate(scenario.requirement):
        if one.from_h > end_h and one.begins_s == one.from_h * HOUR:
            allowed = Text("must be <= {end_h:g} (h), the end of the run", end_h=end_h)
            faults.append(Fault("", f"requirement.{i}.from_h", one.from_h, allowed))
        if scenario.run.fidelity == "channel" and QUANTITIES[one.quantity].kind is HEADING:
            allowed = Text('has no value with run.fidelity = "channel": take "error_model"')
            faults.append(Fault("", f"requirement.{i}.quantity", one.quantity, allowed))
    if faults:
        raise InputError(faults)


def share_of(setting: Setting, outcomes: Sequence[Outcome]) -> Share:
    """Judge a method by its outcomes on all seeds.

    Parameters
    ----------
    setting : Setting
        Gives the quantities of the setting.
    outcomes : sequence of Outcome
        One a seed.
    """
    scenario = setting.ship.scenario
    requirements, end_h = scenario.requirement, scenario.run.duration_h
    values = np.column_stack([_values(setting, one, outcomes) for one in requirements])
    ended = np.array([one.ended for one in outcomes])
    pairs = list(zip(requirements, values.T, strict=True))
    judgements = [judge(one, column, ended, end_h) for one, column in pairs]
    met = np.column_stack([_by_seed(*pair, said) for pair, said in zip(pairs, judgements, strict=True)])
    met &= ended[:, None]
    count, full = len(outcomes), int(np.count_nonzero(met.all(axis=1)))
    limits = tuple(
        Limit(one, finite(float(np.median(column))), said)
        for (one, column), said in zip(pairs, judgements, strict=True)
    )
    return Share(setting.method, full / count, *wilson(full, count), limits, count - int(ended.sum()))


def _by_seed(one: Requirement, values: np.ndarray, said: Judgement) -> np.ndarray:
    """Which seeds meet a limit; what only all of them have together is met by all or by none."""
    if QUANTITIES[one.quantity].over and one.share is None:
        return np.full(len(values), one.met(said.value))
    return np.array([one.met(value) for value in values.tolist()])


def shares_of(
    ship: Ship, methods: Sequence[Method], found: Sequence[tuple[Outcome, ...]]
) -> tuple[Share, ...]:
    """Judge each method by its outcomes, one a seed, in the order of the methods."""
    return tuple(
        share_of(Setting(ship, method), [one[k] for one in found]) for k, method in enumerate(methods)
    )


def smooth_share(setting: Setting, outcomes: Sequence[Outcome]) -> float:
    """Share of the seeds that meet all limits, a seed near its limit counting in part.

    It changes with each parameter, and by less chance than the share itself: a search goes by it.

    Parameters
    ----------
    setting, outcomes
        As of `share_of`.
    """
    scenario, largest = setting.ship.scenario, np.zeros(len(outcomes))
    ended = np.array([one.ended for one in outcomes])
    for one in scenario.requirement:
        values = _values(setting, one, outcomes)
        if QUANTITIES[one.quantity].over and one.share is None:
            said = judge(one, values, ended, scenario.run.duration_h)
            values = np.full(len(values), math.inf if said.value is None else said.value)
        ratios = [one.times(value) if math.isfinite(value) else math.inf for value in values.tolist()]
        largest = np.maximum(largest, ratios)
    largest[~ended] = math.inf
    with np.errstate(divide="ignore", over="ignore"):
        return float(np.mean(1.0 / (1.0 + largest ** (1.0 / _NEAR))))


def _values(setting: Setting, one: Requirement, outcomes: Sequence[Outcome]) -> np.ndarray:
    """Value on each seed, in the unit of the quantity's name; infinite where it diverged or has none."""
    unit, quantity = value_unit(one.quantity), QUANTITIES[one.quantity]
    if one.quantity in OF_THE_SETTING:
        return np.full(len(outcomes), measure(setting, one.quantity) / unit)
    watch = one.begins_s, one.bound_m
    values = (
        run_value(quantity, outcome.spans, outcome.final_m, *watch)
        if outcome.ended
        else without_value(quantity)
        for outcome in outcomes
    )
    return np.fromiter(values, float, len(outcomes)) / unit

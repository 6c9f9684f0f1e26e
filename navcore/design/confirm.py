"""A proposal beside the present setting, both run on the same seeds (design.md, tuning)."""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from navcore.engine.ensemble import Outcome, outcomes
from navcore.engine.measures import run_value, without_value
from navcore.foundation.answers import number
from navcore.foundation.errors import Fault, UnstableError
from navcore.foundation.text import Text
from navcore.quantities import KINDS, QUANTITIES, value_unit
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario
from navcore.scenario.requirement import OF_THE_SETTING

SEEDS = 32
LEAST = 0.01
"""Relative growth of an error from which a proposal says so."""
_COMPARED = tuple(f"{kind.name}_rms" for kind in KINDS)


@dataclass(frozen=True)
class Change:
    """One quantity before and after.

    Attributes
    ----------
    before, after : float or None
        Mean over the seeds; None where the present setting diverges on one of them.
    difference, low, high : float or None
        Mean of after - before of each seed, and its 95 % interval (Student); None likewise.
    """

    before: float | None
    after: float | None
    difference: float | None
    low: float | None
    high: float | None

    def as_dict(self) -> dict[str, float | None]:
        """Return the document of interface.md."""
        return dict(vars(self))


@dataclass(frozen=True)
class Confirmed:
    """Changes that a proposal makes in runs.

    Attributes
    ----------
    seeds : int
        Runs of each setting.
    changes : dict of Change
        Root mean squares of the run by their names, SI; limited quantities of the scenario in the unit of
        their name.
    objective : Change or None
        What was made small, each term over its mean before; None where runs do not measure it.
    """

    seeds: int
    changes: Mapping[str, Change]
    objective: Change | None = None

    @property
    def gains(self) -> bool | None:
        """Whether the objective is smaller beyond chance; None where runs do not measure it."""
        if self.objective is None:
            return None
        return self.objective.high is None or self.objective.high < 0.0

    def worse(self) -> Iterator[str]:
        """Name what is larger after it: beyond chance, and by more than `LEAST`."""
        for name, change in self.changes.items():
            if change.before is None or change.after is None or change.low is None or change.low <= 0.0:
                continue
            if change.after > 2.0 * change.before:
                yield Text(
                    "{name} is {times} times as large after it, over {seeds} seeds of the run",
                    name=name,
                    times=number(change.after / change.before, 3) if change.before else "infinitely many",
                    seeds=self.seeds,
                )
            elif change.after > (1.0 + LEAST) * change.before:
                yield Text(
                    "{name} is {percent} % larger after it, over {seeds} seeds of the run",
                    name=name,
                    percent=number(100.0 * (change.after / change.before - 1.0), 2),
                    seeds=self.seeds,
                )

    def as_dict(self) -> dict[str, Any]:
        """Return the document of interface.md."""
        return {"seeds": self.seeds, **{name: change.as_dict() for name, change in self.changes.items()}}

    def verdict(self, name: str) -> str:
        """Say that a quantity is not smaller in the runs; empty where it is, or was not compared."""
        change = self.changes.get(name)
        if change is None or change.low is None or change.high is None or change.high < 0.0:
            return ""
        if change.low > 0.0:
            return Text(
                "{name} is larger after it, over {seeds} seeds of the run", name=name, seeds=self.seeds
            )
        return Text(
            "{name} is not smaller after it beyond chance, over {seeds} seeds of the run",
            name=name,
            seeds=self.seeds,
        )


def confirmed(
    scenario: Scenario,
    before: Method,
    after: Method,
    seeds: int = SEEDS,
    terms: Sequence[tuple[str, float]] = (),
    progress: Callable[[float], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> Confirmed | None:
    """Run the present setting and a proposal on the same seeds of a scenario.

    Parameters
    ----------
    scenario : Scenario
        Its seed and those after it, each with its noise and constants (`navcore.engine.ensemble.drawn`).
    before, after : Method
        Present setting and proposal.
    seeds : int
        Runs of each; at least 2.
    terms : sequence of (str, float)
        Of the objective: names and weights.
    progress, cancelled : callable, optional
        As of `navcore.engine.ensemble.outcomes`.

    Returns
    -------
    Confirmed or None
        None when it was cancelled.

    Raises
    ------
    UnstableError
        The proposal diverges on a seed.
    """
    found = outcomes(scenario, (before, after), range(seeds), progress, cancelled)
    if len(found) < seeds:
        return None
    lost = sum(not pair[1].ended for pair in found)
    if lost:
        reason = Text("the best setting diverges on {lost} of {seeds} seeds", lost=lost, seeds=seeds)
        raise UnstableError(Fault("", "--vary", None, reason))
    changes = {}
    for name in _COMPARED:
        changes[name] = _change([[_value(one, name, 0.0) for one in pair] for pair in found])
    for one in scenario.requirement:
        if one.quantity not in OF_THE_SETTING:
            watch, unit = (one.begins_s, one.bound_m), value_unit(one.quantity)
            pairs = [[_value(each, one.quantity, *watch) / unit for each in pair] for pair in found]
            changes[one.quantity] = _change(pairs)
    return Confirmed(seeds, changes, _objective(found, terms))


def _objective(found: Sequence[tuple[Outcome, ...]], terms: Sequence[tuple[str, float]]) -> Change | None:
    if not terms or not {name for name, _ in terms} <= {*_COMPARED}:
        return None
    total = np.zeros((len(found), 2))
    for name, weight in terms:
        pairs = np.array([[_value(one, name, 0.0) for one in pair] for pair in found])
        before = pairs[:, 0].mean()
        total += weight * pairs / (before if math.isfinite(before) and before > 0.0 else 1.0)
    return _change(total.tolist())


def _value(outcome: Outcome, name: str, from_s: float, bound_m: float = math.inf) -> float:
    if not outcome.ended:
        return without_value(QUANTITIES[name])
    return run_value(QUANTITIES[name], outcome.spans, outcome.final_m, from_s, bound_m)


def _change(pairs: list[list[float]]) -> Change:
    from scipy.special import stdtrit

    before, after = np.array(pairs).T
    if not np.all(np.isfinite(before)):
        return Change(None, float(after.mean()), None, None, None)
    differences = after - before
    count, mean = len(differences), float(differences.mean())
    half = float(stdtrit(count - 1, 0.975)) * float(differences.std(ddof=1)) / math.sqrt(count)
    return Change(float(before.mean()), float(after.mean()), mean, mean - half, mean + half)

"""Who meets the limits of a scenario in a run, and where pictures draw them."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from navcore.engine.measures import begins_s, judged, measure
from navcore.engine.run import MethodRun, Run
from navcore.quantities import ERRORS, POSITION, QUANTITIES, Quantity, limit_unit
from navcore.scenario.requirement import Requirement
from schuler_bench.editing.limits import BOXES, shown_limit

_IN_SIGHT = 3.0
_WATCHED_S = 60.0
"""A span begins at the first step of the mechanization from the limit's time on."""


@dataclass(frozen=True)
class Verdict:
    """One limit, and what the methods make of it.

    Attributes
    ----------
    quantity : Quantity
        That is limited, or only measured.
    requirement : Requirement or None
        None: nothing is asked, the measured values stand alone.
    measured : tuple of float
        A value a method, in the unit in which the quantity is shown; infinite where there is none.
    passed : tuple of bool
        Whether each method meets it; True without a limit.
    """

    quantity: Quantity
    requirement: Requirement | None
    measured: tuple[float, ...]
    passed: tuple[bool, ...]

    @property
    def limit(self) -> float | None:
        """Limit in the unit in which the quantity is shown."""
        return None if self.requirement is None else shown_limit(self.requirement)


def verdicts(run: Run, requirements: Sequence[Requirement]) -> tuple[Verdict, ...]:
    """Judge every method by every limit in order, then measure what has no limit."""
    limited = {one.quantity for one in requirements}
    rest = (_measured(run, QUANTITIES[key]) for key in BOXES if key not in limited)
    return *asked(run, requirements), *rest


def asked(run: Run, requirements: Sequence[Requirement]) -> tuple[Verdict, ...]:
    """Judge every method by every limit, in order."""
    return tuple(_limited(run, one) for one in requirements)


def _limited(run: Run, one: Requirement) -> Verdict:
    found = [_judged(one, method) for method in run.methods]
    unit = limit_unit(one.quantity) / QUANTITIES[one.quantity].size
    values = tuple(math.inf if value is None else value * unit for value, _ in found)
    return Verdict(QUANTITIES[one.quantity], one, values, tuple(met for _, met in found))


def _judged(one: Requirement, method: MethodRun) -> tuple[float | None, bool]:
    """Judge a method; a pinned run was not watched from the beginning of a limit that came later."""
    watched = any(-1e-6 < span.from_s - begins_s(one) < _WATCHED_S for span in method.spans)
    of_errors = QUANTITIES[one.quantity].statistic in ("rms", "max_abs")
    return judged(one, method) if watched or not of_errors else (None, False)


def _measured(run: Run, row: Quantity) -> Verdict:
    values = tuple(measure(method, row.key) / row.size for method in run.methods)
    return Verdict(row, None, values, (True,) * len(values))


def limits_of(requirements: Sequence[Requirement]) -> dict[str, float]:
    """Strictest limit of each quantity, SI, by its key."""
    limits: dict[str, float] = {}
    for one in requirements:
        strictest = max if one.sense == ">=" else min
        limits[one.quantity] = strictest(one.limit_si, limits.get(one.quantity, one.limit_si))
    return limits


def _drawn(row: Quantity) -> bool:
    """Whether curves have a line for a limit: of a largest value, and of the position's root mean square."""
    return row.statistic == "max_abs" or (row.statistic == "rms" and row.kind is POSITION)


def error_limits(requirements: Sequence[Requirement], run: Run) -> dict[str, float]:
    """Limits to draw in the error plots, SI: key of `schuler_bench.views.errors.figure.error_plots` -> value.

    One that lies far above all curves is left out: it would press them flat.
    """
    limits, drawn = limits_of(requirements), {}
    for key, limit in limits.items():
        for error in ERRORS:
            if error.name not in QUANTITIES[key].errors or not _drawn(QUANTITIES[key]):
                continue
            largest = max(method.errors[error.name]["max_abs"] for method in run.methods)
            if limit <= _IN_SIGHT * largest:
                drawn[error.key] = min(limit, drawn.get(error.key, math.inf))
    return drawn

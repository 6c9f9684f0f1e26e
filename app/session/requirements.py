"""Who meets the limits of a scenario in a run, and where pictures draw them."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from navcore.engine.measures import measure, needs_seeds, verdict
from navcore.engine.run import MethodRun, Run
from navcore.engine.verdicts import Judgement
from navcore.engine.verdicts import Verdict as Word
from navcore.quantities import ERRORS, QUANTITIES, VECTORS, Quantity, value_unit
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
    words : tuple of "met", "missed", "open" or ""
        What each method makes of it; "" without a limit.
    judgements : tuple of Judgement or None
        What seeds say of each method.
    """

    quantity: Quantity
    requirement: Requirement | None
    measured: tuple[float, ...]
    words: tuple[Literal[Word, ""], ...]
    judgements: tuple[Judgement | None, ...]

    @property
    def passed(self) -> tuple[bool, ...]:
        """Whether each method meets it; True without a limit."""
        return tuple(word in ("met", "") for word in self.words)

    @property
    def limit(self) -> float | None:
        """Limit in the unit in which the quantity is shown."""
        return None if self.requirement is None else shown_limit(self.requirement)


Said = Sequence[Sequence[Judgement] | None]
"""What seeds say of the limits of each method, in the scenario's order; None where nothing is known."""


def verdicts(run: Run, requirements: Sequence[Requirement], said: Said = ()) -> tuple[Verdict, ...]:
    """Judge every method by every limit in order, then measure what has no limit."""
    limited = {one.quantity for one in requirements}
    rest = (_measured(run, QUANTITIES[key]) for key in BOXES if key not in limited)
    return *asked(run, requirements, said), *rest


def asked(run: Run, requirements: Sequence[Requirement], said: Said = ()) -> tuple[Verdict, ...]:
    """Judge every method by every limit, in order."""
    columns = [*said, *(None for _ in run.methods[len(said) :])]
    return tuple(
        _limited(run, one, [column[place] if column and place < len(column) else None for column in columns])
        for place, one in enumerate(requirements)
    )


def _limited(run: Run, one: Requirement, said: Sequence[Judgement | None]) -> Verdict:
    found = [_judged(one, method, seeds) for method, seeds in zip(run.methods, said, strict=True)]
    unit = value_unit(one.quantity) / QUANTITIES[one.quantity].size
    values = tuple(math.inf if value is None else value * unit for value, _ in found)
    return Verdict(QUANTITIES[one.quantity], one, values, tuple(word for _, word in found), tuple(said))


def _judged(one: Requirement, method: MethodRun, said: Judgement | None) -> tuple[float | None, Word]:
    """Judge a method; a pinned run was not watched from the beginning of a limit that came later."""
    begins = 0.0 if math.isinf(one.begins_s) else one.begins_s
    alike = (span for span in method.spans if math.isclose(span.bound_m, one.bound_m))
    watched = any(-1e-6 < span.from_s - begins < _WATCHED_S for span in alike)
    of_errors = QUANTITIES[one.quantity].kind is not None
    if watched or not of_errors or said is not None:
        return verdict(one, method, said)
    return None, "open" if needs_seeds(one) else "missed"


def _measured(run: Run, row: Quantity) -> Verdict:
    values = tuple(measure(method, row.key) / row.size for method in run.methods)
    return Verdict(row, None, values, ("",) * len(values), (None,) * len(values))


def limits_of(requirements: Sequence[Requirement]) -> dict[str, float]:
    """Strictest limit of each quantity, SI, by its key."""
    limits: dict[str, float] = {}
    for one in requirements:
        strictest = max if one.sense == ">=" else min
        limits[one.quantity] = strictest(one.limit_si, limits.get(one.quantity, one.limit_si))
    return limits


@dataclass(frozen=True)
class LimitLine:
    """Line of a limit in the plot of an error.

    Attributes
    ----------
    quantity : str
        Key of what is limited.
    value : float
        Largest allowed magnitude, SI.
    from_s : float
        Time from which the limit counts, s.
    """

    quantity: str
    value: float
    from_s: float = 0.0


def _curve_of(row: Quantity) -> str:
    """Key of the curve that stays below its limit exactly where the limit is met; "" for none.

    That is the curve of the very length of which the largest value is judged. A root mean square may be met
    by a curve that passes the limit, and no curve shows what many seeds make.
    """
    if row.over or row.statistic != "max_abs" or row.axes in ("seclat", "roll", "pitch") or row.kind is None:
        return ""
    return next((one.key for one in (*VECTORS, *reversed(ERRORS)) if one.kind is row.kind), "")


def error_limits(requirements: Sequence[Requirement], run: Run) -> dict[str, tuple[LimitLine, ...]]:
    """Lines of limits by the keys of `schuler_bench.views.errors.figure.error_plots`.

    A limit that lies far above all curves is left out: it would press them flat.
    """
    drawn: dict[str, tuple[LimitLine, ...]] = {}
    for one in requirements:
        row = QUANTITIES[one.quantity]
        if key := _curve_of(row):
            largest = max(
                (measure(method, one.quantity) for method in run.methods if method.status == "ok"),
                default=math.inf,
            )
            if one.limit_si <= _IN_SIGHT * largest:
                begins = 0.0 if math.isinf(one.begins_s) else one.begins_s
                drawn[key] = (*drawn.get(key, ()), LimitLine(one.quantity, one.limit_si, begins))
    return drawn

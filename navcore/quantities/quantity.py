"""One row of the table of quantities."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

from navcore.foundation.units import UNITS
from navcore.quantities.errors import LENGTHS, NAMES, POSITION, Kind, components

Judged = Literal["loop", "run", "seeds", "ensemble", "steady"]
"""The loop in force, the run of one seed, many seeds together, all runs that the sensors' statistics give
(their covariance), or the steady state."""
Statistic = Literal["", "rms", "max_abs", "final", "at", "rate", "held", "settled", "point", "spread"]
Over = Literal["", "median", "p95", "2drms", "rms", "repeat"]


@dataclass(frozen=True, eq=False)
class Quantity:
    """One number by which a method is judged; it is computed in SI.

    Attributes
    ----------
    key : str
        Name on the command line and in files.
    names : dict of str to str
        Of what it can be judged (`Judged`), and its name on the page then.
    unit, shown : str
        SI unit, and the unit in which it is shown, a key of `navcore.foundation.units.UNITS`.
    help : str
        Definition.
    kind : Kind or None
        Kind of the errors that it summarises; None for a quantity of a loop.
    statistic : {"rms", "max_abs", "final", "at", "rate", "held", "settled", "point", "spread"} or ""
        Statistic of these errors: at one hour, as the slope of a line through the origin over time, or the
        time for which they stay within a bound; of a gyrocompass's readings, when it settles, its settle
        point, and their spread around it.
    axes : {"per_axis", "vector", "seclat", "roll", "pitch"} or ""
        How two axes make one number: root mean square of both, or the length of the vector. The heading
        error times cos L, or the tilt about one axis of the ship.
    over : {"median", "p95", "2drms", "rms", "repeat"} or ""
        What the values of all seeds make, "repeat" the largest difference of two that follow each other;
        "" for a value that each seed has.
    bounds : str
        Unit of what a limit bounds, where that is not the quantity itself.
    sense : {"<=", ">="} or ""
        Sense of a limit. Only what is better when smaller is an objective; "" for what has no better side.
    signed : bool
        It may be negative, so that two values have no ratio.
    typical : float
        Size (SI) that a miss is compared with where the limit is smaller.
    """

    key: str
    names: Mapping[Judged, str]
    unit: str
    shown: str
    help: str
    kind: Kind | None = None
    statistic: Statistic = ""
    axes: Literal["", "per_axis", "vector", "seclat", "roll", "pitch"] = ""
    over: Over = ""
    bounds: str = ""
    sense: Literal["", "<=", ">="] = "<="
    signed: bool = False
    typical: float = 1e-12

    @property
    def label(self) -> str:
        """Name as the page judges it if nothing else is said: the first of `names`."""
        return next(iter(self.names.values()))

    @property
    def size(self) -> float:
        """SI value of the unit in which it is shown."""
        return UNITS[self.shown]

    @property
    def limit_shown(self) -> str:
        """Unit in which a limit of it is shown."""
        return self.bounds or self.shown

    @property
    def length(self) -> int:
        """Place of the length that a run keeps of its errors, in `LENGTHS`."""
        assert self.kind is not None
        named = self.axes if self.axes in LENGTHS else self.kind.name
        return LENGTHS.index(named)

    @property
    def errors(self) -> tuple[str, ...]:
        """Names of the recorded errors that it summarises."""
        if self.kind is None:
            return ()
        return NAMES[-1:] if self.kind is POSITION else components(self.kind)

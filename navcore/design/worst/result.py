"""The answer to a question for the worst log: the largest errors of every method, as document and tables."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from navcore.design.worst.logs import LogError
from navcore.foundation.answers import Answer, Column, Table
from navcore.foundation.text import Text
from navcore.quantities import COMPONENTS, ERRORS, KINDS, POSITION, components

if TYPE_CHECKING:
    from navcore.scenario.model import Scenario

Bound = Literal["exact", "found"]
_KNOWN: dict[Bound, str] = {"exact": Text("exact"), "found": Text("found, not proven")}


@dataclass(frozen=True, eq=False)
class MethodWorst:
    """Largest errors of one method.

    Attributes
    ----------
    name : str
        Of the method.
    bound : {"exact", "found"}
        The largest that there can be, or the largest that a search has found.
    largest : ndarray, shape (7,)
        For `navcore.quantities.COMPONENTS`, rad, m/s, m; infinite where the method diverges.
    logs : tuple of LogError
        The log that makes each of them; none where the method does not read the log.
    playable : bool
        A scenario can play such a log: not to a Kalman filter, which would be another one without the noise.
    runs : int
        Of the search.
    """

    name: str
    bound: Bound
    largest: np.ndarray
    logs: tuple[LogError, ...] = ()
    playable: bool = True
    runs: int = 0

    @property
    def diverged(self) -> bool:
        """Whether an error leaves the range of the linear model."""
        return not bool(np.isfinite(self.largest).all())

    def document(self) -> dict[str, Any]:
        """Entry of ``methods``; null where an error has no bound."""
        values = (value if math.isfinite(value) else None for value in self.largest.tolist())
        by_name = dict(zip(COMPONENTS, values, strict=True))
        found: dict[str, Any] = {"name": self.name, "bound": self.bound}
        for kind in KINDS:
            own = [by_name[name] for name in components(kind)]
            if kind is POSITION:
                found |= {name.removeprefix("d"): by_name[name] for name in components(kind)}
            else:
                found[kind.figure] = own if len(own) > 1 else own[0]
        return found | {"status": "diverged" if self.diverged else "ok", "runs": self.runs}


@dataclass(frozen=True, eq=False)
class Worst(Answer):
    """Largest errors of every method under a log whose error is bounded.

    Attributes
    ----------
    log_max : float
        Bound of the error of each axis, m/s.
    log_rate : float or None
        Bound of its change, m/s^2.
    horizon_h : float
        Length of the run, h.
    methods : tuple of MethodWorst
        In the scenario's order.
    scenario : Scenario
        That was asked about.
    stopped : bool
        It was stopped: a search has looked at fewer logs, or methods are missing.
    """

    log_max: float
    log_rate: float | None
    horizon_h: float
    methods: Sequence[MethodWorst]
    scenario: Scenario
    stopped: bool = False

    @property
    def failed(self) -> bool:
        """Whether a method diverges."""
        return any(one.diverged for one in self.methods)

    def complaints(self) -> Iterator[str]:
        """Name the methods that diverge."""
        for one in self.methods:
            if one.diverged:
                yield Text("{name}: diverges under the worst log: its errors have no bound", name=one.name)

    def document(self) -> dict[str, Any]:
        """Return what ``--json`` prints."""
        return {
            "log_max_mps": self.log_max,
            "log_rate_mps2": self.log_rate,
            "horizon_h": self.horizon_h,
            "methods": [one.document() for one in self.methods],
        }

    def plays(self) -> tuple[str, ...]:
        """Name each error of each method whose worst log a scenario can play."""
        return tuple(
            Text("{method}: {error}", method=self.methods[place].name, error=ERRORS[k].label)
            for place, k in self.playable
        )

    def played(self, place: int) -> dict[str, str]:
        """Return the log and the scenario that plays it."""
        from navcore.design.worst.written import files_of

        (method, k) = self.playable[place]
        return dict(files_of(self.scenario, self.logs, [(method, k)]))

    @property
    def logs(self) -> list[Sequence[LogError]]:
        """Worst log of each method, for each error."""
        return [one.logs for one in self.methods]

    @property
    def playable(self) -> list[tuple[int, int]]:
        """Place of the method and of the error of each log."""
        kept = (place for place, one in enumerate(self.methods) if one.playable and not one.diverged)
        return [(place, k) for place in kept for k in range(len(COMPONENTS))]

    def rows(self) -> Iterator[Table | str]:
        """Give a row a method."""
        if self.log_rate is None:
            yield Text("worst log within {max:g} m/s on each axis, {hours:g} h", **self._words())
        else:
            yield Text(
                "worst log within {max:g} m/s on each axis, changes within {rate:g} m/s², {hours:g} h",
                **self._words(),
                rate=self.log_rate,
            )
        errors = ERRORS[: len(COMPONENTS)]
        heads = [Column(Text("largest")), *(Column(error.symbol, error.kind.unit) for error in errors)]
        rows = [
            (
                one.name,
                *(v / error.kind.size for v, error in zip(one.largest.tolist(), errors, strict=True)),
                _KNOWN[one.bound],
            )
            for one in self.methods
        ]
        yield Table((*heads, Column(Text("known"))), tuple(rows))
        if any(one.bound == "found" for one in self.methods):
            yield Text(
                "found, not proven: the law looks at the data, and there is no closed form. Shown is the "
                "largest error of {runs} logs that were tried.",
                runs=max(one.runs for one in self.methods),
            )

    def _words(self) -> dict[str, float]:
        return {"max": self.log_max, "hours": self.horizon_h}

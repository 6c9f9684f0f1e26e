"""Error budgets: every method by source, and the floor."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

from navcore.design.figures import Entry, Series
from navcore.design.floor import FLOOR_OF_ZERO
from navcore.foundation.drawing import drawn
from navcore.quantities import budgeted

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
    diverged : bool
        The errors overflow along the run: there are no figures.
    """

    name: str
    shown: Shown
    total: Entry
    sources: Mapping[str, Entry]
    constants: Mapping[str, Entry] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()
    series: Series | None = None
    diverged: bool = False

    def __repr__(self) -> str:
        """Name, and what the numbers are."""
        return f"<MethodBudget {self.name!r}: {'diverged' if self.diverged else self.shown}>"

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
            "status": "diverged" if self.diverged else "ok",
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

    def __repr__(self) -> str:
        """One line: of what, and the methods."""
        over = "steady state" if self.steady else "along the scenario"
        return f"<Budget, {over}; {', '.join(repr(method.name) for method in self.methods)}>"

    def _repr_html_(self) -> str:
        """Tables of ``schuler budget``, for a notebook."""
        return drawn("budget_tables", self)

    def as_dict(self) -> dict[str, Any]:
        """Return the document of interface.md."""
        floor = self.floor.as_dict()
        if self.floor_note:
            floor["reason"] = self.floor_note
        return {
            "steady": self.steady,
            "floor": floor,
            "methods": [
                {**method.as_dict(), "times_floor": self.times_floor(method)} for method in self.methods
            ],
        }

    def figure(self) -> Any:
        """Draw the bars of the tab Design, for a notebook, as `plotly.graph_objects.Figure`."""
        return drawn("budget_bars", self)

    @property
    def floor_note(self) -> str:
        """Why nothing can be compared with the floor; empty when it can."""
        return self.floor_reason or (FLOOR_OF_ZERO if self.floor.rms.tilt_rad == 0.0 else "")

    def times_floor(self, method: MethodBudget) -> dict[str, float | None]:
        """Each figure of a method over that of the floor; None where one of them is missing or zero."""
        ratios = {}
        for kind in budgeted(self.steady):
            own, least = getattr(method.total.rms, kind.figure), getattr(self.floor.rms, kind.figure)
            ratios[kind.name] = own / least if own is not None and least else None
        return ratios

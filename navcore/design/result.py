"""Error budgets: every method by source, and the floor."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Literal

from navcore.design.figures import Entry, Figures, Series
from navcore.design.floor import FLOOR_OF_ZERO
from navcore.foundation.answers import Answer, Column, Table, number
from navcore.foundation.drawing import drawn
from navcore.foundation.text import Text
from navcore.quantities import TILT, VELOCITY, Kind, budgeted

WITHOUT_LOG = Text("no method uses the log: the floor is that of damping with the log")
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
        All sources together, biases too.
    sources : dict of Entry
        Each source; with ``seeds`` there are none.
    random : Figures or None
        Steady state only: the random sources together, without biases.
    given : Entry or None
        Along the run only: the sources that the scenario gives as numbers, together and with their signs;
        None where fewer than two act.
    warnings : tuple of str
        What is to be heeded.
    series : Series or None
        Along the run only.
    diverged : bool
        The errors overflow along the run: there are no figures.
    reads_log : bool
        Whether the log changes a run of the method; the floor is that of damping with the log.
    """

    name: str
    shown: Shown
    total: Entry
    sources: Mapping[str, Entry]
    random: Figures | None = None
    given: Entry | None = None
    warnings: tuple[str, ...] = ()
    series: Series | None = None
    diverged: bool = False
    reads_log: bool = True

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
            **self._random(),
            "sources": {name: entry.as_dict() for name, entry in self.sources.items()},
            **({} if self.given is None else {"given": self.given.as_dict()}),
            "warnings": list(self.warnings),
        }

    def _random(self) -> dict[str, float | None]:
        if self.total.final is not None:
            return {}
        figures = (self.random or Figures()).as_dict(False)
        return {f"random_{name}": value for name, value in figures.items()}


@dataclass(frozen=True)
class Budget(Answer):
    """Budget of a scenario.

    Attributes
    ----------
    steady : bool
        One level channel at rest in the steady state, else along the scenario.
    floor : Entry
        The least that any causal linear damping with the log can reach; empty where no method reads the log.
    floor_reason : str
        Why there is no floor; empty when there is one.
    floor_series : Series or None
        Along the run only.
    methods : tuple of MethodBudget
        In the scenario's order.
    assumed_zero : tuple of str
        Standard deviations of constants that the scenario states in no way, so that 0 is assumed.
    """

    steady: bool
    floor: Entry
    floor_reason: str
    floor_series: Series | None
    methods: tuple[MethodBudget, ...]
    assumed_zero: tuple[str, ...] = ()

    def __repr__(self) -> str:
        """One line: of what, and the methods."""
        over = Text("steady state") if self.steady else Text("along the scenario")
        return f"<Budget, {over}; {', '.join(repr(method.name) for method in self.methods)}>"

    @property
    def failed(self) -> bool:
        """Whether a method diverges."""
        return any(method.diverged for method in self.methods)

    def document(self) -> dict[str, Any]:
        """Return the document of interface.md."""
        floor = self.floor.as_dict()
        if self.floor_note:
            floor["reason"] = self.floor_note
        return {
            "steady": self.steady,
            "floor": floor,
            "assumed_zero": list(self.assumed_zero),
            "methods": [
                {**method.as_dict(), "times_floor": self.times_floor(method)} for method in self.methods
            ],
        }

    def rows(self) -> Iterator[Table | str]:
        """Give the floor, and for each method its sources, their sum, and that over the floor."""
        yield (
            Text("one level channel at rest, steady state, standard deviations")
            if self.steady
            else Text("along the scenario, root mean square over the run")
        )
        yield from self._floor()
        for method in self.methods:
            yield self._sources(method)
            for name, entry in method.sources.items():
                if entry.growth is not None:
                    yield Text(
                        "  {name}: grows to {tilt} {tilt_unit}, {velocity} {velocity_unit} in one hour, "
                        "with the square root of time",
                        name=name,
                        tilt=number(_shown(entry.growth, TILT)),
                        tilt_unit=TILT.unit,
                        velocity=number(_shown(entry.growth, VELOCITY)),
                        velocity_unit=VELOCITY.unit,
                    )
            for text in method.warnings:
                yield Text("warning: {name}: {text}", name=method.name, text=text)

    def _floor(self) -> Iterator[Table | str]:
        if self.floor_reason:
            yield ""
            yield Text("no floor: {reason}", reason=self.floor_reason)
            return
        rows = [self._row(Text("  any causal linear damping with the log"), self.floor.rms)]
        if self.floor.final is not None:
            rows.append(self._row(Text("  at the end"), self.floor.final))
        yield Table(self._columns(Text("floor")), tuple(rows))
        if self.floor_note:
            yield Text("note: {text}", text=self.floor_note)

    def _sources(self, method: MethodBudget) -> Table:
        rows = [self._row(f"  {name}", entry.rms) for name, entry in method.sources.items()]
        if method.random is not None:
            rows.append(self._row(Text("  all that is random"), method.random))
        if method.given is not None:
            rows.append(self._row(Text("  given numbers, with their signs"), method.given.rms))
        rows.append(self._row(Text("  all"), method.total.rms))
        times = self.times_floor(method)
        if any(value is not None for value in times.values()):
            rows.append((Text("  times the floor"), *(number(value, 3) for value in times.values())))
        if method.total.final is not None:
            rows.append(self._row(Text("  at the end"), method.total.final))
        return Table(self._columns(method.name), tuple(rows))

    def _columns(self, name: str) -> tuple[Column, ...]:
        return Column(name), *(Column(kind.name, kind.unit) for kind in budgeted(self.steady))

    def _row(self, name: str, figures: Figures) -> tuple[str | float | None, ...]:
        return name, *(_shown(figures, kind) for kind in budgeted(self.steady))

    def figure(self) -> Any:
        """Draw the bars of Design (tab Limits), for a notebook, as `plotly.graph_objects.Figure`."""
        return drawn("budget_bars", self)

    @property
    def floor_note(self) -> str:
        """Why nothing can be compared with the floor; empty when it can."""
        return self.floor_reason or (FLOOR_OF_ZERO if self.floor.rms.tilt_rad == 0.0 else "")

    def times_floor(self, method: MethodBudget) -> dict[str, float | None]:
        """Each figure of a method over that of the floor; None where one is missing, zero or without the log.

        In the steady state both are of the random sources.
        """
        figures = (method.random or Figures()) if self.steady else method.total.rms
        ratios = {}
        for kind in budgeted(self.steady):
            own, least = getattr(figures, kind.figure), getattr(self.floor.rms, kind.figure)
            ratios[kind.name] = own / least if method.reads_log and own is not None and least else None
        return ratios


def _shown(figures: Figures, kind: Kind) -> float | None:
    value = getattr(figures, kind.figure)
    return None if value is None else value / kind.size


def with_floor(
    steady: bool, floor: Entry, reason: str, series: Series | None, methods: tuple[MethodBudget, ...]
) -> Budget:
    """Put methods beside the floor of damping with the log; beside none where no method reads the log.

    Without the log, the velocity that the network is fed with holds the ship's own motion, for which nobody
    has a stochastic model: there is no least error.
    """
    if any(method.reads_log for method in methods):
        return Budget(steady, floor, reason, series, methods)
    none = Entry(Figures(), None if steady else Figures())
    return Budget(steady, none, reason or WITHOUT_LOG, None, methods)

"""What a search for the best setting gives: the setting, what it is worth, and what holds it."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

from navcore.design.confirm import Confirmed
from navcore.design.default_limits import left_to_runs
from navcore.design.measures import Requirement, in_display_unit
from navcore.foundation.answers import Answer, Column, Table, number
from navcore.foundation.text import Text
from navcore.quantities import TUNED, Judged
from navcore.scenario.model import Scenario


@dataclass(frozen=True)
class Tuned(Answer):
    """Result of a search.

    Attributes
    ----------
    best : dict of float
        Value of each varied field.
    objective : float
        At the best setting, SI (of a sum: relative).
    before : float or None
        At the present setting; None where that makes no method or has no finite value.
    floor : float or None
        Least that any damping can reach; None where the objective has none.
    at_end_of_range : tuple of str
        Fields that stand at an end of their range: the true optimum may lie outside.
    active : tuple of str
        Requirements that hold the optimum back.
    cost : dict of float
        Objective without each active requirement.
    flat : dict of (float, float)
        Range of each field, the others held, within which the objective is at most 5 % above the best.
    stopped : bool
        The search was cancelled: the best so far.
    warnings : tuple of str
        What the objective does not see of the best setting: a mode of the whole system that grows, a
        recording that counts as free of error.
    judged : {"steady", "ensemble"}
        What root mean squares are of.
    default_limits : tuple of str
        Limits that were kept because none of their quantity was given.
    assumed_zero : tuple of str
        Standard deviations of constants that the scenario states in no way, so that 0 is assumed.
    confirmed : Confirmed or None
        Both settings in runs; None where that was not asked for.
    scenario : Scenario
        With the best setting in place.
    of : str
        The objective's name, or the sum, as it was asked for.
    limits : tuple of Requirement
        That were kept: given, of the scenario, and by default.
    repairs : bool
        The present setting misses a limit that was given; the best one keeps it.
    offered : bool
        False where runs prove no gain: the setting, its objective and the scenario are then the present ones.
    refused : dict of float
        Where it is not offered: the setting that the search had found.
    """

    best: dict[str, float]
    objective: float
    before: float | None
    floor: float | None
    at_end_of_range: tuple[str, ...]
    active: tuple[str, ...]
    cost: dict[str, float]
    flat: dict[str, tuple[float, float]]
    stopped: bool
    warnings: tuple[str, ...]
    judged: Judged
    default_limits: tuple[str, ...]
    scenario: Scenario = field(repr=False)
    assumed_zero: tuple[str, ...] = ()
    confirmed: Confirmed | None = None
    of: str = ""
    limits: tuple[Requirement, ...] = ()
    repairs: bool = False
    offered: bool = True
    refused: dict[str, float] = field(default_factory=dict)

    @property
    def failed(self) -> bool:
        """Whether there is no proposal."""
        return not self.offered

    @property
    def so_far(self) -> str:
        """That it is the best setting that was seen."""
        return Text("this is the best so far")

    def document(self) -> dict[str, Any]:
        """Return the document of interface.md."""
        return {
            "best": self.best,
            "objective": self.objective,
            "before": self.before,
            "floor": self.floor,
            "at_end_of_range": list(self.at_end_of_range),
            "active": list(self.active),
            "cost": self.cost,
            "flat": {name: list(ends) for name, ends in self.flat.items()},
            "stopped": self.stopped,
            "offered": self.offered,
            "refused": self.refused,
            "default_limits": list(self.default_limits),
            "assumed_zero": list(self.assumed_zero),
            "warnings": list(self.warnings),
            **({} if self.confirmed is None else {"confirmed": self.confirmed.as_dict()}),
        }

    def rows(self) -> Iterator[Table | str]:
        """Give the best values and how flat the optimum is, the objective before and after, what holds it."""
        yield self._values()
        yield self._objective()
        yield from self._about()
        if self.confirmed is not None:
            yield self._runs(self.confirmed)
            yield ""
        if self.default_limits:
            kept = ", ".join(self.default_limits)
            yield Text("by default: {kept} (--no-default-limits: without)", kept=kept)
        for text in self.active:
            cost = self.cost.get(text)
            if cost is None:
                yield Text("active: {text}", text=text)
            else:
                without = " ".join(in_unit(self.of, cost)).rstrip()
                yield Text("active: {text}; without it {without}", text=text, without=without)
        if left := left_to_runs(self.scenario.requirement):
            yield Text("judged by runs alone, not kept by the search: {left}", left=", ".join(left))
        for text in self.warnings:
            yield Text("warning: {text}", text=text)

    def _values(self) -> Table:
        heads = Text("parameter"), Text("best"), Text("within 5 %"), ""
        rows = []
        for name, value in self.best.items():
            low, high = self.flat.get(name, (value, value))
            end = Text("at the end of its range") if name in self.at_end_of_range else ""
            flat = Text("{low} to {high}", low=number(low, 3), high=number(high, 3))
            rows.append((name, number(value, 5), flat, end))
        return Table(tuple(map(Column, heads)), tuple(rows))

    def _objective(self) -> Table:
        shown = {Text("  before"): self.before, Text("  after"): self.objective, Text("  floor"): self.floor}
        rows = [(name, *in_unit(self.of, value)) for name, value in shown.items()]
        times = number(self.objective / self.floor, 4) if self.floor else "-"
        rows.append((Text("  times the floor"), times, ""))
        return Table((Column(self.of), Column(), Column()), tuple(rows))

    def _about(self) -> Iterator[Table | str]:
        """Give what a search over more than one scenario has to say."""
        return iter(())

    def _runs(self, confirmed: Confirmed) -> Table:
        title = Text("run, {seeds} seeds", seeds=confirmed.seeds)
        heads = title, Text("before"), Text("after"), Text("difference"), Text("95 % interval"), ""
        rows = []
        for name, change in confirmed.changes.items():
            values = [change.before, change.after, change.difference, change.low, change.high]
            cells = [in_unit(name, value)[0] if name in TUNED else number(value) for value in values]
            unit = in_unit(name, 0.0)[1] if name in TUNED else ""
            interval = Text("{low} to {high}", low=cells[3], high=cells[4])
            rows.append((f"  {name}", *cells[:3], interval, unit))
        return Table(tuple(map(Column, heads)), tuple(rows))


def in_unit(name: str, value: float | None) -> list[str]:
    """Value of a measure, and its unit."""
    in_unit, unit = in_display_unit(name, value)
    return [number(in_unit), unit]

"""``schuler budget``: which source an error is made of, and how far it is from the best possible."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

from tyro.conf import Positional, UseAppendAction, arg

from app.cli.table import columns, number
from app.cli.terminal import emit, emit_json, on_terminal, say

if TYPE_CHECKING:
    from navcore.design.budget import Budget
    from navcore.design.figures import Figures


@dataclass(frozen=True)
class BudgetCommand:
    """Error budget of every method by source, beside the floor that no damping can get below.

    Attributes
    ----------
    scenario : str
        Name of a preset, or a TOML file.
    set : tuple of str
        Override one field, e.g. method.0.network.xi=0.5.
    steady : bool
        One level channel at rest in the steady state, in place of the scenario's own run.
    json : bool
        Print one JSON document.
    quiet : bool
        No progress bar.
    """

    scenario: Annotated[Positional[str], arg(metavar="SCENARIO")]
    set: Annotated[UseAppendAction[tuple[str, ...]], arg(metavar="KEY=VALUE")] = ()
    steady: bool = False
    json: bool = False
    quiet: bool = False

    def execute(self) -> int:
        """Compute and print; 3 when it was stopped or a method diverged."""
        from app.cli.progress import Bar
        from app.cli.stop import stop_on_signal
        from navcore.design.budget import budget
        from navcore.foundation.errors import InputError
        from navcore.scenario.file import load

        scenario = load(self.scenario, self.set)
        with stop_on_signal() as stopped, Bar("budget", on_terminal() and not self.quiet) as bar:
            try:
                found = budget(scenario, self.steady, progress=bar.advance, cancelled=stopped)
            except InputError as error:
                raise error.located(self.scenario) from None
            if stopped():
                say(f"{self.scenario}: stopped")
                return 3
        if self.json:
            emit_json(found.as_dict())
        else:
            emit("\n".join(budget_text(found)))
        return 3 if any(method.diverged for method in found.methods) else 0


def budget_text(budget: Budget) -> list[str]:
    """Lines: for each method its sources, their sum, and how many times the floor that is."""
    lines = [
        "one level channel at rest, steady state, standard deviations"
        if budget.steady
        else "along the scenario, root mean square over the run",
        "",
        *_floor(budget),
    ]
    for method in budget.methods:
        rows = [_head(budget, method.name), _units(budget)]
        rows += [[f"  {name}", *_cells(budget, entry.rms)] for name, entry in method.sources.items()]
        rows.append(["  all", *_cells(budget, method.total.rms)])
        times = budget.times_floor(method)
        if any(value is not None for value in times.values()):
            rows.append(["  times the floor", *(number(value, 3) for value in times.values())])
        if method.total.final is not None:
            rows.append(["  at the end", *_cells(budget, method.total.final)])
        rows += [
            [f"  {name}, constant", *_cells(budget, entry.rms)] for name, entry in method.constants.items()
        ]
        lines += ["", *columns(rows)]
        lines += [
            f"  {name}: grows to {number(_arcsec(entry.growth.tilt_rad))} arcsec, "
            f"{number(entry.growth.velocity_mps)} m/s in one hour, with the square root of time"
            for name, entry in method.sources.items()
            if entry.growth is not None
        ]
        lines += [f"warning: {method.name}: {text}" for text in method.warnings]
    return lines


def _floor(budget: Budget) -> list[str]:
    if budget.floor_reason:
        return [f"no floor: {budget.floor_reason}"]
    rows = [
        _head(budget, "floor"),
        _units(budget),
        ["  any causal linear damping", *_cells(budget, budget.floor.rms)],
    ]
    if budget.floor.final is not None:
        rows.append(["  at the end", *_cells(budget, budget.floor.final)])
    lines = columns(rows)
    return [*lines, f"note: {budget.floor_note}"] if budget.floor_note else lines


def _head(budget: Budget, name: str) -> list[str]:
    return [name, "tilt", "velocity", *([] if budget.steady else ["heading", "position"])]


def _units(budget: Budget) -> list[str]:
    return ["", "arcsec", "m/s", *([] if budget.steady else ["arcmin", "m"])]


def _cells(budget: Budget, figures: Figures) -> list[str]:
    cells = [number(_arcsec(figures.tilt_rad)), number(figures.velocity_mps)]
    if not budget.steady:
        heading = _arcsec(figures.heading_rad)
        cells += [number(None if heading is None else heading / 60.0), number(figures.position_m)]
    return cells


def _arcsec(angle: float | None) -> float | None:
    from navcore.foundation.units import ARCSEC

    return None if angle is None else angle / ARCSEC

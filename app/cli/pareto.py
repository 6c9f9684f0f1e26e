"""``schuler pareto``: what two objectives cost each other, for every network."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

from tyro.conf import Positional, UseAppendAction, arg

from app.cli.table import columns, number
from app.cli.terminal import emit, emit_json, on_terminal, say

if TYPE_CHECKING:
    from navcore.design.pareto import Pareto


@dataclass(frozen=True)
class ParetoCommand:
    """Pareto fronts of two objectives for every network in place of a method's own.

    Attributes
    ----------
    scenario : str
        Name of a preset, or a TOML file.
    x, y : str
        The two objectives, e.g. tilt_rms and velocity_rms.
    method : int
        Which method, from 0.
    network : tuple of str
        Only these networks.
    along : bool
        Over the scenario's run, in place of the steady state at rest.
    set : tuple of str
        Override one field of the scenario first.
    json : bool
        Print one JSON document.
    quiet : bool
        No progress bar.
    """

    scenario: Annotated[Positional[str], arg(metavar="SCENARIO")]
    x: Annotated[str, arg(metavar="NAME")] = "tilt_rms"
    y: Annotated[str, arg(metavar="NAME")] = "velocity_rms"
    method: Annotated[int, arg(metavar="N")] = 0
    network: Annotated[UseAppendAction[tuple[str, ...]], arg(metavar="ID")] = ()
    along: bool = False
    set: Annotated[UseAppendAction[tuple[str, ...]], arg(metavar="KEY=VALUE")] = ()
    json: bool = False
    quiet: bool = False

    def execute(self) -> int:
        """Search and print; 3 when it was stopped."""
        from app.cli.progress import Bar
        from app.cli.stop import stop_on_signal
        from navcore.design.pareto import pareto
        from navcore.scenario.file import load

        scenario = load(self.scenario, self.set)
        with stop_on_signal() as stopped, Bar("pareto", on_terminal() and not self.quiet) as bar:
            found = pareto(
                scenario,
                (self.x, self.y),
                self.method,
                networks=self.network or None,
                along=self.along,
                progress=bar.advance,
                cancelled=stopped,
            )
        if self.json:
            emit_json(found.as_dict())
        else:
            emit("\n".join(pareto_text(found)))
        if found.stopped:
            say(f"{self.scenario}: stopped; these are the fronts so far")
        return 3 if found.stopped else 0


def pareto_text(found: Pareto) -> list[str]:
    """Lines: for each network the ends of its front and the settings there, the present design, the floor."""
    first, second = found.objectives
    rows = [["", first, second, ""], ["", _unit(first), _unit(second), ""]]
    for name, points in found.fronts.items():
        chosen = [points[0], points[len(points) // 2], points[-1]] if len(points) > 2 else list(points)
        for k, point in enumerate(chosen):
            setting = ", ".join(
                f"{field} = {value:.4g}" for field, value in point.network.items() if isinstance(value, float)
            )
            if point.earth_growth > 0.0:
                setting = f"{setting or 'no parameter'}; its 24 h mode grows"
            rows.append([name if k == 0 else "", *_values(found, point.values), setting])
    if found.present is not None:
        rows.append(["as it is", *_values(found, found.present), ""])
    rows.append(["floor", *_values(found, found.floor), ""])
    lines = columns([row[:3] for row in rows])
    return [f"{line}  {row[3]}".rstrip() for line, row in zip(lines, rows, strict=True)]


def _unit(name: str) -> str:
    from navcore.design.measures import in_display_unit

    return in_display_unit(name, None)[1]


def _values(found: Pareto, values: tuple[float | None, float | None]) -> list[str]:
    from navcore.design.measures import in_display_unit

    pairs = zip(found.objectives, values, strict=True)
    return [number(in_display_unit(name, value)[0]) for name, value in pairs]

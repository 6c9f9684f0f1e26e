"""``schuler pareto``: what two objectives cost each other, for every network."""

from dataclasses import dataclass
from typing import Annotated

from tyro.conf import Positional, UseAppendAction, arg

from navcore.quantities import WEIGHED
from schuler_bench.cli.terminal import emit_result, say

_OBJECTIVE = f"One of the two objectives, of {', '.join(WEIGHED)}."


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
    beyond_sliders : bool
        Search all that the fields allow, not only what the page's sliders reach.
    set : tuple of str
        Override one field of the scenario first.
    json : bool
        Print one JSON document.
    quiet : bool
        No progress bar.
    """

    scenario: Annotated[Positional[str], arg(metavar="SCENARIO")]
    x: Annotated[str, arg(metavar="NAME", help=_OBJECTIVE)] = "tilt_rms"
    y: Annotated[str, arg(metavar="NAME", help=_OBJECTIVE)] = "velocity_rms"
    method: Annotated[int, arg(metavar="N")] = 0
    network: Annotated[UseAppendAction[tuple[str, ...]], arg(metavar="ID")] = ()
    along: bool = False
    beyond_sliders: bool = False
    set: Annotated[UseAppendAction[tuple[str, ...]], arg(metavar="KEY=VALUE")] = ()
    json: bool = False
    quiet: bool = False

    def execute(self) -> int:
        """Search and print; 3 when it was stopped."""
        from navcore.design.pareto import pareto
        from navcore.scenario.file import load
        from schuler_bench.cli.design_text import pareto_text
        from schuler_bench.cli.progress import working

        scenario = load(self.scenario, self.set)
        with working("pareto", self.quiet) as (progress, stopped):
            result = pareto(
                scenario,
                (self.x, self.y),
                self.method,
                networks=self.network or None,
                along=self.along,
                whole=self.beyond_sliders,
                progress=progress,
                cancelled=stopped,
            )
        emit_result(self.json, result.as_dict(), lambda: pareto_text(result))
        if result.stopped:
            say(f"{self.scenario}: stopped; these are the fronts so far")
        return 3 if result.stopped else 0

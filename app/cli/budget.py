"""``schuler budget``: which source an error is made of, and how far it is from the best possible."""

from dataclasses import dataclass
from typing import Annotated

from tyro.conf import Positional, UseAppendAction, arg

from schuler_bench.cli.terminal import emit_result, say


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
        from navcore.design.budget import budget
        from navcore.scenario.file import load
        from schuler_bench.cli.design_text import budget_text
        from schuler_bench.cli.progress import working

        scenario = load(self.scenario, self.set)
        with working("budget", self.quiet, self.scenario) as (progress, stopped):
            result = budget(scenario, self.steady, progress=progress, cancelled=stopped)
        if stopped():
            say(f"{self.scenario}: stopped")
            return 3
        emit_result(self.json, result.as_dict(), lambda: budget_text(result))
        return 3 if any(method.diverged for method in result.methods) else 0

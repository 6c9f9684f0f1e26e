"""``schuler run``: simulate a scenario, print its metrics, write its files."""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

from tyro.conf import Positional, UseAppendAction, arg

from schuler_bench.cli.terminal import emit_result, say

if TYPE_CHECKING:
    from navcore.engine.measures import SeedShare

_RUN = 0.2
"""Of the time, for the run itself where seeds judge its limits too."""


@dataclass(frozen=True)
class RunCommand:
    """Run a scenario: every method on the same truth, sensors and log.

    Attributes
    ----------
    scenario : str
        Name of a preset, or a TOML file.
    set : tuple of str
        Override one field, e.g. method.0.network.xi=0.5.
    out : Path or None
        Folder for scenario.toml, metrics.json and the time series: made if need be; other files in it stay.
    format : {"parquet", "csv"}
        Of the time series.
    json : bool
        Print the metrics as one JSON document.
    quiet : bool
        No progress bar.
    """

    scenario: Annotated[Positional[str], arg(metavar="SCENARIO")]
    set: Annotated[UseAppendAction[tuple[str, ...]], arg(metavar="KEY=VALUE")] = ()
    out: Annotated[Path | None, arg(metavar="DIR")] = None
    format: Literal["parquet", "csv"] = "parquet"
    json: bool = False
    quiet: bool = False

    def execute(self) -> int:
        """Run, write, print; 0 when every method went through, else 3."""
        from navcore.design.run_shares import draws_more_than_a_run, run_shares
        from navcore.engine.measures import metrics
        from navcore.engine.results import require_results, write_results
        from navcore.engine.simulation import simulate
        from navcore.foundation.errors import InputError
        from navcore.foundation.inputs import noting
        from navcore.foundation.progress import part_of
        from navcore.scenario.file import load
        from schuler_bench.cli.progress import working
        from schuler_bench.cli.run_text import run_text

        with noting() as reads:
            scenario = load(self.scenario, self.set)
        if self.out is not None:
            require_results(scenario, self.out, self.format, reads)
        with working(scenario.title or "running", self.quiet, self.scenario) as (progress, stopped):
            judging = draws_more_than_a_run(scenario)
            run = simulate(scenario, part_of(progress, 0.0, _RUN) if judging else progress, stopped)
            shares: tuple[SeedShare, ...] = ()
            if judging and run.status != "stopped":
                try:
                    shares = run_shares(scenario, progress=part_of(progress, _RUN, 1.0), cancelled=stopped)
                except InputError as error:
                    for fault in error.faults:
                        say(f"{self.scenario}: no share of seeds: {fault}")
        if self.out is not None:
            write_results(run, self.out, self.format, reads, shares)
        emit_result(self.json, metrics(run, shares), lambda: run_text(run, shares))
        for method in run.methods:
            if method.reason:
                say(f"{self.scenario}: {method.method.name}: {method.status}: {method.reason}")
        return 0 if run.status == "ok" else 3

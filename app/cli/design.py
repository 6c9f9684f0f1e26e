"""``schuler design``: which methods meet the limits of a scenario, and with what probability."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from tyro.conf import Positional, UseAppendAction, arg

from navcore.foundation.out import refused, writing
from schuler_bench.cli.terminal import emit_result, say

if TYPE_CHECKING:
    from navcore.design.designs import Designs
    from navcore.scenario.model import Scenario
    from navcore.study.robust import Robust


@dataclass(frozen=True)
class DesignCommand:
    """Share of seeds on which each method meets all [[requirement]] blocks of a scenario.

    Attributes
    ----------
    scenario : str
        Name of a preset, or a TOML file.
    set : tuple of str
        Override one field, e.g. requirement.0.at_most=10.
    seeds : int
        Runs of each method: 200, or 40 at each point of --over.
    as_set : bool
        Judge the scenario's methods as they stand, in place of every network tuned and a Kalman filter.
    over : str or None
        Study (a name or a file) over whose factors the methods must hold, laid over the scenario.
    quantile : float
        With --over: which of its points counts, by the share of seeds there; 0 for the worst.
    out : Path or None
        Folder for design.json and scenario.toml with these methods, best first.
    json : bool
        Print one JSON document.
    quiet : bool
        No progress bar.
    """

    scenario: Annotated[Positional[str], arg(metavar="SCENARIO")]
    set: Annotated[UseAppendAction[tuple[str, ...]], arg(metavar="KEY=VALUE")] = ()
    seeds: Annotated[int | None, arg(metavar="N")] = None
    as_set: bool = False
    over: Annotated[str | None, arg(metavar="STUDY")] = None
    quantile: Annotated[float, arg(metavar="Q")] = 0.0
    out: Annotated[Path | None, arg(metavar="DIR")] = None
    json: bool = False
    quiet: bool = False

    def execute(self) -> int:
        """Search, run and print; 3 when it was stopped."""
        from navcore.design.designs import SEEDS, designs
        from navcore.scenario.file import load
        from schuler_bench.cli.designs_text import designs_text
        from schuler_bench.cli.progress import working

        if self.out is not None:
            _require_own(self.out)
        scenario = load(self.scenario, self.set)
        if self.over is not None:
            return self._over(scenario, self.over)
        with working("design", self.quiet, self.scenario) as (progress, stopped):
            seeds = SEEDS if self.seeds is None else self.seeds
            result = designs(scenario, seeds, as_set=self.as_set, progress=progress, cancelled=stopped)
        if self.out is not None:
            _write(self.out, result, scenario)
        emit_result(self.json, result.as_dict(), lambda: designs_text(result))
        if result.stopped:
            say(f"{self.scenario}: stopped; these are the shares of {result.seeds} seeds")
        return 3 if result.stopped else 0

    def _over(self, scenario: Scenario, over: str) -> int:
        """Judge over the points of a study."""
        from navcore.study.file import load
        from navcore.study.robust import SEEDS, robust_designs
        from schuler_bench.cli.designs_text import robust_text
        from schuler_bench.cli.progress import working

        seeds = SEEDS if self.seeds is None else self.seeds
        study = load(over)
        with working("design", self.quiet, self.scenario) as (progress, stopped):
            result = robust_designs(
                scenario,
                study,
                seeds,
                quantile=self.quantile,
                as_set=self.as_set,
                progress=progress,
                cancelled=stopped,
            )
        if self.out is not None:
            _write(self.out, result, scenario)
        emit_result(self.json, result.as_dict(), lambda: robust_text(result))
        return 0


_FILES = ("design.json", "scenario.toml")


def _require_own(folder: Path) -> None:
    """Refuse a folder with files that this command does not write."""
    try:
        foreign = sorted(path.name for path in folder.iterdir() if path.name not in _FILES)
    except FileNotFoundError:
        return
    except OSError as error:
        raise refused(folder, f"cannot be read: {error.strerror}") from None
    if foreign:
        raise refused(folder, f"holds what this command did not write: {', '.join(foreign[:3])}")


def _write(folder: Path, result: Designs | Robust, scenario: Scenario) -> None:
    from navcore.scenario.file import to_toml

    methods = tuple(share.method for share in result.methods)
    texts = json.dumps(result.as_dict(), indent=2), to_toml(scenario.model_copy(update={"method": methods}))
    with writing(folder):
        folder.mkdir(parents=True, exist_ok=True)
        for name, text in zip(_FILES, texts, strict=True):
            (folder / name).write_text(text + "\n", encoding="utf-8")

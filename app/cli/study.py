"""``schuler study``: one scenario over many settings and seeds."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Annotated

from tyro.conf import Positional, arg

from navcore.foundation.errors import Fault, InputError
from schuler_bench.cli.terminal import emit_result, say

if TYPE_CHECKING:
    from navcore.study.plan import Plan
    from navcore.study.running import Engine


@dataclass(frozen=True)
class StudyCommand:
    """Run a study: a scenario over factors and seeds.

    Attributes
    ----------
    study : str
        Name of a listed study, or a TOML file.
    out : Path or None
        Folder for runs.parquet, study.toml and summary.json; without it only the summary is printed.
    resume : bool
        Go on with the results in the folder: only what is missing is run.
    workers : int or None
        Runs at a time; by default one for each core.
    scheduler : str or None
        Address of a Dask scheduler, tcp://HOST:PORT, on whose workers the runs are carried out.
    hours : float or None
        Largest estimated time that is begun; by default 24.
    json : bool
        Print the summary as one JSON document.
    quiet : bool
        No progress bar.
    """

    study: Annotated[Positional[str], arg(metavar="STUDY")]
    out: Annotated[Path | None, arg(metavar="DIR")] = None
    resume: bool = False
    workers: Annotated[int | None, arg(metavar="N")] = None
    scheduler: Annotated[str | None, arg(metavar="ADDRESS")] = None
    hours: Annotated[float | None, arg(metavar="H")] = None
    json: bool = False
    quiet: bool = False

    def execute(self) -> int:
        """Run, sum up, print; 3 when it was stopped. A run that diverges is a result."""
        from navcore.foundation.cores import cores
        from navcore.foundation.inputs import noting
        from navcore.scenario.reads import recordings as of_scenario
        from navcore.study.file import recordings
        from navcore.study.plan import plan_of, require_affordable
        from navcore.study.results import Folder
        from navcore.study.study import carry_out
        from schuler_bench.cli.progress import working
        from schuler_bench.cli.study_text import study_text

        workers = cores() if self.workers is None else self.workers
        if not 1 <= workers <= 256:
            raise InputError(Fault("--workers", "", workers, "must be >= 1 and <= 256"))
        if self.hours is not None and not self.hours > 0.0:
            raise InputError(Fault("--hours", "", self.hours, "must be > 0 (h)"))
        if self.resume and self.out is None:
            raise InputError(Fault("--resume", "", None, "needs --out DIR, the folder of the results"))
        with noting() as reads:
            plan = plan_of(self.study)
        reads += [*recordings(plan.study), *of_scenario(plan.scenario)]
        with self._engine(plan, workers) as (engine, at_a_time), _folder(self.out) as path:
            require_affordable(plan, at_a_time, self.hours)
            folder = Folder(path, plan, reads)
            with (
                folder.opened(self.resume),
                working(plan.study.title or "study", self.quiet, self.study) as (progress, stopped),
            ):
                document = carry_out(plan, folder, at_a_time, progress, stopped, engine)
        emit_result(self.json, document, lambda: study_text(document))
        if document["status"] == "complete":
            return 0
        kept = f"; --out {self.out} --resume goes on" if self.out else ""
        say(f"{self.study}: stopped after {document['runs']} of {document['of']} runs{kept}")
        return 3

    @contextmanager
    def _engine(self, plan: Plan, workers: int) -> Iterator[tuple[Engine | None, int]]:
        """Give what carries the runs out (None: this machine), and how many blocks at a time."""
        if self.scheduler is None:
            from schuler_bench.memory import bound_arenas

            # a thread's own arena gives its memory back after each block, to ask for it again page by page
            bound_arenas()
            yield None, workers
            return
        from schuler_bench.jobs.study_cluster import study_cluster

        with study_cluster(self.scheduler, plan) as engine:
            yield engine, engine.workers


@contextmanager
def _folder(out: Path | None) -> Iterator[Path]:
    if out is not None:
        yield out
        return
    with TemporaryDirectory(prefix="schuler-study-") as folder:
        yield Path(folder)

"""Study: one scenario over many settings and seeds."""

from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any, ClassVar, Literal

from pydantic import PrivateAttr

from navcore.foundation.errors import Fault, InputError, StoppedError
from navcore.foundation.out import PathLike
from navcore.foundation.parameters import quantity
from navcore.foundation.text import Text
from navcore.questions.base import Cancelled, Progress, Question, option
from navcore.questions.fields import Over

if TYPE_CHECKING:
    from navcore.scenario.model import Scenario
    from navcore.study.plan import Plan
    from navcore.study.running import Engine
    from navcore.study.studied import Studied


class StudyQuestion(Question):
    """A scenario over factors and seeds."""

    title: ClassVar[str] = Text("Study")
    help: ClassVar[str] = Text("Run a study: a scenario over factors and seeds.")
    function: ClassVar[str] = "run_study"
    subject: ClassVar[str] = "study"
    takes: ClassVar[str] = "Study, or str"
    stopped: ClassVar[str] = Text("Stopped: no run was complete.")
    writes: ClassVar = "folder"
    written: ClassVar[str] = Text("runs.parquet, study.toml and summary.json")
    example: ClassVar[str] = """\
>>> from navcore import load, run_study
>>> from navcore.study.crossed import crossed
>>> found = run_study(crossed(load("zha-fast", ["run.duration_h=0.1"]), ["latitude"], 2))
>>> found.complete, found.summary["runs"]
(True, 14)"""
    id: Literal["study"] = "study"
    study: Over = option(..., metavar="STUDY", help=Text("Name of a listed study, or a TOML file."))
    scenario: Any = option(None, hidden=True, help=Text("Of which the study was made, where it was."))
    where: str = option("", hidden=True, help=Text("Name of the study in faults."))
    runs: bytes = option(b"", hidden=True, help=Text("Runs that are there: runs.parquet of a stopped study."))
    folder: Path | None = option(
        None, hidden=True, help=Text("Empty; for the results, part by part, which outlive this process.")
    )
    resume: bool = option(
        False,
        label=Text("go on"),
        help=Text("Go on with the results in the folder: only what is missing is run."),
    )
    workers: int | None = quantity(
        None, ge=1, le=256, label=Text("workers"), help=Text("Runs at a time; by default one for each core.")
    )
    hours: float | None = quantity(
        None,
        gt=0.0,
        unit="h",
        label=Text("hours"),
        help=Text("Largest estimated time that is begun; by default 24 h."),
    )
    _plan: Any = PrivateAttr(default=None)

    @property
    def plan(self) -> "Plan":
        """The study's runs by number; raises `InputError`."""
        from navcore.study.plan import Plan

        if self._plan is None:
            self._plan = Plan(self.study, self.where)
        return self._plan

    def refusals(self) -> tuple[str, ...]:
        """Give methods that the scenario, or a value of a factor, refuses."""
        return self.plan.refused

    @property
    def load(self) -> "Scenario":
        """Scenario of the first setting."""
        return self.plan.scenario

    def __getstate__(self) -> dict[Any, Any]:
        """Leave the plan behind: it is made anew where the study is carried out."""
        state = super().__getstate__()
        return state | {"__pydantic_private__": {"_plan": None}}

    def answer(self, progress: Progress | None = None, cancelled: Cancelled | None = None) -> "Studied":
        """Run it here, and keep the rows."""
        from dataclasses import replace

        from navcore.study.results import RUNS_FILE

        with ExitStack() as until:
            path = self.folder or Path(until.enter_context(TemporaryDirectory(prefix="schuler-study-")))
            found = self.carried_out(path, (), progress, cancelled)
            if not found.summary["runs"]:
                raise StoppedError(Fault("", "", None, Text("stopped before a run was complete")))
            return replace(found, runs=(path / RUNS_FILE).read_bytes(), place="")

    def carried_out(
        self,
        path: Path,
        reads: tuple[PathLike, ...] = (),
        progress: Progress | None = None,
        cancelled: Cancelled | None = None,
        engine: "Engine | None" = None,
        at_a_time: int | None = None,
    ) -> "Studied":
        """Run what is missing in a folder.

        Parameters
        ----------
        path : Path
            Of the folder.
        reads : tuple of path
            Files that are never replaced.
        progress, cancelled : callable, optional
            As of `answer`.
        engine : callable, optional
            Carries blocks of runs out elsewhere, ``at_a_time`` of them.
        """
        from navcore.foundation.cores import cores
        from navcore.study.plan import require_affordable
        from navcore.study.results import Folder
        from navcore.study.studied import Studied
        from navcore.study.study import carry_out

        workers = at_a_time or self.workers or cores()
        require_affordable(self.plan, workers, self.hours)
        folder = Folder(path, self.plan, [*reads, *self.recordings()])
        with folder.opened(self.resume):
            if self.runs:
                folder.take(self.runs)
            document = carry_out(self.plan, folder, workers, progress, cancelled, engine)
        return Studied(document, place=str(path))


@contextmanager
def folder_of(question: StudyQuestion, out: Path | None) -> Iterator[Path]:
    """Give the folder of ``--out``, or one that goes when the study is done.

    Raises
    ------
    InputError
        It is to be gone on with, and no folder is named.
    """
    if question.resume and out is None:
        raise InputError(Fault("--resume", "", None, Text("needs --out DIR, the folder of the results")))
    if out is not None:
        yield out
        return
    with TemporaryDirectory(prefix="schuler-study-") as path:
        yield Path(path)

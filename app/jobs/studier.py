"""Studies of a session: their runs in the background; one that was stopped is gone on with."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.scenario.model import Scenario
from schuler_bench.jobs.scheduler import Lane
from schuler_bench.jobs.search import Search
from schuler_bench.jobs.worker import Watch

if TYPE_CHECKING:
    from navcore.study.model import Study
    from navcore.study.plan import Plan

MOST_RUNS, MOST_S = 20_000, 900.0
"""Runs of a study on a page, and its estimated processor time."""


@dataclass(frozen=True)
class StudyTask:
    """A study to carry out.

    Attributes
    ----------
    study : Study
        What is run, over what.
    where : str
        Its name in faults.
    scenario : Scenario
        Of its first setting.
    present : Scenario or None
        The session's scenario, of which it was made; None: it has a scenario of its own.
    runs : bytes
        ``runs.parquet`` of its complete runs, when it was stopped before.
    folder : Path or None
        Empty; for its results, part by part, so that they outlive this process. None: a temporary one.
    """

    study: Study
    where: str
    scenario: Scenario
    present: Scenario | None = None
    runs: bytes = b""
    folder: Path | None = None


@dataclass(frozen=True)
class StudyResult:
    """Result of a study.

    Attributes
    ----------
    document : dict
        As ``summary.json``; its ``status`` says whether it is complete.
    runs : bytes
        ``runs.parquet``.
    """

    document: dict[str, Any]
    runs: bytes

    @property
    def complete(self) -> bool:
        """Whether no run is missing."""
        return self.document["status"] == "complete"


class Studier(Search[StudyTask, StudyResult]):
    """Carries out one study at a time; ``tell`` and ``name`` as of `Search`."""

    def __init__(self, tell: Callable[[], None], name: str = "studier") -> None:
        super().__init__(
            tell, _carried_out, stopped=Text("Stopped: no run was complete."), name=name, keeps=True
        )
        self.place: Callable[[], Path | None] = lambda: None
        """Gives an empty folder in which the parts of a study are kept."""

    def _carry_out(
        self, asked: StudyTask, progress: Callable[[float], None], watch: Watch
    ) -> StudyResult | None:
        if watch.lane is not Lane.CLUSTER:  # its workers have other disks
            asked = replace(asked, folder=self.place())
        return super()._carry_out(asked, progress, watch)

    @property
    def left(self) -> StudyTask | None:
        """Rest of the last study; None when it is complete."""
        found, asked = self.result, self.asked
        if found is None or asked is None or found.complete:
            return None
        return replace(asked, runs=found.runs)


def require_small(plan: Plan) -> None:
    """Refuse a study that takes too long for a page; raises `InputError`."""
    if plan.runs <= MOST_RUNS and plan.seconds() <= MOST_S:
        return
    allowed = Text(
        "is {runs} runs, about {minutes:.3g} min; on the page at most {most} runs and {longest:g} min: give "
        "fewer values or seeds, or run the file with schuler study",
        runs=plan.runs,
        minutes=plan.seconds() / 60.0,
        most=MOST_RUNS,
        longest=MOST_S / 60.0,
    )
    raise InputError(Fault("", Text("study"), None, allowed))


def _carried_out(
    task: StudyTask, progress: Callable[[float], None], cancelled: Callable[[], bool]
) -> StudyResult | None:
    from tempfile import TemporaryDirectory

    from navcore.study.plan import Plan
    from navcore.study.results import RUNS_FILE, Folder
    from navcore.study.study import carry_out

    plan = Plan(task.study, task.where)
    with ExitStack() as until:
        path = task.folder or Path(until.enter_context(TemporaryDirectory(prefix="schuler-study-")))
        folder = Folder(path, plan)
        with folder.opened(False):
            if task.runs:
                folder.take(task.runs)
            document = carry_out(plan, folder, 1, progress, cancelled)
        if not document["runs"]:
            return None
        return StudyResult(document, (path / RUNS_FILE).read_bytes())

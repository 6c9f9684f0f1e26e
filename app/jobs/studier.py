"""Studies of a session: their runs in the background; one that was stopped is gone on with."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.scenario.model import Scenario
from schuler_bench.jobs.search import Search

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
    """

    study: Study
    where: str
    scenario: Scenario
    present: Scenario | None = None
    runs: bytes = b""


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
    from pathlib import Path
    from tempfile import TemporaryDirectory

    from navcore.study.plan import Plan
    from navcore.study.results import RUNS_FILE, Folder
    from navcore.study.study import carry_out

    plan = Plan(task.study, task.where)
    with TemporaryDirectory(prefix="schuler-study-") as path:
        folder = Folder(Path(path), plan)
        with folder.opened(False):
            if task.runs:
                folder.take(task.runs)
            document = carry_out(plan, folder, 1, progress, cancelled)
        if not document["runs"]:
            return None
        return StudyResult(document, (Path(path) / RUNS_FILE).read_bytes())

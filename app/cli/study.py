"""``schuler study``: its runs lie in a folder, and may be carried out on a cluster."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any

from tyro.conf import arg

from navcore.foundation.answers import Answer
from navcore.questions.base import Question
from navcore.questions.study import StudyQuestion, folder_of
from schuler_bench.cli.asking import AskingCommand

if TYPE_CHECKING:
    from navcore.study.running import Engine


SCHEDULER = (
    "scheduler",
    Annotated[
        str | None,
        arg(
            metavar="ADDRESS",
            help="Address of a Dask scheduler, tcp://HOST:PORT, on whose workers the runs are carried out.",
        ),
    ],
    None,
)
"""The option that the command has beside the question's."""


@dataclass(frozen=True)
class OnCluster(AskingCommand):
    """Carry the study's runs out, here or on a cluster."""

    def _free(self, question: Question, given: Mapping[str, Any], reads: list[Any]) -> None:
        """Leave it to the folder, which knows what it can go on with."""

    def _answered(self, question: Question, given: Mapping[str, Any], reads: list[Any]) -> Answer:
        assert isinstance(question, StudyQuestion)
        from schuler_bench.cli.progress import working

        scheduler, out = given["scheduler"], given["out"]
        with folder_of(question, out) as path, _engine(question, scheduler) as (engine, at_a_time):
            title = question.study.title or "study"
            with working(title, given["quiet"], self._source(given)) as (progress, stopped):
                return question.carried_out(path, tuple(reads), progress, stopped, engine, at_a_time)

    def _written(
        self, question: Question, answer: Answer, given: Mapping[str, Any], reads: list[Any]
    ) -> None:
        """Write nothing more: its runs were written as they came."""


@contextmanager
def _engine(question: StudyQuestion, address: str | None) -> Iterator[tuple[Engine | None, int | None]]:
    """Give what carries the runs out (None: this machine), and how many blocks at a time."""
    if address is None:
        from schuler_bench.memory import bound_arenas

        # a thread's own arena gives its memory back after each block, to ask for it again page by page
        bound_arenas()
        yield None, None
        return
    from schuler_bench.jobs.study_cluster import study_cluster

    with study_cluster(address, question.plan) as engine:
        yield engine, engine.workers

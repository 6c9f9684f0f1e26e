"""Questions asked in the background: here, by a helper or on a cluster, one at a time."""

from collections.abc import Callable
from typing import Any

from navcore.foundation.answers import Answer
from navcore.foundation.errors import InputError
from navcore.foundation.text import Text
from navcore.questions.base import Cancelled, Progress, Question
from navcore.scenario.model import Scenario
from schuler_bench.jobs.load import heavy_load, spare_load
from schuler_bench.jobs.refusals import refusals
from schuler_bench.jobs.scheduler import Lane
from schuler_bench.jobs.search import Search
from schuler_bench.jobs.worker import Watch

CHANGED = Text("Stopped: the scenario was changed meanwhile.")
_SPARE_S = 0.5, 0.25
"""Of spare work: time under way before its progress is reported first, and between two reports."""


class Asker(Search[Any, Any]):
    """Asks one question at a time; the last answer stays until the next.

    Parameters
    ----------
    tell : callable
        As of `Search`.
    question : type of Question
        Whose answers these are.
    name : str
        Of the visitor, for the turns.
    still_s, keeps : optional
        As of `Search`; by default those of the question.

    Attributes
    ----------
    prepared : callable
        Gives a question what it needs of this machine, such as a folder, before it is answered here.
    accepted : Scenario or None
        The scenario into which the answer was taken over.
    """

    def __init__(
        self,
        tell: Callable[[], None],
        question: type[Question],
        name: str = "asker",
        *,
        still_s: float | None = None,
        keeps: bool | None = None,
    ) -> None:
        keeps = question.keeps if keeps is None else keeps
        super().__init__(
            tell,
            answered,
            lambda found: keeps or found.complete,
            stopped=question.stopped,
            name=name,
            load=lambda asked: (spare_load if question.spare else heavy_load)(asked.load),
            still_s=question.still_s if still_s is None else still_s,
            keeps=keeps,
        )
        self.question = question
        if question.spare:
            self.report_after_s, self.report_every_s = _SPARE_S
        self.accepted: Scenario | None = None
        self.prepared: Callable[[Question], Question] = lambda asked: asked

    def _carry_out(self, asked: Question, progress: Progress, watch: Watch) -> Any:
        here = watch.lane is not Lane.CLUSTER  # its workers have other disks
        return super()._carry_out(self.prepared(asked) if here else asked, progress, watch)

    def begin(self, asked: Question) -> None:
        """Ask this, in place of what is under way."""
        self.accepted = None
        super().begin(asked)

    def follow(self, asked: Question) -> None:
        """Ask this once it has been wanted for a moment, unless its answer is there or under way."""
        if asked not in (self.under_way, self.asked):
            self._submit(asked, None)

    def beside(self, asked: Question) -> Any:
        """Answer to exactly this question; None where there is none."""
        return self.result if self.asked == asked else None

    def leave(self, scenario: Scenario) -> None:
        """Stop what is asked of another scenario than this one, which is the session's now."""
        self.words = ()
        asked = self.under_way
        if asked is not None and asked.scenario != scenario:
            self.cancel(CHANGED)

    def accept(self, scenario: Scenario) -> None:
        """Note that the answer has been taken over into this scenario."""
        self.accepted = scenario
        self._tell()

    def forget(self) -> None:
        """Drop the answer."""
        self.accepted = None
        super().forget()

    def discard(self) -> None:
        """Forget the answer, and let the pages know."""
        self.forget()
        self._tell()

    def _refused(self, error: InputError) -> tuple[str, ...]:
        return refusals(error, self.question)


def answered(question: Question, progress: Progress, cancelled: Cancelled) -> Answer:
    """Answer a question; a helper and a cluster find this function by its name."""
    return question.answer(progress, cancelled)

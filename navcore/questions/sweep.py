"""Sweep: a study of one factor at a time: latitude, error of the log, sensor grade, sea."""

from collections.abc import Iterable
from typing import TYPE_CHECKING, ClassVar, Literal

from navcore.foundation.errors import Fault, StoppedError
from navcore.foundation.text import Text
from navcore.questions.base import Cancelled, Progress, Question, option

if TYPE_CHECKING:
    from navcore.study.sweep import Sweeps

Swept = Literal["latitude", "log_bias", "grade", "sea"]


class SweepQuestion(Question):
    """A scenario's run with one quantity varied at a time."""

    title: ClassVar[str] = Text("Sweep")
    help: ClassVar[str] = Text(
        "Run all methods at some latitudes, constant errors of the log, multiples of all sensor errors, and "
        "wave heights, one of them varied at a time."
    )
    stopped: ClassVar[str] = Text("Stopped: the rest is not swept.")
    example: ClassVar[str] = """\
>>> from navcore import load, sweep
>>> found = sweep(load("zha-fast", ["run.duration_h=0.1"]), ["log_bias"])
>>> found.found["log_bias"].values
(0.0, 0.1, 0.2, 0.5, 1.0)"""
    apart: ClassVar[bool] = True
    id: Literal["sweep"] = "sweep"
    over: tuple[Swept, ...] = option(
        ("latitude", "log_bias", "grade", "sea"),
        label=Text("over"),
        metavar="QUANTITY",
        help=Text("What is varied; by default each."),
    )

    def refusals(self) -> Iterable[str]:
        """Give methods that the scenario, or a value of what is swept, refuses."""
        from navcore.study.sweep import refusals

        return (*super().refusals(), *refusals(self.scenario, self.over))

    def answer(self, progress: Progress | None = None, cancelled: Cancelled | None = None) -> "Sweeps":
        """Sweep."""
        from navcore.study.sweep import sweeps

        found = sweeps(self.scenario, self.over, progress, cancelled)
        if found.stopped and not found.found:
            raise StoppedError(Fault("", "", None, Text("stopped before a quantity was swept")))
        return found

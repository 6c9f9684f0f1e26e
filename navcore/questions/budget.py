"""Budget: which source an error is made of, and how far it is from the best possible."""

from typing import TYPE_CHECKING, ClassVar, Literal

from navcore.foundation.parameters import quantity
from navcore.foundation.text import Text
from navcore.questions.base import Cancelled, Progress, Question, option, unless_stopped

if TYPE_CHECKING:
    from navcore.design.result import Budget


class BudgetQuestion(Question):
    """Which sources make the errors of each method, beside the floor."""

    title: ClassVar[str] = Text("Budget")
    help: ClassVar[str] = Text(
        "Error budget of every method by source, beside the floor that no damping can get below."
    )
    keeps: ClassVar[bool] = False
    stopped: ClassVar[str] = Text("Stopped: no budget.")
    example: ClassVar[str] = """\
>>> from navcore import budget, load
>>> found = budget(load("sikuliaq-like"), steady=True)
>>> found.floor.rms.tilt_rad < found.methods[1].total.rms.tilt_rad
True"""
    id: Literal["budget"] = "budget"
    steady: bool = option(
        False,
        label=Text("steady state"),
        help=Text("One level channel at rest in the steady state, in place of the scenario's own run."),
    )
    seeds: int = quantity(
        24,
        ge=2,
        le=10_000,
        label=Text("seeds"),
        help=Text("Runs of a method that has no covariance; of no use in the steady state."),
    )

    def answer(self, progress: Progress | None = None, cancelled: Cancelled | None = None) -> "Budget":
        """Compute the budget."""
        from navcore.design.budget import budget

        found = budget(self.scenario, self.steady, seeds=self.seeds, progress=progress, cancelled=cancelled)
        unless_stopped(cancelled)
        return found

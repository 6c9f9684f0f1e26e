"""Verify: the linear model beside the full strapdown, on the same noise."""

from typing import TYPE_CHECKING, ClassVar, Literal

from navcore.foundation.parameters import quantity
from navcore.foundation.text import Text
from navcore.questions.base import Cancelled, Progress, Question

if TYPE_CHECKING:
    from navcore.engine.verification import Verification


class VerifyQuestion(Question):
    """How far the linear model is from the full strapdown."""

    title: ClassVar[str] = Text("Verify")
    help: ClassVar[str] = Text(
        "Run a scenario as full strapdown and as linear error model on the same noise, and compare them."
    )
    keeps: ClassVar[bool] = False
    stopped: ClassVar[str] = Text("Stopped: nothing was verified.")
    example: ClassVar[str] = """\
>>> from navcore import load, verify
>>> found = verify(load("sikuliaq-like", ["run.duration_h=0.1", "run.rate_hz=10"]), seeds=1)
>>> found.complete, len(found.differences)
(True, 3)"""
    id: Literal["verify"] = "verify"
    seeds: int = quantity(
        4,
        ge=1,
        le=1000,
        label=Text("seeds"),
        help=Text("Seeds over which the difference is held against the methods' own level."),
    )

    def answer(self, progress: Progress | None = None, cancelled: Cancelled | None = None) -> "Verification":
        """Run both."""
        from navcore.engine.verification import verify

        return verify(self.scenario, progress, cancelled, self.seeds)

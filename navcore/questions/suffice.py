"""Suffice: which gyro bias and which log bias still meet the limits, and which parts of the list do."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar, Literal

from navcore.foundation.parameters import quantity
from navcore.foundation.text import Text
from navcore.questions.base import Cancelled, Progress, Question

if TYPE_CHECKING:
    from navcore.design.suffice import Sufficing


class SufficeQuestion(Question):
    """Which sensors suffice."""

    title: ClassVar[str] = Text("Sensors that suffice")
    help: ClassVar[str] = Text(
        "Find the gyro bias and the log bias with which a method still meets the scenario's limits, and the "
        "parts of the list that fall in that family."
    )
    stopped: ClassVar[str] = Text("Stopped: no family.")
    keeps: ClassVar[bool] = False
    example: ClassVar[str] = """\
>>> from navcore import load, suffice
>>> limit = "requirement=[{quantity='velocity_max_mps', at_most=1}]"
>>> found = suffice(load("zha-fast", ["run.duration_h=0.5", limit]), method=1, seeds=8)
>>> found.method, found.family[0][0], found.family[-1][1]
('classic2', 0.0, 0.0)"""
    id: Literal["suffice"] = "suffice"
    method: int = quantity(
        0, ge=0, le=1000, label=Text("method"), help=Text("Which method of the scenario, from 0.")
    )
    share: float = quantity(
        0.9,
        gt=0.0,
        le=1.0,
        slider=(0.5, 1.0),
        label=Text("share"),
        help=Text("Part of the seeds that must meet all limits."),
    )
    seeds: int = quantity(
        200, ge=4, le=10_000, label=Text("seeds"), help=Text("Runs for each pair of biases, the same seeds.")
    )

    def answer(self, progress: Progress | None = None, cancelled: Cancelled | None = None) -> Sufficing:
        """Search."""
        from navcore.design.suffice import suffice

        return suffice(self.scenario, self.method, self.share, self.seeds, progress, cancelled)

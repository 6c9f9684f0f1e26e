"""Detect: how well each policy finds a log that cannot be trusted."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar, Literal

from navcore.foundation.parameters import quantity
from navcore.foundation.text import Text
from navcore.questions.base import Cancelled, Progress, Question

if TYPE_CHECKING:
    from navcore.design.detector import Detectors


class DetectQuestion(Question):
    """Policies as detectors of a wrong log."""

    title: ClassVar[str] = Text("Detectors")
    help: ClassVar[str] = Text(
        "Judge each policy as a detector of a wrong log over several seeds: missed events, false switches, "
        "delay, and its ROC as its thresholds grow."
    )
    keeps: ClassVar[bool] = False
    example: ClassVar[str] = """\
>>> from navcore import detect
>>> found = detect("liu-switching", seeds=1, points=0)
>>> found.methods[0].policy, found.methods[0].counts.events
('yaw_rate', 16)"""
    id: Literal["detect"] = "detect"
    seeds: int = quantity(
        8, unit="1", ge=1, le=1000, slider=(1, 100), label=Text("seeds"), help=Text("Runs, a seed each.")
    )
    points: int = quantity(
        9,
        unit="1",
        ge=0,
        le=101,
        slider=(0, 41),
        label=Text("points"),
        help=Text("Points of each ROC, with thresholds from a tenth to ten times the set ones; 0: none."),
    )
    wrong_mps: float | None = quantity(
        None,
        unit="m/s",
        gt=0.0,
        le=50.0,
        slider=(0.01, 5.0),
        log=True,
        label=Text("wrong from"),
        help=Text("The log counts as wrong while its error exceeds this. Not given: during its events."),
    )
    after_s: float = quantity(
        120.0,
        unit="s",
        ge=0.0,
        le=86400.0,
        slider=(0.0, 3600.0),
        label=Text("after an event"),
        help=Text("Time after it in which a policy may still keep damping off: it counts for neither side."),
    )

    def answer(self, progress: Progress | None = None, cancelled: Cancelled | None = None) -> Detectors:
        """Run the seeds and count."""
        from navcore.design.detector import detectors

        return detectors(
            self.scenario, self.seeds, self.points, self.wrong_mps, self.after_s, progress, cancelled
        )

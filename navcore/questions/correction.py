"""Correction: what a scenario's recordings do not agree in, and what mending it changes."""

from typing import TYPE_CHECKING, ClassVar, Literal

from navcore.foundation.text import Text
from navcore.questions.base import Cancelled, Progress, Question

if TYPE_CHECKING:
    from navcore.engine.correcting import Tried


class CorrectionQuestion(Question):
    """What the correction of the recordings changes."""

    title: ClassVar[str] = Text("Correction")
    help: ClassVar[str] = Text(
        "Say what the recordings of a scenario do not agree in, and what mending it changes in the errors."
    )
    keeps: ClassVar[bool] = False
    stopped: ClassVar[str] = Text("Stopped: the correction was not tried.")
    example: ClassVar[str] = """\
>>> from navcore import correction
>>> correction("zha-fast").document()["finding"] is None
True"""
    id: Literal["correction"] = "correction"

    def answer(self, progress: Progress | None = None, cancelled: Cancelled | None = None) -> "Tried":
        """Run the scenario as it is and with the correction."""
        from navcore.engine.correcting import tried

        return tried(self.scenario, progress, cancelled)

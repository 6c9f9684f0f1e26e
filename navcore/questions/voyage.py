"""Voyage: a simulated voyage like a recorded one, on which methods can be designed and tuned."""

from typing import TYPE_CHECKING, ClassVar, Literal

from navcore.foundation.answers import Answer
from navcore.foundation.parameters import quantity
from navcore.foundation.text import Text
from navcore.questions.base import Cancelled, Progress, Question, Writes, option, unless_stopped

if TYPE_CHECKING:
    from navcore.fitting.voyage import Voyage


class VoyageQuestion(Question):
    """A voyage like mine."""

    title: ClassVar[str] = Text("Voyage")
    help: ClassVar[str] = Text(
        "Make a simulated voyage like a recorded one: legs fitted to its track and sailed as long as you "
        "like, a log that errs as fitted, an IMU of the list."
    )
    keeps: ClassVar[bool] = False
    writes: ClassVar[Writes] = "file"
    files: ClassVar[tuple[str, ...]] = ("toml",)
    written: ClassVar[str] = Text("the scenario, with all of its numbers")
    stopped: ClassVar[str] = Text("Stopped: no voyage was made.")
    example: ClassVar[str] = """\
>>> from navcore import load, voyage
>>> found = voyage(load("sikuliaq-recorded"), hours=2.0)
>>> found.scenario.motion.kind, found.scenario.run.duration_h
('legs', 2.0)"""
    id: Literal["voyage"] = "voyage"
    hours: float | None = quantity(
        None,
        unit="h",
        gt=0.0,
        le=8760.0,
        label=Text("length"),
        help=Text("The legs are sailed again and again for so long; as long as the recording if not given."),
    )
    within: float = quantity(
        0.3,
        unit="m/s",
        gt=0.0,
        le=10.0,
        label=Text("legs within"),
        help=Text("RMS of the velocity over ground that the legs may leave out: less of it, more legs."),
    )
    imu: str = option(
        "",
        label=Text("IMU"),
        metavar="PART",
        help=Text("IMU of the list (schuler parts) that rides along; that of the scenario if not given."),
    )

    def answer(self, progress: Progress | None = None, cancelled: Cancelled | None = None) -> "Voyage":
        """Fit the legs and the log."""
        del progress
        from navcore.fitting.voyage import voyage_like

        found = voyage_like(self.scenario, self.hours, self.within, self.imu)
        unless_stopped(cancelled)
        return found

    def texts(self, answer: Answer) -> dict[str, str]:
        """Return the scenario."""
        return {"toml": vars(type(answer))["text"].fget(answer)}

"""Fit: the error model of a recorded log beside its track, or of a standing IMU."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, ClassVar, Literal

from navcore.foundation.answers import Answer
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.questions.base import Cancelled, Progress, Question, option

if TYPE_CHECKING:
    from navcore.fitting.imu import FittedImu
    from navcore.fitting.recorded import FittedLog
    from navcore.scenario.model import Scenario

_TRACKED = "map", "track_map", "speed"


class FitQuestion(Question):
    """How a recorded log or a standing IMU errs."""

    title: ClassVar[str] = Text("Fit")
    help: ClassVar[str] = Text(
        "Fit the errors of a recorded log beside a recorded track, or of a standing IMU, with 95 % intervals."
    )
    subject: ClassVar[str] = "recording"
    takes: ClassVar[str] = "str"
    keeps: ClassVar[bool] = False
    writes: ClassVar = "file"
    place: ClassVar[str] = "scenario"
    files: ClassVar = ("toml",)
    written: ClassVar[str] = Text("the block [reference] or [imu] with the fitted values")
    stopped: ClassVar[str] = Text("Stopped: nothing was fitted.")
    example: ClassVar[str] = """\
>>> from navcore import fit
>>> from navcore.foundation.assets import asset_path
>>> log, track = (str(asset_path("recordings") / f"sikuliaq-{name}.csv") for name in ("log", "track"))
>>> found = fit(log, track=[track], speed="ground")
>>> found.speed, len(found.document()["log"]["bias_mps"])
('ground', 2)"""
    id: Literal["fit"] = "fit"
    recording: str = option(..., metavar="FILE", help=Text("Recorded log, or IMU at rest."))
    scenario: Any = option(None, hidden=True)
    track: tuple[str, ...] = option(
        (),
        label=Text("track"),
        metavar="TRACK",
        help=Text("Positions and heading recorded with a log; several files are joined by UTC."),
    )
    speed: Literal["water", "ground"] = option(
        "water", label=Text("speed"), help=Text("Which speed of the log is fitted, where it gives both.")
    )
    map: str | None = option(None, metavar="MAP.toml", help=Text("What the columns of the recording mean."))
    track_map: str | None = option(None, metavar="MAP.toml", help=Text("What the columns of the track mean."))

    @property
    def load(self) -> "Scenario":
        """An empty scenario: a fit takes seconds."""
        from navcore.scenario.model import Scenario

        return Scenario()

    def recordings(self) -> list[str]:
        """Return the files that it reads."""
        return [one for one in (self.recording, *self.track, self.map, self.track_map) if one]

    def answer(
        self, progress: Progress | None = None, cancelled: Cancelled | None = None
    ) -> "FittedLog | FittedImu":
        """Read the files, and fit."""
        del progress, cancelled
        from navcore.checks.imu import is_imu

        if is_imu(self.recording, self.map):
            return self._imu()
        if not self.track:
            allowed = Text("must name the positions and the heading that were recorded with the log")
            raise InputError(Fault("", "--track", None, allowed))
        from navcore.fitting.recorded import fit_recorded
        from navcore.motion.track import TrackMotion
        from navcore.sensors.reference import Reference

        motion = TrackMotion(file=self.track, map=self.track_map)
        reference = Reference(kind="file", file=self.recording, map=self.map, speed=self.speed)
        try:
            return fit_recorded(motion, reference)
        except InputError as error:
            raise InputError(_by_option(fault) for fault in error.faults) from None

    def _imu(self) -> "FittedImu":
        from navcore.fitting.imu import fit_imu
        from navcore.io.column_map import read_map
        from navcore.sensors.recorded_imu import read_imu

        if self.track:
            allowed = Text("does not go with an IMU, which is fitted at rest")
            raise InputError(Fault("", "--track", self.track[0], allowed))
        return fit_imu(read_imu(self.recording, column_map=None if self.map is None else read_map(self.map)))

    def texts(self, answer: Answer) -> dict[str, str]:
        """Return the block of a scenario, with where it comes from."""
        from navcore.scenario.file import blocks_to_toml

        source = ", ".join((self.recording, *self.track))
        blocks: Mapping[str, Any] = vars(type(answer))["blocks"](answer)
        return {"toml": blocks_to_toml({"source": f"fit of {source}", **blocks})}


def _by_option(fault: Fault) -> Fault:
    """Name a fault by the option of the command."""
    from dataclasses import replace

    options = {"reference.file": "RECORDING", "motion.file": "--track", "reference.map": "--map", "file": ""}
    return replace(fault, field=options.get(fault.field, fault.field))

"""Blocks ``ins`` and ``truth``: the output of a ship's own INS, and what it is held against."""

from typing import Literal

from pydantic import Field

from navcore.foundation.parameters import FileName, Parameters, choice, quantity
from navcore.foundation.text import Text
from navcore.io.column_map import map_field
from navcore.motion.ins_track import InsTrack
from navcore.scenario.method import Method

AS_RECORDED = Text("as recorded")
"""Name of the INS's own output among the methods of a run."""
REPLACED = ("motion", "imu", "initial_error")
"""Blocks whose place ``[ins]`` takes."""
_CLOCK_HELP = Text("Added to the times of the recording, whose logger has a clock of its own.")


class Ins(Parameters):
    """Block ``ins``: the recorded output of the ship's own INS, which is damped from outside.

    It takes the place of ``motion``, ``imu`` and ``initial_error``: a damped solution differs from the output
    by what the law's corrections do, and no error of the INS's sensors is in that difference (theory.md 22).
    t = 0 is the first epoch that the output and the log share; damping is switched on there.
    """

    file: FileName | tuple[FileName, ...] | None = Field(
        default=None,
        description=Text(
            "Output of the INS: positions, velocity and heading, in any format that `schuler check` reads. "
            "Several files are joined by UTC."
        ),
        json_schema_extra={"label": Text("INS files")},
    )
    map: FileName | None = map_field()
    clock_s: float = quantity(
        0.0,
        unit="s",
        ge=-86400.0,
        le=86400.0,
        slider=(-120.0, 120.0),
        label=Text("clock correction of the INS"),
        help=_CLOCK_HELP,
    )
    jumps: Literal["refuse", "skip", "split"] = choice(
        "refuse",
        help=Text(
            "Where the position steps, as where a fix is given to the INS. refuse: say so; skip: the steps "
            "are taken out of the positions; split: the longest piece without a step is used."
        ),
    )
    damping: Method = Field(
        default_factory=Method,
        description=Text(
            "Block [ins.damping], as a [[method]]: how the INS itself was damped when it was recorded. What "
            "its own law did is taken off, before the methods are laid on. Default: it ran free."
        ),
    )

    def track(self) -> InsTrack:
        """Return the output as a motion."""
        return InsTrack(file=self.file, map=self.map, clock_s=self.clock_s, jumps=self.jumps)


class TruthFile(Parameters):
    """Block ``truth``: a better reference, such as GNSS, against which the errors are given.

    Without it the errors of a run on ``[ins]`` are what damping changes: damped minus recorded.
    """

    file: FileName | tuple[FileName, ...] | None = Field(
        default=None,
        description=Text(
            "Positions, and velocity, heading, pitch and roll where the reference has them. What it does not "
            "hold is left out of the errors."
        ),
        json_schema_extra={"label": Text("reference files")},
    )
    map: FileName | None = map_field()
    clock_s: float = quantity(
        0.0,
        unit="s",
        ge=-86400.0,
        le=86400.0,
        slider=(-120.0, 120.0),
        label=Text("clock correction of the reference"),
        help=_CLOCK_HELP,
    )

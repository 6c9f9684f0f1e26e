"""Corrections of a scenario's recordings: what does not agree, and the field that mends it."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

from navcore.foundation.stage_cache import kept, recorded_state
from navcore.foundation.text import Text
from navcore.io.agreement import Finding, findings
from navcore.motion.track import TrackMotion
from navcore.sensors.log_files import log_recording

if TYPE_CHECKING:
    from navcore.motion.base import MotionParameters
    from navcore.sensors.reference import Reference

_DIGITS = 4
"""Of a factor; times are given to 0.1 s."""
Field = tuple[str, str]
"""Block and field of the scenario."""


class Correction(NamedTuple):
    """Disagreement of recordings, and the value of the scenario that mends it.

    Attributes
    ----------
    finding : str
        What does not agree.
    field : tuple of str, or None
        Block and field that mend it; None where none does.
    value : float
        To be given to the field; what it holds already is included.
    """

    finding: str
    field: Field | None = None
    value: float = 0.0

    @property
    def line(self) -> str:
        """The correction as a line of the scenario: ``reference.clock_s = -79``."""
        if self.field is None:
            return ""
        return Text("{block}.{field} = {value:g}", block=self.field[0], field=self.field[1], value=self.value)

    @property
    def notice(self) -> str:
        """The finding with its correction."""
        if self.field is None:
            return self.finding
        return Text("{finding} ({line})", finding=self.finding, line=self.line)


def corrections(motion: MotionParameters, reference: Reference) -> tuple[Correction, ...]:
    """Find what of a track and its log does not agree, and which value mends it.

    Parameters
    ----------
    motion : MotionParameters
        With a recorded track; else nothing is found.
    reference : Reference
        With ``kind = "file"``; else the track alone is looked at.

    Raises
    ------
    InputError
        A file is missing or wrong.
    """
    if not isinstance(motion, TrackMotion):
        return ()
    states = recorded_state(motion), recorded_state(reference)
    key = "corrections", *states, motion.heading_clock_s, reference.kind, reference.clock_s, reference.factor
    return kept(key, lambda: _made(motion, reference))


def _made(motion: TrackMotion, reference: Reference) -> tuple[Correction, ...]:
    recording = motion.streams().recording
    if reference.kind == "file":
        recording = replace(recording, water=log_recording(reference).water)
    return tuple(_correction(found, motion, reference) for found in findings(recording))


def _correction(found: Finding, motion: TrackMotion, reference: Reference) -> Correction:
    if found.stream == "heading":
        return Correction(
            found.text, ("motion", "heading_clock_s"), round(motion.heading_clock_s - found.late_s, 1)
        )
    if reference.kind == "file" and found.late_s:
        return Correction(found.text, ("reference", "clock_s"), round(reference.clock_s - found.late_s, 1))
    if reference.kind == "file" and found.factor != 1.0:
        return Correction(
            found.text, ("reference", "factor"), round(reference.factor * found.factor, _DIGITS)
        )
    return Correction(found.text)

"""Motion of a scenario on the output of a ship's own INS: the track that it believes in (theory.md 22)."""

from collections.abc import Iterator
from dataclasses import replace
from typing import ClassVar, Literal

import numpy as np

from navcore.foundation.earth import WGS84
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.stage_cache import kept, recorded_state
from navcore.foundation.text import Text
from navcore.io.jumps import Jump, jumps_of
from navcore.io.recording import load
from navcore.io.series import Recording, Series
from navcore.io.times.doubts import span_text
from navcore.motion.base import Streams
from navcore.motion.track import TrackMotion, position_of

LONGEST_INTERVAL_S = 20.0
"""Between the positions of an INS, s: the turns of a ship are lost in longer ones."""
_MOST_NAMED = 5
Jumps = Literal["refuse", "skip", "split"]


class InsTrack(TrackMotion):
    """The output of an INS as a motion: the errors of damping are computed along it.

    A step of the position, as a fix gives it to an INS, is refused, taken out of all positions after it
    (``skip``), or the longest piece without one is taken (``split``). Without a heading the course stands
    for it.
    """

    block: ClassVar[str] = "ins"
    carries_recorded_imu: ClassVar[bool] = False
    smoothing_s: float = 2.0
    clock_s: float = 0.0
    jumps: Jumps = "refuse"

    def recording(self) -> Recording:
        """Files of the INS's output, by its clock put right; raises `InputError` with field ``file``."""
        key = "ins", recorded_state(self), self.clock_s, self.jumps
        return kept(key, self._recording)

    def _recording(self) -> Recording:
        recording = load(self.file or (), field="file", map_file=self.map)
        streams = {name: one.shifted(self.clock_s) for name, one in recording.quantities().items()}
        apart = {name: one.shifted(self.clock_s) for name, one in recording.deviations.items()}
        recording = replace(recording, **streams, deviations=apart)
        position = position_of(recording, self.file)
        if position.interval_s > LONGEST_INTERVAL_S:
            raise InputError(Fault("", "file", self.file, _too_slow(position)))
        found = jumps_of(position, recording.velocity)
        if not found:
            return recording
        if self.jumps == "refuse":
            raise InputError(Fault("", "file", self.file, _named(position, found)))
        if self.jumps == "split":
            return _longest_piece(recording, found)
        if any(jump.velocity_mps for jump in found):
            velocity = next(jump for jump in found if jump.velocity_mps)
            told = Text(
                'must be "split": the velocity steps too ({jump}), and what the INS would have given without '
                "that is not known",
                jump=velocity.text,
            )
            raise InputError(Fault("", "jumps", self.jumps, told))
        return replace(recording, position=_without(position, found))

    @property
    def has_heading(self) -> bool:
        """Whether the output holds a heading; raises `InputError` when it cannot be read."""
        return self.recording().heading is not None

    def streams(self) -> Streams:
        """Positions and angles; without a heading the course over ground in its place."""
        recording = self.recording()
        position = position_of(recording, self.file)
        heading = recording.heading
        if heading is None:
            heading = kept(
                ("course of ins", recorded_state(self), self.clock_s, self.jumps), lambda: course_of(position)
            )
        return Streams(recording, position, heading, recording.attitude)

    def notices(self) -> Iterator[str]:
        """Yield also what was made of jumps, and what stands for a velocity or a heading that is missing."""
        yield from super().notices()
        recording = self.recording()
        if self.jumps != "refuse":
            whole = load(self.file or (), field="file", map_file=self.map)
            found = jumps_of(position_of(whole, self.file), whole.velocity)
            if found:
                yield _made_of(found, self.jumps)
        if recording.velocity is None:
            yield Text("the INS's output holds positions only: its velocity is their rate of change")
        if recording.heading is None:
            yield Text(
                "the INS's output holds no heading: the course over ground stands for it, and no heading is "
                "given out"
            )


def _too_slow(position: Series) -> Text:
    return Text(
        "{source}: one position every {interval:.3g} s ({rate:.2g} Hz) is too slow: the motion of the ship "
        "within a Schuler oscillation is not in it. At least {least:g} Hz are needed; record 1 Hz",
        source=position.source,
        interval=position.interval_s,
        rate=1.0 / position.interval_s,
        least=1.0 / LONGEST_INTERVAL_S,
    )


def _named(position: Series, found: tuple[Jump, ...]) -> Text:
    return Text(
        "{source}: the output jumps ({jumps}) as where a fix is given to an INS: leave the fixes out with "
        'ins.jumps = "skip", or take the longest piece without one with ins.jumps = "split"',
        source=position.source,
        jumps=_listed(found),
    )


def _listed(found: tuple[Jump, ...]) -> Text:
    named = Text.joined("; ", (jump.text for jump in found[:_MOST_NAMED]))
    more = len(found) - _MOST_NAMED
    return Text("{named}; and {more} more", named=named, more=more) if more > 0 else named


def _made_of(found: tuple[Jump, ...], jumps: Jumps) -> Text:
    if jumps == "skip":
        return Text("fixes are left out of the INS's positions: {jumps}", jumps=_listed(found))
    return Text("the longest piece between the INS's jumps is used: {jumps}", jumps=_listed(found))


def _without(position: Series, found: tuple[Jump, ...]) -> Series:
    """Positions as they would be without the steps."""
    values = position.values.copy()
    for jump in found:
        values[jump.at :, :2] -= jump.angles
    return replace(position, values=values)


def _longest_piece(recording: Recording, found: tuple[Jump, ...]) -> Recording:
    position = recording.position
    assert position is not None
    edges = [position.time_s[0], *(jump.time_s for jump in found), np.inf]
    ends = [*(position.time_s[jump.at - 1] for jump in found), position.time_s[-1]]
    begin, end = max(zip(edges[:-1], ends, strict=True), key=lambda piece: piece[1] - piece[0])
    if end - begin <= 0.0:
        raise InputError(Fault("", "jumps", "split", Text("no two positions without a jump between them")))

    def cut(series: Series) -> Series:
        within = (series.time_s >= begin - 1e-6) & (series.time_s <= end + 1e-6)
        if not np.any(within):
            piece = span_text(float(end - begin))
            told = Text("{source}: nothing within the piece of {piece}", source=series.source, piece=piece)
            raise InputError(Fault("", "jumps", "split", told))
        parts = (array[within].copy() for array in (series.time_s, series.values, series.valid))
        time_s, values, valid = parts
        return replace(series, time_s=time_s, values=values, valid=valid)

    return replace(recording, **{name: cut(one) for name, one in recording.quantities().items()})


def course_of(position: Series) -> Series:
    """Course over ground of positions, from the two beside each."""
    lat, lon = position.values[:, 0], np.unwrap(position.values[:, 1])
    meridian, prime_vertical = WGS84.radii(float(np.median(lat)))
    north = np.gradient(lat * meridian, position.time_s)
    east = np.gradient(lon, position.time_s) * prime_vertical * np.cos(lat)
    course = np.mod(np.arctan2(east, north), 2.0 * np.pi)[:, None]
    what = Text("course of {what}", what=position.what)
    return replace(
        position, values=course, valid=position.valid.copy(), time_s=position.time_s.copy(), what=what
    )

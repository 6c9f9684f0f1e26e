"""Motion of an INS that is heard as it comes: the newest part of its track, smoothed as the whole is."""

from dataclasses import replace
from typing import ClassVar

import numpy as np
from pydantic import PrivateAttr

from navcore.foundation.earth import Earth
from navcore.foundation.text import Text
from navcore.io.series import Recording, Series
from navcore.motion.base import Streams
from navcore.motion.filling import sample
from navcore.motion.ins_track import InsTrack, course_of
from navcore.motion.track import in_metres, outliers, position_of, smooth_streams
from navcore.motion.truth import Truth

SETTLES_S = 20.0
"""The smoothing does not feel what lies farther away than this, s."""


class HeardTrack(InsTrack):
    """The part of an INS's output that is at hand; a fix far off its neighbours is left out.

    Attributes
    ----------
    left_out_s : ndarray, shape (n,)
        UTC of the fixes that were left out, s.
    """

    carries_recorded_imu: ClassVar[bool] = False
    _heard: Recording = PrivateAttr()
    _left_out: np.ndarray = PrivateAttr()

    @classmethod
    def of(cls, heard: Recording) -> "HeardTrack":
        """Make the motion of what was heard; raises `InputError` where it holds no position."""
        track = cls()
        position, track._left_out = _without_outliers(position_of(heard, Text("what is heard")))
        track._heard = replace(heard, position=position)
        return track

    @property
    def left_out_s(self) -> np.ndarray:
        """UTC of the fixes that were left out, s."""
        return self._left_out

    def recording(self) -> Recording:
        """Return what was heard."""
        return self._heard

    def streams(self) -> Streams:
        """Positions and angles; without a heading the course over ground in its place."""
        heard = self._heard
        position = position_of(heard, Text("what is heard"))
        return Streams(heard, position, heard.heading or course_of(position), heard.attitude)

    def between(self, start_s: float, steps: int, step_s: float, earth: Earth) -> Truth:
        """Return the motion from a time on.

        Parameters
        ----------
        start_s : float
            UTC of the first row, s.
        steps : int
            Steps of ``step_s``; rows stand at half steps.
        step_s : float
            Length of a step, s.
        earth : Earth
            Gives the radii of curvature.
        """
        count, half_s = 2 * steps + 1, 0.5 * step_s
        track = smooth_streams(self.streams(), (), self.smoothing_s)
        along = self._kinematics(track, start_s, np.arange(count) * half_s)
        return Truth(half_s, sample(along, count, half_s, earth))


def _without_outliers(position: Series) -> tuple[Series, np.ndarray]:
    if position.time_s.size < 3:
        return position, np.empty(0)
    places, _ = outliers(position, in_metres(position)[2])
    if not places.size:
        return position, np.empty(0)
    kept = np.ones(position.time_s.size, bool)
    kept[places] = False
    parts = (array[kept].copy() for array in (position.time_s, position.values, position.valid))
    time_s, values, valid = parts
    return replace(position, time_s=time_s, values=values, valid=valid), position.time_s[places]

"""A recorded log beside the track that was recorded with it."""

from dataclasses import dataclass

import numpy as np

from navcore.foundation.earth import WGS84
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.motion.track import TrackMotion
from navcore.motion.truth import Site, Truth
from navcore.sensors.log_files import log_recording, log_series
from navcore.sensors.recorded import recorded_window
from navcore.sensors.reference import Reference
from navcore.sensors.true_state import horizontal_state, to_ship

_GRID_STEP_S = 0.5


@dataclass(frozen=True)
class LogAlongTrack:
    """A recorded log and the true motion it belongs to.

    Attributes
    ----------
    time_s : ndarray, shape (m,)
        Epochs of the log after t = 0, those called valid by the log only.
    reading : ndarray, shape (m, 2)
        Starboard, forward speed, m/s.
    truth : Truth
        Motion over the time that log and track share.
    """

    time_s: np.ndarray
    reading: np.ndarray
    truth: Truth

    @property
    def end_s(self) -> float:
        """End of the motion, s."""
        return (len(self.truth.values) - 1) * self.truth.step_s

    def known(self, late_s: float) -> np.ndarray:
        """Whether the motion is known ``late_s`` before each epoch, shape (m,)."""
        if self.truth.constant:
            return np.ones(self.time_s.size, dtype=bool)
        return (self.time_s >= late_s) & (self.time_s - late_s <= self.end_s)

    def error(self, late_s: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
        """Times (n,), and reading minus true velocity along the ship's axes ``late_s`` earlier (n, 2)."""
        known = self.known(late_s)
        velocity, heading = horizontal_state(self.truth, self.time_s[known] - late_s)
        return self.time_s[known], self.reading[known] - to_ship(velocity, heading)


def log_along_track(reference: Reference, track: TrackMotion) -> LogAlongTrack:
    """Put a recorded log beside the track recorded with it.

    Parameters
    ----------
    reference : Reference
        With ``kind = "file"``; its ``speed`` says which speed of the log is meant.
    track : TrackMotion
        Positions and heading of the same time.

    Raises
    ------
    InputError
        A file is missing or wrong, they share no time, or the log does not measure along the ship's axes.
    """
    series, along_axes = log_series(reference, log_recording(reference))
    window = recorded_window(track, reference)
    if not along_axes or window is None:
        allowed = Text("needs speeds along the ship's axes (VBW, VHW or speed columns)")
        raise InputError(Fault("", "reference.file", reference.file, allowed))
    count = int(window.span_s / _GRID_STEP_S) + 1
    truth = track.truth(count, _GRID_STEP_S, Site(0.0, 0.0, 0.0), WGS84, start_utc=window.start_s)
    elapsed = series.time_s - window.start_s
    within = series.valid & (elapsed >= 0.0) & (elapsed <= (count - 1) * _GRID_STEP_S)
    return LogAlongTrack(elapsed[within], series.values[within], truth)

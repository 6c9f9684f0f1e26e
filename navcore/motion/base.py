"""Base of the motions: the vehicle's true state on a uniform time grid."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from navcore.foundation.earth import Earth
from navcore.foundation.registry import Entry
from navcore.motion.kinematics import Kinematics
from navcore.motion.truth import Site, Truth

if TYPE_CHECKING:
    from navcore.io.recording import Recording
    from navcore.io.series import Series


@dataclass(frozen=True)
class Streams:
    """Streams that a motion takes from a recording: positions, heading, and pitch and roll if recorded.

    Attributes
    ----------
    recording : Recording
        What the files hold, with the reader's warnings.
    position, heading : Series
    attitude : Series or None
    """

    recording: Recording
    position: Series
    heading: Series
    attitude: Series | None

    def series(self) -> list[Series]:
        """All streams there are."""
        return [s for s in (self.position, self.heading, self.attitude) if s is not None]


class MotionParameters(Entry, ABC):
    """Base of the motion blocks of a scenario; subclasses narrow ``kind`` to a Literal.

    A motion says all that the other rooms ask of it: `truth` and `kinematics` give the same motion on a grid
    and at any time, `before_start` what the vehicle does during an alignment, `frequencies` how fast it
    moves. `navcore.motion.sampled.SampledMotion` answers all four from one function of time.

    Attributes
    ----------
    recorded : bool
        The motion is read from files: `streams` gives what they hold.
    carries_recorded_imu : bool
        The motion can stand beside a recorded IMU, whose own motion is not known.
    block : str
        Block of the scenario that its faults name.
    """

    recorded: ClassVar[bool] = False
    carries_recorded_imu: ClassVar[bool] = False
    block: ClassVar[str] = "motion"
    kind: Any  # a Literal in each subclass

    @property
    def dives(self) -> bool:
        """Whether the vehicle leaves the height of the site for a depth."""
        return False

    @abstractmethod
    def truth(
        self, count: int, step_s: float, site: Site, earth: Earth, start_utc: float | None = None
    ) -> Truth:
        """Return the true motion at ``count`` times 0, step_s, ...; shape (count, 15) or (1, 15).

        Parameters
        ----------
        count : int
            Number of times.
        step_s : float
            Their interval, s.
        site : Site
            Where the motion starts.
        earth : Earth
            WGS-84 or the sphere.
        start_utc : float, optional
            UTC (s) of t = 0 of a recorded motion; default: the first epoch that its streams share.

        Raises
        ------
        InputError
            The motion cannot be carried out (field names relative to the motion block).
        """

    @abstractmethod
    def kinematics(
        self, end_s: float, site: Site, earth: Earth, start_utc: float | None = None
    ) -> Kinematics:
        """Return the motion up to ``end_s`` as compiled loops read it, at any time and step.

        Parameters
        ----------
        end_s : float
            Last time that will be asked for, s.
        site, earth
            As of `truth`.
        start_utc : float, optional
            As of `truth`.

        Raises
        ------
        InputError
            The motion cannot be carried out.
        """

    @abstractmethod
    def before_start(self, true_row: np.ndarray, duration_s: float) -> MotionParameters:
        """Return the motion during an alignment, which ends at t = 0: that of a vehicle that does not travel.

        Parameters
        ----------
        true_row : ndarray, shape (15,)
            True state at t = 0.
        duration_s : float
            Length of the alignment, s.
        """

    def frequencies(self) -> Iterator[tuple[str, float]]:
        """Yield what moves, by the field that sets it, and its frequency (Hz): an IMU must sample it."""
        yield from ()

    def streams(self) -> Streams | None:
        """Return what the motion takes from a recording; None for a motion that is not recorded.

        Raises
        ------
        InputError
            The recording cannot be read (field names relative to the motion block).
        """
        return None

    def notices(self) -> Iterator[str]:
        """Yield what the user should know about a recording and the settings that it leaves unused."""
        yield from ()

    def ending(self, end_s: float) -> Iterator[str]:
        """Yield what the vehicle does once a motion that is shorter than the run is over.

        Parameters
        ----------
        end_s : float
            End of the run, s.
        """
        yield from ()

    def rows(
        self, count: int, step_s: float, site: Site, earth: Earth, start_utc: float | None = None
    ) -> np.ndarray:
        """Rows of `truth` whatever the step: for one who looks at the motion without integrating over it."""
        return self.truth(count, step_s, site, earth, start_utc).values

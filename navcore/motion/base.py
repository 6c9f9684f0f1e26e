"""What every motion gives: the vehicle's true state on a uniform time grid."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from navcore.earth import Earth
from navcore.parameters import Parameters

if TYPE_CHECKING:
    from navcore.motion.kinematics import Kinematics

# Columns of Truth.values.
LAT, LON, HEIGHT, VE, VN, VU, AE, AN, AU, PITCH, ROLL, HEADING, PITCH_RATE, ROLL_RATE, HEADING_RATE = range(
    15
)
COLUMNS = 15


@dataclass(frozen=True)
class Site:
    """Where the motion starts: latitude and longitude in rad, height in m."""

    lat: float
    lon: float
    height: float


@dataclass(frozen=True)
class Truth:
    """True trajectory and attitude at t = k * step_s.

    Attributes
    ----------
    step_s : float
        Grid step, s.
    values : ndarray, shape (n, 15), or (1, 15) when nothing changes
        Columns: latitude, longitude (rad), height (m), velocity E, N, U (m/s), its time derivative (m/s^2),
        pitch, roll, heading (rad, heading not wrapped) and their rates (rad/s).
    """

    step_s: float
    values: np.ndarray

    @property
    def constant(self) -> bool:
        """True when one row stands for all times."""
        return self.values.shape[0] == 1

    def column(self, index: int) -> np.ndarray:
        """One column as a view, shape (n,) or (1,)."""
        return self.values[:, index]


class MotionParameters(Parameters, ABC):
    """Base of the motion blocks of a scenario; subclasses narrow ``kind`` to a Literal."""

    kind: Any  # a Literal in each subclass

    @abstractmethod
    def truth(self, count: int, step_s: float, site: Site, earth: Earth) -> Truth:
        """Return the true motion at ``count`` times 0, step_s, ...; shape (count, 15) or (1, 15).

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
            UTC (s) of t = 0 of a recorded motion; default: the first epoch that its streams share.

        Raises
        ------
        InputError
            The motion cannot be carried out.
        """

    def rows(
        self, count: int, step_s: float, site: Site, earth: Earth, start_utc: float | None = None
    ) -> np.ndarray:
        """Rows of `truth` whatever the step: for one who looks at the motion without integrating over it."""
        del start_utc
        return self.truth(count, step_s, site, earth).values

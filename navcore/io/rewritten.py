"""What damping changes in a recording, by the time of each reading, and the readings with it."""

import math
import re
from dataclasses import dataclass
from typing import Any

import numpy as np

_NUMBER = re.compile(r"([+-]?)(\d*)(?:\.(\d*))?")


@dataclass(frozen=True)
class Moved:
    """Damped minus recorded, over time.

    Attributes
    ----------
    time_s : ndarray, shape (n,)
        By the recording's own clock, s, increasing.
    place : ndarray, shape (n, 2)
        Latitude and longitude, rad.
    velocity : ndarray, shape (n, 2)
        E and N, m/s.
    tilt : ndarray, shape (n, 3)
        phi_E, phi_N, phi_U, rad.
    heading : ndarray, shape (n,)
        As recorded, rad; continuous.
    """

    time_s: np.ndarray
    place: np.ndarray
    velocity: np.ndarray
    tilt: np.ndarray
    heading: np.ndarray

    def at(self, time_s: np.ndarray) -> "Moved":
        """Return the same at other times; zero before the first, for damping is switched on there."""

        def between(values: np.ndarray, before: float) -> np.ndarray:
            columns = values.reshape(len(self.time_s), -1).T
            found = [np.interp(time_s, self.time_s, column) for column in columns]
            found = np.column_stack(found).reshape(len(time_s), *values.shape[1:])
            if math.isfinite(before):
                found[time_s < self.time_s[0]] = before
            return found

        return Moved(
            np.asarray(time_s, float),
            between(self.place, 0.0),
            between(self.velocity, 0.0),
            between(self.tilt, 0.0),
            between(self.heading, math.nan),
        )

    def row(self, place: int) -> "Moved":
        """Return one row of it."""
        chosen = slice(place, place + 1)
        return Moved(
            self.time_s[chosen],
            self.place[chosen],
            self.velocity[chosen],
            self.tilt[chosen],
            self.heading[chosen],
        )

    @property
    def turn(self) -> np.ndarray:
        """Change of the heading, clockwise, rad."""
        return self.tilt[:, 2]

    def leaning(self, pitch: np.ndarray | float = 0.0) -> tuple[np.ndarray, np.ndarray]:
        """Return the changes of pitch (bow up) and roll (starboard down), rad, of a ship of some pitch.

        C_damped = (1 - phi x) C_recorded turns the ship by -phi: about the starboard axis that is pitch,
        about the forward axis roll.
        """
        sine, cosine = np.sin(self.heading), np.cos(self.heading)
        east, north = self.tilt[:, 0], self.tilt[:, 1]
        return -(east * cosine - north * sine), -(east * sine + north * cosine) / np.cos(pitch)


def written_like(text: str, value: float) -> str:
    """Write a number with the sign, the decimals and the width of another one.

    Examples
    --------
    >>> written_like("054.301111", 54.3), written_like("+7.9", -7.93), written_like(" 12", 13.2)
    ('054.300000', '-7.9', ' 13')
    """
    found = _NUMBER.fullmatch(text.strip())
    sign, whole, decimals = found.groups() if found else ("", "", "000000")
    body = f"{abs(value):.{len(decimals or '')}f}"
    if whole and whole.startswith("0") and len(whole) > 1:
        body = body.zfill(len(whole) + (len(decimals) + 1 if decimals else 0))
    negative = value < 0.0 and float(body) != 0.0
    written = ("-" if negative else "+" if sign == "+" else "") + body
    blanks = len(text) - len(text.lstrip()), len(text) - len(text.rstrip())
    return " " * blanks[0] + written + " " * blanks[1]


def wrapped(value: Any, low: float, span: float) -> Any:
    """Angle, or array of angles, within ``low`` and ``low + span``."""
    return (value - low) % span + low

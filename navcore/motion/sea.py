"""A seaway as a sum of sinusoids, and a ship's angular and vertical answer to it."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from navcore.foundation.units import STANDARD_GRAVITY

LOWEST, HIGHEST = 0.5, 3.0
"""Band of the spectrum that is used, as parts of its peak frequency: 98 % of the energy lies in it."""
_PEAKEDNESS = 1.25


@dataclass(frozen=True)
class Seaway:
    """Waves on deep water, one row a component.

    Attributes
    ----------
    amplitude : ndarray, shape (n,)
        Amplitude of the elevation, m.
    frequency : ndarray, shape (n,)
        Angular frequency seen from a fixed place, rad/s.
    towards : ndarray, shape (n,)
        Direction in which the component travels, clockwise from true north, rad.
    phase : ndarray, shape (n,)
        Phase at t = 0, rad: the elevation at the origin is a cos(w t + phase).
    """

    amplitude: np.ndarray
    frequency: np.ndarray
    towards: np.ndarray
    phase: np.ndarray

    @property
    def wave_number(self) -> np.ndarray:
        """w^2/g, rad/m: also the slope of a wave of unit amplitude."""
        return self.frequency**2 / STANDARD_GRAVITY


def fully_developed_peak_period(height_m: float) -> float:
    """Peak period (s) of the Pierson-Moskowitz spectrum of a significant height (m): wp = 0.4 sqrt(g/Hs)."""
    return 2.0 * math.pi / (0.4 * math.sqrt(STANDARD_GRAVITY / height_m))


def energy_below(part: np.ndarray) -> np.ndarray:
    """Energy of the Bretschneider spectrum below ``part`` times its peak frequency, as a part of all.

    S(w) = 5/16 Hs^2 wp^4/w^5 exp(-5/4 (wp/w)^4) (Bretschneider 1959; Pierson & Moskowitz 1964 with wp from
    Hs; Fossen 2011, 8.2) has the integral Hs^2/16 exp(-5/4 (wp/w)^4).
    """
    return np.exp(-_PEAKEDNESS / np.asarray(part, dtype=float) ** 4)


def make_seaway(
    height_m: float, peak_period_s: float, towards: float, spread: float, count: int, rng: np.random.Generator
) -> Seaway:
    """Draw a seaway: one component in each of ``count`` equal bands of frequency, with the band's energy.

    Parameters
    ----------
    height_m : float
        Significant height Hs = 4 x the standard deviation of the elevation; met exactly by the components.
    peak_period_s : float
        Period of the spectrum's peak, s.
    towards : float
        Mean direction of travel, rad.
    spread : float
        Standard deviation of the components' directions, rad.
    count : int
        Number of components.
    rng : numpy.random.Generator
        Draws the frequency within each band (so that nothing repeats), direction and phase.
    """
    edges = np.linspace(LOWEST, HIGHEST, count + 1)
    energy = np.diff(energy_below(edges))
    amplitude = height_m * np.sqrt(energy / energy.sum() / 8.0)
    inside = rng.uniform(size=count)
    frequency = (edges[:-1] + inside * np.diff(edges)) * 2.0 * math.pi / peak_period_s
    return Seaway(
        amplitude,
        frequency,
        towards + spread * rng.standard_normal(count),
        rng.uniform(0.0, 2.0 * math.pi, count),
    )


def encounter_frequency(sea: Seaway, speed: float, heading: float) -> np.ndarray:
    """Angular frequency at which a ship (m/s, rad) meets each component, w - w^2 V/g cos(angle), rad/s.

    Negative when the ship overtakes the wave.
    """
    return sea.frequency - sea.wave_number * speed * np.cos(sea.towards - heading)


@dataclass(frozen=True)
class Answer:
    """A ship's second-order answer x'' + 2 zeta w0 x' + w0^2 x = w0^2 gain u.

    Attributes
    ----------
    gain : float
        Answer to a slow excitation.
    period_s : float
        Natural period 2 pi/w0, s.
    damping : float
        Damping ratio zeta.
    """

    gain: float
    period_s: float
    damping: float

    def transfer(self, frequency: np.ndarray) -> np.ndarray:
        """Complex transfer function at angular frequencies (rad/s)."""
        r = np.asarray(frequency) * (self.period_s / (2.0 * math.pi))
        return self.gain / (1.0 - r**2 + 2j * self.damping * r)


def ship_motion(
    sea: Seaway, speed: float, heading: float, pitch: Answer, roll: Answer, yaw: Answer, heave: Answer
) -> tuple[np.ndarray, np.ndarray]:
    """Answers of a ship to every component.

    Pitch follows the wave's slope along the ship (bow up on a rising slope), roll the slope across it, yaw
    the slope along times the sine of the angle of encounter (largest in quartering seas), heave the
    elevation; each through its own transfer function at the frequency of encounter.

    Returns
    -------
    frequency : ndarray, shape (n,)
        Angular frequency of encounter, rad/s.
    answers : ndarray of complex, shape (n, 4)
        Pitch, roll, yaw (rad) and heave (m): the motion is Re(answer exp(j frequency t)).
    """
    frequency = encounter_frequency(sea, speed, heading)
    return frequency, _answers(sea, frequency, heading, (pitch, roll, yaw, heave))


def _answers(sea: Seaway, frequency: np.ndarray, heading: Any, answers: tuple[Answer, ...]) -> np.ndarray:
    """Complex answers in pitch, roll, yaw and heave at the frequencies of encounter, shape (n, 4)."""
    ahead, starboard = np.cos(sea.towards - heading), np.sin(sea.towards - heading)
    elevation = sea.amplitude * np.exp(1j * sea.phase)
    # The crest comes later by k x: elevation = Re(a exp(j (w t - k x + phase))).
    slope = -1j * sea.wave_number * elevation
    excitation = (slope * ahead, -slope * starboard, slope * ahead * starboard, elevation)
    pairs = zip(answers, excitation, strict=True)
    return np.stack([answer.transfer(frequency) * u for answer, u in pairs], axis=1)


def motion_along(
    sea: Seaway,
    t_s: np.ndarray,
    moved_m: np.ndarray,
    velocity_mps: np.ndarray,
    heading: np.ndarray,
    depth_m: np.ndarray,
    answers: tuple[Answer, ...],
) -> np.ndarray:
    """Answers of a ship along any course: each component's phase where the ship is, at each time's frequency.

    The answer is that of a steady course with the velocity and heading of the time, which change slowly
    against the waves. Below the surface waves fade as exp(-k depth).

    Parameters
    ----------
    t_s : ndarray, shape (n,)
        Times, s.
    moved_m, velocity_mps : ndarray, shape (n, 2)
        Way from the start and velocity, E and N.
    heading, depth_m : ndarray, shape (n,)
        rad; m.
    answers : tuple of Answer
        Pitch, roll, yaw, heave.

    Returns
    -------
    ndarray, shape (n, 4)
        Pitch, roll, yaw (rad) and heave (m).
    """
    total = np.zeros((t_s.size, 4))
    for i, number in enumerate(sea.wave_number):
        one = Seaway(
            *(values[i : i + 1] for values in (sea.amplitude, sea.frequency, sea.towards, sea.phase))
        )
        along = number * np.array([np.sin(one.towards[0]), np.cos(one.towards[0])])
        complex_answers = _answers(one, one.frequency - velocity_mps @ along, heading, answers)
        turn = np.exp(1j * (one.frequency * t_s - moved_m @ along) - number * depth_m)
        total += np.real(complex_answers * turn[:, None])
    return total

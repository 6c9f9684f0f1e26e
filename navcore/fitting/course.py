"""Legs of a voyage: straight runs and turns fitted to a recorded track."""

import math

import numpy as np

from navcore.foundation.units import DEG
from navcore.motion.leg import DEFAULT_ACCELERATION, DEFAULT_TURN_RATE_DPS, Leg

SHORTEST_LEG_S = 120.0
_MOST_PIECES = 4000
_ROOM = 0.8
"""Part of a leg that its change of heading or speed takes at most."""
_SLACK = 1.02


def fit_legs(
    time_s: np.ndarray, velocity: np.ndarray, within_mps: float, most: int = 1000
) -> tuple[Leg, ...]:
    """Fit legs of constant velocity to a ship's velocity over ground.

    Neighbouring pieces are joined, those first whose mean velocities differ least (weighted by their
    lengths), as long as the velocity that joining leaves out stays within a bound. A turn is centred where
    two legs meet.

    Parameters
    ----------
    time_s : ndarray, shape (n,)
        Evenly spaced, s.
    velocity : ndarray, shape (n, 2)
        E and N, m/s.
    within_mps : float
        RMS of the velocity that joining leaves out; more only where there are more than ``most`` legs.
    most : int
        Legs.

    Returns
    -------
    tuple of Leg
        The first gives the speed and heading at the start.
    """
    step = float(time_s[1] - time_s[0])
    size = max(round(SHORTEST_LEG_S / step), math.ceil(len(time_s) / _MOST_PIECES), 1)
    starts = np.arange(0, max(len(time_s) - size // 2, 1), size)
    count = np.diff(np.append(starts, len(time_s))).astype(float)
    total = np.add.reduceat(velocity, starts, axis=0)
    left, allowed = 0.0, within_mps**2 * len(time_s)
    while len(count) > 1:
        mean = total / count[:, None]
        cost = count[1:] * count[:-1] / (count[1:] + count[:-1]) * np.sum(np.diff(mean, axis=0) ** 2, axis=1)
        place = int(np.argmin(cost))
        if left + cost[place] > allowed and len(count) <= most:
            break
        left += float(cost[place])
        total[place] += total[place + 1]
        count[place] += count[place + 1]
        total, count = np.delete(total, place + 1, axis=0), np.delete(count, place + 1)
    return tuple(_legs(count * step, total / count[:, None]))


def _legs(length_s: np.ndarray, velocity: np.ndarray) -> list[Leg]:
    """Legs of mean velocities (m/s) that last so long; each change is centred where two of them meet."""
    speed = np.hypot(*velocity.T)
    heading = np.mod(np.arctan2(velocity[:, 0], velocity[:, 1]) / DEG, 360.0)
    ends = np.cumsum(length_s)
    begins, rates = [0.0], [(0.0, 0.0)]
    for k in range(1, len(length_s)):
        turn = abs((heading[k] - heading[k - 1] + 180.0) % 360.0 - 180.0)
        room = _ROOM * min(length_s[k - 1], length_s[k])
        rate = max(DEFAULT_TURN_RATE_DPS, _SLACK * turn / room)
        pull = max(DEFAULT_ACCELERATION, _SLACK * abs(speed[k] - speed[k - 1]) / room)
        lasts = max(turn / rate, abs(speed[k] - speed[k - 1]) / pull)
        begins.append(float(ends[k - 1]) - 0.5 * lasts)
        rates.append((rate, pull))
    lasting = np.diff([*begins, float(ends[-1])])
    legs = []
    for k, (rate, pull) in enumerate(rates):
        given: dict[str, float] = {
            "duration_s": round(float(lasting[k]), 1),
            "speed_mps": round(float(speed[k]), 3),
            "heading_deg": round(float(heading[k]), 2) % 360.0,
        }
        if k:
            side = (heading[k] - heading[k - 1] + 180.0) % 360.0 - 180.0
            if abs(side) > 0.0:
                given["turn_dps"] = math.copysign(round(rate, 4), side)
            given["accel_mps2"] = round(pull, 4)
        legs.append(Leg(**given))
    return legs

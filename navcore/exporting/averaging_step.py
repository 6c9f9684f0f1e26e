"""One call of an exported averaging: the outputs of all copies of the navigation, and what is given out."""

import math
from typing import Any, NamedTuple

TURN = 2.0 * math.pi
"""rad."""


class Copy(NamedTuple):
    """Outputs of one copy of the navigation."""

    v_e_mps: Any
    v_n_mps: Any
    pitch_rad: Any
    roll_rad: Any
    yaw_rad: Any
    lat_rad: Any
    lon_rad: Any


class Averages(NamedTuple):
    """Outputs of a call: those of a law that does not act, then the means."""

    v_star_e_mps: Any
    v_star_n_mps: Any
    feedback_e_mps2: Any
    feedback_n_mps2: Any
    azimuth_rate_radps: Any
    damped: Any
    v_out_e_mps: Any
    v_out_n_mps: Any
    pitch_out_rad: Any
    roll_out_rad: Any
    yaw_out_rad: Any
    lat_out_rad: Any
    lon_out_rad: Any


def _mean(values):
    """Mean of velocities."""
    total = values[0]
    for value in values[1:]:
        total = total + value
    return total / float(len(values))


def _mean_angle(values):
    """Mean of angles by their small differences to the first: none passes 0 or 360 deg."""
    total = 0.0
    for value in values[1:]:
        off = value - values[0]
        total = total + (off - TURN * math.floor(off / TURN + 0.5))
    return values[0] + total / float(len(values))


def averaged(copies, level, slow):
    """Means of the copies: velocity and level angles of some, heading and position of others (theory.md 5).

    Parameters
    ----------
    copies : tuple of Copy
        The first is the main navigation.
    level, slow : tuple of int
        Copies that are averaged.
    """
    near, far = [copies[i] for i in level], [copies[i] for i in slow]
    return Averages(
        copies[0].v_e_mps,
        copies[0].v_n_mps,
        0.0,
        0.0,
        0.0,
        False,
        _mean([one.v_e_mps for one in near]),
        _mean([one.v_n_mps for one in near]),
        _mean_angle([one.pitch_rad for one in near]),
        _mean_angle([one.roll_rad for one in near]),
        _mean_angle([one.yaw_rad for one in far]),
        _mean_angle([one.lat_rad for one in far]),
        _mean_angle([one.lon_rad for one in far]),
    )

"""Alignment before navigation: coarse in the inertial frame, then the compass loop (theory.md 6.1).

The vehicle is assumed not to travel (it may swing). Coarse: the mean of the gravity vector, which turns
with the Earth in an inertial frame, gives up, its motion gives east (Deng 2019, section 3; analytic). Fine:
the velocity is damped against V_r = 0 by feedback into the platform's rates, first the level channels, then
the azimuth through the north channel, whose loop is (s^2 + 2 sigma s + sigma^2/xi^2)^2.
"""

import math
from dataclasses import dataclass

import numpy as np

from navcore.alignment.kernel import coarse_kernel, fine_kernel
from navcore.alignment.loop import CompassLoop, check_latitude
from navcore.foundation.earth import EARTH_RATE, Earth
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.mechanization.strapdown.run import turned_by
from navcore.networks.azimuth_loop import azimuth_gains
from navcore.networks.compass import gains_from_sigma_xi


@dataclass(frozen=True)
class Aligned:
    """Result of an alignment.

    Attributes
    ----------
    quaternion : ndarray, shape (4,)
        Body to navigation frame at its end.
    velocity : ndarray, shape (2,)
        Velocity E, N that is left, m/s.
    """

    quaternion: np.ndarray
    velocity: np.ndarray


def steady_misalignment(
    eps: np.ndarray, nabla: np.ndarray, lat: float, gravity: float, loop: CompassLoop
) -> np.ndarray:
    """Misalignment phi_E, phi_N, phi_U (rad) that constant sensor errors (ENU) leave (theory.md 6.1)."""
    return np.array(
        [
            -nabla[1] / gravity,
            nabla[0] / gravity,
            -eps[0] / (EARTH_RATE * math.cos(lat))
            + math.tan(lat) * nabla[0] / gravity
            - 4.0 * loop.xi**2 * eps[2] / loop.sigma,
        ]
    )


def coarse_alignment(increments: np.ndarray, rate_hz: float, lat: float) -> np.ndarray:
    """Attitude at the end of a record by the turning gravity vector, quaternion of shape (4,).

    Parameters
    ----------
    increments : ndarray, shape (n, 6)
        Angles (rad) and velocities (m/s); a minute or more. The vehicle may swing but not travel.
    rate_hz : float
        Samples a second.
    lat : float
        Latitude, rad.

    Raises
    ------
    InputError
        |latitude| above 85 deg, or a record without gravity or Earth rate.
    """
    check_latitude(lat)
    n, half = len(increments), len(increments) // 2
    sums, q = np.zeros((2, 3)), np.array([1.0, 0.0, 0.0, 0.0])
    coarse_kernel(np.ascontiguousarray(increments, dtype=float), half, q, sums)
    # Both halves' mean specific force in the inertial frame that was the body frame at the start.
    early, late = sums[0], sums[1]
    if np.linalg.norm(early) == 0.0 or np.linalg.norm(late) == 0.0:
        raise InputError(Fault("", "imu", None, Text("no specific force in the alignment record")))
    # The mean over a half stands for its middle; the present is half of one further than the late one.
    angle = EARTH_RATE * half / rate_hz
    up_early, up_late = early / np.linalg.norm(early), late / np.linalg.norm(late)
    east = up_late - up_early
    if np.linalg.norm(east) < 0.05 * angle * math.cos(lat):
        raise InputError(Fault("", "imu", None, Text("gravity does not turn with the Earth: no north found")))
    middle = up_early + up_late
    east, up = east / np.linalg.norm(east), middle / np.linalg.norm(middle)
    # The bisector of two directions on the cone round the Earth's axis lies inside it.
    cone, half_turn = math.cos(lat), 0.5 * angle
    tilt = math.atan2(math.sin(lat), cone * math.cos(half_turn))
    north = np.cross(up, east)
    axis = math.cos(tilt) * north + math.sin(tilt) * up
    up_now = math.sin(lat) * axis + cone * np.cross(east, axis)
    now = EARTH_RATE * (n - half) / rate_hz
    turned_east = math.cos(now) * east + math.sin(now) * np.cross(axis, east)
    along = (axis @ up_now) * axis
    turned_up = along + math.cos(now) * (up_now - along) + math.sin(now) * np.cross(axis, up_now)
    rows = np.array([turned_east, np.cross(turned_up, turned_east), turned_up])
    return _product(_quaternion(rows), q)


def fine_alignment(
    increments: np.ndarray,
    rate_hz: float,
    start: np.ndarray,
    lat: float,
    height: float,
    earth: Earth,
    loop: CompassLoop | None = None,
    velocity: np.ndarray | None = None,
) -> Aligned:
    """Compass loop with V_r = 0.

    Parameters
    ----------
    increments : ndarray, shape (n, 6)
        Angles (rad) and velocities (m/s).
    rate_hz : float
        Samples a second.
    start : ndarray, shape (4,)
        Coarse attitude.
    lat, height : float
        Known position, rad, m.
    earth : Earth
        Earth model.
    loop : CompassLoop, optional
        Design; default 120 s level at sigma = 0.03, then azimuth at 0.02.
    velocity : ndarray, shape (2,), optional
        True horizontal velocity error at the start; zero when left out.

    Raises
    ------
    InputError
        |latitude| above 85 deg, or a loop too fast for the IMU.
    """
    check_latitude(lat)
    loop = CompassLoop() if loop is None else loop
    fastest = max(loop.sigma, loop.level_sigma) * max(1.0, 1.0 / loop.xi)
    if fastest > 0.1 * rate_hz:
        allowed = Text(
            "must be <= {rate_hz:g} (1/s) at {rate_hz_2:g} Hz", rate_hz=0.1 * rate_hz, rate_hz_2=rate_hz
        )
        raise InputError(Fault("", "alignment.sigma", fastest, allowed))
    gravity, (m, n) = earth.gravity(lat, height), earth.radii(lat)
    radii = m + height, n + height
    # Each channel has its own Schuler frequency: the gains place the poles exactly.
    frequencies = [math.sqrt(gravity / r) for r in radii]
    q = np.array(start, dtype=float)
    v = np.zeros(2) if velocity is None else np.array(velocity, dtype=float)
    integrals = np.zeros(3)
    switch = min(int(loop.level_s * rate_hz), len(increments))
    parts = ((0, switch, loop.level_sigma, False), (switch, len(increments), loop.sigma, True))
    increments = np.ascontiguousarray(increments, dtype=float)
    for first, last, sigma, azimuth in parts:
        east = gains_from_sigma_xi(sigma, loop.xi, frequencies[1])
        north = gains_from_sigma_xi(sigma, loop.xi, frequencies[0])
        up = azimuth_gains(sigma, loop.xi, frequencies[0], gravity)
        fine_kernel(
            increments,
            first,
            last,
            1.0 / rate_hz,
            lat,
            *radii,
            np.array(east),
            np.array(north),
            np.array(up),
            azimuth,
            q,
            v,
            integrals,
        )
    return Aligned(q, v)


def _quaternion(matrix: np.ndarray) -> np.ndarray:
    """Quaternion of a rotation matrix (the largest component first, so that nothing cancels)."""
    m, trace = matrix, float(np.trace(matrix))
    squares = np.array([trace, m[0, 0], m[1, 1], m[2, 2]])
    i = int(np.argmax(squares))
    if i == 0:
        q = np.array([1.0 + trace, m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1]])
    else:
        a, b, c = i - 1, i % 3, (i + 1) % 3
        q = np.zeros(4)
        q[0], q[1 + a] = m[c, b] - m[b, c], 1.0 + m[a, a] - m[b, b] - m[c, c]
        q[1 + b], q[1 + c] = m[a, b] + m[b, a], m[a, c] + m[c, a]
    return q / np.linalg.norm(q)


def _product(p: np.ndarray, q: np.ndarray) -> np.ndarray:
    w = p[0] * q[0] - p[1:] @ q[1:]
    return np.concatenate([[w], p[0] * q[1:] + q[0] * p[1:] + np.cross(p[1:], q[1:])])


__all__ = [
    "Aligned",
    "CompassLoop",
    "check_latitude",
    "coarse_alignment",
    "fine_alignment",
    "steady_misalignment",
    "turned_by",
]

"""The strapdown mechanization once more, slow and obvious: vectors, cross products, matrices, plain Python.

The compiled kernel is tested against this sample by sample. It shares no computation with it: attitude is a
matrix, turned by Rodrigues' formula, and the damping is a small object with a ``step`` of its own.
"""

import math
from collections.abc import Callable

import numpy as np

from navcore.foundation.earth import EARTH_RATE, Earth
from tests.error_model_twin import radii

Damping = Callable[[int, np.ndarray], tuple[np.ndarray, np.ndarray]]
"""Called at each law epoch with its number and the velocity (3,); gives c (m/s) and a (m/s^2), E and N."""


def rotation(vector: np.ndarray) -> np.ndarray:
    """Matrix exp([vector x]) (Rodrigues); vector in rad."""
    angle = float(np.linalg.norm(vector))
    x, y, z = vector
    skew = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    if angle == 0.0:
        return np.eye(3)
    return np.eye(3) + math.sin(angle) / angle * skew + (1 - math.cos(angle)) / angle**2 * skew @ skew


def run_twin(
    increments: np.ndarray,
    before: np.ndarray,
    rate_hz: float,
    law_every: int,
    matrix: np.ndarray,
    velocity: np.ndarray,
    position: np.ndarray,
    earth: Earth,
    damping: Damping | None = None,
    compensation: bool = True,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Integrate increments with a locked vertical channel.

    Parameters
    ----------
    increments : ndarray, shape (n, 6)
        Angles (rad) and velocities (m/s), body axes.
    before : ndarray, shape (6,)
        Increment of the interval that ends at t = 0.
    rate_hz : float
        Samples a second.
    law_every : int
        Samples between two calls of the damping.
    matrix : ndarray, shape (3, 3)
        C_b^n at t = 0.
    velocity, position : ndarray, shape (3,)
        E N U (m/s); latitude, longitude (rad), height (m).
    earth : Earth
        Earth model.
    damping : callable, optional
        None runs free.
    compensation : bool
        Coning, sculling and third-order term.

    Returns
    -------
    ndarray, shapes (n + 1, 3, 3), (n + 1, 3), (n + 1, 3)
        Matrices, velocities and positions after each sample.
    """
    dt, n = 1.0 / rate_hz, len(increments)
    matrices, velocities, positions = np.empty((n + 1, 3, 3)), np.empty((n + 1, 3)), np.empty((n + 1, 3))
    matrices[0], velocities[0], positions[0] = matrix, velocity, position
    theta_0, dv_0 = before[:3], before[3:]
    change, lat_change = np.zeros(3), 0.0
    c = a = np.zeros(2)
    for k in range(n):
        attitude, v, (lat, lon, height) = matrices[k], velocities[k], positions[k]
        if damping is not None and k % law_every == 0:
            c, a = damping(k // law_every, v)
        theta, dv = increments[k, :3], increments[k, 3:]
        turn, push = theta, dv + 0.5 * np.cross(theta, dv)
        if compensation:
            turn = theta + np.cross(theta_0, theta) / 12.0
            push = push + (np.cross(theta_0, dv) + np.cross(dv_0, theta)) / 12.0
            push = push + np.cross(theta, np.cross(theta, dv)) / 6.0
        middle, mid_lat = v + 0.5 * change, lat + 0.5 * lat_change
        radius_m, radius_n = (r + height for r in radii(earth, mid_lat))
        earth_rate = EARTH_RATE * np.array([0.0, math.cos(mid_lat), math.sin(mid_lat)])
        up = middle[0] * math.tan(mid_lat) / radius_n
        transport = np.array([-middle[1] / radius_m, middle[0] / radius_n, up])
        platform = np.array([-(middle[1] + c[1]) / radius_m, (middle[0] + c[0]) / radius_n, up]) + earth_rate
        pushed = attitude @ push
        change = pushed - 0.5 * dt * np.cross(platform, pushed)
        change = change - dt * np.cross(2.0 * earth_rate + transport, middle)
        change[:2] += dt * a
        change[2] = 0.0
        mean = v + 0.5 * change
        lat_change = mean[1] / radius_m * dt
        matrices[k + 1] = rotation(-platform * dt) @ attitude @ rotation(turn)
        velocities[k + 1] = v + change
        positions[k + 1] = lat + lat_change, lon + mean[0] / (radius_n * math.cos(mid_lat)) * dt, height
        theta_0, dv_0 = theta, dv
    return matrices, velocities, positions

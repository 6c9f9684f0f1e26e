"""How long the heading takes to settle where an azimuth network or a gyrocompass holds it."""

import math
from functools import lru_cache

import numpy as np

from navcore.analysis.whole_matrix import DV_N, PHI_E, PHI_U, system_matrix
from navcore.foundation.earth import SPHERE, Earth
from navcore.foundation.units import DEG, HOUR
from navcore.networks.azimuth_loop import AzimuthChannel, AzimuthGains
from navcore.networks.base import LinearNetwork

BAND = 0.7 * DEG
"""Within which a gyrocompass has settled (ISO 8728, IMO A.821(19) 4.1), rad."""
START = 15.0 * DEG
"""Initial heading error from which it settles, rad."""
_POINTS, _LONGEST_S = 20_000, 1000.0 * HOUR
_GROWS = 1e-6
"""Real part from which a mode counts as one that grows, of the Schuler frequency."""


@lru_cache(maxsize=512)
def heading_settling(
    network: LinearNetwork,
    lat: float,
    earth: Earth = SPHERE,
    height: float = 0.0,
    azimuth: AzimuthChannel | None = None,
    band: float = BAND,
) -> float:
    """Last time at which the heading leaves its band around what it settles at, s.

    It begins `START` wrong, all other errors at 0. A gyrocompass settles by its own loop: north velocity,
    tilt about east, heading and the rate that turns the platform. An azimuth network damps the 24 h mode, so
    that all states of the whole system count.

    Parameters
    ----------
    network : LinearNetwork
        H(s) as it acts.
    lat : float
        rad.
    earth : Earth
        WGS-84 or the sphere.
    height : float
        m.
    azimuth : LinearNetwork or AzimuthGains, optional
        Y(s) or the gyrocompass of the azimuth channel.
    band : float
        Half its width, rad.

    Returns
    -------
    float
        Infinite without an azimuth loop, where a mode grows, or beyond a thousand hours.
    """
    if azimuth is None:
        return math.inf
    matrix, heading = system_matrix(network, lat, earth, height, azimuth), PHI_U
    if isinstance(azimuth, AzimuthGains):
        own = [DV_N, PHI_E, PHI_U, len(matrix) - 1]
        matrix, heading = matrix[np.ix_(own, own)], own.index(PHI_U)
    values, vectors = np.linalg.eig(matrix)
    slowest = -float(np.max(np.real(values)))
    if slowest < -_GROWS:
        return math.inf
    start = np.zeros(len(values))
    start[heading] = START
    parts = np.linalg.lstsq(vectors, start, rcond=None)[0] * vectors[heading]

    def error(times_s: np.ndarray) -> np.ndarray:
        return np.real(np.exp(np.outer(times_s * network.omega_s, values)) @ parts)

    gone = math.log(float(np.sum(np.abs(parts))) / band) / max(slowest, 1e-12) / network.omega_s
    times = np.linspace(0.0, min(max(gone, HOUR), _LONGEST_S), _POINTS)
    outside = np.flatnonzero(np.abs(error(times)) > band)
    if len(outside) == 0:
        return 0.0
    last = int(outside[-1])
    if last == _POINTS - 1:
        return math.inf
    fine = np.linspace(times[last], times[last + 1], 100)
    return float(fine[np.flatnonzero(np.abs(error(fine)) > band)[-1]])

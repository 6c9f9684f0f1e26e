"""How long the heading takes to settle where an azimuth network or a gyrocompass holds it."""

import math
from functools import lru_cache

import numpy as np

from navcore.analysis.whole_matrix import PHI_U, system_matrix
from navcore.foundation.earth import SPHERE, Earth
from navcore.foundation.units import HOUR
from navcore.networks.azimuth_loop import AzimuthChannel
from navcore.networks.base import LinearNetwork

_LEFT = 0.02
_STEP_S, _LONGEST_S = 300.0, 1000.0 * HOUR


@lru_cache(maxsize=512)
def heading_settling(
    network: LinearNetwork,
    lat: float,
    earth: Earth = SPHERE,
    height: float = 0.0,
    azimuth: AzimuthChannel | None = None,
) -> float:
    """Last time at which the heading after an initial heading error exceeds 2 % of it, s.

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

    Returns
    -------
    float
        To five minutes; infinite without an azimuth loop, where a mode grows, or beyond a thousand hours.
    """
    if azimuth is None:
        return math.inf
    values, vectors = np.linalg.eig(system_matrix(network, lat, earth, height, azimuth))
    if float(np.max(np.real(values))) > 1e-6:
        return math.inf
    start = np.zeros(len(values))
    start[PHI_U] = 1.0
    parts = np.linalg.lstsq(vectors, start, rcond=None)[0] * vectors[PHI_U]
    times = np.arange(0.0, _LONGEST_S, _STEP_S)
    heading = np.real(np.exp(np.outer(times * network.omega_s, values)) @ parts)
    outside = np.flatnonzero(np.abs(heading) > _LEFT)
    if len(outside) == 0:
        return 0.0
    last = int(outside[-1])
    return math.inf if last == len(times) - 1 else float(times[last] + _STEP_S)

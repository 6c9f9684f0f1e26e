"""The steady Kalman filter of one level channel as a loop beside those of the networks (theory.md 16)."""

import math
from functools import lru_cache

import numpy as np

from navcore.analysis.loop import Loop
from navcore.analysis.settling import last_exceedance
from navcore.networks.lqg import PHI, SensorFigures, filter_covariance, plant
from navcore.networks.roots import sorted_roots
from navcore.networks.state_space import StateSpace


@lru_cache(maxsize=64)
def filter_loop(figures: SensorFigures, omega_s: float) -> Loop | None:
    """Estimator A - L C of the steady filter: its poles, damping and settling of an initial tilt.

    It has no H(s), so that `Loop.h0` is nan. Biases, whose gains die away, are not among its states.

    Parameters
    ----------
    figures : SensorFigures
        Random errors that the filter is told of.
    omega_s : float
        Schuler frequency, rad/s.

    Returns
    -------
    Loop or None
        None where the filter comes to no steady state.
    """
    system = plant(figures, omega_s).excited()
    try:
        gain = filter_covariance(system) @ system.C.T / system.V
    except np.linalg.LinAlgError:
        return None
    estimator = system.A - gain @ system.C
    poles = sorted_roots(np.linalg.eigvals(estimator).astype(complex))
    if np.max(poles.real) > -1e-9:
        return None
    ratios = -poles.real / np.abs(poles)
    least = int(np.argmin(ratios))
    tilt = np.zeros(len(estimator))
    tilt[PHI] = 1.0
    tau = last_exceedance(StateSpace(estimator, tilt, tilt, 0.0), poles)
    return Loop(
        stable=True,
        poles=poles * omega_s,
        h0=math.nan,
        damping_ratio=float(ratios[least]),
        natural_frequency=float(np.abs(poles[least])) * omega_s,
        settling_s=None if tau is None else float(tau / omega_s),
        warnings=(),
    )

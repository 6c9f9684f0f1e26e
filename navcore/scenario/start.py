"""Correlation of the errors at t = 0 with constant sensor errors, which an alignment leaves."""

import math

import numpy as np

from navcore.foundation.earth import EARTH_RATE
from navcore.foundation.units import DEG
from navcore.scenario.model import Scenario

ERRORS = 7


def aligned_errors(scenario: Scenario, eps: np.ndarray, nabla: np.ndarray) -> np.ndarray:
    """Errors that constant sensor errors leave after a compass alignment (theory.md 6.1).

    Parameters
    ----------
    scenario : Scenario
        Without an alignment nothing is left.
    eps, nabla : ndarray, shape (3,)
        Constant errors of gyros (rad/s) and accelerometers (m/s^2) in the navigation frame at t = 0.

    Returns
    -------
    ndarray, shape (7,)
        dV_E, dV_N, dL, dlambda, phi_E, phi_N, phi_U.
    """
    start = np.zeros(ERRORS)
    if scenario.alignment.kind != "compass":
        return start
    lat, alignment = scenario.site.lat_deg * DEG, scenario.alignment
    gravity = scenario.earth.gravity(lat, scenario.site.height_m)
    start[4], start[5] = -nabla[1] / gravity, nabla[0] / gravity
    start[6] = (
        -eps[0] / (EARTH_RATE * math.cos(lat))
        + math.tan(lat) * nabla[0] / gravity
        - 4.0 * alignment.xi**2 * eps[2] / alignment.sigma
    )
    return start


def independent_errors(scenario: Scenario, initial: np.ndarray) -> np.ndarray:
    """Standard deviations of the errors at t = 0 that owe nothing to the sensors, shape (7,).

    An alignment works off all of them but the position.
    """
    if scenario.alignment.kind != "compass":
        return initial
    return np.where(np.isin(np.arange(ERRORS), (2, 3)), initial, 0.0)

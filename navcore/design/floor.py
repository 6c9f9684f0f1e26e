"""The least error that any causal linear damping can reach in the steady state (theory.md 16)."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from navcore.foundation.earth import SEMI_MAJOR_AXIS
from navcore.networks.lqg import DV, PHI, filter_covariance, plant
from navcore.scenario.stochastic import StochasticModel


@dataclass(frozen=True)
class Floor:
    """Standard deviations of one level channel.

    Attributes
    ----------
    tilt_rad, velocity_mps : float or None
        None where there is no floor.
    reason : str
        Why there is none; empty when there is one.
    """

    tilt_rad: float | None
    velocity_mps: float | None
    reason: str = ""


def steady_floor(model: StochasticModel, omega_s: float) -> Floor:
    """Error of the Kalman filter on the same model, measuring V_c - V_r, in the steady state.

    Parameters
    ----------
    model : StochasticModel
        The sensors.
    omega_s : float
        Schuler frequency, rad/s.
    """
    if model.silent:
        return Floor(None, None, "imu and reference have no random error: there is no floor to compare with")
    if not model.log:
        return Floor(None, None, 'reference.kind = "none": without a log nothing bounds the error')
    if not model.figures.inertial:
        return Floor(0.0, 0.0)
    try:
        P = filter_covariance(plant(model.figures, omega_s).excited())
    except np.linalg.LinAlgError:
        return Floor(None, None, "the Riccati equation of these sensors has no solution")
    return Floor(
        math.sqrt(max(P[PHI, PHI], 0.0)) / (omega_s * SEMI_MAJOR_AXIS), math.sqrt(max(P[DV, DV], 0.0))
    )

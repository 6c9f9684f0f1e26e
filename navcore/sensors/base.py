"""What the sensor models hand to the mechanizations."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class SensorErrors:
    """Inertial sensor errors turned to the navigation frame, mean over each step.

    Attributes
    ----------
    gyro : ndarray, shape (n, 3), or (1, 3) when constant
        eps in E, N, U, rad/s; row k holds over the step from t_k to t_(k+1).
    accel : ndarray, shape (n, 3) or (1, 3)
        nabla in E, N, U, m/s^2.
    """

    gyro: np.ndarray
    accel: np.ndarray


@dataclass(frozen=True)
class ReferenceErrors:
    """Errors of the reference velocity (log) at its own epochs.

    Attributes
    ----------
    time_s : ndarray, shape (m,)
        Epochs, s after the start of navigation, increasing.
    error : ndarray, shape (m, 2)
        V_r minus the true velocity, E and N, m/s, as far as it does not depend on the computed heading.
    valid : ndarray of bool, shape (m,)
        False while the log gives nothing (outage, invalid flag).
    body_frame : bool
        The log measures in the body frame and is turned by the *computed* heading: the mechanization adds
        the effect of the heading error (physics: dV_rE += phi_U V_N, dV_rN -= phi_U V_E).
    hold_s : float
        A sample older than this counts as missing.
    """

    time_s: np.ndarray
    error: np.ndarray
    valid: np.ndarray
    body_frame: bool
    hold_s: float

"""Reading the log inside a strapdown run: the newest epoch, its held difference, its use. Compiled."""

import math
from typing import NamedTuple

import numpy as np

from navcore.foundation.compiled import inlined

_EPOCH_TOLERANCE_S = 1e-9


class VelocityReference(NamedTuple):
    """The reference velocity itself, as a strapdown run compares it with its own.

    Attributes
    ----------
    time_s : ndarray, shape (m,)
        Epochs, s.
    velocity : ndarray, shape (m, 2)
        East, north; with ``body_frame`` starboard, forward (turned by the computed heading), m/s.
    valid : ndarray of bool, shape (m,)
    body_frame : bool
    hold_s : float
        A sample older than this counts as missing, s.
    """

    time_s: np.ndarray
    velocity: np.ndarray
    valid: np.ndarray
    body_frame: bool
    hold_s: float


class LastCall(NamedTuple):
    """Time (s) and computed velocity (m/s) of the law's previous call."""

    time: float
    v_e: float
    v_n: float


@inlined
def newest_epoch(t, epoch, log):
    """Index of the newest log epoch at or before t (s); the search starts at ``epoch``."""
    while epoch + 1 < log.time_s.shape[0] and log.time_s[epoch + 1] <= t + _EPOCH_TOLERANCE_S:
        epoch += 1
    return epoch


@inlined
def held_difference(t, epoch, v_e, v_n, heading, last, log):
    """V_r - V_c (m/s) at a log epoch, to be held until the next one (contract, log samples).

    The computed velocity at the epoch lies between that of this law call and of the last one.
    """
    r_e, r_n = log.velocity[epoch, 0], log.velocity[epoch, 1]
    if log.body_frame:
        sh, ch = math.sin(heading), math.cos(heading)
        r_e, r_n = r_e * ch + r_n * sh, r_n * ch - r_e * sh
    elapsed = t - last.time
    share = min((t - log.time_s[epoch]) / elapsed, 1.0) if elapsed > 0.0 else 0.0
    return r_e - (v_e - share * (v_e - last.v_e)), r_n - (v_n - share * (v_n - last.v_n))


@inlined
def usable(t, epoch, log):
    """Whether the sample in force is valid and not older than it may be."""
    return epoch >= 0 and log.valid[epoch] and t - log.time_s[epoch] <= log.hold_s

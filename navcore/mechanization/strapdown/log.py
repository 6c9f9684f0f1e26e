"""Reading the log inside a strapdown run: the newest epoch, its held difference, its use. Compiled."""

from __future__ import annotations

import math

from navcore.compiled import inlined

_EPOCH_TOLERANCE_S = 1e-9


@inlined
def newest_epoch(t, epoch, epoch_s):
    """Index of the newest log epoch at or before t (s), from the one in force on."""
    while epoch + 1 < epoch_s.shape[0] and epoch_s[epoch + 1] <= t + _EPOCH_TOLERANCE_S:
        epoch += 1
    return epoch


@inlined
def held_difference(t, epoch, v_e, v_n, heading, body, last_t, last_e, last_n, epoch_s, epoch_v):
    """V_r - V_c (m/s) at a log epoch, to be held until the next one (contract, log samples).

    The computed velocity at the epoch lies between that of this law call and of the last one.
    """
    r_e, r_n = epoch_v[epoch, 0], epoch_v[epoch, 1]
    if body:
        sh, ch = math.sin(heading), math.cos(heading)
        r_e, r_n = r_e * ch + r_n * sh, r_n * ch - r_e * sh
    elapsed = t - last_t
    share = min((t - epoch_s[epoch]) / elapsed, 1.0) if elapsed > 0.0 else 0.0
    return r_e - (v_e - share * (v_e - last_e)), r_n - (v_n - share * (v_n - last_n))


@inlined
def usable(t, epoch, hold, epoch_s, epoch_valid):
    """Whether the sample in force is valid and not older than ``hold`` s."""
    return epoch >= 0 and epoch_valid[epoch] and t - epoch_s[epoch] <= hold

"""Asking a user's own law in place of the program's: what it is given, and what it commands. Compiled.

The numbers are those of an exported law (`navcore.exporting.step`), in the same order. The law itself is a
function behind an address (`navcore.law.added_call`): compiled from C, or a callback into Python.
"""

import math

from navcore.foundation.compiled import kernel
from navcore.law.added_call import call_user_law
from navcore.law.records import E, N, U
from navcore.law.step import Correction

LOG_NONE, LOG_SAMPLE, LOG_NOT_YET = 0.0, 1.0, 2.0
"""Words of ``log_valid``: the log has no sample to give, gives one, or has none yet."""


@kernel
def ask_user_law(law, v_e, v_n, yaw, lat):
    """Return the `Correction` that the law commands, and c_U (rad/s); not a number where it has failed.

    ``v_e, v_n`` (m/s), ``yaw`` and ``lat`` (rad) are the computed ones.
    """
    p, s, m = law.p, law.s, law.s.user
    given, step = m.given, p.law_step
    fresh = s.epoch != m.epoch
    sample = fresh and s.valid
    m.epoch = s.epoch
    given[0], given[1], given[2] = v_e, v_n, lat
    given[3] = v_e + s.difference[E] if sample else 0.0
    given[4] = v_n + s.difference[N] if sample else 0.0
    given[5] = LOG_SAMPLE if sample else LOG_NONE if fresh else LOG_NOT_YET
    given[6] = yaw
    given[7] = (v_e - m.last[E]) / step if m.asked > 0 else 0.0
    given[8] = (v_n - m.last[N]) / step if m.asked > 0 else 0.0
    m.last[E], m.last[N] = v_e, v_n
    m.asked += 1
    told = m.commanded
    if call_user_law(p.user.step, p.user.handle, m) != 0:
        for i in range(told.shape[0]):
            told[i] = math.nan
    c_e, c_n = told[0] - v_e, told[1] - v_n
    s.damped = told[5] > 0.5
    s.wanted = 1 if s.damped else 0
    s.started = True
    s.correction[E], s.correction[N], s.correction[U] = c_e, c_n, told[4]
    return Correction(c_e, c_n, told[2], told[3]), told[4]

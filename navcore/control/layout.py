"""Where everything lies in the law's arrays: parameters ``p``, state ``s`` and history ``ring``.

Laid out once for every policy and switching method of physics.md section 4, so that adding one is a new file
and a dispatch line, not a new layout. The network itself is part of the *state*: `adaptive`, `schedule`,
`ramp` and `step` re-tune it while it runs.
"""

from __future__ import annotations

MAX_STATES = 4
"""States of a network in one channel (navcore.network.base.MAX_ORDER)."""

# p: constant during a run, float64, shape (PARAMETERS + table rows * 2,)
DAMPING = 0  # FREE, INTERNAL, EXTERNAL
REALISATION = 1  # NETWORK, FEEDBACK, AS_PRINTED
ORDER = 2  # states a channel
POLICY = 3  # code of the policy, navcore.control.policy
SWITCHING = 4  # code of the switching method, navcore.control.switching
LAW_STEP = 5  # s between two calls of the law
NOMINAL_XI = 6  # damping coefficient of the network as configured
FEEDBACK_K1 = 7  # velocity feedback, 1/s
OMEGA_S = 8  # rad/s
POLICY_PARAMETERS = 16  # 16 values, meaning per policy
SWITCHING_PARAMETERS = 32  # 8 values, meaning per switching method
TUNING_PARAMETERS = 40  # 16 values: how to re-tune the network from a damping coefficient
TABLE_ROWS = 56  # number of (argument, damping coefficient) pairs that follow
TABLE = 64
PARAMETERS = 64

FREE, INTERNAL, EXTERNAL = 0, 1, 2
NETWORK, FEEDBACK, AS_PRINTED = 0, 1, 2

# s: changes during a run, float64, shape (STATE,)
DAMPED = 0  # actual state, 0/1
WANTED = 1  # the policy's wish, 0/1
COUNT = 2  # consecutive samples for which the wish differed
XI = 3  # damping coefficient in force
XI_TARGET = 4
SWITCH_TIME = 5  # s, last change of DAMPED
STARTED = 6  # 0 until the first call
MEASURE = 7  # what the policy measured (for the switching view)
CORRECTION = 8  # E, N: velocity correction c applied last (frozen by ramp and bumpless), m/s
DIFFERENCE = 10  # E, N: V_r - V_c held from the last log epoch, m/s
VALID = 12  # the held difference may be used
LOWPASS = 13  # E, N: filtered difference (adaptive)
WINDOW_SUM = 15  # E, N now, E, N earlier (variation)
MEAN_MEMORY = 19  # E, N: mean difference before the event (bumpless)
RING_HEAD = 21
RING_FILL = 22
EPOCH_INDEX = 23  # index of the log epoch in force
NETWORK_A = 32  # dA, row-major MAX_STATES x MAX_STATES
NETWORK_B = 48
NETWORK_C = 52
NETWORK_D = 56
NETWORK_STEADY = 57  # state for a constant unit input
X_E = 64
X_N = 68
X_MEMORY = 72  # E, N network states before the event (bumpless)
STATE = 96

# ring: one row a law call, newest at RING_HEAD: difference E, N and network states E, N (variation, bumpless)
RING_COLUMNS = 2 + 2 * MAX_STATES

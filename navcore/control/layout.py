"""Where everything lies in the law's arrays: parameters ``p``, state ``s`` and history ``ring``.

Laid out once for every policy and switching method of physics.md section 4, so that adding one is a new file
and a dispatch line, not a new layout. The network itself is part of the *state*: `adaptive`, `schedule`,
`ramp` and `step` re-tune it while it runs.
"""

from __future__ import annotations

MAX_STATES = 4
"""States of a network in one channel (navcore.network.base.MAX_ORDER)."""

# p: constant during a run, float64, shape (PARAMETERS + table rows * TABLE_COLUMNS,)
DAMPING = 0  # FREE, INTERNAL, EXTERNAL
REALISATION = 1  # NETWORK, FEEDBACK, AS_PRINTED
ORDER = 2  # states a channel
POLICY = 3  # code of the policy, navcore.control.policy
SWITCHING = 4  # code of the switching method, navcore.control.switching
LAW_STEP = 5  # s between two calls of the law
NOMINAL_XI = 6  # damping coefficient of the network as configured
FEEDBACK_K1 = 7  # velocity feedback of gains that stay, 1/s
OMEGA_S = 8  # rad/s
HISTORY = 9  # 1: clock, history and low-passes are kept
FREEZES = 10  # 1: while undamped the last correction stays
OFFSET_DECAY = 11  # what a call leaves of the offset of a re-tuned network
TAN_HALF = 12  # tan(omega_s T/2), the bilinear step in normalised time
PLAIN = 15  # 1: policy and switching need nothing but the present difference
REMEMBERS = 13  # what of the motion goes into the history, navcore.control.history
SCHEDULED = 14  # 1: the gains follow a schedule
POLICY_PARAMETERS = 16  # 16 values, meaning per policy
SWITCHING_PARAMETERS = 32  # 8 values, meaning per switching method
TUNING_PARAMETERS = 40  # code and parameters of the network that is re-tuned, code 0: none
TUNING_LOW = 48  # below this damping coefficient the re-tuned loop is unstable
TABLE_ROWS = 56  # number of rows (argument m/s, damping coefficient, slope) that follow
TABLE = 64
TABLE_COLUMNS = 3
PARAMETERS = 64

FREE, INTERNAL, EXTERNAL = 0, 1, 2
NOTHING, CLEAR, REST, RESTORE, MASKED = 0, 1, 2, 3, 4
NETWORK, FEEDBACK, AS_PRINTED = 0, 1, 2

# s: changes during a run, float64, shape (STATE,)
DAMPED = 0  # actual state, 0/1
WANTED = 1  # the policy's wish, 0/1
COUNT = 2  # consecutive samples for which the wish differed
XI = 3  # damping coefficient in force
XI_TARGET = 4
SWITCH_TIME = 5  # s, last engagement
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
DECISION = 24  # the policy's own state where it has one (variation), 0/1
OFFSET = 25  # E, N: what re-tuning would have made the correction jump by, fading, m/s
CLOCK = 27  # s since the first call
FRESH = 28  # calls in a row with a valid difference
STEP_TIME = 29  # s, last move of xi (step)
ENGAGED = 30  # 0 until the loop was damped for the first time
FEEDBACK_GAIN = 31  # velocity feedback of gains that change, 1/s; FEEDBACK_K1 is 0 then
NETWORK_A = 32  # dA, row-major MAX_STATES x MAX_STATES
NETWORK_B = 48
NETWORK_C = 52
NETWORK_D = 56
NETWORK_STEADY = 57  # state for a constant unit input
TUNED_XI = 61  # damping coefficient of the coefficients in place
TO_XI = 62  # what a switching method wants the network re-tuned to in this call; 0: as it is
ACTION = 63  # and what then to do with its states
X_E = 64
X_N = 68
X_MEMORY = 72  # E, N network states before the event (bumpless)
LAST_ROW = 80  # of A, and
OUTPUT_ROW = 84  # of the re-tuned network, continuous and normalised (navcore.control.tuned_network)
LAST_HEADING = 88  # rad
TOTAL_HEADING = 89  # rad, without wraps
AUXILIARY_SUM = 90  # over the window of `acceleration`
SCALE = 91  # of its states
SCRATCH = 92
STATE = 96

# ring: one row a law call, newest at RING_HEAD
RING_DIFFERENCE = 0  # E, N: V_r - V_c
RING_INPUT = 2  # E, N: the network's input
RING_X = 4  # E, N: network states before the call
RING_AUXILIARY = 12  # heading without wraps (rad), or acceleration (m/s^2)
RING_DAMPED = 13
RING_COLUMNS = 14

MONITORED = (WANTED, DAMPED, XI, MEASURE)
"""Places in ``s`` that the switching view draws: the wish, the state (0/1), xi, and the policy's measure.

What the measure is, and in which unit, tells `PolicyParameters.measure`; its thresholds tells
`PolicyParameters.limits`.
"""

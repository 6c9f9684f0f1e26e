"""Records of the law: the shared fields of its parameters, state and history, each in one place.

`navcore.law.law` joins them with the records that each policy and each switching method declares for itself.
The network itself is part of the *state*: `adaptive`, `schedule`, `ramp` and `step` re-tune it while it runs.
"""

from typing import Literal, NamedTuple

import numpy as np

from navcore.foundation.records import COUNT, FLAG, REAL, record_type
from navcore.law.added_call import USER_PARAMETERS, USER_STATE
from navcore.networks.base import MAX_ORDER

MAX_STATES = MAX_ORDER
"""Room for the states of a network in one channel.

One size serves all networks. A record sized by the network in use would be a type of its own for each size,
and each kernel would be compiled once for each: two minutes more. What the room costs is memory that a
smaller network never touches.
"""
E, N, U = 0, 1, 2
"""Channels, the first index of what each of them has: two level ones, and the azimuth."""
CHANNELS = 3

LawKind = Literal["free", "internal", "external"]
"""Input of the networks: nothing, minus the computed velocity, or the difference V_r - V_c."""
FREE, INTERNAL, EXTERNAL = 0, 1, 2
CODES: dict[LawKind, int] = {"free": FREE, "internal": INTERNAL, "external": EXTERNAL}
"""Codes of `LawKind` in the compiled law."""
NETWORK, FEEDBACK, AS_PRINTED = 0, 1, 2
"""Realisations of a network."""
NOTHING, CLEAR, REST, RESTORE, MASKED = 0, 1, 2, 3, 4
"""Actions on the network's states that a switching method asks for."""
AS_DECIDED = -1
"""`wanted` while a policy has not said that it wishes something else than it decides."""

TUNING = record_type(
    code=COUNT,  # of the network that is re-tuned (navcore.networks.tuning_codes), 0: none
    values=(REAL, (3,)),  # its parameters, meaning per network
    low=REAL,  # below this damping coefficient the re-tuned loop is unstable
)
COMPASS = record_type(
    k1=REAL,  # K_U1 of the gyrocompass, 1/s
    k2=REAL,  # K_U2
    left=REAL,  # what a call leaves of its rate about the vertical
    gain=REAL,  # what a call adds to it for the north difference, times Omega cos L
)
PARAMETERS = {
    "damping": COUNT,  # FREE, INTERNAL, EXTERNAL: as configured; what feeds the networks is in the state
    "realisation": COUNT,  # NETWORK, FEEDBACK, AS_PRINTED
    "order": COUNT,  # states of a level channel
    "azimuth_order": COUNT,  # states of the azimuth channel; 0: nothing acts there
    "gyrocompass": FLAG,  # a gyrocompass acts there, no network
    "compass": COMPASS,
    "policy": COUNT,  # place of the policy in its registry
    "switching": COUNT,  # place of the switching method in its registry
    "plain": FLAG,  # policy and switching need nothing but the present difference
    "steady": FLAG,  # and, once damped, the policy never wishes anything else
    "keeps_history": FLAG,  # clock, history and low-passes are kept
    "freezes": FLAG,  # while undamped the last correction stays
    "runs_on": FLAG,  # while undamped the network goes on with what the switching method feeds it
    "remembers": COUNT,  # what of the motion goes into the history, navcore.law.history
    "law_step": REAL,  # s between two calls of the law
    "nominal_xi": REAL,  # damping coefficient of the network as configured
    "feedback_k1": REAL,  # velocity feedback of gains that stay, 1/s
    "feeds_back": FLAG,  # the network has a second output, which is the velocity feedback
    "omega_s": REAL,  # rad/s
    "offset_decay": REAL,  # what a call leaves of the offset of a re-tuned network
    "tan_half": REAL,  # tan(omega_s T/2), the bilinear step in normalised time
    "tuning": TUNING,
    "user": USER_PARAMETERS,  # a law from outside the program, in place of all this
}
"""Fields of the parameters, which stay during a run."""

DISCRETE_NETWORK = record_type(
    dA=(REAL, (MAX_STATES, MAX_STATES)),  # transition matrix minus the identity
    B=(REAL, (MAX_STATES,)),
    C=(REAL, (MAX_STATES,)),
    D=REAL,
    E=(REAL, (MAX_STATES,)),  # output row of the velocity feedback, 1/s
    F=REAL,
    steady=(REAL, (MAX_STATES,)),  # state for a constant unit input
    change=(REAL, (MAX_STATES,)),  # of the states in a call, while it is computed (navcore.law.network_state)
)
"""Discrete state space of Q = 1 - H of one channel; what lies beyond the order is zero.

E and F are those of the velocity feedback a = E x + F u (m/s^2); zero unless ``feeds_back``.
"""
RETUNED_NETWORK = record_type(
    xi=REAL,  # damping coefficient of the coefficients in place
    last_row=(REAL, (MAX_STATES,)),  # of A, continuous and normalised
    output=(REAL, (MAX_STATES,)),  # output row
    scale=REAL,  # of the states
    scratch=(REAL, (MAX_STATES,)),
)
"""The network while it is re-tuned (navcore.law.tuned_network)."""
STATE = {
    "damped": FLAG,  # actual state
    "wanted": COUNT,  # the policy's wish, 0 or 1
    "xi": REAL,  # damping coefficient in force
    "xi_target": REAL,
    "measure": REAL,  # what the policy measured, for the switching view
    "started": FLAG,  # there was a call before
    "internal": FLAG,  # the networks are fed with minus the computed velocity, not with V_r - V_c
    "level_only": FLAG,  # the network of the azimuth channel rests
    "engaged": FLAG,  # the loop was damped before
    "clock": REAL,  # s since the first call
    "switch_time": REAL,  # s, last engagement
    "difference": (REAL, (CHANNELS,)),  # V_r - V_c held from the last log epoch, m/s
    "valid": FLAG,  # the held difference may be used
    "fresh": COUNT,  # calls in a row with a valid difference
    "epoch": COUNT,  # index of the log epoch in force
    "steered": FLAG,  # the azimuth channel has started
    "azimuth_epoch": COUNT,  # log epoch of azimuth_input
    "azimuth_input": REAL,  # omega_Ur - omega_U held from that epoch, rad/s
    "latitude": REAL,  # L_r - L_c, rad
    "correction": (REAL, (CHANNELS,)),  # correction c applied last, m/s; in azimuth rad/s
    "output": (REAL, (CHANNELS,)),  # taken off the computed velocity where it is given out, m/s
    "offset": (REAL, (CHANNELS,)),  # what re-tuning would have made the correction jump by, fading, m/s
    "feedback_gain": REAL,  # velocity feedback of gains that change, 1/s; feedback_k1 is 0 then
    "action": COUNT,  # NOTHING, CLEAR, ...: what the switching method asks for in this call
    "to_xi": REAL,  # what it wants the network re-tuned to; 0: as it is
    "network": DISCRETE_NETWORK,  # of both level channels
    "azimuth": DISCRETE_NETWORK,  # of the azimuth channel
    "retuned": RETUNED_NETWORK,
    "x": (REAL, (CHANNELS, MAX_STATES)),  # network states
    "ring_head": COUNT,  # newest row of the history
    "ring_fill": COUNT,  # rows written, at most all
    "last_velocity": (REAL, (2,)),  # V_c at the last call, m/s
    "last_heading": REAL,  # rad
    "total_heading": REAL,  # rad, without wraps
    "user": USER_STATE,
}
"""Fields of the state, which changes during a run."""

HISTORY = {
    "difference": (REAL, (CHANNELS,)),  # V_r - V_c, m/s
    "input": (REAL, (CHANNELS,)),  # the network's input, m/s
    "x": (REAL, (CHANNELS, MAX_STATES)),  # network states before the call
    "auxiliary": REAL,  # heading without wraps (rad), or acceleration (m/s^2)
    "damped": FLAG,
}
"""Fields of a row of the history, one a law call."""


class Law(NamedTuple):
    """A method's law ready to run: what the kernels read and change.

    Attributes
    ----------
    p : record
        Parameters: `PARAMETERS`, and a record of each policy and switching method.
    s : record
        State: `STATE`, and a record of each policy and switching method.
    ring : ndarray of records
        History: `HISTORY`, and a record of each switching method.
    """

    p: np.void
    s: np.void
    ring: np.ndarray


class Sensed(NamedTuple):
    """Input of a call of the law.

    Attributes
    ----------
    v_e, v_n : float
        Computed velocity V_c, m/s.
    heading : float
        rad.
    """

    v_e: float
    v_n: float
    heading: float


class Watched(NamedTuple):
    """Recorded values of the law: the wish, the state (0/1), xi in force, the policy's measure."""

    wanted: float
    damped: float
    xi: float
    measure: float

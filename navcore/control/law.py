"""The damping law: one call a step gives the correction of both channels (compiled, both fidelities).

What it returns for each channel: c (m/s), added to the computed velocity where the platform's transport rate
is formed, V* = V_c + c, and a (m/s^2), fed back into the velocity integrator. Network form: c = Q(s) d with
Q = 1 - H and d = V_r - V_c (external) or -V_c (internal), a = 0. Velocity feedback (`compass`, physics.md
3.1): c = -K2 d + P with P' = -K3 d, a = K1 d. Both are the same state-space block.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from navcore.compiled import inlined, kernel
from navcore.control.combination import LOW_MARGIN, combination_faults, network_in_force, realisation_of
from navcore.control.history import remember
from navcore.control.layout import (
    ACTION,
    AS_PRINTED,
    CLEAR,
    CLOCK,
    CORRECTION,
    DAMPED,
    DAMPING,
    DECISION,
    DIFFERENCE,
    ENGAGED,
    EPOCH_INDEX,
    EXTERNAL,
    FEEDBACK,
    FEEDBACK_GAIN,
    FEEDBACK_K1,
    FREE,
    FREEZES,
    HISTORY,
    INTERNAL,
    LAW_STEP,
    MASKED,
    MAX_STATES,
    NETWORK,
    NETWORK_A,
    NETWORK_B,
    NETWORK_C,
    NETWORK_D,
    NETWORK_STEADY,
    NOMINAL_XI,
    OFFSET,
    OFFSET_DECAY,
    OMEGA_S,
    ORDER,
    PARAMETERS,
    PLAIN,
    POLICY,
    POLICY_PARAMETERS,
    REALISATION,
    REMEMBERS,
    REST,
    RESTORE,
    RING_COLUMNS,
    SCHEDULED,
    STARTED,
    STATE,
    SWITCH_TIME,
    SWITCHING,
    SWITCHING_PARAMETERS,
    TABLE,
    TABLE_COLUMNS,
    TABLE_ROWS,
    TAN_HALF,
    TO_XI,
    TUNING_LOW,
    TUNING_PARAMETERS,
    VALID,
    WANTED,
    XI,
    XI_TARGET,
)
from navcore.control.network_state import advance_network, clear_network, rest
from navcore.control.policy import PolicyParameters, decide
from navcore.control.policy.adaptive import Adaptive
from navcore.control.policy.constant import Constant
from navcore.control.policy.schedule import Schedule, follow_schedule
from navcore.control.policy.threshold import Threshold, decide_threshold
from navcore.control.switching import SwitchingParameters, switch
from navcore.control.switching.bumpless import restore
from navcore.control.switching.hard import Hard
from navcore.control.tuned_network import retune, tune
from navcore.errors import InputError
from navcore.filters import discretise
from navcore.loop import analyse
from navcore.network.base import LinearNetwork, NetworkParameters
from navcore.network.compass import CompassNetwork

__all__ = ["Law", "law_step", "network_in_force", "prepare_law", "realisation_of"]

THRESHOLD = Threshold.code
_DAMPING_CODES = {"free": FREE, "internal": INTERNAL, "external": EXTERNAL}
_REALISATION_CODES = {"network": NETWORK, "feedback": FEEDBACK, "as_printed": AS_PRINTED}
_OFFSET_FADES_S = 100.0
"""Time constant with which the correction passes to that of a re-tuned network."""


@inlined
def law_step(p, s, ring, v_e, v_n, accel, heading):
    """Return (c_E, c_N, a_E, a_N) for computed velocity V_c (m/s), |acceleration| (m/s^2) and heading (rad).

    The held difference V_r - V_c and its validity are already in ``s[DIFFERENCE]``, ``s[VALID]``.
    """
    if p[DAMPING] == FREE:
        return 0.0, 0.0, 0.0, 0.0
    if p[PLAIN] == 0.0:
        return _full_step(p, s, ring, v_e, v_n, accel, heading)
    # What follows gives what the full step gives; inlined without the rest of it, it takes half the time.
    external = p[DAMPING] == EXTERNAL
    u_e = s[DIFFERENCE] if external else -v_e
    u_n = s[DIFFERENCE + 1] if external else -v_n
    wanted = decide_threshold(p, s, ring, accel, heading) if p[POLICY] == THRESHOLD else True
    if external and s[VALID] == 0.0:
        wanted = False
    s[WANTED] = 1.0 if wanted else 0.0
    if s[STARTED] == 0.0:
        s[STARTED] = 1.0
        clear_network(p, s, u_e, u_n)
    if wanted and s[DAMPED] == 0.0:
        clear_network(p, s, u_e, u_n)
    s[DAMPED] = 1.0 if wanted else 0.0
    s[XI] = p[NOMINAL_XI] if wanted else 0.0
    if s[DAMPED] == 0.0:
        s[CORRECTION] = 0.0
        s[CORRECTION + 1] = 0.0
        return 0.0, 0.0, 0.0, 0.0
    return _correct(p, s, v_e, v_n, u_e, u_n, p[FEEDBACK_K1])


@inlined
def _correct(p, s, v_e, v_n, u_e, u_n, k1):
    c_e, c_n = advance_network(p, s, u_e, u_n)
    if p[REALISATION] == AS_PRINTED:
        # Deng 4 forms the platform rate from the difference alone: the reference's transport rate is missing.
        c_e -= v_e + u_e
        c_n -= v_n + u_n
    s[CORRECTION] = c_e
    s[CORRECTION + 1] = c_n
    return c_e, c_n, k1 * u_e, k1 * u_n


@inlined
def _carry_out(p, s, ring, u_e, u_n):
    """Do to the network what the switching method asks for."""
    if p[TUNING_PARAMETERS] != 0.0 and s[TO_XI] > 0.0:
        retune(p, s, s[TO_XI], u_e, u_n)
    if s[ACTION] == CLEAR or s[STARTED] == 0.0:
        clear_network(p, s, u_e, u_n)
    if s[ACTION] == REST:
        rest(p, s, u_e, u_n)
    elif s[ACTION] == RESTORE:
        restore(p, s, ring)
    elif s[ACTION] == MASKED:
        advance_network(p, s, u_e, u_n)


@kernel
def _full_step(p, s, ring, v_e, v_n, accel, heading):
    """Every policy and switching method; arguments and result as of `law_step`."""
    external = p[DAMPING] == EXTERNAL
    u_e = s[DIFFERENCE] if external else -v_e
    u_n = s[DIFFERENCE + 1] if external else -v_n
    if p[HISTORY] != 0.0:
        remember(p, s, ring, u_e, u_n, accel, heading, p[REMEMBERS])
    s[WANTED] = -1.0
    wanted = decide(p, s, ring, accel, heading)
    if s[WANTED] < 0.0:
        s[WANTED] = 1.0 if wanted else 0.0
    if external and s[VALID] == 0.0:
        wanted = False
        s[WANTED] = 0.0
    if wanted and s[DAMPED] == 0.0:
        s[SWITCH_TIME] = s[CLOCK]
    if p[SCHEDULED] != 0.0:
        follow_schedule(p, s, u_e, u_n)
    switch(p, s, ring, wanted)
    _carry_out(p, s, ring, u_e, u_n)
    s[STARTED] = 1.0
    if s[DAMPED] == 0.0:
        if p[FREEZES] == 0.0:
            s[CORRECTION] = 0.0
            s[CORRECTION + 1] = 0.0
        return s[CORRECTION], s[CORRECTION + 1], 0.0, 0.0
    s[ENGAGED] = 1.0
    c_e, c_n, a_e, a_n = _correct(p, s, v_e, v_n, u_e, u_n, p[FEEDBACK_K1] + s[FEEDBACK_GAIN])
    s[CORRECTION], s[CORRECTION + 1] = c_e + s[OFFSET], c_n + s[OFFSET + 1]
    s[OFFSET] *= p[OFFSET_DECAY]
    s[OFFSET + 1] *= p[OFFSET_DECAY]
    return s[CORRECTION], s[CORRECTION + 1], a_e, a_n


@dataclass(frozen=True)
class Law:
    """A method's law ready to run; the arrays are what the kernels take and change.

    Attributes
    ----------
    p : ndarray, shape (PARAMETERS + 3 * table rows,)
        Constant parameters, laid out in `navcore.control.layout`.
    s : ndarray, shape (STATE,)
        State at the start.
    ring : ndarray, shape (rows, RING_COLUMNS)
        History.
    """

    p: np.ndarray
    s: np.ndarray
    ring: np.ndarray


def prepare_law(
    damping: str,
    parameters: NetworkParameters,
    network: LinearNetwork,
    policy: PolicyParameters,
    switching: SwitchingParameters,
    law_step_s: float,
) -> Law:
    """Lay out the arrays of a method's law.

    Parameters
    ----------
    damping : {"free", "internal", "external"}
        Kind of damping.
    parameters, network : NetworkParameters, LinearNetwork
        The network as configured, and as H(s) at the site (of `network_in_force` or as configured: what the
        policy brings itself is formed anew).
    policy, switching : PolicyParameters, SwitchingParameters
        When and how to switch.
    law_step_s : float
        Time between two calls of `law_step`, s.

    Raises
    ------
    InputError
        Network, policy and switching do not go together.
    """
    omega_s = network.omega_s
    faults = list(combination_faults(damping, parameters, policy, switching, law_step_s))
    if faults:
        raise InputError(faults)
    running = network_in_force(damping, parameters, policy)
    if running is not parameters:
        parameters, network = running, running.transfer(omega_s)
    table = policy.table_rows() if damping != "free" else []
    p = np.zeros(PARAMETERS + TABLE_COLUMNS * len(table))
    s = np.zeros(STATE)
    _fill_settings(p, damping, policy, switching, law_step_s)
    p[REALISATION], p[OMEGA_S] = _REALISATION_CODES[realisation_of(damping, parameters)], omega_s
    p[TABLE_ROWS], p[TABLE:] = len(table), np.ravel(table)
    xi = parameters.damping_coefficient()
    p[NOMINAL_XI] = s[XI_TARGET] = analyse(network).damping_ratio if xi is None else xi
    s[EPOCH_INDEX], s[DECISION] = -1.0, 1.0
    _fill_form(p, s, parameters, network, policy, switching)
    rows = max(1, policy.ring_rows(law_step_s), switching.ring_rows(law_step_s))
    return Law(p, s, np.zeros((rows, RING_COLUMNS)))


def _fill_settings(
    p: np.ndarray, damping: str, policy: PolicyParameters, switching: SwitchingParameters, law_step_s: float
) -> None:
    p[DAMPING], p[POLICY], p[SWITCHING] = _DAMPING_CODES[damping], policy.code, switching.code
    p[LAW_STEP], p[REMEMBERS] = law_step_s, policy.remembers
    p[HISTORY], p[FREEZES] = policy.keeps_time or switching.keeps_time, switching.freezes
    p[PLAIN] = isinstance(policy, Constant | Threshold) and isinstance(switching, Hard)
    p[OFFSET_DECAY] = math.exp(-law_step_s / _OFFSET_FADES_S)
    _fill(p, POLICY_PARAMETERS, policy.packed(law_step_s))
    _fill(p, SWITCHING_PARAMETERS, switching.packed(law_step_s))


def _fill_form(
    p: np.ndarray,
    s: np.ndarray,
    parameters: NetworkParameters,
    network: LinearNetwork,
    policy: PolicyParameters,
    switching: SwitchingParameters,
) -> None:
    """Put the network into the state, in the form in which it runs."""
    omega_s, law_step_s = p[OMEGA_S], p[LAW_STEP]
    tuning = parameters.tuning(omega_s) if policy.tunes or switching.tunes else None
    p[TAN_HALF] = math.tan(0.5 * omega_s * law_step_s)
    if isinstance(policy, Schedule):
        # filled by `follow_schedule` at the first call
        p[SCHEDULED], p[ORDER] = 1.0, 1
    elif p[DAMPING] != FREE and tuning is not None:
        p[ORDER] = network.order
        p[TUNING_LOW] = LOW_MARGIN * parameters.least_coefficient()
        _fill(p, TUNING_PARAMETERS, tuning)
        if isinstance(policy, Adaptive):
            p[NOMINAL_XI] = s[XI_TARGET] = max(p[NOMINAL_XI], p[TUNING_LOW])
        tune(p, s, s[XI_TARGET])
    elif p[REALISATION] != NETWORK and isinstance(parameters, CompassNetwork):
        _fill_feedback(p, s, parameters.gains(omega_s), law_step_s)
    else:
        _fill_network(p, s, network, law_step_s)


def _fill(target: np.ndarray, start: int, values: list[float]) -> None:
    target[start : start + len(values)] = values


def _fill_network(p: np.ndarray, s: np.ndarray, network: LinearNetwork, law_step_s: float) -> None:
    """Put Q = 1 - H into the state: the same dA and B, C and the direct term reversed."""
    discrete = discretise(network, law_step_s)
    n = len(discrete.B)
    p[ORDER] = n
    for i in range(n):
        s[NETWORK_A + MAX_STATES * i : NETWORK_A + MAX_STATES * i + n] = discrete.dA[i]
    s[NETWORK_B : NETWORK_B + n] = discrete.B
    s[NETWORK_C : NETWORK_C + n] = -discrete.C
    s[NETWORK_D] = 1.0 - discrete.D
    s[NETWORK_STEADY : NETWORK_STEADY + n] = discrete.steady_state(1.0)


def _fill_feedback(
    p: np.ndarray, s: np.ndarray, gains: tuple[float, float, float], law_step_s: float
) -> None:
    """Put c = -K2 d + P, P' = -K3 d into the same block; D takes the mean of P over the held step."""
    k1, k2, k3 = gains
    p[ORDER], p[FEEDBACK_K1] = 1, k1
    s[NETWORK_B] = -k3 * law_step_s
    s[NETWORK_C] = 1.0
    s[NETWORK_D] = -k2 - 0.5 * k3 * law_step_s

"""The damping law: one call a step gives the correction of both channels (compiled, both fidelities).

What it returns for each channel: c (m/s), added to the computed velocity where the platform's transport rate
is formed, V* = V_c + c, and a (m/s^2), fed back into the velocity integrator. Network form: c = Q(s) d with
Q = 1 - H and d = V_r - V_c (external) or -V_c (internal), a = 0. Velocity feedback (`compass`, physics.md
3.1): c = -K2 d + P with P' = -K3 d, a = K1 d. Both are the same state-space block.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from navcore.compiled import inlined
from navcore.control.layout import (
    AS_PRINTED,
    CORRECTION,
    DAMPED,
    DAMPING,
    DIFFERENCE,
    EPOCH_INDEX,
    EXTERNAL,
    FEEDBACK,
    FEEDBACK_K1,
    FREE,
    INTERNAL,
    LAW_STEP,
    MAX_STATES,
    NETWORK,
    NETWORK_A,
    NETWORK_B,
    NETWORK_C,
    NETWORK_D,
    NETWORK_STEADY,
    NOMINAL_XI,
    OMEGA_S,
    ORDER,
    PARAMETERS,
    POLICY,
    POLICY_PARAMETERS,
    REALISATION,
    RING_COLUMNS,
    STARTED,
    STATE,
    SWITCHING,
    SWITCHING_PARAMETERS,
    VALID,
    WANTED,
)
from navcore.control.network_state import advance_network, clear_network
from navcore.control.policy import PolicyParameters, decide
from navcore.control.switching import SwitchingParameters, switch
from navcore.filters import discretise
from navcore.loop import analyse
from navcore.network.base import LinearNetwork, NetworkParameters
from navcore.network.compass import CompassNetwork

_DAMPING_CODES = {"free": FREE, "internal": INTERNAL, "external": EXTERNAL}
_REALISATION_CODES = {"network": NETWORK, "feedback": FEEDBACK, "as_printed": AS_PRINTED}


@inlined
def law_step(p, s, ring, v_e, v_n, accel, heading):
    """Return (c_E, c_N, a_E, a_N) for computed velocity V_c (m/s), |acceleration| (m/s^2) and heading (rad).

    The held difference V_r - V_c and its validity are already in ``s[DIFFERENCE]``, ``s[VALID]``.
    """
    if p[DAMPING] == FREE:
        return 0.0, 0.0, 0.0, 0.0
    external = p[DAMPING] == EXTERNAL
    u_e = s[DIFFERENCE] if external else -v_e
    u_n = s[DIFFERENCE + 1] if external else -v_n
    wanted = decide(p, s, ring, accel, heading)
    if external and s[VALID] == 0.0:
        wanted = False
    s[WANTED] = 1.0 if wanted else 0.0
    if s[STARTED] == 0.0:
        s[STARTED] = 1.0
        clear_network(p, s, u_e, u_n)
    switch(p, s, ring, wanted, u_e, u_n)
    if s[DAMPED] == 0.0:
        s[CORRECTION] = 0.0
        s[CORRECTION + 1] = 0.0
        return 0.0, 0.0, 0.0, 0.0
    c_e, c_n = advance_network(p, s, u_e, u_n)
    if p[REALISATION] == AS_PRINTED:
        # Deng 4 forms the platform rate from the difference alone: the reference's transport rate is missing.
        c_e -= v_e + u_e
        c_n -= v_n + u_n
    s[CORRECTION] = c_e
    s[CORRECTION + 1] = c_n
    return c_e, c_n, p[FEEDBACK_K1] * u_e, p[FEEDBACK_K1] * u_n


@dataclass(frozen=True)
class Law:
    """A method's law ready to run; the arrays are what the kernels take and change.

    Attributes
    ----------
    p : ndarray, shape (PARAMETERS + 2 * table rows,)
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
        The network as configured and as H(s).
    policy, switching : PolicyParameters, SwitchingParameters
        When and how to switch.
    law_step_s : float
        Time between two calls of `law_step`, s.
    """
    realisation = realisation_of(damping, parameters)
    p = np.zeros(PARAMETERS)
    s = np.zeros(STATE)
    p[DAMPING], p[REALISATION] = _DAMPING_CODES[damping], _REALISATION_CODES[realisation]
    p[POLICY], p[SWITCHING] = policy.code, switching.code
    p[LAW_STEP], p[OMEGA_S] = law_step_s, network.omega_s
    xi = parameters.damping_coefficient()
    p[NOMINAL_XI] = analyse(network).damping_ratio if xi is None else xi
    _fill(p, POLICY_PARAMETERS, policy.packed())
    _fill(p, SWITCHING_PARAMETERS, switching.packed())
    if realisation != "network" and isinstance(parameters, CompassNetwork):
        _fill_feedback(p, s, parameters.gains(network.omega_s), law_step_s)
    else:
        _fill_network(p, s, network, law_step_s)
    s[EPOCH_INDEX] = -1.0
    rows = max(1, policy.ring_rows(law_step_s), switching.ring_rows(law_step_s))
    return Law(p, s, np.zeros((rows, RING_COLUMNS)))


def realisation_of(damping: str, parameters: NetworkParameters) -> str:
    """Realisation in force: internal damping always uses the network form (contract)."""
    if damping == "external" and isinstance(parameters, CompassNetwork):
        return parameters.realisation
    return "network"


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

"""The damping law: one call a step gives the correction of both channels (compiled, both fidelities).

What it returns for each channel: c (m/s), added to the computed velocity where the platform's transport rate
is formed, V* = V_c + c, and a (m/s^2), fed back into the velocity integrator. Network form: c = Q(s) d with
Q = 1 - H and d = V_r - V_c (external) or -V_c (internal), a = 0. Velocity feedback (`compass`, theory.md
3.1): c = -K2 d + P with P' = -K3 d, a = K1 d. Both are the same state-space block. A network with two outputs
(`optimal` with velocity feedback) has a = G(s) d beside it, from the same states.
"""

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from navcore.analysis import analyse
from navcore.foundation.errors import InputError
from navcore.foundation.records import fill_record, new_record, record_type
from navcore.foundation.registry import Registry
from navcore.law.added_call import (
    ADDED,
    ADDED_ID,
    ADDED_MEMORY,
    POLICY_NUMBERS,
    SWITCHING_NUMBERS,
)
from navcore.law.added_code import policy_place, remembered, switching_place
from navcore.law.combination import combination_faults, network_in_force, realisation_of
from navcore.law.policy import POLICIES, PolicyParameters
from navcore.law.policy.base import LOW_MARGIN
from navcore.law.records import (
    AS_PRINTED,
    CODES,
    FEEDBACK,
    FREE,
    HISTORY,
    INTERNAL,
    MAX_STATES,
    NETWORK,
    PARAMETERS,
    STATE,
    Law,
    LawKind,
)
from navcore.law.step import law_step
from navcore.law.switching import SWITCHINGS, SwitchingParameters
from navcore.law.tuned_network import tune
from navcore.networks.azimuth_loop import AzimuthChannel, AzimuthGains
from navcore.networks.base import LinearNetwork, NetworkParameters
from navcore.networks.discrete import discretise

__all__ = ["Law", "law_step", "network_in_force", "prepare_law", "realisation_of"]


def _places(kinds: Registry[Any], of: str, added: np.dtype) -> np.dtype:
    """Records of a registry's own classes under their ids, and the place of an added one."""
    own = {name: getattr(kind, of) for name, kind in kinds.own.items()}
    return record_type(**own, **{ADDED_ID: added})


LAW_PARAMETERS = record_type(
    **PARAMETERS,
    policies=_places(POLICIES, "numbers", POLICY_NUMBERS),
    switchings=_places(SWITCHINGS, "numbers", SWITCHING_NUMBERS),
)
"""Parameters of a law: the shared ones, and those of each policy and switching method under its id."""
LAW_STATE = record_type(
    **STATE,
    policies=_places(POLICIES, "memory", ADDED_MEMORY),
    switchings=_places(SWITCHINGS, "memory", ADDED_MEMORY),
)
"""State of a law, likewise."""
LAW_HISTORY = record_type(
    **HISTORY, switchings=record_type(**{name: kind.history for name, kind in SWITCHINGS.own.items()})
)
"""One row of a law's history."""

_RECORDS = LAW_PARAMETERS, LAW_STATE, LAW_HISTORY
_REALISATION_CODES = {"network": NETWORK, "feedback": FEEDBACK, "as_printed": AS_PRINTED}
_OFFSET_FADES_S = 100.0
"""Time constant with which the correction passes to that of a re-tuned network."""


def prepare_law(
    damping: LawKind,
    parameters: NetworkParameters,
    network: LinearNetwork,
    policy: PolicyParameters,
    switching: SwitchingParameters,
    law_step_s: float,
    azimuth: AzimuthChannel | None = None,
) -> Law:
    """Fill the records of a method's law.

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
    azimuth : LinearNetwork or AzimuthGains, optional
        Y(s) or the gyrocompass of the azimuth channel, for `navcore.law.azimuth.steer`.

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
    coefficient = parameters.damping_coefficient()
    xi = analyse(network).damping_ratio if coefficient is None else coefficient
    p = new_record(
        LAW_PARAMETERS,
        damping=CODES[damping],
        realisation=_REALISATION_CODES[realisation_of(damping, parameters)],
        omega_s=omega_s,
        nominal_xi=xi,
        **_settings(policy, switching, law_step_s, omega_s),
    )
    s = new_record(
        LAW_STATE,
        xi_target=xi,
        epoch=-1,
        internal=CODES[damping] == INTERNAL,
        policies=_memory(policy),
    )
    p["tan_half"] = math.tan(0.5 * omega_s * law_step_s)
    _fill_form(p, s, parameters, network, policy, switching)
    if isinstance(azimuth, AzimuthGains):
        left = math.exp(-azimuth.k4 * law_step_s)
        p["gyrocompass"], p["azimuth_order"] = True, 1
        gain = azimuth.k3 * (1.0 - left) / azimuth.k4
        fill_record(p["compass"], {"k1": azimuth.k1, "k2": azimuth.k2, "left": left, "gain": gain})
    elif azimuth is not None:
        p["azimuth_order"] = azimuth.order
        fill_record(s["azimuth"], _complement(azimuth, law_step_s))
    rows = max(1, policy.ring_rows(law_step_s), switching.ring_rows(law_step_s))
    return Law(p, s, np.zeros(rows, LAW_HISTORY))


def _settings(
    policy: PolicyParameters, switching: SwitchingParameters, law_step_s: float, omega_s: float
) -> dict[str, Any]:
    """Parameters that policy and switching method decide."""
    own = policy.id in POLICIES.own, switching.id in SWITCHINGS.own
    plain = all(own) and policy.plain and switching.plain
    return {
        "policy": list(POLICIES.own).index(policy.id) if own[0] else ADDED,
        "switching": list(SWITCHINGS.own).index(switching.id) if own[1] else ADDED,
        "plain": plain,
        "steady": plain and policy.always,
        "keeps_history": policy.keeps_time or switching.keeps_time,
        "freezes": switching.freezes,
        "runs_on": switching.feed is not None,
        "remembers": policy.remembers,
        "law_step": law_step_s,
        "offset_decay": math.exp(-law_step_s / _OFFSET_FADES_S),
        "policies": _numbers(policy, policy_place, POLICIES, policy.packed(law_step_s)),
        "switchings": _numbers(switching, switching_place, SWITCHINGS, switching.packed(law_step_s, omega_s)),
    }


def _numbers(
    part: Any, place: Callable[..., dict[str, Any]], kinds: Registry[Any], packed: dict[str, Any]
) -> dict[str, Any]:
    """Numbers of a policy or switching method under its id, or in the place of an added one."""
    if part.id in kinds.own:
        return {part.id: packed}
    return {ADDED_ID: place(type(part), _RECORDS, packed)}


def _memory(policy: PolicyParameters) -> dict[str, Any]:
    """Memory of a policy that is not 0 at the start, likewise."""
    values = policy.remembered()
    return {policy.id: values} if policy.id in POLICIES.own else {ADDED_ID: remembered(type(policy), values)}


def _fill_form(
    p: np.void,
    s: np.void,
    parameters: NetworkParameters,
    network: LinearNetwork,
    policy: PolicyParameters,
    switching: SwitchingParameters,
) -> None:
    """Put the network into the state, in the form in which it runs."""
    omega_s, law_step_s = p["omega_s"], p["law_step"]
    tuning = parameters.tuning(omega_s) if policy.tunes or switching.tunes else None
    if policy.follow is not None:
        # filled by the policy at the first call
        p["order"] = 1
    elif p["damping"] != FREE and tuning is not None:
        code, *values = tuning
        low = LOW_MARGIN * parameters.least_coefficient()
        p["order"] = network.order
        p["tuning"]["code"], p["tuning"]["low"] = code, low
        p["tuning"]["values"][: len(values)] = values
        if policy.tunes:
            p["nominal_xi"] = s["xi_target"] = max(p["nominal_xi"], low)
        tune(p, s, s["xi_target"])
    elif p["realisation"] != NETWORK and (gains := parameters.feedback_gains(omega_s)) is not None:
        p["order"], p["feedback_k1"] = 1, gains[0]
        fill_record(s["network"], _feedback(gains, law_step_s))
    else:
        p["order"] = network.order
        p["feeds_back"] = network.feedback_p is not None
        fill_record(s["network"], _complement(network, law_step_s))


def _complement(network: LinearNetwork, law_step_s: float) -> dict[str, Any]:
    """Q = 1 - H in discrete time: C and the direct term reversed; velocity feedback stays as it is."""
    discrete = discretise(network, law_step_s)
    room = (0, MAX_STATES - discrete.order)
    return {
        "dA": np.pad(discrete.dA, (room, room)),
        "B": np.pad(discrete.B, room),
        "C": np.pad(-discrete.C, room),
        "D": 1.0 - discrete.D,
        "E": 0.0 if discrete.E is None else np.pad(discrete.E, room),
        "F": discrete.F,
        "steady": np.pad(discrete.steady_state(1.0), room),
    }


def _feedback(gains: tuple[float, float, float], law_step_s: float) -> dict[str, Any]:
    """C = -K2 d + P, P' = -K3 d in the same block; D takes the mean of P over the held step."""
    _, k2, k3 = gains
    only = np.eye(1, MAX_STATES)[0]
    return {"B": -k3 * law_step_s * only, "C": only, "D": -k2 - 0.5 * k3 * law_step_s}

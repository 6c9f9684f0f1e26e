"""Which network, policy and switching method make sense together, and what runs when they do."""

from collections.abc import Iterator

from navcore.foundation.errors import Fault
from navcore.foundation.text import Text
from navcore.law.policy.base import PolicyParameters
from navcore.law.records import CODES, EXTERNAL, FREE, LawKind
from navcore.law.switching.base import SwitchingParameters
from navcore.networks.base import NetworkParameters
from navcore.networks.undamped import UndampedNetwork

LONGEST_HISTORY = 100_000
"""Law calls that a policy or switching method may look back."""


def network_in_force(
    damping: LawKind, network: NetworkParameters, policy: PolicyParameters
) -> NetworkParameters:
    """Network that runs: `adaptive` may bring its own, `schedule` ends at its last gains, free has none."""
    return UndampedNetwork() if CODES[damping] == FREE else policy.network_in_force(network)


def realisation_of(damping: LawKind, parameters: NetworkParameters) -> str:
    """Realisation in force: internal damping always uses the network form (theory.md 3)."""
    return parameters.external_form if CODES[damping] == EXTERNAL else "network"


def combination_faults(
    damping: LawKind,
    network: NetworkParameters,
    policy: PolicyParameters,
    switching: SwitchingParameters,
    law_step_s: float,
) -> Iterator[Fault]:
    """Say what does not go together; fields are named relative to the method's block.

    Parameters
    ----------
    damping : {"free", "internal", "external"}
        Free: nothing is asked of the rest.
    network, policy, switching
        As configured.
    law_step_s : float
        Time between two calls of the law, s.
    """
    if CODES[damping] == FREE:
        return
    running = policy.network_in_force(network)
    faults = [*policy.network_faults(network)]
    if policy.changes_input and CODES[damping] != EXTERNAL:
        reason = Text('needs damping = "external": the policy itself passes to internal damping')
        faults.append(Fault("", "policy.id", policy.id, reason))
    if policy.changes_input and not switching.follows_input:
        reason = Text(
            'must be hard or step with policy "{id}", which changes the input of the network', id=policy.id
        )
        faults.append(Fault("", "switching.id", switching.id, reason))
    elif switching.needs_log and CODES[damping] != EXTERNAL:
        faults.append(Fault("", "switching.id", switching.id, switching.needs_log))
    else:
        faults += switching.network_faults(running, realisation_of(damping, running), policy)
    for name, part in (("policy", policy), ("switching", switching)):
        rows = part.ring_rows(law_step_s)
        if rows > LONGEST_HISTORY:
            reason = Text(
                "would look back {rows} steps of {law_step_s:g} s: at most {longest_history}",
                rows=rows,
                law_step_s=law_step_s,
                longest_history=LONGEST_HISTORY,
            )
            faults.append(Fault("", f"{name}.id", part.id, reason))
    if not faults:
        faults += policy.stability_faults(network)
    yield from faults


def combination_warnings(
    network: NetworkParameters, policy: PolicyParameters, switching: SwitchingParameters
) -> tuple[str, ...]:
    """Return the notices about policy and switching method with this network.

    Parameters
    ----------
    network, policy, switching
        As configured, free of `combination_faults`.
    """
    return (*policy.warnings(network), *switching.warnings(policy.network_in_force(network)))

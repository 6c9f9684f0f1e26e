"""Which network, policy and switching method make sense together, and what runs when they do."""

from __future__ import annotations

from collections.abc import Iterator

from navcore.control.policy.adaptive import HIGHEST, LOWEST, Adaptive
from navcore.control.policy.base import PolicyParameters
from navcore.control.policy.schedule import Schedule
from navcore.control.switching.base import SwitchingParameters
from navcore.control.switching.bumpless import Bumpless
from navcore.control.switching.ramp import Ramp
from navcore.errors import Fault, InputError
from navcore.loop.analysis import H0_TOLERANCE
from navcore.network.base import NetworkParameters
from navcore.network.compass import CompassNetwork
from navcore.network.undamped import UndampedNetwork

LONGEST_HISTORY = 100_000
"""Law calls that a policy or switching method may look back."""
LOW_MARGIN = 1.05
"""The law stays this much above the damping coefficient at which a loop becomes unstable."""
_RETUNABLE = "complementary, pole2 or unity2"
_ADAPTABLE = "pole2 or unity2"


def network_in_force(damping: str, network: NetworkParameters, policy: PolicyParameters) -> NetworkParameters:
    """Network that runs: `adaptive` may bring its own, `schedule` ends at its last gains, free has none."""
    return UndampedNetwork() if damping == "free" else policy.network_in_force(network)


def realisation_of(damping: str, parameters: NetworkParameters) -> str:
    """Realisation in force: internal damping always uses the network form (contract)."""
    if damping == "external" and isinstance(parameters, CompassNetwork):
        return parameters.realisation
    return "network"


def combination_faults(
    damping: str,
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
    if damping == "free":
        return
    found = [*_policy_faults(network, policy)]
    found += _switching_faults(damping, policy.network_in_force(network), policy, switching)
    for name, part in (("policy", policy), ("switching", switching)):
        rows = part.ring_rows(law_step_s)
        if rows > LONGEST_HISTORY:
            reason = f"would look back {rows} steps of {law_step_s:g} s: at most {LONGEST_HISTORY}"
            found.append(Fault("", f"{name}.id", part.id, reason))
    if not found and isinstance(policy, Adaptive):
        found += _stability_faults(policy, network)
    yield from found


def _policy_faults(network: NetworkParameters, policy: PolicyParameters) -> Iterator[Fault]:
    if isinstance(policy, Schedule) and not isinstance(network, CompassNetwork):
        allowed = f'changes the gains K1, K2, K3: needs network.id = "compass", not "{network.id}"'
        yield Fault("", "policy.id", policy.id, allowed)
    if not isinstance(policy, Adaptive):
        return
    if policy.network is not None:
        if not isinstance(network, UndampedNetwork) and network != policy.network:
            allowed = f'differs from the policy\'s own network "{policy.network.id}": give only one of them'
            yield Fault("", "network.id", network.id, allowed)
    elif network.id not in ("none", "pole2", "unity2"):
        allowed = f'cannot re-tune network "{network.id}": must be {_ADAPTABLE}, in network or policy.network'
        yield Fault("", "policy.id", policy.id, allowed)


def _switching_faults(
    damping: str, network: NetworkParameters, policy: PolicyParameters, switching: SwitchingParameters
) -> Iterator[Fault]:
    def refuse(allowed: str) -> Fault:
        return Fault("", "switching.id", switching.id, allowed)

    if isinstance(policy, Schedule) and (switching.tunes or isinstance(switching, Bumpless)):
        yield refuse('must be hard or keep with policy "schedule", whose gains begin anew at each start')
        return
    if switching.tunes and network.tuning(1.0) is None:
        allowed = f'moves the damping coefficient, which network "{network.id}" has not or cannot change'
        yield refuse(f"{allowed} while it runs: needs network {_RETUNABLE}")
    elif isinstance(switching, Ramp) and network.least_coefficient() > 0.0:
        allowed = f"passes damping coefficients below {network.least_coefficient():.3g}, at which the loop of"
        yield refuse(f'{allowed} "{network.id}" as printed is unstable')
    if isinstance(switching, Bumpless) and realisation_of(damping, network) != "network":
        allowed = "needs a network that comes to rest with a standing difference"
        yield refuse(f'{allowed}: network.realisation must be "network" with compass')


def _stability_faults(policy: Adaptive, network: NetworkParameters) -> Iterator[Fault]:
    """Refuse a printed form that is unstable wherever the law can go; it is held above that otherwise."""
    low = LOW_MARGIN * policy.network_in_force(network).least_coefficient()
    if low > HIGHEST:
        reason = f"is unstable up to xi = {low:.3g} with these n1, n2: must be stable below {HIGHEST}"
        at = "network" if policy.network is None else "policy.network"
        yield Fault("", f"{at}.variant", "as_printed", reason)


def combination_warnings(
    damping: str, network: NetworkParameters, policy: PolicyParameters, switching: SwitchingParameters
) -> tuple[str, ...]:
    """What the user should know about policy and switching method with this network.

    Parameters
    ----------
    damping, network, policy, switching
        As configured, free of `combination_faults`.
    """
    if damping == "free":
        return ()
    found = list(policy.warnings())
    running = policy.network_in_force(network)
    least = running.least_coefficient()
    if isinstance(policy, Adaptive) and least > LOWEST:
        found.append(f"adaptive: below xi = {least:.3g} the printed form is unstable: held above it")
    if isinstance(switching, Bumpless):
        try:
            h0 = running.transfer(1.24e-3).h0
        except InputError:
            return tuple(found)
        if abs(h0 - 1.0) > H0_TOLERANCE:
            found.append("bumpless: H(0) differs from 1, so a change of the log acts for good")
    return tuple(found)

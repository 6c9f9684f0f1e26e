"""Policies that change the gains of a running compass network: their base, and the compiled change."""

from collections.abc import Iterator
from typing import Any, ClassVar

from navcore.foundation.compiled import inlined, kernel
from navcore.foundation.errors import Fault
from navcore.foundation.text import Text
from navcore.law.policy.base import PolicyParameters
from navcore.law.records import NETWORK, E, N
from navcore.networks.base import NetworkParameters
from navcore.networks.compass import CompassNetwork


@kernel
def put_gains(law, k1, k2, k3, u_e, u_n):
    """Put gains K1 (1/s), K2, K3 (1/s) in place, in the present realisation (inputs u_E, u_N, m/s).

    Gains that move by little from call to call leave the correction without a jump; the integral part is
    carried over as it is. In the network form that is the part of Q that is not proportional.
    """
    p, s, network = law.p, law.s, law.s.network
    if p.realisation != NETWORK:
        s.feedback_gain = k1
        network.B[0], network.C[0] = -k3 * p.law_step, 1.0
        network.D = -k2 - 0.5 * k3 * p.law_step
        return
    # c = -K2 u + v, v' = -k v + b u in normalised time; x = v (1 + a k) - a b u is its bilinear state
    a, dA, c = p.tan_half, network.dA[0, 0], network.C[0]
    before, b_before = -dA / (2.0 * a * c), network.B[0] / (2.0 * a * c)
    k = k1 / p.omega_s
    b = k - k3 / p.omega_s + k * k2
    inverse = 1.0 / (1.0 + a * k)
    if c != 0.0:
        for channel, u in ((E, u_e), (N, u_n)):
            v = (s.x[channel, 0] + a * b_before * u) / (1.0 + a * before)
            s.x[channel, 0] = v * (1.0 + a * k) - a * b * u
    network.dA[0, 0], network.B[0], network.C[0] = -2.0 * a * k * inverse, 2.0 * a * b * inverse, inverse
    network.D = -k2 + a * b * inverse
    network.steady[0] = b / k if k != 0.0 else 0.0


@inlined
def always_damped(own, memory, law, sensed):
    """Return True."""
    return True


class GainPolicy(PolicyParameters):
    """Base of the policies that replace K1, K2, K3 of the `compass` network, in each of its realisations."""

    decide: ClassVar[Any] = always_damped
    keeps_time: ClassVar[bool] = True

    def network_faults(self, network: NetworkParameters) -> Iterator[Fault]:
        """Only `compass` has the gains."""
        if not isinstance(network, CompassNetwork):
            allowed = Text(
                'changes the gains K₁, K₂, K₃: needs network.id = "compass", not "{id}"', id=network.id
            )
            yield Fault("", "policy.id", self.id, allowed)

    def sets(self, network: NetworkParameters) -> tuple[str, ...]:
        """All gains of the network."""
        return tuple(f"network.{name}" for group in type(network).alternatives for name in group)

    def network_in_force(self, network: NetworkParameters) -> NetworkParameters:
        """`compass` with the gains of `lasting`, in the realisation of the method's network."""
        realisation = network.realisation if isinstance(network, CompassNetwork) else "feedback"
        return CompassNetwork.model_validate({**self.lasting(), "realisation": realisation})

    def lasting(self) -> dict[str, float]:
        """Fields of the `compass` network that stands for the method where one loop is asked for."""
        raise NotImplementedError

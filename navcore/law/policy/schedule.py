"""Policy `schedule`: compass gains that change in time after each start of the damping (Zha 2019, 4.2)."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Any, ClassVar, Literal

import numpy as np
from pydantic import create_model, model_validator

from navcore.foundation.compiled import inlined, kernel
from navcore.foundation.errors import Fault
from navcore.foundation.parameters import bounded, quantity, vector_quantity
from navcore.foundation.records import REAL, record_type
from navcore.foundation.text import Text
from navcore.foundation.times import EitherUnit
from navcore.law.policy.base import PolicyParameters
from navcore.law.records import NETWORK, E, N
from navcore.networks.base import NetworkParameters, refuse
from navcore.networks.compass import CompassNetwork

_Gain = Annotated[float, bounded(ge=-1e10, le=1e10)]
_LARGEST_K1 = 10.0


def _gains(default: tuple[float, float, float], label: str, help: str) -> Any:
    """Gains in the ranges of the sliders of `compass`."""
    return vector_quantity(
        default,
        elements=("K₁ (1/s)", "K₂", "K₃ (1/s)"),
        label=label,
        help=help,
        slider=((1e-3, 0.5), (1.0, 5e4), (1e-3, 1e3)),
        log=True,
    )


# `from` cannot be written as a class attribute, but it is the name of the field (scenario.md).
_FROM: dict[str, Any] = {
    "from": (
        tuple[_Gain, _Gain, _Gain],
        _gains((0.0264, 156.063, 0.904), "from", Text("Gains at each start of the damping (Zha 2019, 4.2).")),
    )
}
_From = create_model("_From", __base__=PolicyParameters, **_FROM)


@inlined
def _decide(own, memory, law, sensed):
    """Return True."""
    return True


@kernel
def _follow(own, memory, law, u_e, u_n):
    """Put the gains of the time since the last start in place (inputs u_E, u_N, m/s).

    The gains move by a step's share of the passage each call, so the correction has no jump; the integral
    part is carried over as it is. In the network form that is the part of Q that is not proportional.
    """
    p, s, network = law.p, law.s, law.s.network
    share = min(max((s.clock - s.switch_time) / own.duration, 0.0), 1.0)
    k1 = own.first[0] + share * (own.last[0] - own.first[0])
    k2 = own.first[1] + share * (own.last[1] - own.first[1])
    k3 = own.first[2] + share * (own.last[2] - own.first[2])
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


class Schedule(EitherUnit, _From):
    """Always damped; K1, K2, K3 pass linearly from one set to another after each start (Zha 2019, 4.2).

    For the `compass` network, whose own gains it replaces, in each of its realisations.
    """

    numbers: ClassVar[np.dtype] = record_type(
        first=(REAL, (3,)),  # K1 (1/s), K2, K3 (1/s) at each start
        last=(REAL, (3,)),  # after the passage
        duration=REAL,  # s
    )
    decide: ClassVar[Any] = _decide
    follow: ClassVar[Any] = _follow
    keeps_time: ClassVar[bool] = True
    id: Literal["schedule"] = "schedule"
    to: tuple[_Gain, _Gain, _Gain] = _gains(
        (7.68e-3, 6.68, 7.68e-3), "to", Text("Gains after that time (Zha 2019, 4.2).")
    )
    duration_s: float = quantity(
        60.0,
        unit="s",
        gt=0.0,
        le=1e6,
        slider=(1.0, 3600.0),
        log=True,
        label=Text("passage"),
        help=Text("Time of the passage from the one to the other."),
    )

    @model_validator(mode="after")
    def _sizes(self) -> Schedule:
        for name in ("from", "to"):
            k1, k2, k3 = getattr(self, name)
            if not abs(k1) <= _LARGEST_K1:
                raise refuse(
                    f"{name}.0",
                    k1,
                    Text("K₁ must be >= -{largest_k1:g} and <= {largest_k1:g} (1/s)", largest_k1=_LARGEST_K1),
                )
            if 1.0 + k2 == 0.0 and k3 == 0.0:
                raise refuse(f"{name}.1", k2, Text("K₂ must not be -1 while K₃ = 0: H would be zero"))
        return self

    def packed(self, law_step_s: float) -> dict[str, Any]:
        """Both sets; duration."""
        return {"first": getattr(self, "from"), "last": self.to, "duration": self.duration_s}

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
        """`compass` with the gains that stay."""
        k1, k2, k3 = self.to
        realisation = network.realisation if isinstance(network, CompassNetwork) else "feedback"
        return CompassNetwork.model_validate({"k1": k1, "k2": k2, "k3": k3, "realisation": realisation})

    def warnings(self, network: NetworkParameters) -> tuple[str, ...]:
        """Gains on the way at which the loop is unstable (Routh: K1, K3, 1 + K2 > 0, K1 (1 + K2) > K3)."""
        shares = [i / 60.0 for i in range(61)]
        for share in shares:
            k1, k2, k3 = (a + share * (b - a) for a, b in zip(getattr(self, "from"), self.to, strict=True))
            if not (k1 > 0.0 and k3 > 0.0 and 1.0 + k2 > 0.0 and k1 * (1.0 + k2) > k3):
                at = share * self.duration_s
                return (
                    Text("schedule: with the gains at {at:g} s after a start the loop is unstable", at=at),
                )
        return ()

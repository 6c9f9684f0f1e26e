"""Policy `schedule`: compass gains that change in time after each start of the damping (Zha 2019, 4.2)."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar, Literal

from pydantic import create_model, model_validator

from navcore.compiled import inlined, kernel
from navcore.control.layout import (
    CLOCK,
    FEEDBACK_GAIN,
    LAW_STEP,
    NETWORK,
    NETWORK_A,
    NETWORK_B,
    NETWORK_C,
    NETWORK_D,
    NETWORK_STEADY,
    OMEGA_S,
    POLICY_PARAMETERS,
    REALISATION,
    SWITCH_TIME,
    TAN_HALF,
    X_E,
    X_N,
)
from navcore.control.policy.base import PolicyParameters
from navcore.network.base import NetworkParameters, refuse
from navcore.network.compass import CompassNetwork
from navcore.parameters import bounded, quantity, vector_quantity

_Gain = Annotated[float, bounded(ge=-1e10, le=1e10)]
_LARGEST_K1 = 10.0


def _gains(default: tuple[float, float, float], label: str, help: str) -> Any:
    return vector_quantity(default, elements=("K1 (1/s)", "K2", "K3 (1/s)"), label=label, help=help)


# `from` cannot be written as a class attribute, but it is the name of the field (contract).
_FROM: dict[str, Any] = {
    "from": (
        tuple[_Gain, _Gain, _Gain],
        _gains((0.0264, 156.063, 0.904), "from", "Gains at each start of the damping (Zha 2019, 4.2)."),
    )
}
_From = create_model("_From", __base__=PolicyParameters, **_FROM)


class Schedule(_From):
    """Always damped; K1, K2, K3 pass linearly from one set to another after each start (Zha 2019, 4.2).

    For the `compass` network, whose own gains it replaces, in each of its realisations.
    """

    code: ClassVar[int] = 6
    keeps_time: ClassVar[bool] = True
    id: Literal["schedule"] = "schedule"
    to: tuple[_Gain, _Gain, _Gain] = _gains(
        (7.68e-3, 6.68, 7.68e-3), "to", "Gains after that time (Zha 2019, 4.2)."
    )
    duration_s: float = quantity(
        60.0,
        unit="s",
        gt=0.0,
        le=1e6,
        slider=(1.0, 3600.0),
        log=True,
        label="passage",
        help="Time of the passage from the one to the other.",
    )

    @model_validator(mode="after")
    def _sizes(self) -> Schedule:
        for name in ("from", "to"):
            k1, k2, k3 = getattr(self, name)
            if not abs(k1) <= _LARGEST_K1:
                raise refuse(f"{name}.0", k1, f"K1 must be >= -{_LARGEST_K1:g} and <= {_LARGEST_K1:g} (1/s)")
            if 1.0 + k2 == 0.0 and k3 == 0.0:
                raise refuse(f"{name}.1", k2, "K2 must not be -1 while K3 = 0: H would be zero")
        return self

    def packed(self, law_step_s: float) -> list[float]:
        """Both sets; duration, s."""
        return [*getattr(self, "from"), *self.to, self.duration_s]

    def network_in_force(self, network: NetworkParameters) -> NetworkParameters:
        """`compass` with the gains that stay."""
        k1, k2, k3 = self.to
        realisation = network.realisation if isinstance(network, CompassNetwork) else "feedback"
        return CompassNetwork.model_validate({"k1": k1, "k2": k2, "k3": k3, "realisation": realisation})

    def warnings(self) -> tuple[str, ...]:
        """Gains on the way at which the loop is unstable (Routh: K1, K3, 1 + K2 > 0, K1 (1 + K2) > K3)."""
        shares = [i / 60.0 for i in range(61)]
        for share in shares:
            k1, k2, k3 = (a + share * (b - a) for a, b in zip(getattr(self, "from"), self.to, strict=True))
            if not (k1 > 0.0 and k3 > 0.0 and 1.0 + k2 > 0.0 and k1 * (1.0 + k2) > k3):
                at = share * self.duration_s
                return (f"schedule: with the gains at {at:g} s after a start the loop is unstable",)
        return ()


@inlined
def decide_schedule(p, s, ring, accel, heading):
    """Return True."""
    return True


@kernel
def follow_schedule(p, s, u_e, u_n):
    """Put the gains of the time since the last start in place (inputs u_E, u_N, m/s).

    The gains move by a step's share of the passage each call, so the correction has no jump; the integral
    part is carried over as it is. In the network form that is the part of Q that is not proportional.
    """
    share = min(max((s[CLOCK] - s[SWITCH_TIME]) / p[POLICY_PARAMETERS + 6], 0.0), 1.0)
    at = POLICY_PARAMETERS
    k1 = p[at] + share * (p[at + 3] - p[at])
    k2 = p[at + 1] + share * (p[at + 4] - p[at + 1])
    k3 = p[at + 2] + share * (p[at + 5] - p[at + 2])
    if p[REALISATION] != NETWORK:
        s[FEEDBACK_GAIN] = k1
        s[NETWORK_B], s[NETWORK_C] = -k3 * p[LAW_STEP], 1.0
        s[NETWORK_D] = -k2 - 0.5 * k3 * p[LAW_STEP]
        return
    # c = -K2 u + v, v' = -k v + b u in normalised time; x = v (1 + a k) - a b u is its bilinear state
    a = p[TAN_HALF]
    before, b_before = -s[NETWORK_A] / (2.0 * a * s[NETWORK_C]), s[NETWORK_B] / (2.0 * a * s[NETWORK_C])
    k = k1 / p[OMEGA_S]
    b = k - k3 / p[OMEGA_S] + k * k2
    inverse = 1.0 / (1.0 + a * k)
    if s[NETWORK_C] != 0.0:
        for x, u in ((X_E, u_e), (X_N, u_n)):
            v = (s[x] + a * b_before * u) / (1.0 + a * before)
            s[x] = v * (1.0 + a * k) - a * b * u
    s[NETWORK_A], s[NETWORK_B], s[NETWORK_C] = -2.0 * a * k * inverse, 2.0 * a * b * inverse, inverse
    s[NETWORK_D] = -k2 + a * b * inverse
    s[NETWORK_STEADY] = b / k if k != 0.0 else 0.0

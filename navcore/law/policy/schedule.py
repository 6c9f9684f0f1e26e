"""Policy `schedule`: compass gains that change in time after each start of the damping (Zha 2019, 4.2)."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar, Literal

import numpy as np
from pydantic import create_model, model_validator

from navcore.foundation.compiled import kernel
from navcore.foundation.parameters import bounded, quantity, vector_quantity
from navcore.foundation.records import REAL, record_type
from navcore.foundation.text import Text
from navcore.foundation.times import EitherUnit
from navcore.law.policy.compass_gains import GainPolicy, put_gains
from navcore.networks.base import NetworkParameters, refuse

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
_From = create_model("_From", __base__=GainPolicy, **_FROM)


@kernel
def _follow(own, memory, law, u_e, u_n):
    """Put the gains of the time since the last start in place (inputs u_E, u_N, m/s)."""
    s = law.s
    share = min(max((s.clock - s.switch_time) / own.duration, 0.0), 1.0)
    k1 = own.first[0] + share * (own.last[0] - own.first[0])
    k2 = own.first[1] + share * (own.last[1] - own.first[1])
    k3 = own.first[2] + share * (own.last[2] - own.first[2])
    put_gains(law, k1, k2, k3, u_e, u_n)


class Schedule(EitherUnit, _From):
    """Always damped; K1, K2, K3 pass linearly from one set to another after each start (Zha 2019, 4.2).

    For the `compass` network, whose own gains it replaces, in each of its realisations.
    """

    numbers: ClassVar[np.dtype] = record_type(
        first=(REAL, (3,)),  # K1 (1/s), K2, K3 (1/s) at each start
        last=(REAL, (3,)),  # after the passage
        duration=REAL,  # s
    )
    follow: ClassVar[Any] = _follow
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

    def lasting(self) -> dict[str, float]:
        """The gains that stay."""
        return dict(zip(("k1", "k2", "k3"), self.to, strict=True))

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

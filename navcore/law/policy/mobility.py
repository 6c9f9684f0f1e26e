"""Policy `mobility`: compass gains that follow the vehicle's acceleration (Deng 2019, section II B)."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np
from pydantic import model_validator

from navcore.foundation.compiled import inlined, kernel
from navcore.foundation.parameters import quantity
from navcore.foundation.records import COUNT, REAL, record_type
from navcore.foundation.text import Text
from navcore.law.history import USE_ACCELERATION, auxiliary, slide
from navcore.law.policy.base import Limit, Measure, calls
from navcore.law.policy.compass_gains import GainPolicy, put_gains
from navcore.law.policy.mean_acceleration import averaging_time
from navcore.networks.base import refuse


@inlined
def _decide(own, memory, law, sensed):
    """Measure the mean of |a|; return True."""
    memory.total = slide(law, memory.total, auxiliary, 0, own.window)
    law.s.measure = max(memory.total, 0.0) / min(own.window, law.s.ring_fill)
    return True


@kernel
def _follow(own, memory, law, u_e, u_n):
    """Put the gains of the present decay rate in place (inputs u_E, u_N, m/s)."""
    share = min(max((law.s.measure - own.low) / (own.high - own.low), 0.0), 1.0)
    sigma = own.steady + share * (own.moving - own.steady)
    ratio = (sigma / law.p.omega_s) ** 2
    k2, k3 = ratio * (2.0 + own.inverse_xi2) - 1.0, ratio * sigma * own.inverse_xi2
    put_gains(law, 3.0 * sigma, k2, k3, u_e, u_n)


class Mobility(GainPolicy):
    """Always damped; the decay rate passes from one value to another as the ship accelerates more.

    "K_ij of the horizontal damping can be adjusted according to the vehicle mobility" (Deng 2019, section
    II B): the gains are those of Deng 2 for the present decay rate, which is linear in the mean of |a|
    between two accelerations. |a| is the rate of change of the computed velocity, as in `acceleration`. The
    numbers are ours; Deng prints none.
    """

    numbers: ClassVar[np.dtype] = record_type(
        window=COUNT,  # calls
        low=REAL,  # m/s^2, up to which the decay rate is `steady`
        high=REAL,  # m/s^2, from which on it is `moving`
        steady=REAL,  # 1/s
        moving=REAL,  # 1/s
        inverse_xi2=REAL,  # 1/xi^2
    )
    memory: ClassVar[np.dtype] = record_type(total=REAL)  # over the window, m/s^2
    decide: ClassVar[Any] = _decide
    follow: ClassVar[Any] = _follow
    remembers: ClassVar[int] = USE_ACCELERATION
    measure: ClassVar[Measure | None] = Measure("mean |a|", "m/s2", 1.0)
    id: Literal["mobility"] = "mobility"
    sigma_steady: float = quantity(
        0.0088,
        unit="1/s",
        ge=1e-5,
        le=1.0,
        slider=(5e-4, 0.2),
        log=True,
        label=Text("σ, steady"),
        help=Text("Decay rate of the loop while the ship does not accelerate (Deng 2)."),
    )
    sigma_moving: float = quantity(
        0.002,
        unit="1/s",
        ge=1e-5,
        le=1.0,
        slider=(5e-4, 0.2),
        log=True,
        label=Text("σ, manoeuvring"),
        help=Text("Decay rate of the loop while the ship manoeuvres (Deng 2)."),
    )
    xi: float = quantity(
        0.7,
        ge=0.01,
        le=10.0,
        slider=(0.05, 1.5),
        label=Text("damping ratio ζ"),
        help=Text("Damping ratio of the closed-loop pair; Deng and Zha write ξ (Deng 2, Zha 14)."),
    )
    low_mps2: float = quantity(
        0.005,
        unit="m/s2",
        ge=0.0,
        le=100.0,
        slider=(0.0, 1.0),
        label=Text("steady up to"),
        help=Text("Mean of |a| up to which the decay rate is that of a steady ship."),
    )
    high_mps2: float = quantity(
        0.02,
        unit="m/s2",
        gt=0.0,
        le=100.0,
        slider=(0.001, 1.0),
        log=True,
        label=Text("manoeuvring from"),
        help=Text("Mean of |a| from which on the decay rate is that of a manoeuvring ship."),
    )
    mean_s: float = averaging_time()

    @model_validator(mode="after")
    def _apart(self) -> Mobility:
        if not self.high_mps2 > self.low_mps2:
            raise refuse(
                "high_mps2",
                self.high_mps2,
                Text("must be > low_mps2 = {low:g} m/s2", low=self.low_mps2),
            )
        return self

    def packed(self, law_step_s: float) -> dict[str, Any]:
        """Window, accelerations, decay rates and damping ratio."""
        return {
            "window": calls(self.mean_s, law_step_s),
            "low": self.low_mps2,
            "high": self.high_mps2,
            "steady": self.sigma_steady,
            "moving": self.sigma_moving,
            "inverse_xi2": 1.0 / self.xi**2,
        }

    def ring_rows(self, law_step_s: float) -> int:
        """The window and the row that leaves it."""
        return calls(self.mean_s, law_step_s) + 1

    def limits(self) -> tuple[Limit, ...]:
        """The two accelerations."""
        return (
            Limit("low_mps2", self.low_mps2, "m/s2"),
            Limit("high_mps2", self.high_mps2, "m/s2"),
        )

    def lasting(self) -> dict[str, float]:
        """Those of a steady ship."""
        return {"sigma": self.sigma_steady, "xi": self.xi}

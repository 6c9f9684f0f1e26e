"""Our own two-pole network: exact damping ratio and H(0) = 1 together."""

from __future__ import annotations

import math
from typing import Any, ClassVar, Literal

from pydantic import model_validator

from navcore.network.base import (
    LinearNetwork,
    NetworkParameters,
    given,
    linear_network,
    pair,
    quadratic_roots,
    refuse,
)
from navcore.network.tuning_codes import UNITY2
from navcore.parameters import quantity


class Unity2Network(NetworkParameters):
    """Two poles and two zeros with N(0) = D(0); closed-loop pair with damping zeta at r omega_s.

    The second pair is chosen by its damping zeta2 or by its alpha, not both.
    """

    title: ClassVar[str] = "Unity gain, exact damping"
    source: ClassVar[str] = "physics.md 3.4"
    id: Literal["unity2"] = "unity2"
    zeta: float = quantity(
        0.5,
        gt=0.0,
        le=5.0,
        slider=(0.02, 1.5),
        label="zeta",
        help="Damping ratio of the main closed-loop pair (physics.md 3.4).",
    )
    r: float = quantity(
        1.2,
        ge=1.01,
        le=10.0,
        slider=(1.05, 3.0),
        label="r",
        help="Frequency of the main pair over omega_s (physics.md 3.4).",
    )
    zeta2: float | None = quantity(
        None,
        gt=0.0,
        le=5.0,
        slider=(0.1, 2.0),
        label="zeta2",
        help="Damping ratio of the second pair; max(0.7, zeta) when not given (physics.md 3.4).",
    )
    alpha: float | None = quantity(
        None,
        unit="rad/s",
        gt=0.0,
        le=10.0,
        slider=(1e-4, 0.1),
        log=True,
        label="alpha",
        help="Sum of the second pair's poles, instead of zeta2 (physics.md 3.4).",
    )

    @model_validator(mode="before")
    @classmethod
    def _one_way_only(cls, data: Any) -> Any:
        if len(given(data, ("zeta2", "alpha"))) == 2:
            raise refuse("alpha", data["alpha"], "must not be given together with zeta2: each sets the other")
        return data

    def transfer(self, omega_s: float) -> LinearNetwork:
        """Return H(s) (physics.md 3.4) for a Schuler frequency in rad/s."""
        zeta, r = self.zeta, self.r
        excess = (r - 1.0) * (r + 1.0)
        if self.alpha is None:
            zeta2 = max(0.7, zeta) if self.zeta2 is None else self.zeta2
            half = 2.0 * zeta * zeta2 * r
            q = (half + math.hypot(half, excess)) / excess
            alpha, beta, second = 2.0 * zeta2 * q, q * q, pair(zeta2, q)
        else:
            alpha = self.alpha / omega_s
            beta = (2.0 * zeta * r * alpha + excess) / excess
            zeta2 = alpha / (2.0 * math.sqrt(beta))
            second = quadratic_roots(alpha, beta)
        c3 = 2.0 * zeta * r + alpha
        c1 = r * r * alpha + 2.0 * zeta * r * beta
        c0 = r * r * beta
        # D(0) = c2 - 1 equals c0 by the choice of beta; written so, N(0) = D(0) holds exactly
        warnings = ()
        if zeta2 < zeta * (1.0 - 1e-12):
            warnings = (f"the second pair is worse damped ({zeta2:.3g}) than the {zeta:g} asked",)
        return linear_network(
            "unity2",
            omega_s,
            [1.0, c1, c0],
            [1.0, c3, c0],
            closed_loop_p=[*pair(zeta, r), *second],
            warnings=warnings,
        )

    def damping_coefficient(self) -> float:
        """Return zeta."""
        return self.zeta

    def tuning(self, omega_s: float) -> list[float]:
        """Return code, r, zeta2 and alpha / omega_s; 0 where not given."""
        alpha = 0.0 if self.alpha is None else self.alpha / omega_s
        return [UNITY2, self.r, self.zeta2 or 0.0, alpha]

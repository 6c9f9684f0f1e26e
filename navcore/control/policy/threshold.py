"""Policy `threshold`: undamped while the velocity difference is large ("traditional" in Liu 2021, 3.2)."""

from __future__ import annotations

import math
from typing import ClassVar, Literal

from navcore.compiled import inlined
from navcore.control.layout import DIFFERENCE, MEASURE, POLICY_PARAMETERS
from navcore.control.policy.base import Limit, Measure, PolicyParameters
from navcore.parameters import quantity


class Threshold(PolicyParameters):
    """Undamped while the norm of V_r - V_c exceeds a limit (Liu 2021, 3.2; the default is ours)."""

    code: ClassVar[int] = 1
    needs_reference: ClassVar[bool] = True
    measure: ClassVar[Measure | None] = Measure("|V_r - V_c|", "m/s", 1.0)
    id: Literal["threshold"] = "threshold"
    limit_mps: float = quantity(
        0.5,
        unit="m/s",
        gt=0.0,
        le=1000.0,
        slider=(0.01, 10.0),
        log=True,
        label="threshold",
        help="Undamped while |V_r - V_c| exceeds this (Liu 2021, 3.2).",
    )

    def packed(self, law_step_s: float) -> list[float]:
        """Limit, m/s."""
        return [self.limit_mps]

    def limits(self) -> tuple[Limit, ...]:
        """The limit."""
        return (Limit("limit_mps", self.limit_mps, "m/s"),)


@inlined
def decide_threshold(p, s, ring, accel, heading):
    """Return True while the held difference is within the limit."""
    s[MEASURE] = math.hypot(s[DIFFERENCE], s[DIFFERENCE + 1])
    return s[MEASURE] <= p[POLICY_PARAMETERS]

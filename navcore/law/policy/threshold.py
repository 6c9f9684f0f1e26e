"""Policy `threshold`: undamped while the velocity difference is large ("traditional" in Liu 2021, 3.2)."""

import math
from typing import Any, ClassVar, Literal

import numpy as np

from navcore.foundation.compiled import inlined
from navcore.foundation.parameters import quantity
from navcore.foundation.records import REAL, record_type
from navcore.foundation.text import Text
from navcore.law.policy.base import Limit, Measure, PolicyParameters
from navcore.law.records import E, N


@inlined
def _decide(own, memory, law, sensed):
    """Return True while the held difference is within the limit."""
    s = law.s
    s.measure = math.hypot(s.difference[E], s.difference[N])
    return s.measure <= own.limit


class Threshold(PolicyParameters):
    """Undamped while the norm of V_r - V_c exceeds a limit (Liu 2021, 3.2; the default is ours)."""

    numbers: ClassVar[np.dtype] = record_type(limit=REAL)  # m/s
    decide: ClassVar[Any] = _decide
    plain: ClassVar[bool] = True
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
        label=Text("threshold"),
        help=Text("Undamped while |V_r - V_c| exceeds this (Liu 2021, 3.2)."),
    )

    def packed(self, law_step_s: float) -> dict[str, Any]:
        """Limit."""
        return {"limit": self.limit_mps}

    def limits(self) -> tuple[Limit, ...]:
        """The limit."""
        return (Limit("limit_mps", self.limit_mps, "m/s"),)

"""Policy `acceleration`: undamped while the vehicle accelerates (the conventional method in Sun 2017, 1)."""

from typing import Any, ClassVar, Literal

import numpy as np

from navcore.foundation.compiled import inlined
from navcore.foundation.records import COUNT, REAL, record_type
from navcore.law.history import USE_ACCELERATION, auxiliary, slide
from navcore.law.policy.base import Limit, Measure, PolicyParameters, calls
from navcore.law.policy.mean_acceleration import acceleration_limit, averaging_time


@inlined
def _decide(own, memory, law, sensed):
    """Return True while the mean of |a| is within the limit."""
    memory.total = slide(law, memory.total, auxiliary, 0, own.window)
    law.s.measure = max(memory.total, 0.0) / min(own.window, law.s.ring_fill)
    return law.s.measure <= own.limit


class Acceleration(PolicyParameters):
    """Undamped while the mean of the horizontal acceleration's size exceeds a limit (Sun 2017, 1).

    |a| is what a ship can measure, in both fidelities: the change of the computed horizontal velocity V_c
    between two calls of the law, divided by their interval. The defaults are ours.
    """

    numbers: ClassVar[np.dtype] = record_type(window=COUNT, limit=REAL)  # calls, m/s^2
    memory: ClassVar[np.dtype] = record_type(total=REAL)  # over the window, m/s^2
    decide: ClassVar[Any] = _decide
    remembers: ClassVar[int] = USE_ACCELERATION
    keeps_time: ClassVar[bool] = True
    measure: ClassVar[Measure | None] = Measure("mean |a|", "m/s2", 1.0)
    id: Literal["acceleration"] = "acceleration"
    limit_mps2: float = acceleration_limit()
    mean_s: float = averaging_time()

    def packed(self, law_step_s: float) -> dict[str, Any]:
        """Window and limit."""
        return {"window": calls(self.mean_s, law_step_s), "limit": self.limit_mps2}

    def ring_rows(self, law_step_s: float) -> int:
        """The window and the row that leaves it."""
        return calls(self.mean_s, law_step_s) + 1

    def limits(self) -> tuple[Limit, ...]:
        """The limit."""
        return (Limit("limit_mps2", self.limit_mps2, "m/s2"),)

"""Policy `acceleration`: undamped while the vehicle accelerates (the conventional method in Sun 2017, 1)."""

from __future__ import annotations

from typing import ClassVar, Literal

from navcore.compiled import inlined, kernel
from navcore.control.history import USE_ACCELERATION, slide
from navcore.control.layout import AUXILIARY_SUM, MEASURE, POLICY_PARAMETERS, RING_AUXILIARY, RING_FILL
from navcore.control.policy.base import Limit, Measure, PolicyParameters, calls
from navcore.parameters import quantity


class Acceleration(PolicyParameters):
    """Undamped while the mean of the horizontal acceleration's size exceeds a limit (Sun 2017, 1).

    The defaults are ours.
    """

    code: ClassVar[int] = 3
    remembers: ClassVar[int] = USE_ACCELERATION
    keeps_time: ClassVar[bool] = True
    measure: ClassVar[Measure | None] = Measure("mean |a|", "m/s2", 1.0)
    id: Literal["acceleration"] = "acceleration"
    limit_mps2: float = quantity(
        0.01,
        unit="m/s2",
        gt=0.0,
        le=100.0,
        slider=(0.001, 1.0),
        log=True,
        label="acceleration limit",
        help="Undamped while the mean of |a| exceeds this (Sun 2017, 1).",
    )
    mean_s: float = quantity(
        20.0,
        unit="s",
        gt=0.0,
        le=3600.0,
        slider=(1.0, 300.0),
        log=True,
        label="averaged over",
        help="Time over which |a| is averaged.",
    )

    def packed(self, law_step_s: float) -> list[float]:
        """Window in calls; limit, m/s^2."""
        return [calls(self.mean_s, law_step_s), self.limit_mps2]

    def ring_rows(self, law_step_s: float) -> int:
        """The window and the row that leaves it."""
        return calls(self.mean_s, law_step_s) + 1

    def limits(self) -> tuple[Limit, ...]:
        """The limit."""
        return (Limit("limit_mps2", self.limit_mps2, "m/s2"),)


@kernel
def _mean(p, s, ring):
    count = int(p[POLICY_PARAMETERS])
    total = slide(s, ring, AUXILIARY_SUM, RING_AUXILIARY, 0, count)
    return max(total, 0.0) / min(count, int(s[RING_FILL]))


@inlined
def decide_acceleration(p, s, ring, accel, heading):
    """Return True while the mean of |a| is within the limit."""
    s[MEASURE] = _mean(p, s, ring)
    return s[MEASURE] <= p[POLICY_PARAMETERS + 1]

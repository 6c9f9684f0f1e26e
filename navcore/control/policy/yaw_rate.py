"""Policy `yaw_rate`: undamped while the heading changes ("traditional method ... change of yaw", Liu 3.2)."""

from __future__ import annotations

from typing import ClassVar, Literal

from navcore.compiled import inlined, kernel
from navcore.control.history import USE_HEADING, row_of_age
from navcore.control.layout import MEASURE, POLICY_PARAMETERS, RING_AUXILIARY, RING_FILL, TOTAL_HEADING
from navcore.control.policy.base import Limit, Measure, PolicyParameters, calls
from navcore.parameters import quantity
from navcore.units import DEG


class YawRate(PolicyParameters):
    """Undamped while the heading has changed over a window by more than a limit (Liu 2021, 3.2).

    The heading counts without wraps: a full turn is 360 deg, not 0. The defaults are ours.
    """

    code: ClassVar[int] = 2
    remembers: ClassVar[int] = USE_HEADING
    keeps_time: ClassVar[bool] = True
    measure: ClassVar[Measure | None] = Measure("heading change", "deg", DEG)
    id: Literal["yaw_rate"] = "yaw_rate"
    window_s: float = quantity(
        60.0,
        unit="s",
        gt=0.0,
        le=3600.0,
        slider=(5.0, 600.0),
        log=True,
        label="window",
        help="Time over which the heading change is taken.",
    )
    limit_deg: float = quantity(
        5.0,
        unit="deg",
        gt=0.0,
        le=3600.0,
        slider=(0.5, 90.0),
        log=True,
        label="heading limit",
        help="Undamped while the heading changed by more than this over the window (Liu 2021, 3.2).",
    )

    def packed(self, law_step_s: float) -> list[float]:
        """Window in calls; limit, rad."""
        return [calls(self.window_s, law_step_s), self.limit_deg * DEG]

    def ring_rows(self, law_step_s: float) -> int:
        """The window and the present call."""
        return calls(self.window_s, law_step_s) + 1

    def limits(self) -> tuple[Limit, ...]:
        """The limit."""
        return (Limit("limit_deg", self.limit_deg, "deg"),)


@kernel
def _change(p, s, ring):
    age = min(int(p[POLICY_PARAMETERS]), int(s[RING_FILL]) - 1)
    return abs(s[TOTAL_HEADING] - ring[row_of_age(s, ring, age), RING_AUXILIARY])


@inlined
def decide_yaw_rate(p, s, ring, accel, heading):
    """Return True while the heading change over the window is within the limit."""
    s[MEASURE] = _change(p, s, ring)
    return s[MEASURE] <= p[POLICY_PARAMETERS + 1]

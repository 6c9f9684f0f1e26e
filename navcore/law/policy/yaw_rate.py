"""Policy `yaw_rate`: undamped while the heading changes ("traditional method ... change of yaw", Liu 3.2)."""

from typing import Any, ClassVar, Literal

import numpy as np

from navcore.foundation.compiled import inlined, kernel
from navcore.foundation.parameters import quantity
from navcore.foundation.records import COUNT, REAL, record_type
from navcore.foundation.text import Text
from navcore.foundation.units import DEG
from navcore.law.history import USE_HEADING, row_of_age
from navcore.law.policy.base import Limit, Measure, PolicyParameters, calls


@kernel
def _change(law, window):
    return abs(law.s.total_heading - row_of_age(law, min(window, law.s.ring_fill - 1)).auxiliary)


@inlined
def _decide(own, memory, law, sensed):
    """Return True while the heading change over the window is within the limit."""
    law.s.measure = _change(law, own.window)
    return law.s.measure <= own.limit


class YawRate(PolicyParameters):
    """Undamped while the heading has changed over a window by more than a limit (Liu 2021, 3.2).

    The heading counts without wraps: a full turn is 360 deg, not 0. The defaults are ours.
    """

    numbers: ClassVar[np.dtype] = record_type(window=COUNT, limit=REAL)  # calls, rad
    decide: ClassVar[Any] = _decide
    remembers: ClassVar[int] = USE_HEADING
    keeps_time: ClassVar[bool] = True
    measure: ClassVar[Measure | None] = Measure(Text("heading change"), "°", DEG)
    id: Literal["yaw_rate"] = "yaw_rate"
    window_s: float = quantity(
        60.0,
        unit="s",
        gt=0.0,
        le=3600.0,
        slider=(5.0, 600.0),
        log=True,
        label=Text("window"),
        help=Text("Time over which the heading change is taken."),
    )
    limit_deg: float = quantity(
        5.0,
        unit="deg",
        gt=0.0,
        le=3600.0,
        slider=(0.5, 90.0),
        log=True,
        label=Text("heading limit"),
        help=Text("Undamped while the heading changed by more than this over the window (Liu 2021, 3.2)."),
    )

    def packed(self, law_step_s: float) -> dict[str, Any]:
        """Window and limit."""
        return {"window": calls(self.window_s, law_step_s), "limit": self.limit_deg * DEG}

    def ring_rows(self, law_step_s: float) -> int:
        """The window and the present call."""
        return calls(self.window_s, law_step_s) + 1

    def limits(self) -> tuple[Limit, ...]:
        """The limit."""
        return (Limit("limit_deg", self.limit_deg, "°"),)

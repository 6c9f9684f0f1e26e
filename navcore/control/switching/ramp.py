"""Switching `ramp`: the damping coefficient rises after re-engagement (Liu 2021, 3.4, fig. 10)."""

from __future__ import annotations

import math
from typing import ClassVar, Literal

from navcore.compiled import inlined
from navcore.control.layout import (
    ACTION,
    CLEAR,
    CLOCK,
    DAMPED,
    ENGAGED,
    REST,
    SWITCH_TIME,
    SWITCHING_PARAMETERS,
    TO_XI,
    XI,
    XI_TARGET,
)
from navcore.control.switching.base import SwitchingParameters
from navcore.parameters import choice, quantity


class Ramp(SwitchingParameters):
    """Cleared on re-engagement, the coefficient raised as xi e^-(49-m), m = 0..49 s (Liu 2021, fig. 10).

    While undamped the last correction stays. The start of the run is no switch: it begins with the full
    coefficient.
    """

    code: ClassVar[int] = 2
    keeps_time: ClassVar[bool] = True
    tunes: ClassVar[bool] = True
    freezes: ClassVar[bool] = True
    id: Literal["ramp"] = "ramp"
    duration_s: float = quantity(
        50.0,
        unit="s",
        ge=1.0,
        le=3600.0,
        slider=(1.0, 600.0),
        log=True,
        label="ramp",
        help="The coefficient is xi e^-(duration - 1 - m) m seconds after re-engagement (Liu 2021, fig. 10).",
    )
    form: Literal["state", "as_printed"] = choice(
        "state",
        label="ramp form",
        help="state: the filter's states are cleared and the present difference arrives as a step; "
        "as_printed: Liu 19's recursion, which sees differences of its input only, so that what stands "
        "during the ramp is never seen.",
    )

    def packed(self, law_step_s: float) -> list[float]:
        """Time to the full coefficient, s; whether as printed."""
        return [self.duration_s - 1.0, float(self.form == "as_printed")]


@inlined
def switch_ramp(p, s, wanted):
    """Raise the coefficient after re-engagement; undamped at once."""
    if not wanted:
        s[DAMPED] = s[XI] = 0.0
        return
    if s[DAMPED] == 0.0:
        s[ACTION] = CLEAR
        if s[ENGAGED] == 0.0:
            s[SWITCH_TIME] = -math.inf
    left = p[SWITCHING_PARAMETERS] - (s[CLOCK] - s[SWITCH_TIME])
    # Rounded: a clock that adds up tenths of a second must not end the ramp a step late.
    left = 0.0 if abs(left) < 1e-6 else left
    s[DAMPED], s[XI] = 1.0, s[XI_TARGET] * math.exp(-max(left, 0.0))
    s[TO_XI] = s[XI]
    if left >= 0.0 and p[SWITCHING_PARAMETERS + 1] != 0.0:
        # What a recursion on differences has seen until now came with e^-49 ... e^-1.
        s[ACTION] = REST

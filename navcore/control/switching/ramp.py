"""Switching `ramp`: the damping coefficient rises after re-engagement (Liu 2021, 3.4, fig. 10)."""

from __future__ import annotations

import math
from typing import ClassVar, Literal

from navcore.compiled import inlined, kernel
from navcore.control.layout import (
    CLOCK,
    DAMPED,
    ENGAGED,
    LAW_STEP,
    SWITCH_TIME,
    SWITCHING_PARAMETERS,
    XI,
    XI_TARGET,
)
from navcore.control.network_state import clear_network, rest
from navcore.control.switching.base import SwitchingParameters
from navcore.control.tuned_network import follow_target, retune
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


@kernel
def _raise(p, s, wanted, u_e, u_n):
    if not wanted:
        s[DAMPED] = s[XI] = 0.0
        return
    engaging = s[DAMPED] == 0.0
    if engaging and s[ENGAGED] == 0.0:
        s[SWITCH_TIME] = -math.inf
    # Rounded: a clock that adds up tenths of a second must not end the ramp a step late.
    left = p[SWITCHING_PARAMETERS] - (s[CLOCK] - s[SWITCH_TIME])
    left = 0.0 if abs(left) < 1e-6 else left
    if left <= 1e-6 - p[LAW_STEP]:
        follow_target(p, s, u_e, u_n)
        xi = s[XI_TARGET]
    else:
        xi = s[XI_TARGET] * math.exp(-max(left, 0.0))
        retune(p, s, xi, u_e, u_n)
    if engaging:
        clear_network(p, s, u_e, u_n)
    if left >= 0.0 and p[SWITCHING_PARAMETERS + 1] != 0.0:
        # e^-49 ... e^-1 of a recursion on differences: what the input is when the ramp ends is at rest.
        rest(p, s, u_e, u_n)
    s[DAMPED], s[XI] = 1.0, xi


@inlined
def switch_ramp(p, s, ring, wanted, u_e, u_n):
    """Raise the coefficient after re-engagement; undamped at once."""
    _raise(p, s, wanted, u_e, u_n)

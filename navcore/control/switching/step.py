"""Switching `step`: the damping coefficient moves in steps (Sun 2017, 4.2)."""

from __future__ import annotations

from typing import ClassVar, Literal

from navcore.compiled import inlined
from navcore.control.layout import (
    ACTION,
    CLEAR,
    CLOCK,
    DAMPED,
    DAMPING,
    ENGAGED,
    EXTERNAL,
    STEP_TIME,
    SWITCHING_PARAMETERS,
    TO_XI,
    TUNING_LOW,
    VALID,
    XI,
    XI_TARGET,
)
from navcore.control.switching.base import SwitchingParameters
from navcore.parameters import quantity

_NOTHING = 1e-9


class Step(SwitchingParameters):
    """The coefficient moves towards its target by at most 0.1 every 2 min, down to undamped (Sun 2017, 4.2).

    The start of the run is no switch: it begins with the full coefficient. Without a valid reference the
    loop is undamped at once.
    """

    code: ClassVar[int] = 3
    keeps_time: ClassVar[bool] = True
    tunes: ClassVar[bool] = True
    id: Literal["step"] = "step"
    size: float = quantity(
        0.1,
        gt=0.0,
        le=5.0,
        slider=(0.01, 1.0),
        log=True,
        label="step size",
        help="Largest change of the damping coefficient at a time (Sun 2017, 4.2).",
    )
    every_s: float = quantity(
        120.0,
        unit="s",
        gt=0.0,
        le=3600.0,
        slider=(1.0, 1200.0),
        log=True,
        label="every",
        help="Time between two changes (Sun 2017, 4.2).",
    )

    def packed(self, law_step_s: float) -> list[float]:
        """Size and interval (s)."""
        return [self.size, self.every_s]


@inlined
def switch_step(p, s, wanted):
    """Move the coefficient towards its target; undamped when it has come to nothing."""
    if p[DAMPING] == EXTERNAL and s[VALID] == 0.0:
        s[DAMPED] = s[XI] = 0.0
        return
    target, size = s[XI_TARGET] if wanted else 0.0, p[SWITCHING_PARAMETERS]
    if s[DAMPED] == 0.0:
        if not wanted:
            return
        xi = target if s[ENGAGED] == 0.0 else min(size, target)
        s[ACTION] = CLEAR
    else:
        if s[CLOCK] - s[STEP_TIME] < p[SWITCHING_PARAMETERS + 1] - 1e-6 or target == s[XI]:
            return
        xi = s[XI] + min(max(target - s[XI], -size), size)
    s[STEP_TIME] = s[CLOCK]
    if xi < _NOTHING or (xi < p[TUNING_LOW] and not wanted):
        s[DAMPED] = s[XI] = 0.0
        return
    s[DAMPED], s[XI] = 1.0, max(xi, p[TUNING_LOW])
    s[TO_XI] = s[XI]

"""Switching `step`: the damping coefficient moves in steps (Sun 2017, 4.2)."""

from __future__ import annotations

from typing import ClassVar, Literal

from navcore.compiled import inlined, kernel
from navcore.control.layout import (
    CLOCK,
    DAMPED,
    DAMPING,
    ENGAGED,
    EXTERNAL,
    STEP_TIME,
    SWITCHING_PARAMETERS,
    TUNING_LOW,
    VALID,
    XI,
    XI_TARGET,
)
from navcore.control.network_state import clear_network
from navcore.control.switching.base import SwitchingParameters
from navcore.control.tuned_network import retune, tune
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


@kernel
def _engage(p, s, xi, u_e, u_n):
    tune(p, s, xi)
    clear_network(p, s, u_e, u_n)
    s[DAMPED], s[XI], s[STEP_TIME] = 1.0, xi, s[CLOCK]


@kernel
def _move(p, s, wanted, u_e, u_n):
    if p[DAMPING] == EXTERNAL and s[VALID] == 0.0:
        s[DAMPED] = s[XI] = 0.0
        return
    target, size = s[XI_TARGET] if wanted else 0.0, p[SWITCHING_PARAMETERS]
    if s[DAMPED] == 0.0:
        if wanted:
            start = target if s[ENGAGED] == 0.0 else min(size, target)
            _engage(p, s, max(start, p[TUNING_LOW]), u_e, u_n)
        return
    if s[CLOCK] - s[STEP_TIME] < p[SWITCHING_PARAMETERS + 1] - 1e-6 or target == s[XI]:
        return
    xi = s[XI] + min(max(target - s[XI], -size), size)
    s[STEP_TIME] = s[CLOCK]
    if xi < _NOTHING or (xi < p[TUNING_LOW] and not wanted):
        s[DAMPED] = s[XI] = 0.0
        return
    xi = max(xi, p[TUNING_LOW])
    retune(p, s, xi, u_e, u_n)
    s[XI] = xi


@inlined
def switch_step(p, s, ring, wanted, u_e, u_n):
    """Move the coefficient towards its target; undamped when it has come to nothing."""
    _move(p, s, wanted, u_e, u_n)

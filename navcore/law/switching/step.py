"""Switching `step`: the damping coefficient moves in steps (Sun 2017, 4.2)."""

from typing import Any, ClassVar, Literal

import numpy as np

from navcore.foundation.compiled import inlined
from navcore.foundation.parameters import quantity
from navcore.foundation.records import REAL, record_type
from navcore.foundation.text import Text
from navcore.law.records import CLEAR
from navcore.law.switching.base import SwitchingParameters

_NOTHING = 1e-9


@inlined
def _switch(own, memory, law, wanted):
    """Move the coefficient towards its target; undamped when it has come to nothing."""
    p, s = law.p, law.s
    if not s.internal and not s.valid:
        s.damped, s.xi = False, 0.0
        return
    target = s.xi_target if wanted else 0.0
    if not s.damped:
        if not wanted:
            return
        xi = target if not s.engaged else min(own.size, target)
        s.action = CLEAR
    else:
        if s.clock - memory.moved < own.every - 1e-6 or target == s.xi:
            return
        xi = s.xi + min(max(target - s.xi, -own.size), own.size)
    memory.moved = s.clock
    if xi < _NOTHING or (xi < p.tuning.low and not wanted):
        s.damped, s.xi = False, 0.0
        return
    s.damped, s.xi = True, max(xi, p.tuning.low)
    s.to_xi = s.xi


class Step(SwitchingParameters):
    """The coefficient moves towards its target by at most 0.1 every 2 min, down to undamped (Sun 2017, 4.2).

    The start of the run is no switch: it begins with the full coefficient. Without a valid reference the
    loop is undamped at once.
    """

    numbers: ClassVar[np.dtype] = record_type(size=REAL, every=REAL)  # every: s
    memory: ClassVar[np.dtype] = record_type(moved=REAL)  # s, when xi last moved
    switch: ClassVar[Any] = _switch
    keeps_time: ClassVar[bool] = True
    tunes: ClassVar[bool] = True
    follows_input: ClassVar[bool] = True
    id: Literal["step"] = "step"
    size: float = quantity(
        0.1,
        gt=0.0,
        le=5.0,
        slider=(0.01, 1.0),
        log=True,
        label=Text("step size"),
        help=Text("Largest change of the damping ratio at a time (Sun 2017, 4.2)."),
    )
    every_s: float = quantity(
        120.0,
        unit="s",
        gt=0.0,
        le=3600.0,
        slider=(1.0, 1200.0),
        log=True,
        label=Text("every"),
        help=Text("Time between two changes (Sun 2017, 4.2)."),
    )

    def packed(self, law_step_s: float, omega_s: float) -> dict[str, Any]:
        """Size and interval."""
        return {"size": self.size, "every": self.every_s}

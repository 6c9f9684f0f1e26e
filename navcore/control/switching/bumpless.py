"""Switching `bumpless` (ours): only the *change* of the log is removed, the damping achieved is kept.

On the way out the network's state and the mean difference of before the event are put aside and the
correction is frozen; on the way back the state returns with the steady state for what the mean difference
has changed by (physics.md section 4).
"""

from __future__ import annotations

from typing import ClassVar, Literal

from navcore.compiled import inlined, kernel
from navcore.control.history import mean_of, row_of_age
from navcore.control.layout import (
    ACTION,
    DAMPED,
    DAMPING,
    EXTERNAL,
    FRESH,
    MAX_STATES,
    MEAN_MEMORY,
    NETWORK_STEADY,
    OFFSET,
    ORDER,
    RESTORE,
    RING_DAMPED,
    RING_FILL,
    RING_INPUT,
    RING_X,
    SWITCHING_PARAMETERS,
    TO_XI,
    X_E,
    X_MEMORY,
    X_N,
    XI,
    XI_TARGET,
)
from navcore.control.policy.base import calls
from navcore.control.switching.base import SwitchingParameters
from navcore.parameters import quantity


class Bumpless(SwitchingParameters):
    """Restore the network's state of before the event, shifted by the change of the log (physics.md 4).

    While undamped the last correction stays. Damping begins, at the start of the run too, when n_s of valid
    differences are there.
    """

    code: ClassVar[int] = 4
    keeps_time: ClassVar[bool] = True
    freezes: ClassVar[bool] = True
    id: Literal["bumpless"] = "bumpless"
    n_s: float = quantity(
        20.0,
        unit="s",
        gt=0.0,
        le=3600.0,
        slider=(1.0, 300.0),
        log=True,
        label="bumpless mean",
        help="Time over which the difference is averaged, before the event and on re-engagement.",
    )
    memory_s: float = quantity(
        110.0,
        unit="s",
        gt=0.0,
        le=3600.0,
        slider=(1.0, 1200.0),
        log=True,
        label="memory",
        help="How far before the switch state and mean are taken: window, mean and count of the policy.",
    )

    def packed(self, law_step_s: float) -> list[float]:
        """Mean and memory in calls."""
        return [calls(self.n_s, law_step_s), calls(self.memory_s, law_step_s)]

    def ring_rows(self, law_step_s: float) -> int:
        """The memory and the mean before it."""
        return calls(self.n_s, law_step_s) + calls(self.memory_s, law_step_s) + 1


@kernel
def _put_aside(p, s, ring):
    """Take state and mean of before the event; what is put aside already stays if that was undamped."""
    n, age = int(p[SWITCHING_PARAMETERS]), int(p[SWITCHING_PARAMETERS + 1])
    row = row_of_age(s, ring, age)
    if s[RING_FILL] < age + n or ring[row, RING_DAMPED] == 0.0:
        return
    for i in range(2 * MAX_STATES):
        s[X_MEMORY + i] = ring[row, RING_X + i]
    s[MEAN_MEMORY] = mean_of(s, ring, RING_INPUT, age, n)
    s[MEAN_MEMORY + 1] = mean_of(s, ring, RING_INPUT + 1, age, n)


@kernel
def restore(p, s, ring):
    """Put the state back, moved by the steady state for the change of the mean."""
    n = int(p[SWITCHING_PARAMETERS])
    change_e = mean_of(s, ring, RING_INPUT, 0, n) - s[MEAN_MEMORY]
    change_n = mean_of(s, ring, RING_INPUT + 1, 0, n) - s[MEAN_MEMORY + 1]
    s[OFFSET], s[OFFSET + 1] = 0.0, 0.0
    for i in range(int(p[ORDER])):
        s[X_E + i] = s[X_MEMORY + i] + s[NETWORK_STEADY + i] * change_e
        s[X_N + i] = s[X_MEMORY + MAX_STATES + i] + s[NETWORK_STEADY + i] * change_n


@inlined
def switch_bumpless(p, s, ring, wanted):
    """Leave with the state of before the event put aside; come back without a step."""
    if not wanted:
        if s[DAMPED] != 0.0:
            _put_aside(p, s, ring)
        s[DAMPED] = s[XI] = 0.0
        return
    if s[DAMPED] == 0.0:
        known = s[FRESH] if p[DAMPING] == EXTERNAL else s[RING_FILL]
        if known < p[SWITCHING_PARAMETERS]:
            return
        s[ACTION] = RESTORE
    s[DAMPED] = 1.0
    s[XI] = s[TO_XI] = s[XI_TARGET]

"""Switching `hard`: clear the network on re-engagement, correct nothing while undamped."""

from __future__ import annotations

from typing import ClassVar, Literal

from navcore.compiled import inlined
from navcore.control.layout import ACTION, CLEAR, DAMPED, TO_XI, XI, XI_TARGET
from navcore.control.switching.base import SwitchingParameters


class Hard(SwitchingParameters):
    """The plain switch: the network starts anew at each re-engagement, as at the start of the run."""

    code: ClassVar[int] = 0
    id: Literal["hard"] = "hard"


@inlined
def switch_hard(p, s, wanted):
    """Take the wanted state at once; the network is cleared when damping comes back."""
    s[TO_XI] = s[XI_TARGET]
    if wanted and s[DAMPED] == 0.0:
        s[ACTION] = CLEAR
    s[DAMPED] = 1.0 if wanted else 0.0
    s[XI] = s[XI_TARGET] if wanted else 0.0

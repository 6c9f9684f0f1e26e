"""Switching `hard`: clear the network on re-engagement, correct nothing while undamped."""

from __future__ import annotations

from typing import ClassVar, Literal

from navcore.compiled import inlined
from navcore.control.layout import DAMPED, TUNING_PARAMETERS, XI, XI_TARGET
from navcore.control.network_state import clear_network
from navcore.control.switching.base import SwitchingParameters
from navcore.control.tuned_network import follow_target


class Hard(SwitchingParameters):
    """The plain switch: the network starts anew at each re-engagement, as at the start of the run."""

    code: ClassVar[int] = 0
    id: Literal["hard"] = "hard"


@inlined
def switch_hard(p, s, ring, wanted, u_e, u_n):
    """Take the wanted state at once; the network is cleared when damping comes back."""
    if p[TUNING_PARAMETERS] != 0.0:
        follow_target(p, s, u_e, u_n)
    if wanted and s[DAMPED] == 0.0:
        clear_network(p, s, u_e, u_n)
    s[DAMPED] = 1.0 if wanted else 0.0
    s[XI] = s[XI_TARGET] if wanted else 0.0

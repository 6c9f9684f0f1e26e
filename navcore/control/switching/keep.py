"""Switching `keep`: the network runs on masked while undamped (for comparison, physics.md section 4)."""

from __future__ import annotations

from typing import ClassVar, Literal

from navcore.compiled import inlined
from navcore.control.layout import DAMPED, DAMPING, EXTERNAL, TUNING_PARAMETERS, VALID, XI, XI_TARGET
from navcore.control.network_state import advance_network
from navcore.control.switching.base import SwitchingParameters
from navcore.control.tuned_network import follow_target


class Keep(SwitchingParameters):
    """Nothing is cleared: the network goes on with what it sees while undamped, its output unused.

    Without a valid reference it stands still.
    """

    code: ClassVar[int] = 1
    id: Literal["keep"] = "keep"


@inlined
def switch_keep(p, s, ring, wanted, u_e, u_n):
    """Take the wanted state at once; while undamped feed the network all the same."""
    if p[TUNING_PARAMETERS] != 0.0:
        follow_target(p, s, u_e, u_n)
    if not wanted and (p[DAMPING] != EXTERNAL or s[VALID] != 0.0):
        advance_network(p, s, u_e, u_n)
    s[DAMPED] = 1.0 if wanted else 0.0
    s[XI] = s[XI_TARGET] if wanted else 0.0

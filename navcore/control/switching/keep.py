"""Switching `keep`: the network runs on masked while undamped (for comparison, physics.md section 4)."""

from __future__ import annotations

from typing import ClassVar, Literal

from navcore.compiled import inlined
from navcore.control.layout import ACTION, DAMPED, DAMPING, EXTERNAL, MASKED, TO_XI, VALID, XI, XI_TARGET
from navcore.control.switching.base import SwitchingParameters


class Keep(SwitchingParameters):
    """Nothing is cleared: the network goes on with what it sees while undamped, its output unused.

    Without a valid reference it stands still.
    """

    code: ClassVar[int] = 1
    id: Literal["keep"] = "keep"


@inlined
def switch_keep(p, s, wanted):
    """Take the wanted state at once; while undamped feed the network all the same."""
    s[TO_XI] = s[XI_TARGET]
    if not wanted and (p[DAMPING] != EXTERNAL or s[VALID] != 0.0):
        s[ACTION] = MASKED
    s[DAMPED] = 1.0 if wanted else 0.0
    s[XI] = s[XI_TARGET] if wanted else 0.0

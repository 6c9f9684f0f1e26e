"""Switching `keep`: the network runs on masked while undamped (for comparison, theory.md section 4)."""

from typing import Any, ClassVar, Literal

from navcore.foundation.compiled import inlined
from navcore.law.records import EXTERNAL, MASKED
from navcore.law.switching.base import SwitchingParameters


@inlined
def _switch(own, memory, law, wanted):
    """Take the wanted state at once; while undamped feed the network all the same."""
    s = law.s
    s.to_xi = s.xi_target
    if not wanted and (law.p.damping != EXTERNAL or s.valid):
        s.action = MASKED
    s.damped = wanted
    s.xi = s.xi_target if wanted else 0.0


class Keep(SwitchingParameters):
    """Nothing is cleared: the network goes on with what it sees while undamped, its output unused.

    Without a valid reference it stands still.
    """

    switch: ClassVar[Any] = _switch
    id: Literal["keep"] = "keep"

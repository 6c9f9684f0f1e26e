"""Switching `hard`: clear the network on re-engagement, correct nothing while undamped."""

from typing import Any, ClassVar, Literal

from navcore.foundation.compiled import inlined
from navcore.law.records import CLEAR
from navcore.law.switching.base import SwitchingParameters


@inlined
def switch_hard(own, memory, law, wanted):
    """Take the wanted state at once; the network is cleared when damping comes back."""
    s = law.s
    s.to_xi = s.xi_target
    if wanted and not s.damped:
        s.action = CLEAR
    s.damped = wanted
    s.xi = s.xi_target if wanted else 0.0


class Hard(SwitchingParameters):
    """The plain switch: the network starts anew at each re-engagement, as at the start of the run."""

    switch: ClassVar[Any] = switch_hard
    plain: ClassVar[bool] = True
    follows_input: ClassVar[bool] = True
    id: Literal["hard"] = "hard"

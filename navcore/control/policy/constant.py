"""Policy `constant`: always damped."""

from __future__ import annotations

from typing import ClassVar, Literal

from navcore.compiled import inlined
from navcore.control.policy.base import PolicyParameters


class Constant(PolicyParameters):
    """Damped whenever a valid reference is there (external) or always (internal)."""

    code: ClassVar[int] = 0
    id: Literal["constant"] = "constant"


@inlined
def decide_constant(p, s, ring, accel, heading):
    """Return True."""
    return True

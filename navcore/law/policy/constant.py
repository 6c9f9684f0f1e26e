"""Policy `constant`: always damped."""

from typing import Any, ClassVar, Literal

from navcore.foundation.compiled import inlined
from navcore.law.policy.base import PolicyParameters


@inlined
def _decide(own, memory, law, sensed):
    """Return True."""
    return True


class Constant(PolicyParameters):
    """Damped whenever a valid reference is there (external) or always (internal)."""

    decide: ClassVar[Any] = _decide
    plain: ClassVar[bool] = True
    always: ClassVar[bool] = True
    id: Literal["constant"] = "constant"

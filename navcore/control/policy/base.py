"""What every policy has: parameters, a code for the compiled dispatch, and what it needs to decide."""

from __future__ import annotations

from typing import Any, ClassVar

from navcore.parameters import Parameters


class PolicyParameters(Parameters):
    """Base of the ``policy`` block of a method; subclasses narrow ``id`` to a Literal.

    Attributes
    ----------
    code : int
        Number by which the compiled dispatch knows the policy.
    needs_reference : bool
        The policy looks at V_r - V_c, so the scenario must have a reference velocity.
    """

    code: ClassVar[int]
    needs_reference: ClassVar[bool] = False
    id: Any  # a Literal in each subclass

    def packed(self) -> list[float]:
        """Values for ``p[POLICY_PARAMETERS:]``, at most 16."""
        return []

    def ring_rows(self, law_step_s: float) -> int:
        """Law calls of history that the decision needs."""
        return 0

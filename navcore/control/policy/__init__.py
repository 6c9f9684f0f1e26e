"""Policies: when to damp. A new one is a file, a registry line and a dispatch line (held equal by a test)."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from navcore.compiled import inlined
from navcore.control.layout import POLICY
from navcore.control.policy.base import PolicyParameters
from navcore.control.policy.constant import Constant, decide_constant
from navcore.control.policy.threshold import Threshold, decide_threshold

POLICIES: dict[str, type[PolicyParameters]] = {"constant": Constant, "threshold": Threshold}

Policy = Annotated[Constant | Threshold, Field(discriminator="id")]


@inlined
def decide(p, s, ring, accel, heading):
    """Ask the policy named by ``p[POLICY]``: True when it wants the loop damped."""
    code = int(p[POLICY])
    if code == 1:
        return decide_threshold(p, s, ring, accel, heading)
    return decide_constant(p, s, ring, accel, heading)


__all__ = ["POLICIES", "Policy", "PolicyParameters", "decide"]

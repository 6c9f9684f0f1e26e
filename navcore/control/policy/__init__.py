"""Policies: when to damp. A new one is a file, a registry line and a dispatch line (held equal by a test)."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from navcore.compiled import inlined
from navcore.control.layout import POLICY
from navcore.control.policy.acceleration import Acceleration, decide_acceleration
from navcore.control.policy.adaptive import Adaptive, decide_adaptive
from navcore.control.policy.base import Limit, Measure, PolicyParameters
from navcore.control.policy.constant import Constant, decide_constant
from navcore.control.policy.schedule import Schedule, decide_schedule
from navcore.control.policy.threshold import Threshold, decide_threshold
from navcore.control.policy.variation import Variation, decide_variation
from navcore.control.policy.yaw_rate import YawRate, decide_yaw_rate

POLICIES: dict[str, type[PolicyParameters]] = {
    "constant": Constant,
    "threshold": Threshold,
    "yaw_rate": YawRate,
    "acceleration": Acceleration,
    "variation": Variation,
    "adaptive": Adaptive,
    "schedule": Schedule,
}
"""All policies by id, in the order in which the page offers them."""

Policy = Annotated[
    Constant | Threshold | YawRate | Acceleration | Variation | Adaptive | Schedule, Field(discriminator="id")
]
"""Type of a field that holds any policy, told apart by ``id``."""


@inlined
def decide(p, s, ring, accel, heading):
    """Ask the policy named by ``p[POLICY]``: True when it wants the loop damped."""
    code = int(p[POLICY])
    if code == 1:
        return decide_threshold(p, s, ring, accel, heading)
    if code == 2:
        return decide_yaw_rate(p, s, ring, accel, heading)
    if code == 3:
        return decide_acceleration(p, s, ring, accel, heading)
    if code == 4:
        return decide_variation(p, s, ring, accel, heading)
    if code == 5:
        return decide_adaptive(p, s, ring, accel, heading)
    if code == 6:
        return decide_schedule(p, s, ring, accel, heading)
    return decide_constant(p, s, ring, accel, heading)


__all__ = ["POLICIES", "Limit", "Measure", "Policy", "PolicyParameters", "decide"]

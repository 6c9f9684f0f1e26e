"""Policies: when to damp. A new one is a new file and a line in the registry.

The field's type, the records of parameters and state, and the compiled choice between the decisions are made
from the registry.
"""

from typing import TYPE_CHECKING, TypeAlias

from navcore.foundation.registry import any_of, registry
from navcore.law.policy.base import Limit, Measure, PolicyParameters

POLICIES = registry(
    PolicyParameters,
    "id",
    "navcore.law.policy.constant:Constant",
    "navcore.law.policy.threshold:Threshold",
    "navcore.law.policy.yaw_rate:YawRate",
    "navcore.law.policy.acceleration:Acceleration",
    "navcore.law.policy.variation:Variation",
    "navcore.law.policy.adaptive:Adaptive",
    "navcore.law.policy.schedule:Schedule",
    "navcore.law.policy.mobility:Mobility",
    "navcore.law.policy.states:States",
)
"""All policies by id, in the order in which the page offers them."""

if TYPE_CHECKING:
    Policy: TypeAlias = PolicyParameters
else:
    Policy = any_of(POLICIES, "id")
    """Type of a field that holds any policy, told apart by ``id``."""

__all__ = ["POLICIES", "Limit", "Measure", "Policy", "PolicyParameters"]

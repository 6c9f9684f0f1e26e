"""Switching methods: how the loop passes between damped and undamped. A new one: a file, a registry line."""

from typing import TYPE_CHECKING, TypeAlias

from navcore.foundation.registry import any_of, registry
from navcore.law.switching.base import SwitchingParameters

SWITCHINGS = registry(
    SwitchingParameters,
    "id",
    "navcore.law.switching.hard:Hard",
    "navcore.law.switching.keep:Keep",
    "navcore.law.switching.ramp:Ramp",
    "navcore.law.switching.step:Step",
    "navcore.law.switching.bumpless:Bumpless",
    "navcore.law.switching.bridge:Bridge",
)
"""All switching methods by id, in the order in which the page offers them."""

if TYPE_CHECKING:
    Switching: TypeAlias = SwitchingParameters
else:
    Switching = any_of(SWITCHINGS, "id")
    """Type of a field that holds any switching method, told apart by ``id``."""

__all__ = ["SWITCHINGS", "Switching", "SwitchingParameters"]

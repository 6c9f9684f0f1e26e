"""Motions of the vehicle: one file each, its parameters beside its truth; the scenario's block ``motion``."""

from typing import TYPE_CHECKING, TypeAlias

from navcore.foundation.registry import any_of, registry
from navcore.motion.base import MotionParameters
from navcore.motion.legs import LegsMotion
from navcore.motion.profile import ProfileMotion
from navcore.motion.static import StaticMotion
from navcore.motion.swing import SwingMotion
from navcore.motion.track import TrackMotion
from navcore.motion.waves import WavesMotion

MOTIONS = registry(
    MotionParameters,
    "kind",
    "navcore.motion.static:StaticMotion",
    "navcore.motion.swing:SwingMotion",
    "navcore.motion.legs:LegsMotion",
    "navcore.motion.profile:ProfileMotion",
    "navcore.motion.waves:WavesMotion",
    "navcore.motion.track:TrackMotion",
)
"""All motions by ``kind``, in the order in which the page offers them."""

if TYPE_CHECKING:
    Motion: TypeAlias = MotionParameters
else:
    Motion = any_of(MOTIONS, "kind")
    """Type of a field that holds any motion, told apart by ``kind``."""

__all__ = [
    "MOTIONS",
    "LegsMotion",
    "Motion",
    "MotionParameters",
    "ProfileMotion",
    "StaticMotion",
    "SwingMotion",
    "TrackMotion",
    "WavesMotion",
]

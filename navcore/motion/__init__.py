"""Motions of the vehicle: one file each, its parameters beside its truth; the scenario's block ``motion``."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from navcore.motion.base import MotionParameters
from navcore.motion.legs import LegsMotion
from navcore.motion.profile import ProfileMotion
from navcore.motion.static import StaticMotion
from navcore.motion.swing import SwingMotion
from navcore.motion.track import TrackMotion
from navcore.motion.waves import WavesMotion

MOTIONS: dict[str, type[MotionParameters]] = {
    "static": StaticMotion,
    "swing": SwingMotion,
    "legs": LegsMotion,
    "profile": ProfileMotion,
    "waves": WavesMotion,
    "track": TrackMotion,
}
"""All motions by ``kind``."""

Motion = Annotated[
    StaticMotion | SwingMotion | LegsMotion | ProfileMotion | WavesMotion | TrackMotion,
    Field(discriminator="kind"),
]

__all__ = [
    "MOTIONS",
    "LegsMotion",
    "Motion",
    "ProfileMotion",
    "StaticMotion",
    "SwingMotion",
    "TrackMotion",
    "WavesMotion",
]

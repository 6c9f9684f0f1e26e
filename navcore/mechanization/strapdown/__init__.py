"""The full strapdown mechanization: quaternion, increments in, the damping law inside (theory.md 6)."""

from navcore.mechanization.strapdown.run import (
    Settings,
    Start,
    StrapdownRun,
    VelocityReference,
    no_reference,
    start_from,
    start_run,
    velocity_reference,
)

__all__ = [
    "Settings", "Start", "StrapdownRun", "VelocityReference", "no_reference", "start_from", "start_run",
    "velocity_reference",
]  # fmt: skip

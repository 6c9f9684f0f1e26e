"""Faults of a Kalman filter as a method that only the whole scenario shows."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from navcore.foundation.errors import Fault

if TYPE_CHECKING:
    from navcore.scenario.model import Scenario


def kalman_faults(scenario: Scenario) -> Iterator[Fault]:
    """Yield the faults of methods with ``damping = "kalman"``."""
    for i, method in enumerate(scenario.method):
        if method.damping != "kalman":
            continue
        at = f"method.{i}.damping"
        if scenario.run.fidelity == "channel":
            yield Fault(
                "", at, "kalman",
                'needs run.fidelity "error_model" or "strapdown": it estimates both channels and the heading',
            )  # fmt: skip
        if scenario.reference.kind != "log":
            yield Fault(
                "", at, "kalman",
                'needs reference.kind = "log": the filter must be told the noise of what it measures with',
            )  # fmt: skip
        if scenario.imu.file is not None:
            yield Fault(
                "", at, "kalman",
                "needs a simulated IMU: the filter must be told its random errors (no imu.file)",
            )  # fmt: skip

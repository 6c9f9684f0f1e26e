"""Faults of half-period averaging that only the whole scenario shows."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from navcore.averaging.record import standing_row
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text

if TYPE_CHECKING:
    from navcore.scenario.model import Scenario


def averaging_faults(scenario: Scenario) -> Iterator[Fault]:
    """Yield the faults of methods with ``damping = "averaging"`` and of ``alignment.motion``."""
    alignment = scenario.alignment
    for i, motion in enumerate(alignment.motion):
        if motion.t_s < -alignment.duration_s:
            yield Fault(
                "",
                f"alignment.motion.{i}.t_s",
                motion.t_s,
                Text(
                    "must be >= {duration_s:g} (s): the alignment begins there",
                    duration_s=-alignment.duration_s,
                ),
            )
        elif motion.t_s + motion.duration_s > 0.0:
            yield Fault(
                "",
                f"alignment.motion.{i}.duration_s",
                motion.duration_s,
                Text("must be <= {t_s:g} (s): navigation starts at 0", t_s=-motion.t_s),
            )
    averaging = [i for i, method in enumerate(scenario.method) if method.damping == "averaging"]
    if averaging and not scenario.motion.recorded:
        yield from _start_faults(scenario)
    for i in averaging:
        if scenario.run.fidelity == "channel":
            yield Fault(
                "",
                f"method.{i}.damping",
                "averaging",
                'needs run.fidelity "error_model" or "strapdown": two channels by themselves have neither '
                "Foucault nor 24 h oscillation",
            )
        if scenario.imu.file is not None:
            yield Fault(
                "",
                f"method.{i}.damping",
                "averaging",
                "needs a simulated IMU: its forecast comes from a simulated alignment record (no imu.file)",
            )


def _start_faults(scenario: Scenario) -> Iterator[Fault]:
    """Yield the fault of a vehicle under way at t = 0 (that of a recorded track shows when it is run)."""
    try:
        row = scenario.motion.truth(1, 1.0, scenario.site.site(), scenario.earth).values[0]
    except InputError:
        return  # a fault of the motion itself
    try:
        standing_row(row)
    except InputError as error:
        yield from error.faults

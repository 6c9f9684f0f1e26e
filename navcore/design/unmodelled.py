"""What of a scenario the stochastic model does not hold, so that budget and floor do not either."""

from __future__ import annotations

from navcore.scenario.model import Scenario


def recorded_warnings(scenario: Scenario) -> tuple[str, ...]:
    """Say which recordings count as free of error.

    Parameters
    ----------
    scenario : Scenario
        Complete and checked.
    """
    warnings = []
    if scenario.reference.kind == "file":
        warnings.append("reference.file: a recorded log has no stochastic model and counts as free of error")
    if scenario.imu.file is not None:
        warnings.append("imu.file: a recorded IMU has no stochastic model and counts as free of error")
    return tuple(warnings)

"""Terms of a scenario that the stochastic model leaves out, and with it budget, floor and tuning."""

import numpy as np

from navcore.foundation.text import Text
from navcore.scenario.model import Scenario
from navcore.sensors.base import ErrorPart, modelled_drift


def unmodelled_warnings(scenario: Scenario, steady: bool = False) -> tuple[str, ...]:
    """Say which errors of the scenario are left out; of recordings `navcore.design.modelled` does.

    Parameters
    ----------
    scenario : Scenario
        Complete and checked.
    steady : bool
        True for the steady state of one channel at rest, which knows random processes and constants only.
    """
    warnings = []
    parts: list[tuple[str, ErrorPart]] = []
    if scenario.reference.kind == "log":
        parts += [("reference", part) for part in scenario.reference.all_parts()]
    if scenario.imu.file is None:
        parts += [("imu", part) for part in scenario.imu.all_parts()]
    for block, part in parts:
        own = (other for _, other in parts if other.sensor == part.sensor)
        second_drift = part.markov[0] > 0.0 and part is not modelled_drift(own)
        counts = block == "imu" and np.any(part.lsb)
        if second_drift or counts or (steady and part.has_shape and part.source != "log_tide"):
            fields = ", ".join(f"{block}.{field}" for field in part.fields)
            warnings.append(Text("{fields}: {label} is not in the budget", fields=fields, label=part.label))
    return tuple(warnings)

"""Cost of a run before it is started: memory and processor time, for a scheduler that admits runs.

Both are estimates from the scenario alone: no file is opened and nothing is simulated. The coefficients were
fitted to measured runs (peak of the resident set above the start, time of the process) and are meant to be
right to about a factor of two for runs that are large enough to matter.
"""

import os
from dataclasses import dataclass

from navcore.damping.base import Carrying
from navcore.foundation.units import HOUR
from navcore.scenario.model import Scenario

_FIXED_BYTES = 2e6
"""Kernels' work space, one chunk of samples, small arrays."""
_METHOD_BYTES = 0.3e6
"""Plot bins and curves of one method."""
_ROW_BYTES, _TRUE_ROW_BYTES, _NAVIGATION_ROW_BYTES = 136.0, 120.0, 88.0
"""An output row: of each method (errors, law), of the truth, and of a method's navigation (strapdown)."""
_FILE_FACTOR = 15.0
"""Bytes held for one byte of a recorded file while it is read and joined."""
_SMALLEST_S = 0.005


@dataclass(frozen=True)
class _Cost:
    """Cost of one step (linear error model) or of one recorded interval (strapdown).

    That of a method depends on how it is carried out.
    """

    base: float
    noise: float
    moving: float
    method: dict[Carrying, float]


_LINEAR_BYTES = _Cost(60.0, 75.0, 650.0, {"law": 0.0, "copies": 180.0, "filter": 0.0, "user": 0.0})
_STRAPDOWN_BYTES = _Cost(60.0, 0.0, 140.0, {"law": 0.0, "copies": 60.0, "filter": 0.0, "user": 0.0})
_LINEAR_S = _Cost(
    0.15e-6, 0.2e-6, 1.2e-6, {"law": 0.16e-6, "copies": 0.66e-6, "filter": 5.16e-6, "user": 10e-6}
)
_STRAPDOWN_S = _Cost(30e-9, 5e-9, 10e-9, {"law": 40e-9, "copies": 200e-9, "filter": 90e-9, "user": 10e-6})
"""Of one IMU sample."""
_ROW_S = 0.3e-6
_WORKERS = 2
"""Methods of a linear run that are under way at once."""


def estimated_bytes(scenario: Scenario) -> float:
    """Memory that a run of the scenario holds at its peak, above what the process holds already.

    Parameters
    ----------
    scenario : Scenario
        Complete and checked.

    Returns
    -------
    float
        Bytes.
    """
    cost = _STRAPDOWN_BYTES if scenario.strapdown else _LINEAR_BYTES
    methods, moving = len(scenario.method), _moving(scenario)
    per_step = cost.base + cost.noise * _noisy(scenario) + cost.moving * moving
    per_step += sum(sorted(_methods(cost, scenario))[-_WORKERS:])
    per_row = _ROW_BYTES + (_NAVIGATION_ROW_BYTES if scenario.strapdown else 0.0)
    arrays = scenario.steps * per_step + _rows(scenario) * (methods * per_row + _TRUE_ROW_BYTES * moving)
    return _FIXED_BYTES + methods * _METHOD_BYTES + arrays + _FILE_FACTOR * _file_bytes(scenario)


def estimated_seconds(scenario: Scenario) -> float:
    """Processor time that a run of the scenario takes, kernels compiled, on one core of about 3 GHz.

    Parameters
    ----------
    scenario : Scenario
        Complete and checked.

    Returns
    -------
    float
        Seconds; what recorded files take to read (once, then cached) is not included.
    """
    methods, moving = len(scenario.method), _moving(scenario)
    cost = _STRAPDOWN_S if scenario.strapdown else _LINEAR_S
    steps = scenario.sampling.samples if scenario.strapdown else scenario.steps
    if scenario.alignment.kind == "compass":
        steps += scenario.alignment.duration_s * scenario.run.rate_hz
    per_step = cost.base + cost.noise * _noisy(scenario) + cost.moving * moving
    per_step += sum(_methods(cost, scenario))
    return _SMALLEST_S + steps * per_step + _rows(scenario) * methods * _ROW_S


def _moving(scenario: Scenario) -> bool:
    return scenario.motion.kind != "static"


def _noisy(scenario: Scenario) -> bool:
    return any(part.white > 0.0 or part.markov[0] > 0.0 for part in scenario.imu.all_parts())


def _methods(cost: _Cost, scenario: Scenario) -> list[float]:
    return [cost.method[method.kind.carrying] for method in scenario.method]


def _rows(scenario: Scenario) -> float:
    run = scenario.run
    return min(run.duration_h * HOUR / run.output_step_s + 1.0, scenario.steps + 1.0)


def _file_bytes(scenario: Scenario) -> float:
    track = getattr(scenario.motion, "file", None)
    named = (track, scenario.reference.file, scenario.imu.file)
    files = {file for name in named if name for file in ((name,) if isinstance(name, str) else name)}
    return float(sum(_size(file) for file in files))


def _size(file: str) -> int:
    try:
        return os.stat(file).st_size
    except (OSError, ValueError):
        return 0

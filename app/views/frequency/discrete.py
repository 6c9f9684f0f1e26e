"""Dots on H(jw): gain and phase of the filter that really runs, measured by driving it with sines."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from app.plots.effective import Loop, effective_network, loop_of, realisation
from navcore.engine.run import MethodRun, Run
from navcore.networks.base import ComplexArray

LOWEST, HIGHEST = 2e-4, 0.15
"""Range of the measured frequencies, rad/s: the slowest takes nine hours of the filter's time."""
_COUNT = 14
_OF_NYQUIST = 0.8


def law_step_s(run: Run) -> float:
    """Time between two steps of the damping filter, s."""
    return run.scenario.run.step_s if run.sampling is None else run.sampling.law_step_s


def measured_gain(method: MethodRun, step_s: float) -> tuple[np.ndarray, ComplexArray] | None:
    """Frequencies (rad/s) and complex gains of a method's filter; None where no filter runs.

    None runs in a free method, nor for gains that act as velocity feedback; a filter that does not come to
    rest cannot be measured.
    """
    network = effective_network(method)
    gains = realisation(method) != "network" and network.feedback_p is None
    if network.order == 0 or gains:
        return None
    return _measure(loop_of(method), step_s)


# A slider of one method leaves the filters of the others as they were.
@lru_cache(maxsize=32)
def _measure(loop: Loop, step_s: float) -> tuple[np.ndarray, ComplexArray] | None:
    from navcore.analysis.measured import measured_response
    from navcore.foundation.errors import InputError
    from navcore.networks.discrete import discretise

    omega = np.geomspace(LOWEST, min(HIGHEST, _OF_NYQUIST * math.pi / step_s), _COUNT)
    try:
        gain = measured_response(discretise(loop.network, step_s), omega)
    except InputError:
        return None
    return None if gain is None else (omega, gain)

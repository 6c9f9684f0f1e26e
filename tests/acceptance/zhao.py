"""Line amplitudes of Zhao's presets: what is left of the Schuler and 24 h swing, arc-seconds, m/s, m."""

from __future__ import annotations

import numpy as np

from navcore.averaging.lines import line_amplitudes, line_phases
from navcore.engine.run import Run
from navcore.engine.simulation import simulate
from navcore.foundation.units import ARCSEC
from navcore.mechanization.recorder import NAMES, POSITION
from navcore.scenario.file import load

LEVEL = ("phi_e_rad", "phi_n_rad", "dve_mps", "dvn_mps")
SLOW = ("phi_u_rad", "dlat_m")
_UNITS = np.array([ARCSEC] * 3 + [1.0] * 4)


def amplitudes(run: Run) -> dict[str, dict[str, np.ndarray]]:
    """Method -> quantity -> amplitude of both Schuler lines and of the 24 h line."""
    phases = line_phases(run.t_s, run.truth, run.scenario.earth)
    found = {}
    for method in run.methods:
        fit = line_amplitudes(method.t_s, method.rows[:, :POSITION] / _UNITS, phases)
        found[method.method.name] = dict(zip(NAMES[:POSITION], fit.amplitude, strict=True))
    return found


def run_preset(name: str, *overrides: str) -> Run:
    """Run a preset with some fields changed."""
    return simulate(load(name, list(overrides)))


def schuler(lines: np.ndarray) -> float:
    """Largest Schuler swing that both lines together make."""
    return float(lines[0] + lines[1])

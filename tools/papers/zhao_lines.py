"""Amplitudes of the Schuler and 24 h lines in Zhao's presets, over several seeds."""

import numpy as np

from navcore.averaging.lines import line_amplitudes, line_phases
from navcore.engine.run import Run
from navcore.engine.simulation import simulate
from navcore.foundation.units import ARCSEC
from navcore.mechanization.recorder import D_LAT, DV_E, DV_N, PHI_E, PHI_N, PHI_U, POSITION
from tools.papers.runs import STRAPDOWN, Runs, method, scenario_of

UNITS = np.array([ARCSEC, ARCSEC, ARCSEC, 1.0, 1.0, 1.0, 1.0])
LEVEL, SLOW = (PHI_E, PHI_N, DV_E, DV_N), (PHI_U, D_LAT)
SEEDS, STRAPDOWN_SEEDS, TURNTABLE_SEEDS = range(1, 11), range(1, 4), range(1, 7)
TURNTABLE_HZ = "run.rate_hz=20"
"""The table swings with 0.05 Hz and the noise of a second is the same as at 100 Hz."""


def noise(arw_dpsh: float, vrw_ugpshz: float) -> tuple[str, str]:
    """Overrides for the random walks."""
    return f"imu.gyro_arw_dpsh={arw_dpsh}", f"imu.accel_vrw_ugpshz={vrw_ugpshz}"


def per_sample(arw_dph: float, vrw_g: float, rate_hz: float = 100.0) -> tuple[str, str]:
    """Overrides for random walks given as the standard deviation of one sample, deg/h and g."""
    return noise(arw_dph / (3600.0 * rate_hz) ** 0.5, vrw_g * 1e6 / rate_hz**0.5)


READINGS: dict[str, dict[str, tuple[str, str]]] = {
    "zhao-sensors": {
        "both per 100 Hz sample": per_sample(0.005, 5e-4),
        "gyros per root hour, accelerometers per sample": noise(0.005, 50.0),
        "both per root of time": noise(0.005, 500.0),
    },
    "zhao-turntable": {
        "both per 100 Hz sample": per_sample(0.005, 5e-5),
        "gyros per sample, accelerometers per root hertz": noise(0.005 / 600.0, 50.0),
        "both per root of time": noise(0.005, 50.0),
    },
}
"""How the printed random walks, 0.005 deg/h and 5e-4 g (5e-5 g on the turntable), may be read."""
PER_SAMPLE, PER_ROOT = "both per 100 Hz sample", "both per root of time"


def lines(run: Run, name: str) -> np.ndarray:
    """Amplitude of both Schuler lines together and of the 24 h line, by quantity, shape (7, 2)."""
    found = method(run, name)
    phases = line_phases(run.t_s, run.truth, run.scenario.earth)
    fit = line_amplitudes(found.t_s, found.rows[:, :POSITION] / UNITS, phases).amplitude
    return np.column_stack([fit[:, 0] + fit[:, 1], fit[:, 2]])


def remaining(run: Run) -> np.ndarray:
    """Largest fraction of the free run's lines left by Zhao's average: Schuler (tilt, velocity), 24 h."""
    ratio = lines(run, "Zhao") / lines(run, "free")
    return np.array([ratio[list(LEVEL), 0].max(), ratio[list(SLOW), 1].max()])


def left(
    runs: Runs, preset: str, line: int, overrides: tuple[str, ...] = (), one: bool = False
) -> np.ndarray:
    """Fraction of a line (0 Schuler, 1 24 h) that is left, with each of the seeds.

    The turntable is always the full strapdown. ``one``: the preset's own seed only, where nothing is random.
    """
    strapdown = runs.strapdown or preset == "zhao-turntable"
    seeds, fidelity = (STRAPDOWN_SEEDS, STRAPDOWN) if runs.strapdown else (SEEDS, ())
    if preset == "zhao-turntable":
        seeds, fidelity = TURNTABLE_SEEDS, (TURNTABLE_HZ,)

    def make() -> np.ndarray:
        two = scenario_of(preset).canonical()["method"][:2]
        found = []
        for seed in seeds[:1] if one else seeds:
            given = (*fidelity, f"run.seed={seed}", *overrides)
            found.append(remaining(simulate(scenario_of(preset, given, method=two))))
        return np.array(found)

    return runs.keep((preset, "left", strapdown, one, overrides), make)[:, line]

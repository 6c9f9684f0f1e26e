"""Sun 2017, section 5.2, table 2 and figures 16 to 18: the vehicle experiment."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from navcore.engine.run import Run
from navcore.engine.simulation import simulate
from navcore.foundation.units import ARCMIN
from tools.papers.claim import Claim, Exhibit, Table, at_most
from tools.papers.estimate import ratio_estimate
from tools.papers.measure import attitude_error, hours, mean_and_interval
from tools.papers.picture import curve, panel
from tools.papers.runs import Runs, method, scenario_of
from tools.papers.sun_ship import ANGLES, METHODS

if TYPE_CHECKING:
    from matplotlib.figure import Figure

PRESET = "deng-vehicle"
SEEDS = range(1, 25)
TABLE_2: dict[str, Any] = {
    "gyro_bias_dph": [0.006, 0.006, 0.006],
    "gyro_arw_dpsh": 0.006,
    "accel_bias_ug": [50.0, 50.0, 50.0],
    "accel_vrw_ugpshz": 50.0,
}
"""Sun's table 2; the accelerometers' random error of 50 ug read as 50 ug/sqrt(Hz)."""


def drive(runs: Runs, seed: int) -> Run:
    """Deng's drive with Sun's sensors, log and methods, full strapdown."""

    def make() -> Run:
        ship = scenario_of("sun-ship").canonical()
        overrides = (f"run.seed={seed}", "run.rate_hz=50", "run.output_step_s=5")
        blocks = {"imu": TABLE_2, "reference": ship["reference"], "method": ship["method"]}
        return simulate(scenario_of(PRESET, overrides, **blocks))

    return runs.keep(("sun drive", seed), make)


def rms(runs: Runs, name: str, angle: str) -> np.ndarray:
    """RMS error of an angle, arcmin, with each of the seeds."""
    found = []
    for seed in SEEDS:
        run = drive(runs, seed)
        error = attitude_error(run, method(run, name))[:, ANGLES.index(angle)]
        found.append(np.sqrt(np.mean(error**2)) / ARCMIN)
    return np.array(found)


def _claim(angle: str) -> Claim:
    return Claim(
        f"adaptive damping is more accurate than conventional: RMS of {angle}, adaptive over conventional",
        "smaller",
        at_most(1.0),
        lambda runs: ratio_estimate(rms(runs, "adaptive", angle) / rms(runs, "conventional", angle)),
        quote="our proposed adaptive damping method has a better performance than the conventional damping "
        "method ... the attitude and heading angles of our proposed method are more accurate than the "
        "conventional one",
    )


def _table(runs: Runs) -> Table:
    rows = tuple((name, *(mean_and_interval(rms(runs, name, angle)) for angle in ANGLES)) for name in METHODS)
    caption = f"RMS error, arcmin, full strapdown, mean over {len(SEEDS)} seeds +- 95 % confidence:"
    return Table(caption, ("method", *ANGLES), rows)


def _draw(runs: Runs, figure: Figure) -> None:
    axes = figure.subplots(1, 3)
    run = drive(runs, 1)
    for i, name in enumerate(METHODS):
        found = method(run, name)
        for k, angle in enumerate(ANGLES):
            curve(axes[k], hours(found), attitude_error(run, found)[:, k] / ARCMIN, name, i)
            panel(axes[k], angle.capitalize(), "time, h", "error, arcmin", legend=i == 2 and k == 0)


VEHICLE = Exhibit(
    name="sun-fig-16",
    title="Section 5.2, table 2, figures 13 to 18: vehicle experiment",
    presets=(PRESET,),
    setting="Figures 13 to 15 show the equipment. The drive and its log are not printed. Here: the drive of "
    "`deng-vehicle` (the same campus), the sensors of table 2, compass alignment, log and methods of "
    "`sun-ship`.",
    claims=tuple(_claim(angle) for angle in ANGLES),
    tables=(_table,),
    draw=_draw,
)

"""Zhao 2015, figures 4 to 6: the forecast of the IMU signals from a disturbed alignment."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from navcore.averaging.forecast import base_motion, forecast_from
from navcore.averaging.record import alignment_record, standing_row
from navcore.engine.environment import truth_of
from navcore.foundation.units import DEG, HOUR
from tools.papers.claim import Claim, Exhibit, Table, at_most
from tools.papers.measure import mean_and_interval
from tools.papers.picture import panel
from tools.papers.runs import Runs, scenario_of
from tools.papers.zhao_lines import PER_SAMPLE, READINGS

if TYPE_CHECKING:
    from matplotlib.figure import Figure

PRESET = "zhao-turntable"
SEEDS = range(1, 21)
DURATION_S = 600.0
PRINTED_S = ((100.0, 105.0), (198.0, 203.0))
"""When the base moved, seconds after the alignment began (Zhao, figure 5)."""
DEG_PER_HOUR = DEG / HOUR


def record(seed: int, quiet: bool = False) -> np.ndarray:
    """Alignment record of the preset, (600, 6) increments; ``quiet``: no noise and no motion of the base."""
    noise = ("imu.gyro_arw_dpsh=0", "imu.accel_vrw_ugpshz=0") if quiet else READINGS[PRESET][PER_SAMPLE]
    scenario = scenario_of(PRESET, (f"run.seed={seed}", *noise))
    standing = standing_row(truth_of(scenario, 1, 1.0).values[0])
    motions = () if quiet else scenario.alignment.motion
    return alignment_record(scenario.imu, standing, DURATION_S, motions, scenario.earth, seed)


def not_found(runs: Runs) -> np.ndarray:
    """Seconds within the printed motions that the detector took for rest, for each seed."""

    def make() -> np.ndarray:
        inside = np.zeros(int(DURATION_S), bool)
        for begin, end in PRINTED_S:
            inside[int(begin) : int(end)] = True
        return np.array([float(np.sum(inside & ~base_motion(record(s)[:, :3]))) for s in SEEDS])

    return runs.keep("zhao forecast: not found", make)


def forecast_errors(runs: Runs, kept: bool = False) -> np.ndarray:
    """Error of the forecast of each gyro against its output without noise, deg/h, shape (seeds, 3).

    ``kept``: of the plain mean, the motions of the base included.
    """

    def make() -> np.ndarray:
        right = record(1, quiet=True)[0, :3]
        found = [
            made[:, :3].mean(axis=0) if kept else forecast_from(made).gyro for made in map(record, SEEDS)
        ]
        return (np.array(found) - right) / DEG_PER_HOUR

    return runs.keep(("zhao forecast: errors", kept), make)


def _forecast_table(runs: Runs) -> Table:
    rows = []
    for name, kept in (("motions left out (Zhao 26)", False), ("plain mean of the record", True)):
        errors = forecast_errors(runs, kept)
        rows.append((name, *(mean_and_interval(errors[:, axis]) for axis in range(3))))
    caption = f"Error of the forecast of each gyro, deg/h, mean over {len(SEEDS)} seeds +- 95 % confidence:"
    return Table(caption, ("forecast", "x", "y", "z"), tuple(rows))


def _draw_forecast(runs: Runs, figure: Figure) -> None:
    del runs
    axes = figure.subplots(1, 2)
    angles = record(1)[:, :3]
    seconds = np.arange(1, len(angles) + 1)
    still = ~base_motion(angles)
    axes[0].plot(seconds, np.cumsum(angles[:, 0]) / DEG, color="#0072B2")
    panel(axes[0], "Figure 5: integral of the gyro output, x", "s", "deg", legend=False)
    rate = angles[:, 0] / DEG_PER_HOUR
    axes[1].plot(seconds[still], rate[still], linestyle="", marker=".", markersize=2.0, color="#0072B2")
    panel(axes[1], "Figure 6: the seconds that are used, x", "s", "deg/h", legend=False)


FORECAST = Exhibit(
    name="zhao-fig-4",
    title="Figures 4 to 6: forecast from an alignment during which the base moves",
    presets=(PRESET,),
    setting="600 s of the preset's alignment; the base turns by 0.3 deg and by 0.1 to 0.2 deg within 5 s "
    "each at the times that figure 5 shows. The sizes of the motions are not printed. Random walks per 100 "
    "Hz sample.",
    claims=(
        Claim(
            "figure 5: the integral of the gyro output shows when the base moved (100 to 105 s and 198 to "
            "203 s): seconds of the motion that are not found",
            "0",
            at_most(0.0),
            not_found,
            "s",
            kind="predicted",
            note="Two seconds on either side are left out as well.",
        ),
        Claim(
            "figure 3: motions that are not removed bias the forecast: error of the plain mean, x gyro",
            "a certain bias",
            (0.01, np.inf),
            lambda runs: np.abs(forecast_errors(runs, kept=True)[:, 0]),
            "deg/h",
        ),
        Claim(
            "figure 6: with the motions removed the forecast is unbiased but for the gyro's own bias: error "
            "of the x gyro",
            "0",
            (-1e-3, 1e-3),
            lambda runs: forecast_errors(runs)[:, 0],
            "deg/h",
            kind="predicted",
            note="The forecast here is of order 0, and earlier parts of the record are turned into the "
            "attitude of the last one. A line fitted to 600 s of gyro noise of 0.005 deg/sqrt(h) would "
            "extrapolate to some 3 deg/h after 12 h.",
        ),
    ),
    tables=(_forecast_table,),
    draw=_draw_forecast,
)

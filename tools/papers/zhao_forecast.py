"""Zhao 2015, figures 4 to 6: the forecast of the IMU signals from a disturbed alignment."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from navcore.averaging import AlignmentMotion
from navcore.averaging.forecast import base_motion, forecast_from, joined_parts
from navcore.averaging.record import alignment_record, standing_row
from navcore.engine.environment import truth_of
from navcore.foundation.units import DEG, HOUR, MICRO_G
from tools.papers.claim import Claim, Exhibit, Table, at_most, number
from tools.papers.measure import mean_and_interval
from tools.papers.picture import curve, panel
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


FORMS = {
    "turned by +0.3 deg": ((-400.0, 0.3),),
    "turned by -0.3 deg": ((-400.0, -0.3),),
    "turned and turned back": ((-400.0, 0.3), (-390.0, -0.3)),
}
"""Small motions of the base in Zhao's figure 3: begin (s) and turn about x (deg), 5 s each."""
FITS = {
    "mean, parts turned (ours)": (0, False),
    "mean, parts shifted (Zhao 26)": (0, True),
    "line, parts turned": (1, False),
    "line, parts shifted (Zhao 26)": (1, True),
    "parabola, parts turned": (2, False),
}
"""Order of the fit, and whether the parts are shifted as printed."""
HORIZONS_S = {"at the start": 0.0, "after half a Schuler period": 2535.0, "after 12 h": 43200.0}


def record(seed: int, quiet: bool = False, motions: Sequence[AlignmentMotion] | None = None) -> np.ndarray:
    """Alignment record of the preset, (600, 6) increments.

    ``quiet``: no noise and no motion of the base; ``motions``: others than the preset's.
    """
    noise = ("imu.gyro_arw_dpsh=0", "imu.accel_vrw_ugpshz=0") if quiet else READINGS[PRESET][PER_SAMPLE]
    scenario = scenario_of(PRESET, (f"run.seed={seed}", *noise))
    standing = standing_row(truth_of(scenario, 1, 1.0).values[0])
    if motions is None:
        motions = () if quiet else scenario.alignment.motion
    return alignment_record(scenario.imu, standing, DURATION_S, motions, scenario.earth, seed)


def _formed(name: str) -> np.ndarray:
    """Record with one of `FORMS`."""
    turns = ((t, (deg, 0.0, 0.0)) for t, deg in FORMS[name])
    return record(1, motions=[AlignmentMotion(t_s=t, duration_s=5.0, turn_deg=turn) for t, turn in turns])


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
    for name, kept in (("motions left out", False), ("plain mean of the record", True)):
        errors = forecast_errors(runs, kept)
        rows.append((name, *(mean_and_interval(errors[:, axis]) for axis in range(3))))
    caption = f"Error of the forecast of each gyro, deg/h, mean over {len(SEEDS)} seeds +- 95 % confidence:"
    return Table(caption, ("forecast", "x", "y", "z"), tuple(rows))


def fit_errors(runs: Runs, order: int, shifted: bool, time_s: float) -> tuple[np.ndarray, np.ndarray]:
    """Error of a fit at a time after the start, by seed: x gyro, deg/h, and y accelerometer, ug."""

    def make() -> np.ndarray:
        right = record(1, quiet=True)[0]
        found = [
            forecast_from(made, 1.0, order, shifted).at(np.array([time_s]))[0] for made in map(record, SEEDS)
        ]
        return np.array(found) - right

    off = runs.keep(("zhao forecast: fit", order, shifted, time_s), make)
    return off[:, 0] / DEG_PER_HOUR, off[:, 4] / MICRO_G


def _fit_table(runs: Runs) -> Table:
    rows = []
    for name, (order, shifted) in FITS.items():
        both = [fit_errors(runs, order, shifted, time_s) for time_s in HORIZONS_S.values()]
        rows.append(
            (name, *(number(float(np.std(part)), 2) for k in (0, 1) for part in (one[k] for one in both)))
        )
    head = (
        "fit",
        *(f"{sensor}, {when}" for sensor in ("x gyro, deg/h", "y accelerometer, ug") for when in HORIZONS_S),
    )
    caption = f"Scatter of the forecast over {len(SEEDS)} seeds, by the fit (Zhao 18 to 27):"
    return Table(caption, head, tuple(rows))


def _draw_forecast(runs: Runs, figure: Figure) -> None:
    """Figures 3 to 6, gyro x left, accelerometer y right."""
    del runs
    axes = figure.subplots(4, 2)
    seconds = np.arange(1, int(DURATION_S) + 1)
    for i, name in enumerate(FORMS):
        angle = np.cumsum(_formed(name)[:, 0] - record(1, quiet=True)[0, 0]) / DEG
        curve(axes[0, 0], seconds, angle, name, i)
        curve(axes[0, 1], seconds, _formed(name)[:, 4], name, i)
    panel(axes[0, 0], "Figure 3: small motions, integral of x", "", "deg")
    panel(axes[0, 1], "and the y accelerometer", "", "m/s^2", legend=False)
    moved, still = record(1), ~base_motion(record(1)[:, :3])
    gyro, accel = moved[:, 0] / DEG_PER_HOUR, moved[:, 4]
    for axis, values, unit, name in (
        (axes[1, 0], gyro, "deg/h", "x gyro"),
        (axes[1, 1], accel, "m/s^2", "y accelerometer"),
    ):
        curve(axis, seconds, values, name, 0)
        panel(axis, f"Figure 4: output of the {name}", "", unit, legend=False)
    curve(axes[2, 0], seconds, np.cumsum(moved[:, 0]) / DEG, "x", 0)
    panel(axes[2, 0], "Figure 5: integral of the x gyro", "", "deg", legend=False)
    curve(axes[2, 1], seconds, np.cumsum(accel), "y", 0)
    panel(axes[2, 1], "and of the y accelerometer", "", "m/s", legend=False)
    forecast = forecast_from(moved)
    joined = joined_parts(moved, forecast.segments)
    for axis, column, scale, unit, name in (
        (axes[3, 0], 0, DEG_PER_HOUR, "deg/h", "gyro"),
        (axes[3, 1], 4, 1.0, "m/s^2", "accelerometer"),
    ):
        axis.plot(
            seconds[still],
            joined[:, column] / scale,
            linestyle="",
            marker=".",
            markersize=2.0,
            color="#0072B2",
            label="joined",
        )
        after = np.arange(0.0, 301.0)
        curve(axis, DURATION_S + after, forecast.at(after)[:, column] / scale, "forecast", 1)
        panel(axis, f"Figure 6: series and fit, {name}", "s", unit)


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
            quote="angular movements of the IMU happened during 100 s~105 s and 198 s~203 s. Therefore, the "
            "time when the angular motions occurred can be distinguished by variation of",
            kind="predicted",
            note="Two seconds on either side are left out as well.",
        ),
        Claim(
            "figure 3: motions that are not removed bias the forecast: error of the plain mean, x gyro",
            "a certain bias",
            (0.01, np.inf),
            lambda runs: np.abs(forecast_errors(runs, kept=True)[:, 0]),
            "deg/h",
            quote="small angular motions bring a certain bias to forecasted time series obtained by curve "
            "fitting based on least square method",
        ),
        Claim(
            "figure 6: with the motions removed the forecast is unbiased but for the gyro's own bias: error "
            "of the x gyro",
            "0",
            (-1e-3, 1e-3),
            lambda runs: forecast_errors(runs)[:, 0],
            "deg/h",
            quote="Since the least squares method is a type of unbiased estimator, forecasted time series "
            "still contains gyro bias drift and accelerometer bias.",
            kind="predicted",
            note="The forecast is of order 0, and earlier parts of the record are turned into the attitude "
            "of the last one. Other fits, and (26) as printed, are settings (last table): with (26) the last "
            "part alone counts. A line scatters by {line} deg/h after 12 h; with 0.005 deg/sqrt(h) by some 3 "
            "deg/h.",
            facts={"line": lambda runs: float(np.std(fit_errors(runs, 1, False, 43200.0)[0]))},
        ),
    ),
    tables=(_forecast_table, _fit_table),
    draw=_draw_forecast,
    height=8.0,
)

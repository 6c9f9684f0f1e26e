"""Deng 2019: external horizontal damping of a strapdown system by the compass-alignment loop."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from navcore.foundation.units import ARCSEC, HOUR
from navcore.mechanization.recorder import D_LAT, D_LON, DV_N, PHI_E, PHI_N
from navcore.motion.truth import LAT, LON
from tools.papers.claim import Claim, Exhibit, Paper, Reading, Table, at_least, at_most, number, order_of
from tools.papers.deng_alignment import ALIGNMENT
from tools.papers.deng_errors import (
    DAMPED,
    PRINTED,
    ROWS,
    SEEDS,
    SLOW,
    TABLE_1,
    TABLE_2,
    TABLE_4,
    Printed,
    errors,
    log_spreads,
    statistics,
)
from tools.papers.deng_reasons import WHY_1, WHY_4, effects
from tools.papers.measure import hours, mean_and_interval, rms
from tools.papers.picture import curve, panel
from tools.papers.runs import Runs, method
from tools.papers.search_deng import DRIVE_SEARCH, TABLE_1_SEARCH, TABLE_2_SEARCH

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def schuler_swing(runs: Runs, preset: str, name: str, seeds: range = SEEDS) -> np.ndarray:
    """Amplitude of the Schuler line in dV_N by least squares over the whole run, m/s, with each seed."""
    found = []
    for seed in seeds:
        run = runs(preset, f"run.seed={seed}")
        each = method(run, name)
        phase = run.scenario.omega_s * each.t_s
        basis = np.column_stack([np.ones_like(phase), each.t_s, np.cos(phase), np.sin(phase)])
        fit = np.linalg.lstsq(basis, each.rows[:, DV_N], rcond=None)[0]
        found.append(float(np.hypot(fit[2], fit[3])))
    return np.array(found)


def _table(preset: str, printed: Printed, caption: str) -> Callable[[Runs], Table]:
    def make(runs: Runs) -> Table:
        columns = [statistics(runs, preset, name) for name in (DAMPED, SLOW, "free")]
        rows = []
        for i, name in enumerate(ROWS):
            mean, variance = printed[i]
            cells = [number(mean), number(variance), number(variance**0.5)]
            for found in columns:
                cells += [number(rms(found[:, i, 0]), 2), mean_and_interval(found[:, i, 1], 2)]
            rows.append((name, *cells))
        head = ["error", "paper: mean", "paper: variance", "its square root"]
        for name in ("sigma = 0.13", "sigma = 0.0088", "free"):
            head += [f"{name}: RMS of the means", "std"]
        return Table(f"{caption} (ours over {len(SEEDS)} seeds):", tuple(head), tuple(rows))

    return make


def _spreads(preset: str, printed: Printed, why: dict[str, str]) -> tuple[Claim, ...]:
    """Each row of a table; "variance" read as a standard deviation, and as a variance beside it."""

    def claim(row: int) -> Claim:
        name, unit = ROWS[row].split(", ")
        value = printed[row][1]

        def ours(runs: Runs) -> np.ndarray:
            return statistics(runs, preset, DAMPED)[:, row, 1]

        return Claim(
            f'"variance" of {name}, as a standard deviation',
            number(value),
            order_of(value, 2.0),
            ours,
            unit,
            kind="fitted" if row in (0, 1, 3, 4) else "direction only",
            why=why.get(name, ""),
            facts=effects(preset, row) if name in why else {},
            readings=(Reading("as a variance", number(value**0.5), order_of(value**0.5, 2.0), ours),),
        )

    return tuple(claim(row) for row in range(len(ROWS)))


def _log_table(runs: Runs) -> Table:
    fast, slow = log_spreads(runs, 200.0), log_spreads(runs, 2.0)
    rows = tuple(
        (name, number(TABLE_1[i][1]), *(number(v, 2) for v in (fast[i], fast[i] ** 2, slow[i], slow[i] ** 2)))
        for i, name in enumerate(ROWS)
    )
    head = ("error", 'paper: "variance"', "200 Hz: std", "its square", "2 Hz: std", "its square")
    return Table("The rate of the log, which is not printed (mean over 3 seeds):", head, rows)


def _no_oscillation(preset: str) -> Claim:
    return Claim(
        "the Schuler oscillation has disappeared: amplitude of its line in V_N, damped over free",
        "none",
        at_most(0.01),
        lambda runs: schuler_swing(runs, preset, DAMPED) / schuler_swing(runs, preset, "free"),
    )


def _draw(preset: str, methods: tuple[str, ...]) -> Callable[[Runs, Figure], None]:
    def draw(runs: Runs, figure: Figure) -> None:
        axes = figure.subplots(1, 3)
        for i, name in enumerate(methods):
            values = errors(runs, preset, name)
            t = hours(method(runs(preset, "run.seed=1"), name))
            behind = {"zorder": 1.5, "alpha": 0.6} if name == DAMPED else {}
            curve(axes[0], t, values[:, 0] * 60.0, name, i, **behind)
            curve(axes[1], t, values[:, 4], name, i, **behind)
            curve(axes[2], t, np.hypot(values[:, 6], values[:, 7]), name, i, **behind)
        panel(axes[0], "Pitch", "time, h", "error, arcmin", legend=False)
        panel(axes[1], "Northern velocity", "time, h", "error, m/s", legend=False)
        panel(axes[2], "Position", "time, h", "error, m", legend=False)
        axes[1].set_yscale("symlog", linthresh=0.02)
        axes[2].set_yscale("symlog", linthresh=1.0)
        handles, labels = axes[0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside lower center", ncols=len(methods))

    return draw


_SETTING = (
    "What the paper calls variance is read as a standard deviation. sigma, xi, the rate of the log and the "
    "signs of the sensor errors are not printed; sigma = 0.13, xi = 0.707 are fitted to pitch, roll, V_E and "
    "V_N of table 1 with the log at 200 Hz. With the log at 2 Hz the same four come near as variances; "
    "longitude and latitude tell the readings apart: at 2 Hz their variances are more than twenty times the "
    "printed ones, at 200 Hz their standard deviations are of the printed size (last table). Heading and V_U "
    "fit in neither reading. Means are not compared: each is one drawing of the random walk and the unknown "
    "signs."
)


def tilt(runs: Runs, preset: str, name: str) -> np.ndarray:
    """RMS of the tilt on one axis with each of the seeds, arcsec."""
    found = []
    for seed in SEEDS:
        rows = method(runs(preset, f"run.seed={seed}"), name).rows
        found.append(rms(rows[:, [PHI_E, PHI_N]]) / ARCSEC)
    return np.array(found)


def _tilt_claim(preset: str, where: str, why: str) -> Claim:
    return Claim(
        f"damping improves the attitude ({where}): RMS tilt of an axis, damped over free",
        "smaller",
        at_most(1.0),
        lambda runs: tilt(runs, preset, DAMPED) / tilt(runs, preset, "free"),
        why=why,
        facts={
            "damped": lambda runs: float(np.mean(tilt(runs, preset, DAMPED))),
            "free": lambda runs: float(np.mean(tilt(runs, preset, "free"))),
            "slow": lambda runs: float(np.mean(tilt(runs, preset, SLOW))),
        },
    )


_AT_REST = (
    "with sigma = 0.13, which fits the paper's spread, the damped tilt ({damped} arcsec) is larger than "
    "the free one ({free} arcsec): the fast loop lets the log's noise in, and 1.5 h after a good alignment "
    "there is little to damp. sigma = 0.0088 leaves {slow} arcsec."
)


STATIC = Exhibit(
    name="deng-table-1",
    title="Table 1, figures 7 to 9: at rest on a turntable",
    presets=("deng-static",),
    setting=_SETTING,
    claims=(
        _no_oscillation("deng-static"),
        _tilt_claim("deng-static", "at rest", _AT_REST),
        *_spreads("deng-static", TABLE_1, WHY_1),
    ),
    tables=(_table("deng-static", TABLE_1, "Table 1 side by side"), _log_table),
    search=TABLE_1_SEARCH,
    draw=_draw("deng-static", ("free", DAMPED, SLOW)),
)

SWING = Exhibit(
    name="deng-table-2",
    title="Table 2, figures 10 to 12: on a swinging turntable",
    presets=("deng-swing",),
    setting="As table 1, with the three-axis swing and the sigma fitted there.",
    claims=(
        _no_oscillation("deng-swing"),
        _tilt_claim("deng-swing", "swinging", _AT_REST),
        *_spreads("deng-swing", TABLE_2, WHY_1),
    ),
    tables=(_table("deng-swing", TABLE_2, "Table 2 side by side"),),
    search=TABLE_2_SEARCH,
    draw=_draw("deng-swing", ("free", DAMPED, SLOW)),
)


def improvement(runs: Runs, row: int) -> np.ndarray:
    """RMS of the free error over the damped one on the drive, with each of the seeds."""
    free, damped = (
        np.sum(statistics(runs, "deng-vehicle", name)[:, row] ** 2, axis=-1) for name in ("free", DAMPED)
    )
    return np.sqrt(free / damped)


def largest_tilt(runs: Runs, name: str) -> np.ndarray:
    """Largest pitch error of a method on the drive after the first 10 min, arcsec, with each of the seeds."""
    found = []
    for seed in SEEDS:
        t = method(runs("deng-vehicle", f"run.seed={seed}"), name).t_s
        pitch = errors(runs, "deng-vehicle", name, seed)[t > HOUR / 6.0, 0]
        found.append(float(np.max(np.abs(pitch))) * 3600.0)
    return np.array(found)


VEHICLE = Exhibit(
    name="deng-table-4",
    title="Table 4, figures 17 to 22: a drive of 9000 s",
    presets=("deng-vehicle",),
    setting="The drive is not printed; ours has stops, turns and 30 to 60 km/h.",
    claims=(
        _no_oscillation("deng-vehicle"),
        Claim(
            "the accuracy of attitude is improved obviously: RMS of pitch, free over damped",
            "better",
            at_least(1.0),
            lambda runs: improvement(runs, 0),
        ),
        Claim(
            "the accuracy of velocity is improved obviously: RMS of V_N, free over damped",
            "better",
            at_least(1.0),
            lambda runs: improvement(runs, 4),
        ),
        Claim(
            "the accuracy of position is also improved: RMS of latitude, free over damped",
            "better",
            at_least(1.0),
            lambda runs: improvement(runs, 7),
        ),
        *_spreads("deng-vehicle", TABLE_4, WHY_4),
        Claim(
            "(3, 4) as printed work on a moving vehicle: largest pitch error over that of the corrected form "
            "(sigma = 0.0088)",
            "1",
            at_most(1.2),
            lambda runs: largest_tilt(runs, PRINTED) / largest_tilt(runs, SLOW),
            why="as printed the platform's command lacks the transport rate V_r/R of the reference: after "
            "every change of speed the loop has to settle on it anew ({printed} against {right} arcsec).",
            facts={
                "printed": lambda runs: float(np.mean(largest_tilt(runs, PRINTED))),
                "right": lambda runs: float(np.mean(largest_tilt(runs, SLOW))),
            },
        ),
    ),
    tables=(_table("deng-vehicle", TABLE_4, "Table 4 side by side"),),
    search=DRIVE_SEARCH,
    draw=_draw("deng-vehicle", ("free", DAMPED, SLOW, PRINTED)),
)


def track(runs: Runs, name: str, seed: int = 1) -> np.ndarray:
    """Horizontal position of a method, or of the vehicle ("true"), from the start, km, shape (m, 2)."""
    run = runs("deng-vehicle", f"run.seed={seed}")
    found = method(run, DAMPED if name == "true" else name)
    truth = run.truth[: len(found.t_s)]
    meridian, normal = run.scenario.earth.radii(float(truth[0, LAT]))
    east = (truth[:, LON] - truth[0, LON]) * normal * np.cos(truth[0, LAT])
    north = (truth[:, LAT] - truth[0, LAT]) * meridian
    if name != "true":
        east, north = east + found.rows[:, D_LON], north + found.rows[:, D_LAT]
    return np.column_stack([east, north]) / 1000.0


def _largest_on_map(runs: Runs) -> np.ndarray:
    """Largest distance of the damped track from the true one over the extent of the drive, %, by seed."""
    true = track(runs, "true")
    extent = np.linalg.norm(np.ptp(true, axis=0))
    distances = [np.linalg.norm(track(runs, DAMPED, seed) - true, axis=1) for seed in SEEDS]
    return np.array([100.0 * np.max(distance) / extent for distance in distances])


def _draw_map(runs: Runs, figure: Figure) -> None:
    axes = figure.subplots()
    for i, name in enumerate(("true", DAMPED, "free")):
        place = track(runs, name)
        curve(axes, place[:, 0], place[:, 1], name, i, linestyle="--" if name == DAMPED else "-")
    panel(axes, "Figure 23: horizontal position", "east, km", "north, km")
    axes.set_aspect("equal")


MAP = Exhibit(
    name="deng-fig-23",
    title="Figure 23: map of the drive",
    presets=("deng-vehicle",),
    setting="The text names the two tracks and says nothing about their distance; 1 % of the extent, about "
    "the width of a line on the map, is our measure.",
    claims=(
        Claim(
            "the map shows the damped track and that of the reference: largest distance over the extent of "
            "the drive",
            "not stated (two tracks in one map)",
            at_most(1.0),
            _largest_on_map,
            "%",
        ),
    ),
    draw=_draw_map,
    height=4.6,
)

PAPER = Paper(
    "Deng 2019",
    "Deng, Sun, Ding, Ismail: *A novel damping method for strapdown inertial navigation system*, IEEE Access "
    "7, 2019.",
    (ALIGNMENT, STATIC, SWING, VEHICLE, MAP),
)

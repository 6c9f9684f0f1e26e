"""Deng 2019: external horizontal damping of a strapdown system by the compass-alignment loop."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from app.papers.claim import Claim, Exhibit, Paper, Table, at_least, at_most, number, order_of
from app.papers.measure import attitude_error, hours
from app.papers.picture import curve, panel
from app.papers.runs import Runs, method
from navcore.mechanization.recorder import D_LAT, D_LON, DV_E, DV_N
from navcore.mechanization.strapdown.layout import NAVIGATION
from navcore.units import DEG, HOUR

if TYPE_CHECKING:
    from matplotlib.figure import Figure

DAMPED, SLOW, PRINTED = "damped (Deng)", "damped, sigma = 0.0088", "sigma = 0.0088, as printed"
ROWS = (
    "pitch, deg",
    "roll, deg",
    "heading, deg",
    "V_E, m/s",
    "V_N, m/s",
    "V_U, m/s",
    "longitude, m",
    "latitude, m",
)
Printed = tuple[tuple[float, float], ...]
TABLE_1: Printed = (
    (0.0056, 0.0068), (-0.0073, 0.0069), (0.0468, 0.0899),
    (8.5077e-4, 0.0086), (2.3199e-4, 0.0082), (-0.0032, 5.4e-6), (0.9009, 0.5135), (0.2462, 0.6012),
)  # fmt: skip
TABLE_2: Printed = (
    (0.0035, 0.0114), (0.0149, 0.0092), (-0.0532, 0.0879),
    (1.494e-4, 0.0112), (6.526e-4, 0.0092), (-0.0039, 3.8e-6), (0.6151, 0.3872), (-0.1091, 0.4231),
)  # fmt: skip
TABLE_4: Printed = (
    (-0.0112, 0.0167), (-0.0063, 0.0832), (0.0137, 0.0734),
    (0.0004, 0.0123), (0.000005, 0.0128), (-0.0017, 0.0129), (-2.1172, 1.1474), (-4.2569, 3.8084),
)  # fmt: skip
SPREADS = ("pitch", "roll", "heading", "V_E", "V_N")
"""What the claims compare: the first rows of a table."""


def errors(runs: Runs, preset: str, name: str) -> np.ndarray:
    """Errors in the order and the units of the tables at the output rows, shape (m, 8)."""
    run = runs(preset)
    found = method(run, name)
    rows = found.rows
    upward = np.zeros(len(rows))
    if found.navigation is not None:
        upward = found.navigation[:, NAVIGATION.index("dvu_mps")]
    velocity = np.column_stack([rows[:, DV_E], rows[:, DV_N], upward])
    return np.column_stack([attitude_error(run, found) / DEG, velocity, rows[:, D_LON], rows[:, D_LAT]])


def schuler_swing(runs: Runs, preset: str, name: str) -> float:
    """Amplitude of the Schuler line in dV_N by least squares over whole run, m/s."""
    run = runs(preset)
    found = method(run, name)
    phase = run.scenario.omega_s * found.t_s
    basis = np.column_stack([np.ones_like(phase), found.t_s, np.cos(phase), np.sin(phase)])
    fit = np.linalg.lstsq(basis, found.rows[:, DV_N], rcond=None)[0]
    return float(np.hypot(fit[2], fit[3]))


def _table(preset: str, printed: Printed, caption: str) -> Callable[[Runs], Table]:
    def make(runs: Runs) -> Table:
        columns = [errors(runs, preset, name) for name in (DAMPED, SLOW, "free")]
        rows = []
        for i, name in enumerate(ROWS):
            values = [*printed[i], *(v for c in columns for v in (np.mean(c[:, i]), np.std(c[:, i])))]
            rows.append((name, *(number(float(value)) for value in values)))
        head = ["error", "paper: mean", "paper: variance"]
        for name in ("sigma = 0.13", "sigma = 0.0088", "free"):
            head += [f"{name}: mean", "std"]
        return Table(caption, tuple(head), tuple(rows))

    return make


def _spread(preset: str, row: int) -> Callable[[Runs], float]:
    return lambda runs: float(np.std(errors(runs, preset, DAMPED)[:, row]))


_HEADING = (
    "0.02 deg/h and 0.006 deg/sqrt(h) turn the heading by {drift} deg within this run, and the heading is "
    "not damped (the paper's neither): what the paper's heading scatters with does not come from the sensors "
    "that it states."
)
_CAR = (
    "a real car with its engine running against a reference that is itself good to 0.01 deg; ours has the "
    "errors of the sensors and the log only."
)


def heading_drift(runs: Runs, preset: str) -> float:
    """Range of the heading error within a run, deg."""
    return float(np.ptp(errors(runs, preset, DAMPED)[:, 2]))


def _spreads(preset: str, printed: Printed, why: dict[str, str]) -> tuple[Claim, ...]:
    return tuple(
        Claim(
            f'"variance" of {name}',
            number(printed[row][1]),
            order_of(printed[row][1], 2.0),
            _spread(preset, row),
            ROWS[row].split(", ")[1],
            why=why.get(name, ""),
            facts={"drift": lambda runs: heading_drift(runs, preset)},
        )
        for row, name in enumerate(SPREADS)
    )


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
            t = hours(method(runs(preset), name))
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
    "What the paper calls variance is read as standard deviation: only so do the 0.2 m/s of the log at 200 "
    "Hz fit. sigma, xi and the signs of the sensor errors are not printed; sigma = 0.13, xi = 0.707 fit "
    "table 1. Means are not compared: each is one drawing of the random walk and the unknown signs."
)

STATIC = Exhibit(
    name="deng-table-1",
    title="Table 1, figures 7 to 9: at rest on a turntable",
    presets=("deng-static",),
    setting=_SETTING,
    claims=(_no_oscillation("deng-static"), *_spreads("deng-static", TABLE_1, {"heading": _HEADING})),
    tables=(_table("deng-static", TABLE_1, "Table 1 side by side:"),),
    draw=_draw("deng-static", ("free", DAMPED, SLOW)),
)

SWING = Exhibit(
    name="deng-table-2",
    title="Table 2, figures 10 to 12: on a swinging turntable",
    presets=("deng-swing",),
    setting="As table 1, with the three-axis swing.",
    claims=(_no_oscillation("deng-swing"), *_spreads("deng-swing", TABLE_2, {"heading": _HEADING})),
    tables=(_table("deng-swing", TABLE_2, "Table 2 side by side:"),),
    draw=_draw("deng-swing", ("free", DAMPED, SLOW)),
)


def improvement(runs: Runs, row: int) -> float:
    """RMS of the free error over the damped one on the drive."""
    free, damped = (errors(runs, "deng-vehicle", name)[:, row] for name in ("free", DAMPED))
    return float(np.sqrt(np.mean(free**2) / np.mean(damped**2)))


def largest_tilt(runs: Runs, name: str) -> float:
    """Largest pitch error of a method on the drive after the first 10 min, arcsec."""
    t = method(runs("deng-vehicle"), name).t_s
    return float(np.max(np.abs(errors(runs, "deng-vehicle", name)[t > HOUR / 6.0, 0]))) * 3600.0


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
        *_spreads("deng-vehicle", TABLE_4, {"pitch": _CAR, "roll": _CAR, "heading": _CAR}),
        Claim(
            "(3, 4) as printed work on a moving vehicle: largest pitch error over that of the corrected form "
            "(sigma = 0.0088)",
            "1",
            at_most(1.2),
            lambda runs: largest_tilt(runs, PRINTED) / largest_tilt(runs, SLOW),
            why="as printed the platform's command lacks the transport rate V_r/R of the reference: after "
            "every change of speed the loop has to find it anew ({printed} against {right} arcsec).",
            facts={
                "printed": lambda runs: largest_tilt(runs, PRINTED),
                "right": lambda runs: largest_tilt(runs, SLOW),
            },
        ),
    ),
    tables=(_table("deng-vehicle", TABLE_4, "Table 4 side by side:"),),
    draw=_draw("deng-vehicle", ("free", DAMPED, SLOW, PRINTED)),
)

PAPER = Paper(
    "Deng 2019",
    "Deng, Sun, Ding, Ismail: *A novel damping method for strapdown inertial navigation system*, IEEE Access "
    "7, 2019.",
    (STATIC, SWING, VEHICLE),
)

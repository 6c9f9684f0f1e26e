"""Zhao 2015: oscillations cancelled by averaging copies of the navigation that are half a period ahead."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from navcore.mechanization.recorder import D_LAT, D_LON, DV_E, DV_N, NAMES, PHI_E, PHI_N, PHI_U
from tools.papers.claim import Claim, Exhibit, Paper, Reading, Table, about, at_most, number
from tools.papers.estimate import Estimate, ratio_estimate
from tools.papers.measure import hours, mean_and_interval
from tools.papers.picture import curve, panel
from tools.papers.runs import Runs, method
from tools.papers.zhao_fast import FAST_VEHICLE, tilt_table
from tools.papers.zhao_forecast import FORECAST
from tools.papers.zhao_lines import PER_ROOT, PER_SAMPLE, READINGS, UNITS, left, lines

if TYPE_CHECKING:
    from matplotlib.figure import Figure

TEXT = {
    PHI_E: "phi_E, arcsec",
    PHI_N: "phi_N, arcsec",
    PHI_U: "phi_U, arcsec",
    DV_E: "dV_E, m/s",
    DV_N: "dV_N, m/s",
    D_LAT: "latitude, m",
    D_LON: "longitude, m",
}
AT_REST = ("motion.kind=static",)
TILTED = ("motion.pitch_deg=45", "motion.roll_deg=45")
_TILTED = "It hangs on a level vehicle: at 45 deg of pitch and roll {tilted} of the line is left."
EFFECTIVE = 0.25
"""Share of a line that "suppressed effectively" may leave; the paper prints no number."""
_FOUR = ("free", "Zhao", "four copies", "eight copies")
_THREE = ("free", "Zhao", "eight copies")


def _table(preset: str, methods: tuple[str, ...], *overrides: str) -> Callable[[Runs], Table]:
    def make(runs: Runs) -> Table:
        found = {name: lines(runs(preset, *overrides), name) for name in methods}
        rows = []
        for quantity, text in TEXT.items():
            values = [float(found[name][quantity, line]) for line in (0, 1) for name in methods]
            rows.append((text, *(number(value) for value in values)))
        head = ["", *(f"Schuler: {name}" for name in methods), *(f"24 h: {name}" for name in methods)]
        caption = "Amplitude of the Schuler lines (both together) and of the 24 h line, before and after:"
        return Table(caption, tuple(head), tuple(rows))

    return make


def _draw(preset: str, methods: tuple[str, ...], *overrides: str) -> Callable[[Runs, Figure], None]:
    def draw(runs: Runs, figure: Figure) -> None:
        axes = figure.subplots(2, 2)
        run = runs(preset, *overrides)
        for axis, quantity in zip(axes.flat, (PHI_E, PHI_U, DV_N, D_LAT), strict=True):
            for i, name in enumerate(methods):
                found = method(run, name)
                curve(axis, hours(found), found.rows[:, quantity] / UNITS[quantity], name, i)
            panel(
                axis, NAMES[quantity].rsplit("_", 1)[0], "time, h", TEXT[quantity], legend=quantity == PHI_E
            )

    return draw


_QUOTES = {
    "zhao-initial": "Schuler, Foucault, and Earth periodic oscillation errors caused by initial errors can "
    "be suppressed",
    "zhao-sensors": "the new method has good performance in suppressing Schuler, Foucault, and Earth "
    "periodic oscillation errors as well",
    "zhao-turntable": "the method can suppress Schuler periodic oscillation errors, Foucault periodic "
    "oscillation errors, and Earth periodic oscillation errors effectively",
}


def _suppressed(preset: str, strapdown: bool) -> tuple[Claim, Claim]:
    """The claims on the Schuler lines and on the 24 h line, in both readings of the random walks."""
    texts = (
        "Schuler and Foucault oscillations of tilt and velocity are suppressed: largest fraction left of "
        "both Schuler lines",
        "the 24 h oscillation of heading and latitude is suppressed: largest fraction left of its line",
    )

    def claim(line: int) -> Claim:
        def ours(reading: str) -> Callable[[Runs], Estimate]:
            return lambda runs: ratio_estimate(left(runs, preset, line, READINGS[preset][reading]))

        other = Reading(
            f"the random walks are {PER_ROOT}", "suppressed effectively", at_most(EFFECTIVE), ours(PER_ROOT)
        )
        return Claim(
            f"{texts[line]}; random walks {PER_SAMPLE}",
            "suppressed effectively",
            at_most(EFFECTIVE),
            ours(PER_SAMPLE),
            strapdown=strapdown,
            readings=(other,),
            quote=_QUOTES[preset],
            note=_TILTED if line and preset == "zhao-sensors" else "",
            facts={"tilted": lambda runs: float(left(runs, preset, 1, TILTED, True).mean())},
        )

    return claim(0), claim(1)


def _reading_table(preset: str) -> Callable[[Runs], Table]:
    def make(runs: Runs) -> Table:
        rows = []
        for reading, overrides in READINGS[preset].items():
            values = (mean_and_interval(left(runs, preset, line, overrides)) for line in (0, 1))
            given = [number(float(text.split("=")[1]), 2) for text in overrides]
            rows.append((reading, *given, *values))
        head = ("reading", "gyros, deg/sqrt(h)", "accelerometers, ug/sqrt(Hz)", "Schuler lines", "24 h line")
        count = len(left(runs, preset, 0, READINGS[preset][PER_SAMPLE]))
        return Table(
            f"Largest fraction left by Zhao's average, mean over {count} seeds +- 95 % confidence:",
            head,
            tuple(rows),
        )

    return make


_PER_ROOT = (
    "The first reading is the one that fits: per root of time, noise that arises after t = 0 raises new "
    "Schuler oscillations, which are the same in all copies and which no average removes, and the mean of "
    "600 s of the gyros' output, from which the copy half a day ahead starts, errs by 0.012 deg/h, as much "
    "as the bias."
)

INITIAL = Exhibit(
    name="zhao-fig-8",
    title="Figure 8: initial errors only, fast vehicle",
    presets=("zhao-initial",),
    setting="24 h, V_E 0 to 300 m/s, V_N 0 to 30 m/s; lines by least squares along the true motion. Nothing "
    f"is random. The paper prints no number; up to {EFFECTIVE} of a line counts as suppressed.",
    claims=(
        Claim(
            "Schuler and Foucault oscillations of tilt and velocity are suppressed: largest fraction left of "
            "both Schuler lines",
            "suppressed",
            at_most(EFFECTIVE),
            lambda runs: left(runs, "zhao-initial", 0, one=True),
            strapdown=True,
            quote=_QUOTES["zhao-initial"],
            note="What stays is mostly the split of the Schuler line by the Earth's rotation, which one "
            "delay cannot cancel; the cascade of both half periods does (table).",
        ),
        Claim(
            "the 24 h oscillation of heading and latitude is suppressed: largest fraction left of its line",
            "suppressed",
            at_most(EFFECTIVE),
            lambda runs: left(runs, "zhao-initial", 1, one=True),
            strapdown=True,
            quote=_QUOTES["zhao-initial"],
        ),
        Claim(
            "the method is not affected by the motion of the vehicle: fraction left of the Schuler lines, "
            "moving over at rest",
            "not affected",
            about(1.0, 0.1),
            lambda runs: (
                left(runs, "zhao-initial", 0, one=True) / left(runs, "zhao-initial", 0, AT_REST, True)
            ),
            strapdown=True,
            quote="the method is not affected by the motion state of the carrier",
            note="It holds for initial errors. Biases that turn with the vehicle are no longer what they "
            "were at t = 0, and the average loses part of its effect: see figure 9, claim 3.",
        ),
        *FAST_VEHICLE,
    ),
    tables=(_table("zhao-initial", _FOUR), tilt_table),
    draw=_draw("zhao-initial", _FOUR),
    height=4.6,
)


def _left_at_rest(runs: Runs) -> np.ndarray:
    return left(runs, "zhao-sensors", 1, AT_REST)


SENSORS = Exhibit(
    name="zhao-fig-9",
    title="Figure 9: with sensor errors",
    presets=("zhao-sensors",),
    setting='As figure 8 with 0.01 deg/h, 1e-4 g and random walks, printed as "0.005 deg/h" and "5e-4 g". '
    "The units are not those of a random walk; they are read as the standard deviation of one sample at 100 "
    "Hz (8.3e-6 deg/sqrt(h) and 50 ug/sqrt(Hz)), as in the preset, and as deg/sqrt(h) and g/sqrt(Hz). "
    + _PER_ROOT,
    claims=(
        *_suppressed("zhao-sensors", True),
        Claim(
            "section 3.2: what biases raise is suppressed less while the vehicle moves, since its attitude "
            "turns them: fraction left of the 24 h line, moving less at rest",
            "weaker",
            (0.0, np.inf),
            lambda runs: left(runs, "zhao-sensors", 1) - _left_at_rest(runs),
            quote="during the movement of carrier ... would vary over time due to the factors, such as "
            "changes of the attitude, which weakens the effect of suppressing oscillation error caused by "
            "them",
            note="{moving} of the 24 h line is left, at rest {rest}. Section 5.1.2 says of figure 8, without "
            "biases, that the motion does not matter.",
            facts={
                "moving": lambda runs: float(left(runs, "zhao-sensors", 1).mean()),
                "rest": lambda runs: float(_left_at_rest(runs).mean()),
            },
        ),
    ),
    tables=(_reading_table("zhao-sensors"), _table("zhao-sensors", _FOUR)),
    draw=_draw("zhao-sensors", _FOUR),
    height=4.6,
)

_TABLE_SAMPLED = READINGS["zhao-turntable"][PER_SAMPLE]
TURNTABLE = Exhibit(
    name="zhao-fig-12",
    title="Figure 12: turntable, forecast from a disturbed alignment",
    presets=("zhao-turntable",),
    setting="25 h in the full strapdown; the motion of the base during alignment is found and left out. The "
    'sensors are printed as upper limits, the random walks as "0.005" and "5e-5 g", read as in figure 9. '
    "Seeds at 20 Hz, table and picture at 100 Hz. " + _PER_ROOT,
    claims=(*_suppressed("zhao-turntable", False),),
    tables=(_reading_table("zhao-turntable"), _table("zhao-turntable", _THREE, *_TABLE_SAMPLED)),
    draw=_draw("zhao-turntable", _THREE, *_TABLE_SAMPLED),
    height=4.6,
)

PAPER = Paper(
    "Zhao 2015",
    "Zhao, Li, Cheng, Jia, Wang: *A method for oscillation errors restriction of SINS based on forecasted "
    "time series*, Sensors 15, 2015.",
    (FORECAST, INITIAL, SENSORS, TURNTABLE),
)

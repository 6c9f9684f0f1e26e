"""Zhao 2015: oscillations cancelled by averaging copies of the navigation that are half a period ahead."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from app.papers.claim import Claim, Exhibit, Paper, Table, at_most, number
from app.papers.measure import hours
from app.papers.picture import curve, panel
from app.papers.runs import Runs, method
from navcore.averaging.lines import line_amplitudes, line_phases
from navcore.mechanization.recorder import D_LAT, D_LON, DV_E, DV_N, NAMES, PHI_E, PHI_N, PHI_U, POSITION
from navcore.units import ARCSEC

if TYPE_CHECKING:
    from matplotlib.figure import Figure

UNITS = np.array([ARCSEC, ARCSEC, ARCSEC, 1.0, 1.0, 1.0, 1.0])
TEXT = {
    PHI_E: "phi_E, arcsec", PHI_N: "phi_N, arcsec", PHI_U: "phi_U, arcsec",
    DV_E: "dV_E, m/s", DV_N: "dV_N, m/s", D_LAT: "latitude, m", D_LON: "longitude, m",
}  # fmt: skip
LEVEL, SLOW = (PHI_E, PHI_N, DV_E, DV_N), (PHI_U, D_LAT)


def amplitudes(runs: Runs, preset: str, name: str) -> np.ndarray:
    """Amplitude of both Schuler lines together and of the 24 h line, by quantity, shape (7, 2)."""

    def make() -> np.ndarray:
        run = runs(preset)
        found = method(run, name)
        phases = line_phases(run.t_s, run.truth, run.scenario.earth)
        fit = line_amplitudes(found.t_s, found.rows[:, :POSITION] / UNITS, phases).amplitude
        return np.column_stack([fit[:, 0] + fit[:, 1], fit[:, 2]])

    return runs.keep((preset, name, "lines", runs.strapdown), make)


def left(runs: Runs, preset: str, name: str, quantities: tuple[int, ...], line: int) -> float:
    """Largest fraction of a line (0 Schuler, 1 24 h) that is left of the free one, over some quantities."""
    ours, free = (amplitudes(runs, preset, one)[list(quantities), line] for one in (name, "free"))
    return float(np.max(ours / free))


def _claims(preset: str, strapdown: bool, why_level: str, why_slow: str, note: str = "") -> tuple[Claim, ...]:
    return (
        Claim(
            "Schuler and Foucault oscillations of tilt and velocity are suppressed: largest fraction left of "
            "both Schuler lines",
            "suppressed effectively",
            at_most(0.25),
            lambda runs: left(runs, preset, "Zhao", LEVEL, 0),
            strapdown=strapdown,
            why=why_level,
            note=note,
        ),
        Claim(
            "the 24 h oscillation of heading and latitude is suppressed: largest fraction left of its line",
            "suppressed effectively",
            at_most(0.25),
            lambda runs: left(runs, preset, "Zhao", SLOW, 1),
            strapdown=strapdown,
            why=why_slow,
        ),
    )


def _table(preset: str, methods: tuple[str, ...]) -> Callable[[Runs], Table]:
    def make(runs: Runs) -> Table:
        rows = []
        for quantity, text in TEXT.items():
            found = [amplitudes(runs, preset, name)[quantity] for name in methods]
            values = [*(f[0] for f in found), *(f[1] for f in found)]
            rows.append((text, *(number(float(value)) for value in values)))
        head = ["", *(f"Schuler: {name}" for name in methods), *(f"24 h: {name}" for name in methods)]
        caption = "Amplitude of the Schuler lines (both together) and of the 24 h line, before and after:"
        return Table(caption, tuple(head), tuple(rows))

    return make


def _draw(preset: str, methods: tuple[str, ...]) -> Callable[[Runs, Figure], None]:
    def draw(runs: Runs, figure: Figure) -> None:
        axes = figure.subplots(2, 2)
        for axis, quantity in zip(axes.flat, (PHI_E, PHI_U, DV_N, D_LAT), strict=True):
            for i, name in enumerate(methods):
                found = method(runs(preset), name)
                curve(axis, hours(found), found.rows[:, quantity] / UNITS[quantity], name, i)
            panel(
                axis, NAMES[quantity].rsplit("_", 1)[0], "time, h", TEXT[quantity], legend=quantity == PHI_E
            )

    return draw


_FOUR = ("free", "Zhao", "four copies", "eight copies")
_THREE = ("free", "Zhao", "eight copies")
_SPLIT = (
    "What stays is mostly the split of the Schuler line by the Earth's rotation, which one delay cannot "
    "cancel; the cascade of both half periods does (table)."
)

_NEW = (
    "averaging cancels what the state at t = 0 holds, nothing that arises later: random walks, and biases "
    "that turn with the vehicle, raise new Schuler oscillations. (Zhao 6.3 says as much of his own figure "
    "12.)"
)
_FORECAST = (
    "the forecast of half a day carries the mean gyro noise of the alignment record, and the biases turn "
    "with the vehicle."
)

PAPER = Paper(
    "Zhao 2015",
    "Zhao, Li, Cheng, Jia, Wang: *A method for oscillation errors restriction of SINS based on forecasted "
    "time series*, Sensors 15, 2015.",
    (
        Exhibit(
            name="zhao-fig-8",
            title="Figure 8: initial errors only, fast vehicle",
            presets=("zhao-initial",),
            setting="24 h, V_E 0 to 300 m/s, V_N 0 to 30 m/s; lines by least squares along the true motion.",
            claims=_claims("zhao-initial", True, "", "", _SPLIT),
            tables=(_table("zhao-initial", _FOUR),),
            draw=_draw("zhao-initial", _FOUR),
            height=4.6,
        ),
        Exhibit(
            name="zhao-fig-9",
            title="Figure 9: with sensor errors",
            presets=("zhao-sensors",),
            setting="As figure 8 with 0.01 deg/h, 1e-4 g and random walks.",
            claims=_claims("zhao-sensors", True, _NEW, _FORECAST),
            tables=(_table("zhao-sensors", _FOUR),),
            draw=_draw("zhao-sensors", _FOUR),
            height=4.6,
        ),
        Exhibit(
            name="zhao-fig-12",
            title="Figure 12: turntable, forecast from a disturbed alignment",
            presets=("zhao-turntable",),
            setting="25 h in the full strapdown; the motion of the base during alignment is found and left "
            "out.",
            claims=_claims("zhao-turntable", False, _NEW, ""),
            tables=(_table("zhao-turntable", _THREE),),
            draw=_draw("zhao-turntable", _THREE),
            height=4.6,
        ),
    ),
)

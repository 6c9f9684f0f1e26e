"""Sun 2017: an adaptive network whose damping ratio follows the velocity difference."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from navcore.analysis import analyse, network_step_response
from navcore.foundation.earth import SPHERE
from navcore.foundation.units import ARCSEC, HOUR
from navcore.mechanization.recorder import PHI_N
from navcore.networks import parse_network
from navcore.networks.base import LinearNetwork
from tools.papers.claim import Claim, Exhibit, Paper, Table, about, at_least, at_most, number
from tools.papers.measure import hours, peak
from tools.papers.picture import curve, panel
from tools.papers.runs import Runs, method
from tools.papers.search_sun import LAW_SEARCH, STEP_SEARCH
from tools.papers.sun_bulge import BULGE
from tools.papers.sun_optimum import OPTIMUM
from tools.papers.sun_ship import SHIP
from tools.papers.sun_table_law import TABLE_LAW
from tools.papers.sun_vehicle import VEHICLE

if TYPE_CHECKING:
    from matplotlib.figure import Figure

OMEGA_S = SPHERE.schuler_frequency(0.0)
SCHULER_S = 2.0 * np.pi / OMEGA_S

# ---------------------------------------------------------------- figures 3 and 4: the network's overshoot

STEP_S = np.arange(0.0, 3001.0)
SWITCH_S = 22140.0
"""When the preset's damping is switched on."""
SWITCHES_S = tuple(6.0 * HOUR + SCHULER_S * k / 12.0 for k in range(12))
"""When the damping is switched on: twelve phases of one Schuler oscillation."""


def step() -> np.ndarray:
    """Answer of classic3 to a unit step, at 0 .. 3000 s."""
    return network_step_response(parse_network('id = "classic3"').transfer(OMEGA_S), STEP_S)


def sun_7() -> np.ndarray:
    """The same as Sun prints it."""
    return 1.0 - (0.0244 * STEP_S + 9.7101) * np.exp(-0.0088 * STEP_S) + 9.7101 * np.exp(-0.0044 * STEP_S)


def switching_overshoot(runs: Runs, switch_s: float) -> float:
    """Largest tilt after the switch over the largest of the Schuler period before it."""
    run = runs("sun-step", f"reference.outage.0.duration_s={round(switch_s)}")
    damped = method(run, "classic3")
    tilt = damped.rows[:, PHI_N]
    before = peak(damped.t_s, tilt, switch_s - SCHULER_S, switch_s)
    return peak(damped.t_s, tilt, switch_s) / before


def _overshoots(runs: Runs) -> list[float]:
    return [switching_overshoot(runs, switch_s) for switch_s in SWITCHES_S]


def _draw_step(runs: Runs, figure: Figure) -> None:
    axes = figure.subplots(1, 2)
    curve(axes[0], STEP_S, step(), "H(s) = classic3", 1)
    curve(axes[0], STEP_S, sun_7(), "Sun 7, printed", 0, linestyle="--")
    panel(axes[0], "Figure 3: step of the network", "time, s", "y")
    for i, run in enumerate(runs("sun-step").methods):
        curve(axes[1], hours(run), -run.rows[:, PHI_N] / ARCSEC, run.method.name, i)
    panel(axes[1], "Figure 4: switched on at 6.15 h", "time, h", "roll error, arcsec")


STEP = Exhibit(
    name="sun-fig-3",
    title="Figures 3 and 4: step of the third-order network, overshoot when it is switched on",
    presets=("sun-step",),
    setting="Figure 4's setting is not printed: the constant errors of Sun 5.1 and its initial tilt of 0.1 "
    "deg at rest, switched on at 6.15 h.",
    claims=(
        Claim(
            "(Sun 7) is the answer of (Sun 4) to a unit step: largest difference",
            "0",
            at_most(0.01),
            lambda runs: float(np.max(np.abs(step() - sun_7()))),
            kind="predicted",
            note="What is left is the rounding of Sun's coefficients.",
            quote="y(t) = 1− (0.0244t + 9.7101)e−0.0088t + 9.7101e−0.0044t",
        ),
        Claim(
            "figure 3: the network overshoots its final value 1 under a step",
            "overshoots",
            at_least(0.1),
            lambda runs: float(np.max(step()) - 1.0),
            note="The paper prints no number for figure 3. The peak is {peak} at {time} s.",
            facts={"peak": lambda runs: float(np.max(step())), "time": lambda runs: float(np.argmax(step()))},
            quote="the damping network in the time domain will overshoot under the action of input step",
        ),
        Claim(
            "figure 4: roll error after the switch over the oscillation before it",
            "approximately two-fold",
            about(2.0, 0.2),
            lambda runs: switching_overshoot(runs, SWITCH_S),
            kind="fitted",
            strapdown=True,
            note="It hangs on the moment of the switch: {least} to {most} times over twelve moments.",
            facts={"least": lambda runs: min(_overshoots(runs)), "most": lambda runs: max(_overshoots(runs))},
            quote="It can be seen in Figure 4 that the overshoot of the roll error was approximately "
            "two-fold when the statuses switched",
        ),
    ),
    search=STEP_SEARCH,
    draw=_draw_step,
)

# ---------------------------------------------------------------- table 1 and the network of section 3.3

TABLE_1 = (
    (3.0, 0.04),
    (1.8, 0.05),
    (0.7, 0.08),
    (0.6, 0.10),
    (0.5, 0.12),
    (0.4, 0.22),
    (0.3, 0.44),
    (0.2, 0.64),
    (0.1, 0.82),
    (0.0, 0.99),
)
"""Sun's table 1: velocity difference in knots, damping coefficient."""
MENDED, PRINTED = (0.3076, -1.1452, 0.8101), (0.3076, 1.1452, 0.8101)
"""Sun 9 with its sign mended, and as printed."""


def fitted() -> np.ndarray:
    """Least-squares parabola through table 1: coefficients of d^2, d, 1."""
    difference, coefficient = np.array(TABLE_1).T
    return np.polyfit(difference, coefficient, 2)


def parabola(difference: np.ndarray | float) -> np.ndarray:
    """Sun 9 with its sign mended."""
    return np.polyval(MENDED, difference)


def pole2(xi: float, variant: str) -> LinearNetwork:
    """Sun's network (Sun 12, 18) with n1 = 14, n2 = 5."""
    text = f'id = "pole2", xi = {xi}, n1 = 14, n2 = 5, variant = "{variant}"'
    return parse_network(text).transfer(OMEGA_S)


def pole2_damping(xi: float, variant: str) -> float:
    """Least damping of the closed loop with it."""
    return analyse(pole2(xi, variant)).damping_ratio


def _stability_limit(runs: Runs) -> float:
    """Damping ratio asked for below which (18) as printed is unstable."""
    del runs
    low, high = 0.05, 0.3
    while high - low > 1e-6:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if pole2_damping(middle, "as_printed") < 0.0 else (low, middle)
    return high


def _unstable(runs: Runs) -> float:
    del runs
    return float(sum(pole2_damping(xi, "as_printed") < 0.0 for _, xi in TABLE_1))


def _law_table(runs: Runs) -> Table:
    del runs
    rows = []
    for difference, xi in TABLE_1:
        values = (
            float(parabola(difference)),
            float(np.polyval(PRINTED, difference)),
            pole2_damping(xi, "as_printed"),
            pole2_damping(xi, "exact"),
        )
        rows.append((number(difference, 2), number(xi, 2), *(number(value) for value in values)))
    head = (
        "dV, kn",
        "xi, table 1",
        "Sun 9, sign mended",
        "Sun 9, printed",
        "damping with (18) as printed",
        "with (18) exact",
    )
    return Table("Sun's law, and the damping that the loop then has:", head, tuple(rows))


def _draw_law(runs: Runs, figure: Figure) -> None:
    del runs
    axes = figure.subplots(1, 2)
    difference, xi = np.array(TABLE_1).T
    grid = np.linspace(0.0, 3.0, 301)
    from scipy.interpolate import PchipInterpolator

    curve(axes[0], difference, xi, "table 1", 0, linestyle="", marker="o", markersize=4.0)
    curve(axes[0], grid, PchipInterpolator(difference[::-1], xi[::-1])(grid), "PCHIP", 2)
    curve(axes[0], grid, parabola(grid), "Sun 9, sign mended", 1)
    axes[0].axhline(0.0, color="black", linewidth=0.6)
    panel(axes[0], "Table 1 and (9)", "|V_c - V_r|, kn", "xi")
    asked = np.linspace(0.04, 0.99, 96)
    for i, variant in enumerate(("exact", "as_printed")):
        curve(
            axes[1], asked, np.array([pole2_damping(float(x), variant) for x in asked]), f"(18) {variant}", i
        )
    axes[1].axhline(0.0, color="black", linewidth=0.6)
    panel(axes[1], "Damping of the loop with (12)", "xi asked for", "xi obtained")


LAW = Exhibit(
    name="sun-table-1",
    title="Table 1, equations 9 and 18: the adaptive law",
    presets=(),
    setting="Computed from the formulas, n1 = 14, n2 = 5.",
    claims=(
        Claim(
            "(9): xi = 0.3076 dV^2 + 1.1452 dV + 0.8101 fits table 1: its linear coefficient by least "
            "squares",
            "+1.1452",
            about(1.1452, 0.01),
            lambda runs: float(fitted()[1]),
            kind="predicted",
            digits=5,
            why="the sign: least squares gives {a}, {b}, {c}. As printed xi would be {three} at 3 kn.",
            note="Ours, not a claim of the paper: with its sign mended, and unclamped, the parabola is "
            "negative between {low} and {high} kn. The program clamps every form to 0.04 .. 0.99; its "
            "default is monotone interpolation of table 1.",
            quote="ξ = 0.3076δV2 e + 1.1452δVe + 0.8101 ... The relational expression can be obtained "
            "through the curve fitting data in Table 1 based on the least square fitting method.",
            facts={
                "low": lambda runs: float(np.min(np.roots(MENDED).real)),
                "high": lambda runs: float(np.max(np.roots(MENDED).real)),
                "a": lambda runs: float(fitted()[0]),
                "b": lambda runs: float(fitted()[1]),
                "c": lambda runs: float(fitted()[2]),
                "three": lambda runs: float(np.polyval(PRINTED, 3.0)),
            },
        ),
        Claim(
            "(18) gives the damping that is asked for: at xi = 0.5",
            "0.5",
            about(0.5, 0.02),
            lambda runs: pole2_damping(0.5, "as_printed"),
            kind="predicted",
            why="B = -A w2/w1 makes H(0) = 1 but moves the pole pair. With the exact B (variant `exact`) the "
            "pair is where it should be and H(0) = {h0}; `unity2` has both.",
            facts={"h0": lambda runs: pole2(0.5, "exact").h0},
            quote="the following equations are obtained ... B = −Aω2 ω1 ... Supposing that the dominant pole "
            "of the system is",
        ),
        Claim(
            "the loop is stable for every entry of table 1: unstable entries",
            "0",
            at_most(0.0),
            _unstable,
            kind="predicted",
            digits=1,
            why="the same B: with (18) as printed the loop is unstable for xi <= {limit}.",
            facts={"limit": _stability_limit},
            quote="Following the system stability criterion, we have: |n1 − n2| ≥ 9. (19) Taking Equation "
            "(15) into consideration, we can recommend n1 = 14, n2 = 5.",
        ),
    ),
    tables=(_law_table,),
    search=LAW_SEARCH,
    draw=_draw_law,
)

PAPER = Paper(
    "Sun 2017",
    "Sun, Xu, Liu, Zhang, Li, Tong: *An adaptive damping network designed for strapdown fiber optic "
    "gyrocompass system for ships*, Sensors 17 (3), 494, 2017.",
    (STEP, LAW, OPTIMUM, SHIP, TABLE_LAW, BULGE, VEHICLE),
)

"""Liu 2021: the complementary network, and damping switched on the variation of the log's error."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from navcore.analysis import RADIUS, frequency_response
from navcore.foundation.earth import SPHERE
from navcore.foundation.units import HOUR
from navcore.mechanization.recorder import DV_E
from navcore.networks import parse_network
from tools.papers.claim import Claim, Exhibit, Paper, Table, about, at_least, at_most, number
from tools.papers.liu_bumpless import BUMPLESS
from tools.papers.liu_fig_7 import FIGURE_7
from tools.papers.liu_fig_11 import LONG
from tools.papers.liu_maneuvers import LIMIT, MANEUVERS
from tools.papers.liu_tables import TABLES
from tools.papers.liu_window import WINDOW
from tools.papers.measure import departure, hours, peak_gain
from tools.papers.picture import curve, panel
from tools.papers.runs import Runs
from tools.papers.search_liu import GAINS_SEARCH

if TYPE_CHECKING:
    from matplotlib.figure import Figure

OMEGA_S = SPHERE.schuler_frequency(0.0)
NETWORKS = {
    "classic2": 'id = "classic2"',
    "classic3": 'id = "classic3"',
    "complementary": 'id = "complementary", zeta = 0.7, eta = 0.5',
}
ZETAS = (0.1, 0.3, 0.5, 0.7, 0.9)
FREQUENCIES = np.logspace(-2.0, 2.0, 401)


def gain(text: str, frequency: np.ndarray | float) -> np.ndarray:
    """R omega_s |phi / dV_r| at frequencies in Schuler frequencies, dimensionless."""
    transfer = parse_network(text).transfer(OMEGA_S)
    omega = np.asarray(frequency) * OMEGA_S
    return RADIUS * OMEGA_S * np.abs(frequency_response(transfer, "dv_r", "phi", omega))


def decibels(ratio: np.ndarray | float) -> np.ndarray:
    """20 lg of a ratio."""
    return np.round(20.0 * np.log10(ratio), 6)


def advantage(frequency: float, other: str) -> float:
    """How much less the complementary network lets through than another one, dB."""
    return float(decibels(gain(NETWORKS[other], frequency) / gain(NETWORKS["complementary"], frequency)))


def slope(low: float, high: float) -> float:
    """Slope of the complementary network's gain, dB a decade (towards higher frequencies)."""
    ends = decibels(gain(NETWORKS["complementary"], np.array([low, high])))
    return float((ends[1] - ends[0]) / np.log10(high / low))


def zeta_ratio(frequency: float | None, low: float = 0.1) -> float:
    """Gain at zeta = 0.9 over that at a lower one, at a frequency or (None) of the peaks."""
    texts = (f'id = "complementary", zeta = {zeta}' for zeta in (0.9, low))
    if frequency is None:
        wide, narrow = (peak_gain(lambda p, text=text: gain(text, p), FREQUENCIES) for text in texts)
    else:
        wide, narrow = (float(gain(text, frequency)) for text in texts)
    return wide / narrow


def _draw_networks(runs: Runs, figure: Figure) -> None:
    del runs
    axes = figure.subplots(1, 2, sharey=True)
    for i, (name, text) in enumerate(NETWORKS.items()):
        curve(axes[0], FREQUENCIES, decibels(gain(text, FREQUENCIES)), name, i)
    for i, zeta in enumerate(ZETAS):
        text = f'id = "complementary", zeta = {zeta}'
        curve(axes[1], FREQUENCIES, decibels(gain(text, FREQUENCIES)), f"zeta = {zeta}", i)
    for axis, title in zip(axes, ("Figure 3: three networks", "Figure 5: complementary"), strict=True):
        panel(axis, title, "frequency / omega_s", "R omega_s |phi / dV_r|, dB")
        axis.set_xscale("log")
        axis.set_ylim(-130.0, 20.0)


def _gain_table(runs: Runs) -> Table:
    del runs
    rows = []
    for frequency in (0.01, 0.1, 1.0, 3.0, 10.0, 100.0):
        gains = (number(float(decibels(gain(text, frequency))), 3) for text in NETWORKS.values())
        rows.append((number(frequency, 1), *gains))
    return Table("Gain R omega_s |phi / dV_r| in dB:", ("frequency / omega_s", *NETWORKS), tuple(rows))


_BEST_EFFECT = (
    "the complementary filtering horizontal damping network has the best effect on suppressing the reference "
    "velocity errors, especially on the high-frequency reference velocity errors"
)
_SLOPES = (
    "It has 40 dB/10 dec or higher attenuation rate to both low-frequency and high-frequency reference "
    "velocity errors."
)
_ALIKE = (
    "the ability of different damping coefficients to suppress the reference velocity error is not much "
    "different"
)

GAINS = Exhibit(
    name="liu-fig-3",
    title="Figures 3 and 5: what the networks let through of the log's error",
    presets=("liu-networks",),
    setting="Gain from the log's velocity error to the tilt, zeta = 0.7, eta = 0.5 in figure 3. (Liu 5, 6 "
    "print wrong powers of omega_s.)",
    claims=(
        Claim(
            "the complementary network suppresses high-frequency errors best: against classic3 at 10 omega_s",
            "lowest",
            at_least(0.0),
            lambda runs: advantage(10.0, "classic3"),
            "dB",
            quote=_BEST_EFFECT,
        ),
        Claim(
            "the same at low frequency: against classic3 at 0.1 omega_s",
            "lowest",
            at_least(0.0),
            lambda runs: advantage(0.1, "classic3"),
            "dB",
            quote=_BEST_EFFECT,
            why="below the Schuler frequency all three fall alike with 40 dB a decade, and the complementary "
            "network lets through the most of the three (classic2 {classic2} dB less, classic3 {classic3} dB "
            "less).",
            facts={
                "classic2": lambda runs: -advantage(0.1, "classic2"),
                "classic3": lambda runs: -advantage(0.1, "classic3"),
            },
        ),
        Claim(
            "it has 40 dB a decade or more towards low frequency (0.01 to 0.1 omega_s)",
            ">= 40 dB/dec",
            at_least(39.5),
            lambda runs: slope(0.01, 0.1),
            "dB/dec",
            quote=_SLOPES,
            kind="predicted",
        ),
        Claim(
            "and towards high frequency (10 to 100 omega_s)",
            ">= 40 dB/dec",
            at_least(39.5),
            lambda runs: -slope(10.0, 100.0),
            "dB/dec",
            quote=_SLOPES,
            kind="predicted",
        ),
        Claim(
            "figure 5: the damping coefficient changes little: largest gain, zeta = 0.9 over zeta = 0.1",
            "not much different",
            about(1.0, 0.2),
            lambda runs: zeta_ratio(None),
            quote=_ALIKE,
            note="The peaks are alike; where the networks fall off (10 omega_s) the gain is proportional to "
            "zeta: see the next line.",
        ),
        Claim(
            "the same at 10 omega_s",
            "not much different",
            about(1.0, 0.2),
            lambda runs: zeta_ratio(10.0),
            quote=_ALIKE,
            why="1 - H has the factor 2 zeta (with eta = 0.5), so above the Schuler frequency a nine times "
            "smaller zeta lets nine times less through, and one three times smaller {third} times less. Only "
            "the peak hardly depends on zeta ({peak}).",
            facts={
                "third": lambda runs: zeta_ratio(10.0, 0.3),
                "peak": lambda runs: zeta_ratio(None),
            },
        ),
    ),
    tables=(_gain_table,),
    search=GAINS_SEARCH,
    draw=_draw_networks,
)


# ---------------------------------------------------------------- figure 4: overshoot

EVENT_S = 5.0 * HOUR
CHANGES_MPS = (1.0, 0.5, 1.0, 1.5)


def overshoot(runs: Runs, case: int) -> float:
    """Largest departure of dV_E from its value at the event, case 1 to 5."""
    run = runs("liu-overshoot").methods[case - 1]
    return departure(run.t_s, run.rows[:, DV_E], EVENT_S)


def _draw_overshoot(runs: Runs, figure: Figure) -> None:
    axes = figure.subplots()
    for i, run in enumerate(runs("liu-overshoot").methods):
        curve(axes, hours(run), run.rows[:, DV_E], run.method.name, i)
    panel(axes, "liu-overshoot", "time, h", "dV_E, m/s")


def _overshoot_table(runs: Runs) -> Table:
    rows = []
    for case in range(1, 6):
        linear, strapdown = overshoot(runs, case), overshoot(runs.in_strapdown(), case)
        name = runs("liu-overshoot").methods[case - 1].method.name
        change = number(CHANGES_MPS[case - 1], 2) if case < 5 else "0"
        rows.append((name, change, number(linear, 4), number(strapdown, 4)))
    head = ("case", "change of dV_r, m/s", "overshoot of dV_E, channel, m/s", "strapdown, m/s")
    return Table("Overshoot, counted from the standing value at 5 h:", head, tuple(rows))


_SAME = (
    "For the first and third situations, the variations of the reference velocity error are both 1 m/s "
    "although the accelerations of reference velocity errors are different. Accordingly, the overshoot "
    "errors caused by reference velocity errors are the same."
)
_IN_PROPORTION = (
    "For the second and fourth situations, the variations of reference velocity errors are smaller and "
    "larger than the first case, respectively, so the overshoot errors are smaller and larger than the first "
    "case correspondingly. ... the dynamic overshoot caused by the reference velocity error is proportional "
    "to the acceleration integral value of the reference velocity error"
)
_ALMOST_NONE = (
    "For the fifth case, it almost does not have any overshoot error because the variation of the reference "
    "velocity error in each cycle is zero."
)

OVERSHOOT = Exhibit(
    name="liu-fig-4",
    title="Figure 4: overshoot after five changes of the log's error",
    presets=("liu-overshoot",),
    setting="10 ug, 1e-4 deg/h, zeta = 1.3; the changes begin at 5 h. One channel as in the paper's "
    "analysis, and the full strapdown at 32 deg N. The paper prints no number: its statements are relations.",
    claims=(
        Claim(
            "equal overshoot for equal changes at different rates: case 3 over case 1",
            "the same",
            about(1.0, 0.02),
            lambda runs: overshoot(runs, 3) / overshoot(runs, 1),
            quote=_SAME,
            kind="predicted",
            strapdown=True,
            digits=4,
        ),
        Claim(
            "overshoot proportional to the change: case 2 over case 1 (0.5 over 1 m/s)",
            "smaller, in proportion",
            about(0.5, 0.02),
            lambda runs: overshoot(runs, 2) / overshoot(runs, 1),
            quote=_IN_PROPORTION,
            kind="predicted",
            strapdown=True,
            digits=4,
        ),
        Claim(
            "case 4 over case 1 (1.5 over 1 m/s)",
            "larger, in proportion",
            about(1.5, 0.02),
            lambda runs: overshoot(runs, 4) / overshoot(runs, 1),
            quote=_IN_PROPORTION,
            kind="predicted",
            strapdown=True,
            digits=4,
        ),
        Claim(
            "almost none for the oscillating error: case 5 over case 1",
            "almost none",
            at_most(0.03),
            lambda runs: overshoot(runs, 5) / overshoot(runs, 1),
            quote=_ALMOST_NONE,
            strapdown=True,
        ),
    ),
    tables=(_overshoot_table,),
    draw=_draw_overshoot,
)

PAPER = Paper(
    "Liu 2021",
    "Liu, Wu, Hu, Zhang: *Design of variable damping INS for ships based on the variation of reference "
    "velocity error*, Journal of Sensors, 2021.",
    (GAINS, OVERSHOOT, MANEUVERS, LIMIT, FIGURE_7, LONG, TABLES, WINDOW, BUMPLESS),
)

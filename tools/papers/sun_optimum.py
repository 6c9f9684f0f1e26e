"""Sun 2017, equation 8 and table 1: the best damping coefficient for each velocity difference."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from navcore.design.sun import Tuning, TuningSettings, sun_scenario, tune_table
from tools.papers.claim import Claim, Exhibit, Reading, Table, about, number
from tools.papers.picture import curve, panel
from tools.papers.runs import Runs
from tools.papers.search_sun import EQUATION_8_SEARCH

if TYPE_CHECKING:
    from matplotlib.figure import Figure

STEP = 0.05
"""Coarser than Sun's 0.01, for time; the optima are flat."""
TILTED = "pole2 as printed, 0.1 deg of initial tilt"
SETTINGS: dict[str, dict[str, Any]] = {
    TILTED: {"network": {"id": "pole2", "variant": "as_printed"}},
    "pole2 as printed": {"network": {"id": "pole2", "variant": "as_printed"}},
    "pole2 exact": {"network": {"id": "pole2", "variant": "exact"}},
    "unity2": {},
    "complementary, drifting error": {"network": {"id": "complementary"}, "error": "drift"},
}


def optimum(runs: Runs, name: str) -> np.ndarray:
    """Difference (kn), our best xi, Sun's xi, shape (10, 3), falling difference."""

    def make() -> np.ndarray:
        settings = TuningSettings.model_validate({"step": STEP, **SETTINGS[name]})
        scenario = sun_scenario()
        if name == TILTED:
            tilt = scenario.initial_error.model_copy(update={"attitude_arcmin": (6.0, 6.0, 0.0)})
            scenario = scenario.model_copy(update={"initial_error": tilt})
        found: Tuning = tune_table(scenario, settings)
        return np.array(found.beside_sun())

    return runs.keep(("tuning", name), make)


def at_no_difference(runs: Runs, name: str) -> float:
    """Our best xi at no difference."""
    rows = optimum(runs, name)
    return float(rows[np.argmin(rows[:, 0]), 1])


def _optimum_table(runs: Runs) -> Table:
    found = [optimum(runs, name) for name in SETTINGS]
    rows = tuple(
        (number(row[0], 2), number(row[2], 2), *(number(one[i, 1], 2) for one in found))
        for i, row in enumerate(found[0])
    )
    return Table("Best xi by (8) in steps of 0.05:", ("dV, kn", "Sun's table 1", *SETTINGS), rows)


def _draw_optimum(runs: Runs, figure: Figure) -> None:
    axes = figure.subplots()
    rows = optimum(runs, "unity2")
    curve(axes, rows[:, 0], rows[:, 2], "Sun's table 1", 0, marker="o")
    for i, name in enumerate(SETTINGS, 1):
        rows = optimum(runs, name)
        curve(axes, rows[:, 0], rows[:, 1], name, i, marker=".")
    panel(axes, "Least sum of squared velocity errors", "dV, kn", "xi")


OPTIMUM = Exhibit(
    name="sun-eq-8",
    title="Equation 8: where table 1 comes from",
    presets=(),
    setting="The double loop on Sun's own setting: 24 h, gyros 0.006, 0.006, 0.001 deg/h, for each "
    "difference the coefficient with the least sum of squared velocity errors.",
    claims=(
        Claim(
            "without a difference the best coefficient is 0.99, with Sun's network as printed and 0.1 deg of "
            "initial tilt (Sun 5.1)",
            "0.99",
            about(0.99, 0.1),
            lambda runs: at_no_difference(runs, TILTED),
            kind="fitted",
            quote="0.0 0.99 ... the optimal damping coefficient corresponding to all values of δV can be "
            "obtained",
            readings=(
                Reading(
                    "only the gyros drift",
                    "0.99",
                    about(0.99, 0.1),
                    lambda runs: at_no_difference(runs, "pole2 as printed"),
                ),
            ),
            note="Sun 3.2 names the gyros' drifts and no initial error. With drifts alone the least sum lies "
            "far lower, and it hardly depends on a constant difference when H(0) = 1: a constant error of "
            "the log is rejected whatever xi. An initial tilt, which a fast loop takes out sooner, puts it "
            "near 1.",
        ),
        Claim(
            "the same with the complementary network and an error that drifts",
            "0.99",
            about(0.99, 0.1),
            lambda runs: at_no_difference(runs, "complementary, drifting error"),
            kind="fitted",
            quote="0.0 0.99 ... the optimal damping coefficient corresponding to all values of δV can be "
            "obtained",
            note="So table 1's shape, from near 1 down to near 0, is right for a log whose error *changes*.",
        ),
    ),
    tables=(_optimum_table,),
    search=EQUATION_8_SEARCH,
    draw=_draw_optimum,
)

"""Liu 2021, tables 1 to 3 as an exhibit: when to damp, over many seeds."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from navcore.mechanization.recorder import DAMPED_COLUMN, DV_E, POSITION
from tools.papers.claim import Claim, Exhibit, Reading, Table, at_most, number
from tools.papers.liu_switching import (
    BEST,
    METHODS,
    NO_STANDING,
    NOVEL,
    PRESET,
    QUANTITIES,
    RAMP,
    SEEDS,
    UNITS,
    added,
    altered_ratio,
    largest_ratios,
    ratio,
    ratios,
    study,
    window_ratios,
    without_changes,
    without_standing,
)
from tools.papers.measure import hours, mean_and_interval
from tools.papers.picture import curve, panel
from tools.papers.runs import Runs, method
from tools.papers.search_liu import TABLES_SEARCH

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def study_table(case: str, caption: str) -> Callable[[Runs], Table]:
    """Table of the mean over the seeds of one study, with confidence intervals."""

    def make(runs: Runs) -> Table:
        found = study(runs, case)
        rows = tuple(
            (name, *(mean_and_interval(found[:, i, k]) for k in range(len(QUANTITIES))))
            for i, name in enumerate(METHODS)
        )
        head = ("method", *(f"{quantity}, {UNITS[quantity]}" for quantity in QUANTITIES))
        return Table(
            f"{caption} RMS over the run, mean over {len(found)} seeds +- 95 % confidence:", head, rows
        )

    return make


PRINTED = {
    "table 1, 4-8 h": (0.4961, 0.4288, 0.3497),
    "table 1, 11-15 h": (0.2320, 0.3163, 0.2318),
    "table 2, 1-4 h": (0.2358, 0.2117, 0.1659),
    "table 2, 9-11 h": (0.4042, 0.4042, 0.3616),
    "table 2, 18-24 h": (0.2733, 0.2415, 0.2371),
    "table 3, 0-6 h": (0.3391, 0.2362, 0.2015),
    "table 3, 22-25 h": (0.2471, 0.2276, 0.1829),
    "table 3, 28-32 h": (0.2560, 0.2559, 0.2429),
}
"""Normalised position RMS of tables 1 to 3: constant, traditional, novel."""
ROLES = {"constant": 0, "yaw_rate": 1, NOVEL: 2}


def printed_ratios(ours: str, than: str) -> np.ndarray:
    """The paper's ratios of position RMS of two methods, one for each interval of its tables."""
    values = np.array(list(PRINTED.values()))
    return values[:, ROLES[ours]] / values[:, ROLES[than]]


PAIRS = ((NOVEL, "constant"), (NOVEL, "yaw_rate"), ("yaw_rate", "constant"))


def _window_table(runs: Runs) -> Table:
    """The paper's ratios in each of its windows, and ours in the same hours."""
    rows = []
    for i, name in enumerate(PRINTED):
        cells = []
        for pair in PAIRS:
            printed = float(printed_ratios(*pair)[i])
            cells += [number(printed), mean_and_interval(window_ratios(runs, "sea", *pair)[:, i])]
        rows.append((name, *cells))
    head = ["window of the paper"]
    for name in ("novel over constant", "novel over traditional", "traditional over constant"):
        head += [f"{name}: paper", "ours"]
    caption = (
        "Ratios of position RMS over the paper's windows of 2 to 6 h (its tables are normalised), and ours "
        f"at sea in the same hours, mean over {len(SEEDS)} seeds +- 95 % confidence:"
    )
    return Table(caption, tuple(head), tuple(rows))


def added_table(case: str, caption: str) -> Callable[[Runs], Table]:
    """Table of what the changes of the log add, seed by seed against the same run without any."""

    def make(runs: Runs) -> Table:
        found = added(runs, case)
        rows = tuple(
            (name, *(mean_and_interval(found[:, i, k]) for k in range(len(QUANTITIES))))
            for i, name in enumerate(METHODS)
        )
        head = ("method", *(f"{quantity}, {UNITS[quantity]}" for quantity in QUANTITIES))
        return Table(
            f"{caption} What the changes of the log add: RMS of the difference from the same run without any "
            f"change, mean over {len(found)} seeds +- 95 % confidence:",
            head,
            rows,
        )

    return make


_ROWS = {
    "constant": ("Constant 0.4961 0.2320", "Constant 0.2358 0.4042 0.2733", "Constant 0.3391 0.2471 0.2560"),
    "yaw_rate": (
        "Traditional 0.4288 0.3163",
        "Traditional 0.2117 0.4042 0.2415",
        "Traditional 0.2362 0.2276 0.2559",
    ),
    NOVEL: ("Novel 0.3497 0.2318", "Novel 0.1659 0.3616 0.2371", "Novel 0.2015 0.1829 0.2429"),
}
"""Rows of tables 1 to 3 as they are printed."""
_NAMES = {"constant": "constant", "yaw_rate": "traditional", NOVEL: "novel"}
UNBIASED = "the log has no standing error"


def _within_printed(ours: str, than: str, note: str = "") -> Claim:
    """Whether our ratio of position RMS lies in the interval of the paper's eight."""
    printed = printed_ratios(ours, than)
    low, high = float(printed.min()), float(printed.max())
    text = f"{low:.2f} to {high:.2f}"
    return Claim(
        f"position RMS, {_NAMES[ours]} over {_NAMES[than]}, at sea",
        text,
        (low, high),
        lambda runs: ratios(runs, "sea", "position", ours, than),
        strapdown=True,
        note=note,
        readings=(
            Reading(
                UNBIASED,
                text,
                (low, high),
                lambda runs: ratios(runs, NO_STANDING, "position", ours, than),
                strapdown=False,
            ),
            Reading(
                "judged over the paper's windows of 2 to 6 h",
                text,
                (low, high),
                lambda runs: window_ratios(runs, "sea", ours, than).mean(axis=1),
                strapdown=False,
            ),
        ),
        facts={
            "ramp": lambda runs: ratio(runs, "sea", "position", RAMP, than),
            **{
                change.__name__: lambda runs, change=change: altered_ratio(runs, change, ours, than)
                for change in (without_changes, without_standing)
                if f"{{{change.__name__}}}" in note
            },
        },
        quote=" ... ".join((*_ROWS[than], *_ROWS[ours])),
    )


_BEST = "indicates that the navigation accuracy of the novel variable damping system is the best"
_LARGEST = (
    "the maximum position error is reduced compared with the constant damping system and traditional "
    "variable "
    f"damping system, which {_BEST}"
)


def _largest_claim(than: str) -> Claim:
    return Claim(
        f"largest position error (Liu 4.4), novel over {_NAMES[than]}, at sea",
        "reduced",
        at_most(1.0),
        lambda runs: largest_ratios(runs, "sea", NOVEL, than),
        strapdown=True,
        readings=(
            Reading(
                UNBIASED,
                "reduced",
                at_most(1.0),
                lambda runs: largest_ratios(runs, NO_STANDING, NOVEL, than),
                strapdown=False,
            ),
        ),
        quote=_LARGEST,
    )


def _draw_sea(runs: Runs, figure: Figure) -> None:
    axes = figure.subplots(3, 1, sharex=True)
    shown = ("constant", "yaw_rate", RAMP, NOVEL, BEST)
    run = runs(PRESET)
    for i, name in enumerate(shown):
        found = method(run, name)
        t = hours(found)
        curve(axes[0], t, found.rows[:, POSITION], name, i)
        curve(axes[1], t, found.rows[:, DV_E], name, i)
        curve(axes[2], t, found.rows[:, DAMPED_COLUMN] + 1.2 * i, name, i)
    panel(axes[0], "liu-switching", "", "position, m")
    panel(axes[1], "", "", "dV_E, m/s", legend=False)
    panel(axes[2], "", "time, h", "damped", legend=False)
    axes[2].set_yticks([])


_STANDS = (
    "The direction is the paper's with the standing error as well, the size is not. The changes of the log "
    "are not the reason: without any the ratio is {without_changes}. The standing 0.5 m/s is: each time "
    "yaw_rate damps again with a cleared filter, it arrives as a step."
)
_CLEARED = (
    "A turn is over within minutes, but the changed error of the log stays: yaw_rate damps again with a "
    "cleared filter, so that both this change and the standing error arrive as a step. Without any change "
    "the ratio is {without_changes}. (Five of the paper's eight ratios lie between 0.70 and 0.93, one at "
    "1.36.)"
)

TABLES = Exhibit(
    name="liu-table-1",
    title="Tables 1 to 3, figures 13 to 15: constant, traditional and novel switching",
    presets=(PRESET,),
    setting="The paper's sea trial is not public and its tables are normalised; ours: 36 h, eight lasting "
    "changes of the log's error (0.5 to 1.5 m/s for 0.5 to 2 h, four with a turn) with the preset's sensors "
    "and 0.5 m/s standing, the average that the paper states for figure 7 (*at sea*). It does not say what "
    "stands in its tables. The same changes with perfect sensors and no standing error (*log only*, a table "
    "below) are no experiment of the paper. *Traditional* is `yaw_rate`, *novel* is `variation + Liu 19`, "
    "the paper's recursion to the letter. A ratio agrees when it lies in the interval of the paper's eight.",
    claims=(
        _within_printed(
            NOVEL,
            "constant",
            "With a filter that sees the whole difference (`variation + ramp`) the ratio is {ramp}: when it "
            "is cleared, the standing 0.5 m/s, which constant damping has long rejected, arrives anew as a "
            "step, and a ramp of 50 s softens nothing in a loop with a time constant of 800 s.",
        ),
        _within_printed(NOVEL, "yaw_rate", _STANDS),
        _within_printed("yaw_rate", "constant", _CLEARED),
        Claim(
            "its velocity is better as well (Liu 4.4): velocity RMS, novel over constant, at sea",
            "smaller",
            at_most(1.0),
            lambda runs: ratios(runs, "sea", "velocity", NOVEL, "constant"),
            strapdown=True,
            quote="the simulation results can confirm that the velocity accuracy of the novel variable "
            "damping system is the best",
        ),
        _largest_claim("constant"),
        _largest_claim("yaw_rate"),
    ),
    tables=(
        study_table("sea", "At sea."),
        added_table("sea", "At sea."),
        study_table("log only", "Log only."),
        _window_table,
    ),
    search=TABLES_SEARCH,
    draw=_draw_sea,
    height=5.0,
)

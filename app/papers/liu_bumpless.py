"""What our own switching adds to Liu 2021, as an exhibit."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from app.papers.claim import Claim, Exhibit, Table, at_least, at_most, number
from app.papers.liu_switching import (
    BEST,
    DAYS,
    METHODS,
    NOVEL,
    PRESET,
    QUANTITIES,
    RAMP,
    daily,
    quiet_episodes,
    ratio,
)
from app.papers.liu_tables import study_table
from app.papers.picture import curve, panel
from app.papers.runs import Runs

if TYPE_CHECKING:
    from matplotlib.figure import Figure

DAILY = ("constant", "variation + hard", RAMP, NOVEL, BEST)


def _five_day_table(runs: Runs) -> Table:
    rows = tuple((name, *(number(value) for value in daily(runs, name))) for name in DAILY)
    head = ("method", *(f"day {day}" for day in range(1, DAYS + 1)))
    return Table(
        "Five days of episodes with 0.5 m/s standing, log without noise: RMS of dV_E, m/s:", head, rows
    )


def _quiet(runs: Runs, ours: str, than: str) -> float:
    found = quiet_episodes(runs)[:, QUANTITIES.index("velocity")]
    return float(found[METHODS.index(ours)] / found[METHODS.index(than)])


def _last_over_first(runs: Runs, name: str) -> float:
    found = daily(runs, name)
    return float(found[-1] / found[0])


def _draw_five_days(runs: Runs, figure: Figure) -> None:
    axes = figure.subplots()
    for i, name in enumerate(DAILY):
        curve(axes, np.arange(1, DAYS + 1), daily(runs, name), name, i, marker="o")
    axes.set_yscale("log")
    panel(axes, "Episodes of 300 s every 30 min, 0.5 m/s standing", "day", "RMS of dV_E, m/s")
    axes.set_xticks(range(1, DAYS + 1))


BUMPLESS = Exhibit(
    name="liu-bumpless",
    title="Our own: `variation + bumpless`",
    presets=(PRESET,),
    setting="No figure of the paper: what keeping the network's state and taking out only the change of the "
    "log gains. Lasting changes as above; episodes of +1 m/s for 300 s every 30 min on one channel.",
    claims=(
        Claim(
            "on lasting changes at least 5 times better than ramp in velocity RMS, log only: ramp over "
            "bumpless",
            ">= 5",
            at_least(5.0),
            lambda runs: ratio(runs, "log only", "velocity", RAMP, BEST),
            strapdown=True,
            note="Against the paper's recursion to the letter the ratio is {liu}.",
            facts={"liu": lambda runs: ratio(runs, "log only", "velocity", NOVEL, BEST)},
        ),
        Claim(
            "the same with the preset's sensors, at sea",
            ">= 5",
            at_least(5.0),
            lambda runs: ratio(runs, "sea", "velocity", RAMP, BEST),
            strapdown=True,
            why="what the sensors and the start with 0.5 m/s standing leave is common to all methods (tables "
            "above): only what the switching itself adds is taken away.",
        ),
        Claim(
            "never worse than hard on the 30 min episodes: velocity RMS over hard, log without noise",
            "<= 1",
            at_most(1.0),
            lambda runs: _quiet(runs, BEST, "variation + hard"),
        ),
        Claim(
            "the same with 0.1 m/s of noise in the log",
            "<= 1",
            at_most(1.0),
            lambda runs: ratio(runs, "episodes", "velocity", BEST, "variation + hard"),
            why="the change of the log is estimated from two means of 20 s; with noise of 0.1 m/s its error "
            "is 0.03 m/s, a random step at each of the 144 switches, where hard lets in nothing when the log "
            "has no standing error. In size it is a few cm/s (table).",
        ),
        Claim(
            "the velocity error decays in five days of episodes with 0.5 m/s standing: last day over first, "
            "hard",
            "< 1",
            at_most(1.0),
            lambda runs: _last_over_first(runs, "variation + hard"),
        ),
        Claim(
            "the same, the paper's recursion (Liu 19)",
            "< 1",
            at_most(1.0),
            lambda runs: _last_over_first(runs, NOVEL),
            why="every re-engagement throws away the correction reached so far and takes the present "
            "difference, the velocity error in it, for the log's own: with an episode each half hour nothing "
            "is damped, from {first} to {last} m/s.",
            facts={
                "first": lambda runs: float(daily(runs, NOVEL)[0]),
                "last": lambda runs: float(daily(runs, NOVEL)[-1]),
            },
        ),
        Claim(
            "the same, bumpless (it must not grow)",
            "<= 1",
            at_most(1.05),
            lambda runs: _last_over_first(runs, BEST),
            note="It starts with the steady state for the standing error, so that there is nothing left to "
            "decay.",
        ),
    ),
    tables=(study_table("episodes", "Episodes, noise 0.1 m/s."), _five_day_table),
    draw=_draw_five_days,
)

"""Our own switching, `bumpless` and `bridge`, beside Liu 2021, as an exhibit."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from navcore.engine.simulation import simulate
from tools.papers import liu_bridge_rest
from tools.papers.claim import Claim, Exhibit, Table, at_least, at_most, number
from tools.papers.liu_switching import (
    BEST,
    BRIDGE,
    DAYS,
    HARD,
    METHODS,
    NOVEL,
    PRESET,
    QUANTITIES,
    RAMP,
    added_by,
    daily,
    episodes,
    errors,
    of_method,
    ratio,
    ratios,
)
from tools.papers.liu_tables import added_table, study_table
from tools.papers.measure import mean_and_interval
from tools.papers.picture import curve, panel
from tools.papers.runs import Runs

if TYPE_CHECKING:
    from matplotlib.figure import Figure

DAILY = ("constant", HARD, RAMP, NOVEL, BEST, BRIDGE)


def _five_day_table(runs: Runs) -> Table:
    rows = tuple((name, *(number(value) for value in daily(runs, name))) for name in DAILY)
    head = ("method", *(f"day {day}" for day in range(1, DAYS + 1)))
    return Table(
        "Five days of episodes with 0.5 m/s standing, log without noise: RMS of dV_E, m/s:", head, rows
    )


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


THEORY = {
    ("lasting changes, perfect sensors", "log only"): (0.194, 0.0114, 0.00005),
    ("lasting changes, the preset's sensors", "sea"): (0.305, 0.130, 0.131),
    ("30 min episodes, 0.1 m/s noise, perfect sensors", "episodes"): (0.00137, 0.0307, 0.00005),
    ("30 min episodes, 0.1 m/s noise, the preset's sensors", "episodes at sea"): (0.260, 0.141, 0.132),
}
"""Velocity RMS with hard, bumpless and bridge by the trial of theory.md 12, m/s, and our case."""


def _theory_table(runs: Runs) -> Table:
    rows = []
    for (name, case), expected in THEORY.items():
        cells = []
        for method, value in zip((HARD, BEST, BRIDGE), expected, strict=True):
            cells += [number(value), mean_and_interval(of_method(runs, case, "velocity", method))]
        rows.append((name, *cells))
    head = ["case"]
    for name in ("hard", "bumpless", "bridge"):
        head += [f"{name}: theory.md 12", "here"]
    return Table("Velocity RMS, m/s, twenty seeds:", tuple(head), tuple(rows))


def _difference(case: str, ours: str, than: str) -> Callable[[Runs], np.ndarray]:
    """Velocity RMS of one method less another's, seed by seed, m/s."""
    return lambda runs: of_method(runs, case, "velocity", ours) - of_method(runs, case, "velocity", than)


QUIETER_MPS = 0.01


def _quieter_excess(runs: Runs) -> float:
    """Velocity RMS of bumpless less that of hard in the episodes, with a tenth of the noise, m/s."""

    def make() -> float:
        found = errors(simulate(episodes(1, noise_mps=QUIETER_MPS)))[:, QUANTITIES.index("velocity")]
        return float(found[METHODS.index(BEST)] - found[METHODS.index(HARD)])

    return runs.keep("quieter episodes", make)


def _never_worse(ours: str, name: str, case: str, where: str, why: str = "") -> Claim:
    return Claim(
        f"{name} is never worse than hard: velocity RMS less that of hard, {where}",
        "<= 0",
        at_most(1e-6),
        _difference(case, ours, HARD),
        "m/s",
        kind="own",
        why=why,
        facts={"quieter": _quieter_excess} if why else {},
    )


_NOISE = (
    "the change of the log is estimated from two means of 20 s. With noise of 0.1 m/s the error of this "
    "estimate is 0.03 m/s, and it enters as a random step at each switch. With hard nothing enters, because "
    "here the log has no standing error. With a tenth of the noise the difference is {quieter} m/s."
)

BUMPLESS = Exhibit(
    name="liu-bumpless",
    title="Our own: `variation + bumpless` and `variation + bridge`",
    presets=(PRESET,),
    setting="No figure of the paper: these claims are ours. `bumpless` keeps the network's state and removes "
    "only the change of the log; `bridge` runs on an estimate while the log is not trusted (theory.md 12). "
    "The lasting changes are those of tables 1 to 3; the episodes are of +1 m/s for 300 s every 30 min. What "
    "the changes add is the paired difference from the same run, with the same noise, without any change of "
    "the log.",
    claims=(
        Claim(
            "lasting changes, log only: velocity RMS of ramp over that of bumpless",
            ">= 5",
            at_least(5.0),
            lambda runs: ratios(runs, "log only", "velocity", RAMP, BEST),
            kind="own",
            strapdown=True,
            note="Against the paper's recursion to the letter the ratio is {liu}.",
            facts={"liu": lambda runs: ratio(runs, "log only", "velocity", NOVEL, BEST)},
        ),
        Claim(
            "lasting changes at sea: what they add to the velocity with ramp over what they add with "
            "bumpless",
            ">= 5",
            at_least(5.0),
            lambda runs: added_by(runs, "sea", "velocity", RAMP) / added_by(runs, "sea", "velocity", BEST),
            kind="own",
            note="The whole error falls only by the factor {whole}: the sensors and the standing 0.5 m/s at "
            "the start cause most of it, with or without changes of the log.",
            facts={"whole": lambda runs: ratio(runs, "sea", "velocity", RAMP, BEST)},
        ),
        Claim(
            "the same with ramp over bridge",
            ">= 5",
            at_least(5.0),
            lambda runs: added_by(runs, "sea", "velocity", RAMP) / added_by(runs, "sea", "velocity", BRIDGE),
            kind="own",
            note="On lasting changes at sea bumpless adds less than bridge, on passing episodes more "
            "(tables).",
        ),
        _never_worse(BEST, "bumpless", "sea", "lasting changes at sea"),
        _never_worse(BRIDGE, "bridge", "sea", "lasting changes at sea"),
        _never_worse(BEST, "bumpless", "episodes at sea", "episodes with the preset's sensors"),
        _never_worse(BRIDGE, "bridge", "episodes at sea", "episodes with the preset's sensors"),
        _never_worse(BEST, "bumpless", "episodes", "episodes with perfect sensors", _NOISE),
        _never_worse(BRIDGE, "bridge", "episodes", "episodes with perfect sensors"),
        Claim(
            "bridge is better than bumpless on passing episodes: what they add to the velocity with bridge "
            "less bumpless, the preset's sensors",
            "< 0",
            at_most(0.0),
            lambda runs: (
                added_by(runs, "episodes at sea", "velocity", BRIDGE)
                - added_by(runs, "episodes at sea", "velocity", BEST)
            ),
            "m/s",
            kind="own",
        ),
        Claim(
            "the velocity error decays in five days of episodes with 0.5 m/s standing: last day over first, "
            "hard",
            "< 1",
            at_most(1.0),
            lambda runs: _last_over_first(runs, HARD),
            kind="own",
        ),
        Claim(
            "the same, the paper's recursion (Liu 19)",
            "< 1",
            at_most(1.0),
            lambda runs: _last_over_first(runs, NOVEL),
            kind="own",
            why="every re-engagement discards the correction reached so far and takes the present "
            "difference, which contains the velocity error, for an error of the log: with an episode each "
            "half hour nothing is damped, and the error grows from {first} to {last} m/s.",
            facts={
                "first": lambda runs: float(daily(runs, NOVEL)[0]),
                "last": lambda runs: float(daily(runs, NOVEL)[-1]),
            },
        ),
        Claim(
            "the same, bumpless: RMS of the last day (it must not grow)",
            "0",
            at_most(1e-3),
            lambda runs: float(daily(runs, BEST)[-1]),
            "m/s",
            kind="own",
            note="It starts in the steady state for the standing error, so that nothing is left to decay.",
        ),
        Claim(
            "the same, bridge",
            "0",
            at_most(1e-3),
            lambda runs: float(daily(runs, BRIDGE)[-1]),
            "m/s",
            kind="own",
        ),
        *liu_bridge_rest.CLAIMS,
    ),
    tables=(
        _theory_table,
        liu_bridge_rest.rest_table,
        study_table("episodes at sea", "Episodes, the preset's sensors."),
        added_table("episodes at sea", "Episodes, the preset's sensors."),
        study_table("episodes", "Episodes, noise 0.1 m/s, perfect sensors, one channel."),
        _five_day_table,
    ),
    draw=_draw_five_days,
)

"""Liu 2021, figure 7 as an exhibit: overshoot of a step against that of a switch."""

from __future__ import annotations

from typing import TYPE_CHECKING

from navcore.engine.run import Run
from navcore.foundation.units import HOUR
from navcore.mechanization.recorder import DV_E
from tools.papers.claim import Claim, Exhibit, Table, about, at_most, number
from tools.papers.liu_switching import (
    PRESET,
    STEPS_MPS,
    SWITCHED_S,
    fig_7,
    overshoot,
    switched,
)
from tools.papers.picture import curve, panel
from tools.papers.runs import Runs
from tools.papers.search_liu import FIG_7_SEARCH

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SWITCHINGS = ("hard", "keep", "ramp", "Liu 19", "bumpless")


def _switch(runs: Runs, name: str) -> Run:
    return switched(runs, "ramp", form="as_printed") if name == "Liu 19" else switched(runs, name)


def _draw_fig_7(runs: Runs, figure: Figure) -> None:
    axes = figure.subplots()
    shown = [(found.method.name, found) for found in fig_7(runs).methods]
    shown += [(f"200 s undamped, {name}", _switch(runs, name).methods[0]) for name in SWITCHINGS]
    for i, (name, found) in enumerate(shown):
        inside = (found.t_s >= SWITCHED_S - 1800.0) & (found.t_s <= SWITCHED_S + 5.0 * HOUR)
        curve(axes, found.t_s[inside] / HOUR, found.rows[inside, DV_E], name, i)
    panel(
        axes,
        "Overshoot after a step of the log's error, and after 200 s undamped",
        "time, h",
        "dV_E, m/s",
        False,
    )
    axes.legend(loc="upper right", ncols=2)


def _fig_7_table(runs: Runs) -> Table:
    rows = [(f"s = {s} m/s", number(overshoot(fig_7(runs), i))) for i, s in enumerate(STEPS_MPS)]
    for name in SWITCHINGS:
        rows.append((f"200 s undamped, {name}", number(round(overshoot(_switch(runs, name)), 6))))
    return Table("Overshoot of dV_E:", ("what happens at 10 h", "m/s"), tuple(rows))


FIGURE_7 = Exhibit(
    name="liu-fig-7",
    title="Figure 7: overshoot of a step against that of a switch",
    presets=(PRESET,),
    setting="One channel, 10 ug, 1e-4 deg/h, zeta = 0.5, the log 0.5 m/s off from the start; at 10 h its "
    "error changes by s, or the loop is undamped for 200 s.",
    claims=(
        Claim(
            "undamped for 200 s and back overshoots like a step of 0.25 m/s: ratio of the two",
            "approximately equal",
            about(1.0, 0.2),
            lambda runs: overshoot(switched(runs, "hard")) / overshoot(fig_7(runs), 0),
            quote="Figure 7 shows that the overshoot error when s = 0.25 m/s is approximately equal to the "
            "overshoot error when the status switches to the undamping status",
            kind="predicted",
            why="when the filter is cleared the standing 0.5 m/s arrives as a step of 0.5 m/s on "
            "re-engagement ({hard} m/s against {step} m/s). A filter that is kept running has no overshoot.",
            facts={
                "hard": lambda runs: overshoot(switched(runs, "hard")),
                "step": lambda runs: overshoot(fig_7(runs), 0),
            },
        ),
        Claim(
            "Liu's overshoot suppression lowers the overshoot of the switch: his (19) with the ramp, over "
            "hard",
            "lower",
            at_most(1.0),
            lambda runs: overshoot(_switch(runs, "Liu 19")) / overshoot(_switch(runs, "hard")),
            quote="this paper presented a method to suppress the switch overshoot",
            note="The recursion does this, not the ramp: (19) takes only the changes of its input, so that "
            "what stands while zeta is close to 0 never enters. With a filter that takes the whole "
            "difference the same ramp leaves {ramp} m/s.",
            facts={"ramp": lambda runs: overshoot(_switch(runs, "ramp"))},
        ),
    ),
    tables=(_fig_7_table,),
    search=FIG_7_SEARCH,
    draw=_draw_fig_7,
)

"""Liu 2021, figures 11 and 12 as an exhibit: five days, free and with three networks."""

from __future__ import annotations

from typing import TYPE_CHECKING

from app.papers.claim import Claim, Exhibit, at_least, at_most
from app.papers.liu_switching import (
    PRESET,
)
from app.papers.measure import rms
from app.papers.picture import curve, panel
from app.papers.runs import Runs, method, scenario_of
from navcore.mechanization.recorder import POSITION
from navcore.run import Run
from navcore.simulation import simulate
from navcore.units import HOUR

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def long_run(runs: Runs) -> Run:
    """Five days with the networks of figure 3 and free, sensors of liu-switching, log of liu-networks."""

    def make() -> Run:
        sensors = scenario_of(PRESET).canonical()
        methods = [{"name": "free", "damping": "free"}, *scenario_of("liu-networks").canonical()["method"]]
        overrides = ("run.duration_h=120", "run.output_step_s=120")
        blocks = {name: sensors[name] for name in ("imu", "initial_error")}
        return simulate(scenario_of("liu-networks", overrides, method=methods, **blocks))

    return runs.keep("five days of networks", make)


def last_day(runs: Runs, name: str) -> float:
    """RMS of the position error on the fifth day, m."""
    found = method(long_run(runs), name)
    return rms(found.rows[found.t_s >= 96.0 * HOUR, POSITION])


def first_day(runs: Runs, name: str) -> float:
    """RMS of the position error on the first day, m."""
    found = method(long_run(runs), name)
    return rms(found.rows[found.t_s <= 24.0 * HOUR, POSITION])


def _draw_long(runs: Runs, figure: Figure) -> None:
    axes = figure.subplots()
    for i, found in enumerate(long_run(runs).methods):
        curve(axes, found.t_s / HOUR, found.rows[:, POSITION], found.method.name, i)
    panel(axes, "Five days", "time, h", "position, m")


LONG = Exhibit(
    name="liu-fig-11",
    title="Figures 11 and 12: five days, free and with three networks",
    presets=("liu-networks", PRESET),
    setting="The paper's records are not public; here the log of `liu-networks` and the sensors of "
    "`liu-switching`.",
    claims=(
        Claim(
            "figure 11: the undamped position error diverges with time: RMS of the fifth day over the first",
            "grows",
            at_least(1.5),
            lambda runs: last_day(runs, "free") / first_day(runs, "free"),
            why="with the drifts of Liu's own simulation (1e-4 deg/h, 10 ug) nothing diverges in five days; "
            "his trial's gyros must have been worse, or its velocity random.",
        ),
        Claim(
            "figure 12: the complementary network is the most accurate: fifth day over that of classic2",
            "smallest",
            at_most(1.0),
            lambda runs: last_day(runs, "complementary") / last_day(runs, "classic2"),
        ),
        Claim(
            "the same over that of classic3",
            "smallest",
            at_most(1.0),
            lambda runs: last_day(runs, "complementary") / last_day(runs, "classic3"),
        ),
    ),
    draw=_draw_long,
)

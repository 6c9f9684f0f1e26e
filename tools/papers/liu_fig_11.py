"""Liu 2021, figures 11 and 12 as an exhibit: five days, free and with three networks."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from navcore.analysis.whole_system import WholeSystem, whole_system
from navcore.engine.run import Run
from navcore.engine.simulation import simulate
from navcore.foundation.units import DEG, HOUR
from navcore.mechanization.recorder import POSITION
from tools.papers.claim import Claim, Exhibit, Table, at_least, at_most, number
from tools.papers.liu_days import METHODS, scenario_of_days
from tools.papers.liu_switching import PRESET
from tools.papers.measure import mean_and_interval, rms
from tools.papers.picture import curve, panel
from tools.papers.runs import Runs, method
from tools.papers.search_liu import DAYS_SEARCH

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SEEDS = range(1, 21)
DAYS, DAY_S = 5, 24.0 * HOUR


def long_run(runs: Runs, seed: int) -> Run:
    """Five days with the networks of figure 3 and free, sensors of liu-switching, log of liu-networks."""
    return runs.keep(("five days of networks", seed), lambda: simulate(scenario_of_days(seed)))


def daily(runs: Runs, name: str) -> np.ndarray:
    """RMS of the position error on each day with each of the seeds, m, shape (seeds, 5)."""
    found = []
    for seed in SEEDS:
        one = method(long_run(runs, seed), name)
        day = np.minimum((one.t_s / DAY_S).astype(int), DAYS - 1)
        found.append([rms(one.rows[day == k, POSITION]) for k in range(DAYS)])
    return np.array(found)


def growth(runs: Runs, name: str) -> np.ndarray:
    """RMS of the fifth day over the first, with each of the seeds."""
    found = daily(runs, name)
    return found[:, -1] / found[:, 0]


def growth_with(runs: Runs, **gyros: Any) -> float:
    """Growth of the free error with other gyros: fields of the IMU."""

    def make() -> float:
        found = []
        for seed in SEEDS:
            scenario = long_run(runs, seed).scenario
            imu = scenario.imu.model_copy(update=gyros)
            run = simulate(scenario.model_copy(update={"imu": imu, "method": scenario.method[:1]}))
            one = run.methods[0]
            last = rms(one.rows[one.t_s >= 4.0 * DAY_S, POSITION])
            found.append(last / rms(one.rows[one.t_s <= DAY_S, POSITION]))
        return float(np.mean(found))

    return runs.keep(("five days, other gyros", *gyros.items()), make)


def fifth_day(runs: Runs, ours: str, than: str) -> np.ndarray:
    """Position RMS of the fifth day of one method over another's, with each of the seeds."""
    return daily(runs, ours)[:, -1] / daily(runs, than)[:, -1]


def whole(runs: Runs, name: str) -> WholeSystem:
    """Whole system of a method at the site."""
    run = long_run(runs, SEEDS[0])
    settings = method(run, name).method
    scenario = run.scenario
    transfer = settings.network.transfer(scenario.omega_s)
    return whole_system(settings.kind.acting(transfer), scenario.site.lat_deg * DEG, scenario.earth)


def _e_folding_days(runs: Runs, name: str) -> float:
    return whole(runs, name).e_folding_s / DAY_S


def _table(runs: Runs) -> Table:
    rows = []
    for name in METHODS:
        system, found = whole(runs, name), daily(runs, name)
        days = system.e_folding_s / DAY_S
        rows.append(
            (
                name,
                number(system.h_slope),
                "neither grows nor decays" if np.isinf(days) else number(days),
                *(mean_and_interval(found[:, k]) for k in range(DAYS)),
            )
        )
    head = ("method", "H'(0), s", "e-folding of the 24 h mode, days", *(f"day {k + 1}" for k in range(DAYS)))
    return Table(
        "The whole system at the site (negative: decays), and RMS of the position error on each day, m, mean "
        f"over {len(SEEDS)} seeds +- 95 % confidence:",
        head,
        tuple(rows),
    )


def _draw_long(runs: Runs, figure: Figure) -> None:
    axes = figure.subplots()
    for i, found in enumerate(long_run(runs, SEEDS[0]).methods):
        curve(axes, found.t_s / HOUR, found.rows[:, POSITION], found.method.name, i)
    panel(axes, "Five days", "time, h", "position, m")


_FACTS = {name: lambda runs, name=name: _e_folding_days(runs, name) for name in METHODS}

_DIVERGES = (
    "the position error of the undamping system is divergent with the increase of time, while the position "
    "error of the constant damping system does not diverge"
)
_BEST = (
    "Figure 12 shows that the accuracy of the complementary filtering horizontal damping network is the best"
)

LONG = Exhibit(
    name="liu-fig-11",
    title="Figures 11 and 12: five days, free and with three networks",
    presets=("liu-networks", PRESET),
    setting="The paper's records are not public; here the log of `liu-networks` and the sensors of "
    "`liu-switching`. Both figures show days, and over days the stability of the whole system decides, not "
    "that of one channel (theory.md 10): H'(0) of the network makes the 24 h mode grow or decay.",
    claims=(
        Claim(
            "figure 11: the undamped position error diverges with time: RMS of the fifth day over the first",
            "grows",
            at_least(1.5),
            lambda runs: growth(runs, "free"),
            quote=_DIVERGES,
            why="without damping no mode of the whole system grows or decays: the 24 h oscillation keeps its "
            "size, and the sensors add little to it in five days. What makes a free system's error grow is "
            "the gyros: with ten times the noise (0.005 deg/sqrt(h)) the ratio is {noisy}, with a bias of "
            "0.001 deg/h it is {biased}. The paper prints neither. Such gyros make the damped error grow as "
            "well, so that claim 2 then fails (search).",
            facts={
                "noisy": lambda runs: growth_with(runs, gyro_arw_dpsh=0.005),
                "biased": lambda runs: growth_with(runs, gyro_bias_dph=(0.001, 0.001, 0.001)),
            },
        ),
        Claim(
            "figure 11: with constant damping (complementary) it does not: fifth day over the first",
            "does not diverge",
            at_most(1.0),
            lambda runs: growth(runs, "complementary"),
            quote=_DIVERGES,
            note="The whole system explains it: H'(0) < 0, and the 24 h mode decays with an e-folding time "
            "of {decay} days.",
            facts={"decay": lambda runs: -_e_folding_days(runs, "complementary")},
        ),
        Claim(
            "figure 12: the complementary network is the most accurate: fifth day over that of classic2",
            "smallest",
            at_most(1.0),
            lambda runs: fifth_day(runs, "complementary", "classic2"),
            quote=_BEST,
            note="The whole system explains it: with classic2, H'(0) > 0, the 24 h mode grows with an "
            "e-folding time of {classic2} days, although one channel is stable with a damping ratio of 0.70.",
            facts=_FACTS,
        ),
        Claim(
            "the same over that of classic3",
            "smallest",
            at_most(1.0),
            lambda runs: fifth_day(runs, "complementary", "classic3"),
            quote=_BEST,
            note="Likewise: with classic3 its e-folding time is {classic3} days.",
            facts=_FACTS,
        ),
        Claim(
            "figure 11: on the fifth day constant damping (complementary) is more accurate than none: "
            "position RMS over that of free",
            "smaller",
            at_most(1.0),
            lambda runs: fifth_day(runs, "complementary", "free"),
            quote=_DIVERGES,
            note="Over the 36 h of tables 1 to 3, which say nothing of the undamped system, it is not.",
        ),
    ),
    tables=(_table,),
    search=DAYS_SEARCH,
    draw=_draw_long,
)

"""Liu 2021, sections 2.3 to 3.3: a log that errs when the ship manoeuvres; the traditional limit."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from navcore.engine.run import Run
from navcore.engine.simulation import simulate
from navcore.foundation.units import HOUR
from navcore.mechanization.recorder import DAMPED_COLUMN, POSITION
from navcore.motion.truth import VE, VN
from tools.papers.claim import Claim, Exhibit, Table, about, at_least, at_most
from tools.papers.liu_switching import NOVEL, paired
from tools.papers.measure import hours, mean_and_interval
from tools.papers.picture import curve, panel
from tools.papers.runs import Runs, method, scenario_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SEEDS = range(1, 21)
PRESET, LIMITS = "liu-maneuvers", "liu-limits"
FAITHFUL = ("reference.acceleration_s=0", "reference.turn_s=0", "reference.smoothing_s=0")
"""A log that follows the ship without an error."""
BEGIN_S = 3600.0
"""When the ship first accelerates."""
QUANTITIES = ("position, m", "velocity, m/s", "tilt, arcsec")


def added(runs: Runs, *overrides: str) -> np.ndarray:
    """RMS of the paired difference that the log's errors in manoeuvres make, shape (seeds, methods, 3)."""

    def one(seed: int) -> np.ndarray:
        given = (f"run.seed={seed}", *overrides)
        return paired(runs(PRESET, *given), runs(PRESET, *given, *FAITHFUL))

    return runs.keep(("liu maneuvers", overrides), lambda: np.array([one(seed) for seed in SEEDS]))


def of_method(runs: Runs, name: str, quantity: int, *overrides: str) -> np.ndarray:
    """`added` of one method and quantity, with each of the seeds."""
    names = [one.method.name for one in runs(PRESET).methods]
    return added(runs, *overrides)[:, names.index(name), quantity]


def _ratio(than: str, quantity: int) -> Callable[[Runs], np.ndarray]:
    return lambda runs: of_method(runs, NOVEL, quantity) / of_method(runs, than, quantity)


def log_error(runs: Runs) -> tuple[np.ndarray, np.ndarray]:
    """Times (s) and the error of the log along the course (m/s) in the first manoeuvre, without noise.

    Made apart from the simulation: k times the true acceleration, then a filter of first order.
    """
    free = [{"name": "free", "damping": "free"}]
    run = simulate(scenario_of(PRESET, ("run.output_step_s=1", "run.duration_h=1.5"), method=free))
    speed = np.hypot(run.truth[:, VE], run.truth[:, VN])
    log = run.scenario.reference
    raw = speed + log.acceleration_s * np.gradient(speed, run.t_s)
    smoothed, share = raw.copy(), -np.expm1(-1.0 / log.smoothing_s)
    for i in range(1, len(raw)):
        smoothed[i] = smoothed[i - 1] + share * (raw[i] - smoothed[i - 1])
    return run.t_s, smoothed - speed


def rise_s(runs: Runs) -> float:
    """Time from the beginning of the first manoeuvre until the log's error reaches 0.5 m/s, s."""
    t, error = log_error(runs)
    return float(t[np.argmax(np.abs(error) >= 0.5)] - BEGIN_S)


def _table(runs: Runs) -> Table:
    names = [one.method.name for one in runs(PRESET).methods]
    rows = tuple(
        (name, *(mean_and_interval(added(runs)[:, i, k]) for k in range(3))) for i, name in enumerate(names)
    )
    caption = (
        "What the log's errors by acceleration, turns and smoothing add: RMS of the difference from the same "
        "run "
        f"with a log that follows the ship, mean over {len(SEEDS)} seeds +- 95 % confidence:"
    )
    return Table(caption, ("method", *QUANTITIES), rows)


def _draw(runs: Runs, figure: Figure) -> None:
    axes = figure.subplots(2, 1, sharex=True)
    run = runs(PRESET)
    for i, found in enumerate(run.methods):
        curve(axes[0], hours(found), found.rows[:, POSITION], found.method.name, i)
        curve(axes[1], hours(found), found.rows[:, DAMPED_COLUMN] + 1.2 * i, found.method.name, i)
    panel(axes[0], PRESET, "", "position, m")
    panel(axes[1], "", "time, h", "damped", legend=False)
    axes[1].set_yticks([])


_NAMES = {"constant": "constant", "yaw_rate": "traditional"}


def _claim(than: str, quantity: int, why: str = "") -> Claim:
    what = QUANTITIES[quantity].split(",")[0]
    return Claim(
        f"on this ship novel damping lets less of the log's error into the {what}: what it adds, novel over "
        f"{_NAMES[than]}",
        "smaller",
        at_most(1.0),
        _ratio(than, quantity),
        kind="own",
        why=why,
        facts={
            name: lambda runs, method=method: float(np.mean(_switches(runs, method)))
            for name, method in (("novel", NOVEL), ("yaw", "yaw_rate"))
        },
    )


def _switches(runs: Runs, name: str) -> np.ndarray:
    """How often a method switches in the day, with each of the seeds."""
    return np.array(
        [np.sum(np.abs(np.diff(_damped(runs(PRESET, f"run.seed={seed}"), name)))) for seed in SEEDS],
        dtype=float,
    )


_RETURNS = (
    "the error by acceleration comes and goes within minutes, and a network that stays on lets little of "
    "such an error through. The novel method switches {novel} times a day for it and comes back to a cleared "
    "filter each time; yaw_rate, which looks at turns alone, switches {yaw} times."
)

MANEUVERS = Exhibit(
    name="liu-maneuvers",
    title="Sections 2.3 and 3.3: a ship that accelerates, and a log that errs when it does",
    presets=(PRESET,),
    setting="Liu names the ship's accelerating as the main cause of the log's error, with turns and the "
    "smoothing of the log beside it; he prints neither ship nor factors. Ours changes its speed by 2 to 5 "
    "m/s every two hours with 0.02 m/s2; the log errs by 40 s times the acceleration and 10 s times yaw rate "
    "and speed, and smooths over 20 s. What follows for the methods is our own experiment, and no verdict on "
    "the paper.",
    claims=(
        Claim(
            "the log's error reaches 0.5 m/s within 80 s when the ship accelerates",
            "80 s",
            about(80.0, 0.1),
            rise_s,
            "s",
            kind="fitted",
            quote="the variation of the reference velocity error needs 80 s to reach 0.5 m/s in our sea "
            "trial when the ship accelerates or decelerates",
        ),
        _claim("constant", 1),
        _claim("constant", 0, _RETURNS),
        _claim("yaw_rate", 1, _RETURNS),
        _claim("yaw_rate", 0, _RETURNS),
    ),
    tables=(_table,),
    draw=_draw,
    height=4.0,
)

# ---------------------------------------------------------------- section 3.2: the traditional limit

SMALL, LARGE = "too small", "too large"


def undamped_share(runs: Runs, name: str) -> np.ndarray:
    """Share of the time that a method of `LIMITS` is undamped, with each of the seeds."""
    return np.array([1.0 - float(np.mean(_damped(runs(LIMITS, f"run.seed={s}"), name))) for s in SEEDS])


def switches_a_day(runs: Runs, name: str) -> np.ndarray:
    """How often a method of `LIMITS` switches in a day by its output rows, with each of the seeds."""
    found = []
    for seed in SEEDS:
        run = runs(LIMITS, f"run.seed={seed}")
        count = float(np.sum(np.abs(np.diff(_damped(run, name)))))
        found.append(count / (run.scenario.run.duration_h / 24.0))
    return np.array(found)


def _damped(run: Run, name: str) -> np.ndarray:
    return method(run, name).rows[:, DAMPED_COLUMN]


def _limit_table(runs: Runs) -> Table:
    rows = []
    for found in runs(LIMITS).methods:
        name = found.method.name
        rows.append(
            (
                name,
                mean_and_interval(undamped_share(runs, name)),
                mean_and_interval(switches_a_day(runs, name)),
            )
        )
    caption = f"Mean over {len(SEEDS)} seeds +- 95 % confidence:"
    return Table(caption, ("limit", "share of time undamped", "switches a day"), tuple(rows))


def _draw_limits(runs: Runs, figure: Figure) -> None:
    axes = figure.subplots(2, 1, sharex=True)
    for i, found in enumerate(runs(LIMITS).methods):
        t = found.t_s / HOUR
        curve(axes[0], t, found.rows[:, POSITION], found.method.name, i)
        curve(axes[1], t, found.rows[:, DAMPED_COLUMN] + 1.2 * i, found.method.name, i)
    panel(axes[0], LIMITS, "", "position, m")
    panel(axes[1], "", "time, h", "damped", legend=False)
    axes[1].set_yticks([])


_LARGE = (
    "if the error threshold is set too large, the traditional method is not sensitive enough to reference "
    "the velocity error so that the system cannot switch to the undamping status in a timely manner"
)
_SMALL = (
    "If the error threshold is too small, it is susceptible to external interference so that the system "
    "switches the damping status frequently"
)
_LONG = "it may make INS on the undamping status for a long time"

LIMIT = Exhibit(
    name="liu-limits",
    title="Section 3.2: the limit of the traditional method",
    presets=(LIMITS,),
    setting="The sea of `liu-switching`; undamped while the difference exceeds 0.6, 2 and 3 m/s. The paper "
    "prints no limit and no number.",
    claims=(
        Claim(
            "too large a limit (3 m/s) does not switch in time: share of the time undamped, though the log's "
            "error changes by up to 1.5 m/s",
            "not sensitive enough",
            at_most(0.001),
            lambda runs: undamped_share(runs, LARGE),
            quote=_LARGE,
        ),
        Claim(
            "too small a limit (0.6 m/s) switches frequently: switches a day",
            "frequently",
            at_least(24.0),
            lambda runs: switches_a_day(runs, SMALL),
            quote=_SMALL,
        ),
        Claim(
            "and stays undamped for a long time: share of the time",
            "long",
            at_least(0.5),
            lambda runs: undamped_share(runs, SMALL),
            quote=_LONG,
        ),
    ),
    tables=(_limit_table,),
    draw=_draw_limits,
    height=4.0,
)

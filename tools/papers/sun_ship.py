"""Sun 2017, figures 10 to 12: conventional, adaptive and no damping on a ship that accelerates at 10 h.

Sun is judged by his own law: (9) as printed, put into (18) as printed. Table 1 interpolated in `unity2` is
ours, and is judged apart (`sun_table_law`).
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np

from navcore.engine.run import Run
from navcore.engine.simulation import simulate
from navcore.foundation.units import ARCMIN, HOUR, KNOT
from navcore.mechanization.recorder import XI_COLUMN
from navcore.scenario.model import Scenario
from tools.papers.claim import Claim, Exhibit, Reading, Table, at_least, at_most, number
from tools.papers.measure import attitude_error, hours, mean_and_interval
from tools.papers.picture import curve, panel
from tools.papers.runs import Runs, method, scenario_of
from tools.papers.search import Axis, Search, Setting

if TYPE_CHECKING:
    from matplotlib.figure import Figure

PRESET = "sun-ship"
SEEDS, STRAPDOWN_SEEDS = range(1, 21), range(1, 5)
NO_MANOEUVRE = "motion.point.2.speed_kn=2"
MANOEUVRE_S, WEAKER_S = 10.0 * HOUR, 10.0 * HOUR + 120.0
"""When the ship begins to accelerate, and from when on its acceleration falls."""
ANGLES = ("pitch", "roll", "heading")
OURS = "table 1"
METHODS = ("free", "conventional", "adaptive", OURS)

UNITY2 = 'method.2.network={id="unity2",zeta=0.5}'
MENDED = "method.2.policy.law=quadratic"
AT_ONCE = 'method.2.switching={id="hard"}'
PER_SAMPLE = "imu.gyro_arw_dpsh=0.0001"
"""The printed random drift, 0.006 deg/h, read as the scatter of means of 1 s: 0.006 / 60 deg/sqrt(h)."""
OWN = "(9) as printed in (18) as printed"
VARIANTS: dict[str, tuple[str, ...]] = {
    OWN: (),
    "(9) as printed in `unity2`": (UNITY2,),
    "(9) with its sign mended in (18) as printed": (MENDED,),
    "(9) with its sign mended in `unity2`": (MENDED, UNITY2),
    "(9) and (18) as printed, switched at once": (AT_ONCE,),
    "random drift of the gyros per sample": (PER_SAMPLE,),
}
"""Overrides of the preset's adaptive method and of its sensors."""
_, IN_UNITY2, SIGN_MENDED, SIGN_MENDED_IN_UNITY2, HARD, SAMPLED = VARIANTS


def errors(runs: Runs, name: str, *overrides: str) -> np.ndarray:
    """Errors of pitch, roll, heading at the output rows, arcmin, shape (m, 3)."""
    run = runs(PRESET, *overrides)
    return attitude_error(run, method(run, name)) / ARCMIN


def measured(runs: Runs, overrides: tuple[str, ...] = (), name: str = "adaptive") -> dict[str, np.ndarray]:
    """Measure what the preset with some overrides gives from 10 h on, with each of the seeds.

    Returns
    -------
    dict
        "overshoot", shape (seeds, methods, 3): largest effect of the manoeuvre on each angle, with it less
        without it, all else equal, arcmin. "std", the same shape: standard deviation of the error, arcmin.
        Of the method ``name``, shape (seeds,): "xi", "difference": mean damping coefficient and mean
        low-passed difference (kn) that its law saw; "largest xi", "least xi", "least difference": extremes;
        "weaker": how far the coefficient falls below its value at the largest acceleration.
    """

    def one(seed: int) -> dict[str, np.ndarray]:
        given = (f"run.seed={seed}", *overrides)
        adaptive = method(runs(PRESET, *given), name)
        after = adaptive.t_s >= MANOEUVRE_S
        with_it = np.array([errors(runs, name, *given)[after] for name in METHODS])
        without = np.array([errors(runs, name, *given, NO_MANOEUVRE)[after] for name in METHODS])
        xi, difference = adaptive.rows[after, XI_COLUMN], adaptive.law_series[after, 3] / KNOT
        late = xi[adaptive.t_s[after] >= WEAKER_S]
        return {
            "overshoot": np.max(np.abs(with_it - without), axis=1),
            "std": np.std(with_it, axis=1),
            "xi": np.asarray(np.mean(xi)),
            "largest xi": np.asarray(np.max(xi)),
            "least xi": np.asarray(np.min(xi)),
            "weaker": np.asarray(late[0] - np.min(late)),
            "difference": np.asarray(np.mean(difference)),
            "least difference": np.asarray(np.min(difference)),
        }

    def make() -> dict[str, np.ndarray]:
        found = [one(seed) for seed in (STRAPDOWN_SEEDS if runs.strapdown else SEEDS)]
        return {name: np.array([values[name] for values in found]) for name in found[0]}

    return runs.keep(("sun ship", overrides, name, runs.strapdown), make)


def over_conventional(
    runs: Runs, what: str, angle: str, overrides: tuple[str, ...] = (), name: str = "adaptive"
) -> np.ndarray:
    """Overshoot or standard deviation of a method over that of conventional, with each of the seeds."""
    found = measured(runs, overrides)[what][:, :, ANGLES.index(angle)]
    return found[:, METHODS.index(name)] / found[:, METHODS.index("conventional")]


def _forms(
    printed: str, agreed: tuple[float, float], ours: Callable[[Runs, tuple[str, ...]], np.ndarray]
) -> tuple[Reading, ...]:
    """The other forms of Sun's law as readings of a claim."""
    return tuple(
        Reading(name, printed, agreed, lambda runs, name=name: ours(runs, VARIANTS[name]), strapdown=False)
        for name in (IN_UNITY2, SIGN_MENDED, SIGN_MENDED_IN_UNITY2, SAMPLED)
    )


_SMALLER = (
    "It can be seen in Figures 10–12 that, when adopting the adaptive damping network, the oscillation "
    "amplitude of error angles caused by the ship’s maneuvering is smaller, and the dynamic performance of "
    "the system is obviously improved."
)
_TIMELY = "its damping coefficient can be adjusted in a timely manner with changes of acceleration"
_WEAKER = (
    "When acceleration is reduced, the system gradually turned from strong damping to weak damping, and the "
    "overshoot is also very small as the method where the damping coefficient is gradually changed is "
    "adopted."
)


def _smaller(angle: str) -> Claim:
    def ours(runs: Runs, overrides: tuple[str, ...] = ()) -> np.ndarray:
        return over_conventional(runs, "overshoot", angle, overrides)

    return Claim(
        f"the manoeuvre causes a smaller oscillation with adaptive damping: {angle}, over conventional",
        "smaller",
        at_most(1.0),
        ours,
        strapdown=True,
        readings=_forms("smaller", at_most(1.0), ours),
        quote=_SMALLER,
    )


def _spread(runs: Runs, overrides: tuple[str, ...] = ()) -> np.ndarray:
    return over_conventional(runs, "std", "pitch", overrides)


def _largest(runs: Runs, overrides: tuple[str, ...] = ()) -> np.ndarray:
    return measured(runs, overrides)["largest xi"]


def _weaker(runs: Runs, overrides: tuple[str, ...] = ()) -> np.ndarray:
    return measured(runs, overrides)["weaker"]


def gradual_over_hard(runs: Runs) -> np.ndarray:
    """Overshoot of pitch with the gradual change over that with switching at once, with each of the seeds."""
    gradual, hard = (measured(runs, overrides)["overshoot"][:, 2, 0] for overrides in ((), (AT_ONCE,)))
    return gradual / hard


def printed_law(difference_kn: float) -> float:
    """Sun 9 as printed."""
    return 0.3076 * difference_kn**2 + 1.1452 * difference_kn + 0.8101


def held_from_kn() -> float:
    """Difference from which (9) as printed lies above 0.99, kn."""
    return float(np.max(np.roots([0.3076, 1.1452, 0.8101 - 0.99]).real))


def _variant_table(runs: Runs) -> Table:
    rows = []
    for variant, overrides in VARIANTS.items():
        found = measured(runs, overrides)
        values = [over_conventional(runs, "overshoot", angle, overrides) for angle in ANGLES]
        values += [over_conventional(runs, "std", angle, overrides) for angle in ANGLES[:2]]
        values += [found["xi"], found["difference"]]
        rows.append((variant, *(mean_and_interval(value, 2) for value in values)))
    head = ["form of the law", *(f"overshoot of {angle}" for angle in ANGLES)]
    head += [*(f"std of {angle}" for angle in ANGLES[:2]), "mean xi", "mean difference, kn"]
    caption = f"Adaptive over conventional from 10 h on, linear, mean over {len(SEEDS)} seeds +- 95 %:"
    return Table(caption, tuple(head), tuple(rows))


def _ship_table(runs: Runs) -> Table:
    rows = []
    for i, name in enumerate(METHODS):
        values = [
            number(float(np.mean(measured(r)[what][:, i, k])))
            for what, angles in (("overshoot", 3), ("std", 2))
            for k in range(angles)
            for r in (runs, runs.in_strapdown())
        ]
        rows.append((name, *values))
    head = ["method"]
    for what, angles in (("overshoot", ANGLES), ("std", ANGLES[:2])):
        for angle in angles:
            head += [f"{what} of {angle}, linear", "strapdown"]
    return Table(
        "Overshoot by the manoeuvre and standard deviation from 10 to 20 h as printed, arcmin, mean over the "
        "seeds:",
        tuple(head),
        tuple(rows),
    )


def _draw_ship(runs: Runs, figure: Figure) -> None:
    axes = figure.subplots(2, 3)
    for i, name in enumerate(METHODS):
        t = hours(method(runs(PRESET), name))
        effect = errors(runs, name) - errors(runs, name, NO_MANOEUVRE)
        late = t >= 9.5
        for k in range(3):
            curve(axes[0, k], t[t > 8.0], errors(runs, name)[t > 8.0, k], name, i)
            curve(axes[1, k], t[late], effect[late, k], name, i)
    for k, angle in enumerate(ANGLES):
        panel(axes[0, k], f"{angle.capitalize()} error", "", "arcmin", legend=k == 0)
        panel(axes[1, k], "effect of the manoeuvre", "time, h", "arcmin", legend=False)


# ---------------------------------------------------------------- the search

LAW, NETWORK = "law", "network of the adaptive method"
SCALE, LIMIT, DRIFT = "the log's scale error k", "conventional undamped above", "random drift of the gyros"
LAWS = {"(9) as printed": "as_printed", "(9) with its sign mended": "quadratic", "table 1": "table"}
NETWORKS: dict[str, dict[str, Any]] = {
    "(18) as printed": {"id": "pole2", "variant": "as_printed"},
    "(18) exact": {"id": "pole2", "variant": "exact"},
    "unity2": {"id": "unity2", "zeta": 0.5},
}
SHIP_AXES = (
    Axis(SCALE, {"0": 0.0, "0.02": 0.02, "0.1": 0.1}),
    Axis(LIMIT, {"0.01 m/s2": 0.01, "0.03 m/s2": 0.03}),
    Axis(DRIFT, {"0.006 deg/sqrt(h)": 0.006, "0.006 deg/h per 1 s sample": 0.0001}),
    Axis(LAW, {name: name for name in LAWS}),
    Axis(NETWORK, {name: name for name in NETWORKS}),
)
Values = tuple[np.ndarray, ...]


def ship_scenario(seed: int, scale: float, limit: float, drift: float, *overrides: str) -> Scenario:
    """The preset with every law in every network beside free and conventional."""
    free, conventional, adaptive, _ = scenario_of(PRESET).canonical()["method"]
    conventional = {**conventional, "policy": {"id": "acceleration", "limit_mps2": limit}}
    laws = [
        {
            **adaptive,
            "name": f"{law}, {network}",
            "policy": {"id": "adaptive", "law": LAWS[law]},
            "network": block,
        }
        for law, (network, block) in product(LAWS, NETWORKS.items())
    ]
    given = (
        f"run.seed={seed}",
        "run.output_step_s=60",
        f"reference.scale_ppm={1e6 * scale}",
        f"imu.gyro_arw_dpsh={drift}",
        *overrides,
    )
    return scenario_of(PRESET, given, method=[free, conventional, *laws])


def _attitudes(run: Run, after: np.ndarray) -> np.ndarray:
    """Errors of pitch, roll, heading of each method, arcmin, shape (methods, n, 3)."""
    return np.array([attitude_error(run, one)[after] / ARCMIN for one in run.methods])


def _all_laws(runs: Runs, scale: float, limit: float, drift: float) -> dict[str, Values]:
    """Numbers of claims 1 to 7 for each law and network, each with all seeds."""

    def one(seed: int) -> dict[str, tuple[float, ...]]:
        made, without = (
            simulate(ship_scenario(seed, scale, limit, drift, *more)) for more in ((), (NO_MANOEUVRE,))
        )
        after = made.methods[0].t_s >= MANOEUVRE_S
        moved, still = _attitudes(made, after), _attitudes(without, after)
        over, spread = np.max(np.abs(moved - still), axis=1), np.std(moved[:, :, 0], axis=1)
        found = {}
        for i, each in enumerate(made.methods[2:], 2):
            xi = each.rows[after, XI_COLUMN]
            late = xi[each.t_s[after] >= WEAKER_S]
            ratios = (*(over[i] / over[1]), over[0, 1] / over[1, 1], spread[i] / spread[1])
            found[each.method.name] = (*ratios, float(np.max(xi)), float(late[0] - np.min(late)))
        return found

    def make() -> dict[str, Values]:
        by_seed = [one(seed) for seed in SEEDS]
        return {name: tuple(np.array([each[name] for each in by_seed]).T) for name in by_seed[0]}

    return runs.keep(("search: sun ship", scale, limit, drift), make)


def _at(runs: Runs, setting: Setting) -> Values:
    """Numbers of claims 1 to 7 in a setting of the search."""
    laws = _all_laws(runs, setting[SCALE], setting[LIMIT], setting[DRIFT])
    return laws[f"{setting[LAW]}, {setting[NETWORK]}"]


SHIP_SEARCH = Search(
    SHIP_AXES,
    (1, 2, 3, 4, 5, 6, 7),
    _at,
    len(SEEDS),
    "Initial errors, biases and the log's errors are as printed.",
)

SHIP = Exhibit(
    name="sun-fig-10",
    title="Figures 10 to 12: a ship that accelerates at 10 h",
    presets=(PRESET,),
    setting="Initial errors, gyros, accelerometers and log as printed in Sun 5.1. *Adaptive* is Sun's own "
    "law: (9) as printed put into (18) as printed, changed by at most 0.1 every 2 min. *Conventional* is "
    "classic3, undamped while the acceleration exceeds 0.03 m/s2 (the 0.1 deg of initial tilt alone look "
    "like 0.024 m/s2 to the accelerometers: with a lower limit the strapdown system never begins to damp). "
    "Overshoot is what the manoeuvre changes: the run less the same run without it. The paper prints no "
    "number for these figures. *Table 1* in the first table below is ours and is judged in the next section.",
    claims=(
        *(_smaller(angle) for angle in ANGLES),
        Claim(
            "while manoeuvring the undamped system errs least: overshoot of roll, free over conventional",
            "at a minimum",
            at_most(1.0),
            lambda runs: over_conventional(runs, "overshoot", "roll", name="free"),
            strapdown=True,
            quote="when the maneuverability of the carrier is larger, the system error of the undamping "
            "status is at a minimum",
        ),
        Claim(
            "the dynamic performance is improved: standard deviation of pitch from 10 h on over conventional",
            "smaller",
            at_most(1.0),
            _spread,
            strapdown=True,
            readings=_forms("smaller", at_most(1.0), _spread),
            quote=_SMALLER,
        ),
        Claim(
            "the damping coefficient takes values of table 1: largest xi from 10 h on",
            "0.04 to 0.99",
            (0.1, 0.9901),
            _largest,
            readings=_forms("0.04 to 0.99", (0.1, 0.9901), _largest),
            note="It stands at {least} to {largest} the whole time: (9) as printed rises with the difference "
            "and is held at 0.99, the largest value of table 1, from {held} kn on, and the difference is "
            "{difference} kn on the average. So the printed law does not adapt: it meets the claims above as "
            "a strong constant damping would.",
            facts={
                "least": lambda runs: float(np.min(measured(runs)["least xi"])),
                "largest": lambda runs: float(np.max(measured(runs)["largest xi"])),
                "held": lambda runs: held_from_kn(),
                "difference": lambda runs: float(np.mean(measured(runs)["difference"])),
            },
            quote=_TIMELY,
        ),
        Claim(
            "when the acceleration falls, strong damping becomes weak damping: fall of xi after 10 h 2 min",
            "weaker",
            at_least(0.1),
            _weaker,
            readings=_forms("weaker", at_least(0.1), _weaker),
            why="the coefficient follows the difference of the navigation's velocity and the log, not the "
            "acceleration, and with the printed initial errors this difference never falls below {least} kn: "
            "(9) as printed stays at 0.99. The sentence goes with the printed sign, by which damping is "
            "strong where the difference is large; table 1 has it the other way round.",
            facts={"least": lambda runs: float(np.min(measured(runs)["least difference"]))},
            quote=_WEAKER,
        ),
        Claim(
            "the overshoot is very small because the coefficient changes gradually (0.1 every 2 min): "
            "overshoot of pitch over that with switching at once",
            "smaller",
            at_most(0.9),
            gradual_over_hard,
            why="the overshoot is very small (claim 1), but not for this reason: the coefficient moves by "
            "{moved} from 10 h on, so that it does not matter how fast it may move.",
            facts={
                "moved": lambda runs: float(
                    np.max(measured(runs)["largest xi"] - measured(runs)["least xi"])
                ),
            },
            quote=_WEAKER,
        ),
    ),
    tables=(_ship_table, _variant_table),
    search=SHIP_SEARCH,
    draw=_draw_ship,
    height=4.6,
)

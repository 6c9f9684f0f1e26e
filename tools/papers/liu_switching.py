"""Liu 2021, figure 7 and tables 1 to 3: when to damp while the log's error changes, over many seeds."""

from collections.abc import Callable, Iterable, Sequence
from typing import Any, Literal

import numpy as np

from navcore.engine.run import Run
from navcore.engine.simulation import simulate
from navcore.foundation.units import ARCSEC, HOUR
from navcore.mechanization.recorder import D_LAT, D_LON, DV_E, DV_N, PHI_E, PHI_N, POSITION
from navcore.scenario.model import Scenario
from navcore.sensors.log_errors.events import LogEvent
from tools.papers.measure import departure, rms
from tools.papers.runs import STRAPDOWN_HZ, Runs, method, scenario_of

PRESET = "liu-switching"
Quantity = Literal["position", "velocity", "tilt"]
QUANTITIES: tuple[Quantity, ...] = ("position", "velocity", "tilt")
UNITS = {"position": "m", "velocity": "m/s", "tilt": "arcsec"}
SEEDS, STRAPDOWN_SEEDS = range(1, 21), range(1, 4)
WINDOWS_H = ((4, 8), (11, 15), (1, 4), (9, 11), (18, 24), (0, 6), (22, 25), (28, 32))
"""Hours over which the paper's tables 1 to 3 give their RMS, in its order."""
METHODS = (
    "free",
    "constant",
    "yaw_rate",
    "threshold",
    "variation + hard",
    "variation + ramp",
    "variation + Liu 19",
    "variation + bumpless",
    "variation + bridge",
)
"""Methods of the preset, and `bridge` with the same network and policy."""
HARD, RAMP, NOVEL, BEST, BRIDGE = METHODS[4:]

# ---------------------------------------------------------------- the log's error of each case

Events = list[dict[str, Any]]


def _change(t_h: float, lasts_h: float, change: Iterable[float], within_s: float) -> Events:
    """A change of the log's error and back."""
    return [
        {"t_h": t, "duration_s": within_s, "accel_mps2": [float(sign * c / within_s) for c in change]}
        for t, sign in ((float(t_h), 1.0), (float(t_h + lasts_h), -1.0))
    ]


def lasting(seed: int, turns_h: Sequence[float]) -> Events:
    """Eight changes of 0.5 to 1.5 m/s, east or north, for 0.5 to 2 h, every other one with a turn."""
    random = np.random.default_rng([seed, 2021])
    events: Events = []
    for k in range(8):
        turn_h = turns_h[min(2 * (k // 2), len(turns_h) - 1)]
        begins = turn_h if k % 2 == 0 else turn_h + random.uniform(2.5, 3.5)
        change = np.zeros(2)
        change[random.integers(2)] = random.choice([-1.0, 1.0]) * random.uniform(0.5, 1.5)
        events += _change(begins, random.uniform(0.5, 2.0), change, 30.0)
    return events


def turns(scenario: Scenario) -> list[float]:
    """Hours at which the legs of the preset begin, without the first."""
    legs = scenario.canonical()["motion"]["leg"]
    return [float(t) / HOUR for t in np.cumsum([leg["duration_s"] for leg in legs])[:-1]]


def sea(seed: int) -> Scenario:
    """The preset with other episodes and noise."""
    base = _base([f"run.seed={seed}", "run.output_step_s=60"])
    return with_events(base, lasting(seed, turns(base)))


def log_only(seed: int) -> Scenario:
    """The same episodes and noise of the log, perfect sensors, no standing error of the log."""
    overrides = [f"run.seed={seed}", "run.output_step_s=60", "reference.bias_mps=[0,0]"]
    base = _base(overrides, imu={}, initial_error={})
    return with_events(base, lasting(seed, turns(base)))


def episodes_at_sea(seed: int) -> Scenario:
    """+1 m/s east for 300 s every 30 min with the preset's sensors, standing error and noise."""
    base = _base([f"run.seed={seed}", "run.output_step_s=60"])
    return with_events(base, _passing(36.0))


def episodes(seed: int, noise_mps: float = 0.1, days: float = 1.5, standing_mps: float = 0.0) -> Scenario:
    """+1 m/s for 300 s every 30 min, one channel, perfect sensors."""
    overrides = [
        f"run.seed={seed}",
        f"run.duration_h={24.0 * days}",
        "run.output_step_s=60",
        "run.fidelity=channel",
        f"reference.bias_mps=[{standing_mps},0]",
        f"reference.noise_mps={noise_mps}",
        "motion.kind=static",
    ]
    return with_events(_base(overrides, imu={}, initial_error={}), _passing(24.0 * days))


def _passing(hours: float) -> Events:
    """+1 m/s east for 300 s every 30 min."""
    starts = np.arange(1.0, hours, 0.5)
    return [e for t in starts for e in _change(t, 1.0 / 12.0, (1.0, 0.0), 10.0)]


def _base(overrides: Iterable[str], **blocks: Any) -> Scenario:
    """The preset with `METHODS`."""
    methods = scenario_of(PRESET).canonical()["method"]
    bridge = {**methods[-1], "name": METHODS[-1], "switching": {"id": "bridge"}}
    return scenario_of(PRESET, overrides, method=[*methods, bridge], **blocks)


def without_standing(scenario: Scenario) -> Scenario:
    """The same without the standing error of the log."""
    reference = scenario.reference.model_copy(update={"bias_mps": (0.0, 0.0)})
    return scenario.model_copy(update={"reference": reference})


def without_changes(scenario: Scenario) -> Scenario:
    """The same without any change of the log's error."""
    return with_events(scenario, [])


def with_events(scenario: Scenario, events: Events) -> Scenario:
    """Replace the log's events; there may be more of them than a file may hold."""
    made = tuple(LogEvent(**event) for event in events)
    return scenario.model_copy(update={"reference": scenario.reference.model_copy(update={"event": made})})


NO_STANDING = "sea, no standing error"
CASES: dict[str, Callable[[int], Scenario]] = {
    "sea": sea,
    NO_STANDING: lambda seed: without_standing(sea(seed)),
    "log only": log_only,
    "episodes": episodes,
    "episodes at sea": episodes_at_sea,
}
DAYS = 5

# ---------------------------------------------------------------- errors over the seeds


def errors(run: Run) -> np.ndarray:
    """RMS of position (m), velocity (m/s) and tilt (arcsec) of each method, shape (methods, 3)."""
    rows = [m.rows for m in run.methods]
    return np.array(
        [
            [
                rms(x[:, POSITION]),
                rms(np.hypot(x[:, DV_E], x[:, DV_N])),
                rms(np.hypot(x[:, PHI_E], x[:, PHI_N])) / ARCSEC,
            ]
            for x in rows
        ]
    )


def windowed(run: Run) -> np.ndarray:
    """RMS of position of each method over each of `WINDOWS_H`, m, shape (methods, windows)."""
    return np.array(
        [
            [rms(m.rows[(m.t_s >= a * HOUR) & (m.t_s <= b * HOUR), POSITION]) for a, b in WINDOWS_H]
            for m in run.methods
        ]
    )


def largest(run: Run) -> np.ndarray:
    """Largest position error of each method, m, shape (methods,)."""
    return np.array([float(np.max(m.rows[:, POSITION])) for m in run.methods])


def _studied(runs: Runs, case: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Errors of a case over the run, over the paper's windows, and at the largest, for each of the seeds."""
    seeds = STRAPDOWN_SEEDS if runs.strapdown else SEEDS

    def make() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        found, parts, peaks = [], [], []
        for seed in seeds:
            scenario = CASES[case](seed)
            run = simulate(in_strapdown(scenario) if runs.strapdown else scenario)
            found.append(errors(run))
            parts.append(windowed(run))
            peaks.append(largest(run))
        return np.array(found), np.array(parts), np.array(peaks)

    return runs.keep(("liu-switching", case, runs.strapdown), make)


def study(runs: Runs, case: str) -> np.ndarray:
    """Errors of a case over the seeds, shape (seeds, methods, 3)."""
    return _studied(runs, case)[0]


def window_ratios(runs: Runs, case: str, ours: str, than: str) -> np.ndarray:
    """One method's position RMS over another's in each of `WINDOWS_H`, shape (seeds, windows)."""
    parts = _studied(runs, case)[1]
    return parts[:, METHODS.index(ours)] / parts[:, METHODS.index(than)]


def largest_ratios(runs: Runs, case: str, ours: str, than: str) -> np.ndarray:
    """One method's largest position error over another's with each of the seeds."""
    peaks = _studied(runs, case)[2]
    return peaks[:, METHODS.index(ours)] / peaks[:, METHODS.index(than)]


def in_strapdown(scenario: Scenario) -> Scenario:
    """The same scenario in the full strapdown."""
    update = {"fidelity": "strapdown", "rate_hz": STRAPDOWN_HZ}
    return scenario.model_copy(update={"run": scenario.run.model_copy(update=update)})


def of_method(runs: Runs, case: str, quantity: Quantity, name: str) -> np.ndarray:
    """Error of one method with each of the seeds."""
    return study(runs, case)[:, METHODS.index(name), QUANTITIES.index(quantity)]


def ratios(runs: Runs, case: str, quantity: Quantity, ours: str, than: str) -> np.ndarray:
    """One method's error over another's with each of the seeds."""
    return of_method(runs, case, quantity, ours) / of_method(runs, case, quantity, than)


def ratio(runs: Runs, case: str, quantity: Quantity, ours: str, than: str) -> float:
    """Geometric mean over the seeds of one method's error over another's."""
    return float(np.exp(np.mean(np.log(ratios(runs, case, quantity, ours, than)))))


def altered_ratio(runs: Runs, change: Callable[[Scenario], Scenario], ours: str, than: str) -> float:
    """Mean over the seeds of one method's position RMS over another's at sea, in an altered scenario."""

    def make() -> float:
        found = []
        for seed in SEEDS:
            scenario = change(sea(seed))
            methods = {one.name: one for one in scenario.method}
            pair = scenario.model_copy(update={"method": (methods[ours], methods[than])})
            mine, other = errors(simulate(pair))[:, QUANTITIES.index("position")]
            found.append(mine / other)
        return float(np.mean(found))

    return runs.keep(("liu-switching", change.__name__, ours, than), make)


def paired(run: Run, without: Run) -> np.ndarray:
    """RMS of the difference of two runs in position (m), velocity (m/s), tilt (arcsec), (methods, 3)."""
    return np.array(
        [
            [
                rms(np.hypot(change[:, D_LAT], change[:, D_LON])),
                rms(np.hypot(change[:, DV_E], change[:, DV_N])),
                rms(np.hypot(change[:, PHI_E], change[:, PHI_N])) / ARCSEC,
            ]
            for change in (
                one.rows - other.rows for one, other in zip(run.methods, without.methods, strict=True)
            )
        ]
    )


def added(runs: Runs, case: str) -> np.ndarray:
    """Compute what the changes of the log add with each method and seed, shape (seeds, methods, 3).

    Each run is compared with the same run, noise and all, without any change of the log.
    """

    def make() -> np.ndarray:
        found = []
        for seed in SEEDS:
            scenario = CASES[case](seed)
            found.append(paired(simulate(scenario), simulate(without_changes(scenario))))
        return np.array(found)

    return runs.keep(("liu-switching", case, "added"), make)


def added_by(runs: Runs, case: str, quantity: Quantity, name: str) -> np.ndarray:
    """Compute what the changes of the log add with one method, with each of the seeds."""
    return added(runs, case)[:, METHODS.index(name), QUANTITIES.index(quantity)]


def quiet_episodes(runs: Runs) -> np.ndarray:
    """Errors with the episodes and a log without noise, shape (methods, 3)."""
    return runs.keep("quiet episodes", lambda: errors(simulate(episodes(1, noise_mps=0.0))))


def five_days(runs: Runs) -> Run:
    """Run of the episodes for five days, 0.5 m/s standing, a log without noise."""
    return runs.keep("five days", lambda: simulate(episodes(1, 0.0, DAYS, 0.5)))


def daily(runs: Runs, name: str) -> np.ndarray:
    """RMS of dV_E on each of the five days, m/s."""
    found = method(five_days(runs), name)
    day = np.minimum((found.t_s / (24.0 * HOUR)).astype(int), DAYS - 1)
    return np.array([rms(found.rows[day == k, DV_E]) for k in range(DAYS)])


# ---------------------------------------------------------------- figure 7

FIG_7 = {
    "run.duration_h": 20.0,
    "run.fidelity": "channel",
    "run.earth": "sphere",
    "run.output_step_s": 10.0,
    "motion.kind": "static",
    "reference.noise_mps": 0.0,
    "reference.bias_mps": [0.5, 0.0],
}
SWITCHED_S = 10.0 * HOUR
STEPS_MPS = (0.25, 0.35, 0.45)


def fig_7(runs: Runs) -> Run:
    """Damped with 0.5 m/s standing; at 10 h a step of the log's error, or 200 s undamped."""

    def make() -> Run:
        network = {"id": "complementary", "zeta": 0.5, "eta": 0.5}
        damped = {"damping": "external", "network": network}
        methods = [
            {"name": f"s = {s} m/s", **damped, "event": _change(10.0, 9.9, (-s, 0.0), 1.0)[:1]}
            for s in STEPS_MPS
        ]
        overrides = [f"{key}={value}" for key, value in FIG_7.items()]
        imu = {"gyro_bias_dph": [1e-4] * 3, "accel_bias_ug": [10.0] * 3}
        reference = {"kind": "log", "bias_mps": [0.5, 0.0]}
        return simulate(
            scenario_of(PRESET, overrides, imu=imu, initial_error={}, reference=reference, method=methods)
        )

    return runs.keep("fig 7", make)


def switched(runs: Runs, switching: str, **more: str) -> Run:
    """The same log without the step, undamped for 200 s at 10 h."""

    def make() -> Run:
        base = fig_7(runs).scenario
        log = {"kind": "log", "bias_mps": [0.5, 0.0], "outage": [{"t_h": 10.0, "duration_s": 200.0}]}
        one = {
            **base.canonical()["method"][0],
            "name": switching,
            "event": [],
            "switching": {"id": switching, **more},
        }
        return simulate(type(base).parse({**base.canonical(), "reference": log, "method": [one]}))

    return runs.keep(("fig 7", switching, *more.values()), make)


def overshoot(run: Run, index: int = 0) -> float:
    """Largest departure of dV_E from its value at 10 h, m/s."""
    found = run.methods[index]
    return departure(found.t_s, found.rows[:, DV_E], SWITCHED_S)

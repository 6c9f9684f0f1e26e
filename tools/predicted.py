"""The budget along the run beside 200 seeds of random ships: ``make covariance``.

Each case draws a ship (latitude, motion, sensors with their constants, log with a rate of 0.002 to 10 Hz), a
network and its parameters within the sliders' ranges; settings whose loop grows as it is sampled are left
out. Compared is the root mean square of tilt and velocity over the run, per axis. A comparison holds where
the runs lie within 3 % of the budget, or the budget lies within the 99 % interval of the runs.
"""

import math
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from navcore.design.figures import mean_figures
from navcore.design.measures import Setting
from navcore.design.pareto import LEFT_OUT
from navcore.design.ship import Ship
from navcore.design.vary import Varied, changed, read_varied
from navcore.engine.ensemble import Outcome, outcomes
from navcore.engine.measures import run_value
from navcore.foundation.errors import InputError
from navcore.networks import NETWORKS
from navcore.quantities import QUANTITIES
from navcore.scenario.model import Scenario

CASES, SEEDS = 40, 200
NEAR, WANTED = 0.03, 0.95
SLOWEST_HZ, FASTEST_HZ = 0.002, 10.0
_T = 2.6
"""Quantile of the 99 % interval with 200 seeds (Student)."""


@dataclass(frozen=True)
class Case:
    """One ship with one setting, which its budget says does not grow."""

    name: str
    ship: Ship


def random_ship(rng: np.random.Generator, network: str) -> Scenario:
    """Draw a ship with one externally damped method of a network at its defaults."""

    def between(low: float, high: float) -> float:
        return float(np.exp(rng.uniform(np.log(low), np.log(high))))

    still = {"kind": "static", "heading_deg": rng.uniform(0.0, 360.0)}
    legs = [
        {"duration_s": 5400.0, "speed_kn": rng.uniform(5.0, 20.0), "heading_deg": rng.uniform(0.0, 360.0)},
        {"duration_s": 120.0, "turn_dps": rng.uniform(-1.0, 1.0)},
        {"duration_s": 30000.0},
    ]
    gyro, accel = between(1e-3, 2e-2), between(5.0, 100.0)
    return Scenario.parse(
        {
            "run": {"duration_h": 8.0, "seed": int(rng.integers(1, 10**6))},
            "site": {"lat_deg": rng.uniform(-70.0, 70.0)},
            "motion": still if rng.integers(2) else {"kind": "legs", "leg": legs},
            "imu": {
                "gyro_arw_dpsh": between(3e-4, 1e-2),
                "gyro_instability_dph": between(1e-3, 1e-2),
                "gyro_tau_s": between(300.0, 20000.0),
                "accel_vrw_ugpshz": between(2.0, 50.0),
                "accel_instability_ug": between(2.0, 30.0),
                "accel_tau_s": between(300.0, 20000.0),
                "gyro_bias_std_dph": gyro,
                "accel_bias_std_ug": accel,
            },
            "reference": {
                "kind": "log",
                "rate_hz": between(SLOWEST_HZ, FASTEST_HZ),
                "noise_mps": between(0.02, 0.5),
                "drift_mps": between(0.02, 0.2),
                "drift_tau_s": between(100.0, 5000.0),
                "bias_std_mps": between(0.01, 0.2),
            },
            "initial_error": {
                "level_std_arcmin": between(0.05, 0.5),
                "heading_std_arcmin": between(0.5, 5.0),
                "velocity_std_mps": between(0.02, 0.5),
                "position_std_arcsec": between(0.5, 5.0),
            },
            "method": [{"name": network, "damping": "external", "network": {"id": network}}],
        }
    )


def parameters(scenario: Scenario) -> tuple[Varied, ...]:
    """Parameters of the network that a search moves, within their sliders' ranges."""
    fields = scenario.method[0].network.design_fields()
    return read_varied(scenario, [f"method.0.network.{field}" for field in fields]) if fields else ()


def cases(count: int) -> Iterator[Case]:
    """Draw ships and settings."""
    ids = [name for name in NETWORKS if name not in LEFT_OUT]
    rng = np.random.default_rng(36)
    while count:
        name = ids[count % len(ids)]
        scenario = random_ship(rng, name)
        varied = parameters(scenario)
        values = [one.value(rng.uniform()) for one in varied]
        try:
            method = changed(scenario, varied, values) if varied else scenario.method[0]
            scenario = scenario.model_copy(update={"method": (method,)})
            ship = Ship(scenario)
            setting = Setting(ship, method)
            if setting.instability or not setting.loop.stable:
                continue
        except (InputError, np.linalg.LinAlgError):
            continue
        count -= 1
        rate = scenario.reference.rate_hz
        shown = ", ".join(f"{one.path[-1]} {value:.3g}" for one, value in zip(varied, values, strict=True))
        yield Case(
            f"{name} {shown}, log {rate:.3g} Hz, {scenario.site.lat_deg:.0f} deg".replace(" ,", ","), ship
        )


def compared(case: Case, seeds: int) -> dict[str, tuple[float, bool]]:
    """Of tilt and velocity: runs over the budget less 1, and whether that holds."""
    method = case.ship.scenario.method[0]
    along = case.ship.along(method)
    predicted = mean_figures(along.t_s, along.total)
    found = [one[0] for one in outcomes(case.ship.scenario, (method,), range(seeds))]
    wanted = {"tilt_rms": predicted.tilt_rad, "velocity_rms": predicted.velocity_mps}
    return {name: _beside(found, name, value or math.nan) for name, value in wanted.items()}


def _beside(found: list[Outcome], name: str, predicted: float) -> tuple[float, bool]:
    if not all(one.ended for one in found):
        return math.inf, False
    squares = np.array([run_value(QUANTITIES[name], one.spans, one.final_m, 0.0) ** 2 for one in found])
    mean, half = float(squares.mean()), _T * float(squares.std(ddof=1)) / math.sqrt(len(squares))
    off = math.sqrt(mean) / predicted - 1.0
    return off, abs(off) <= NEAR or abs(mean - predicted**2) <= half


def main() -> int:
    """Print a line a case; 1 when fewer than 95 % of the comparisons hold."""
    given = [int(text) for text in sys.argv[1:3]]
    count, seeds = (*given, *(CASES, SEEDS)[len(given) :])
    began, held = time.perf_counter(), []
    for case in cases(count):
        both = compared(case, seeds)
        held += [good for _, good in both.values()]
        text = ", ".join(
            f"{name} {100.0 * off:+.1f} %{'' if good else ' (!)'}" for name, (off, good) in both.items()
        )
        print(f"{case.name}: {text}", flush=True)
    share = float(np.mean(held))
    print(
        f"{count} ships, {seeds} seeds each: {100.0 * share:.1f} % of {len(held)} comparisons within 3 % or "
        f"the 99 % interval; {time.perf_counter() - began:.0f} s"
    )
    return 0 if share >= WANTED else 1


if __name__ == "__main__":
    sys.exit(main())

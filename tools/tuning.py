"""The tuning beside a fine grid, from several starts, with its times: ``make tuning``.

Two parameters of compass (velocity feedback and network form) and of complementary, steady tilt of the
example ship of theory.md 20. Then a run of 24 h with a moving ship, and its confirmation by 32 seeds. Last,
200 random tunings, each of another ship with another log: none of their proposals may diverge when it is run.
"""

import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from navcore.design.confirm import confirmed
from navcore.design.measures import Setting, Ship
from navcore.design.pareto import LEFT_OUT
from navcore.design.tune import tune
from navcore.design.vary import changed, read_varied
from navcore.engine.ensemble import outcomes
from navcore.foundation.errors import InputError
from navcore.foundation.units import ARCSEC
from navcore.networks import NETWORKS
from navcore.scenario.model import Scenario
from schuler_bench.bench.runs import day
from tests.acceptance.test_design_values import set_a
from tools.predicted import parameters, random_ship

GRID = 60
WITHIN = 1e-3
STEADY_S, ALONG_S, CONFIRMED_S = 3.0, 20.0, 1.5
TUNINGS, RUNS = 200, 2


@dataclass(frozen=True)
class Case:
    """One network with two parameters.

    Attributes
    ----------
    name : str
        Shown.
    network : dict
        Without the parameters.
    ranges : dict of (float, float)
        Parameters and their ends.
    starts : tuple of (float, float)
        Settings that the search begins with.
    """

    name: str
    network: dict[str, Any]
    ranges: dict[str, tuple[float, float]]
    starts: tuple[tuple[float, float], ...]

    @property
    def vary(self) -> list[str]:
        """Fields with their ranges."""
        return [f"method.0.network.{name}={low}:{high}" for name, (low, high) in self.ranges.items()]

    def scenario(self, values: tuple[float, float]) -> Scenario:
        """Return the example ship with these values."""
        return set_a({**self.network, **dict(zip(self.ranges, values, strict=True))})


COMPASS = {"sigma": (1e-4, 0.1), "xi": (0.1, 5.0)}
STARTS = ((0.0088, 0.7), (1.1e-4, 0.11), (0.099, 4.9), (1.1e-4, 4.9), (0.099, 0.11))
CASES = (
    Case("compass, feedback", {"id": "compass"}, COMPASS, STARTS),
    Case("compass, network", {"id": "compass", "realisation": "network"}, COMPASS, STARTS),
    Case(
        "complementary",
        {"id": "complementary"},
        {"zeta": (0.05, 2.0), "eta": (0.05, 2.0)},
        ((0.5, 0.5), (0.06, 0.06), (1.9, 1.9), (0.06, 1.9), (1.9, 0.06)),
    ),
)


def best_of_grid(case: Case, points: int = GRID) -> float:
    """Least steady tilt over points x points values in equal ratios, rad."""
    scenario = case.scenario(case.starts[0])
    ship, varied = Ship(scenario, along_run=False), read_varied(scenario, case.vary)
    axes = [np.geomspace(low, high, points) for low, high in case.ranges.values()]
    best = np.inf
    for first in axes[0]:
        for second in axes[1]:
            try:
                setting = Setting(ship, changed(scenario, varied, (first, second)))
            except InputError:
                continue
            best = min(best, setting.figures.tilt_rad or np.inf)
    return float(best)


def from_starts(case: Case) -> tuple[list[float], list[float]]:
    """Objective (rad) and wall time (s) of the tuning from every start, without limits as the grid."""
    found, times = [], []
    for start in case.starts:
        began = time.perf_counter()
        found.append(tune(case.scenario(start), "tilt_rms", case.vary, default_limits=False).objective)
        times.append(time.perf_counter() - began)
    return found, times


def confirmation_s() -> float:
    """Median wall time of a confirmation: two settings, 32 seeds of 24 h, s."""
    scenario, times = day(seed=1), []
    for _ in range(5):
        began = time.perf_counter()
        confirmed(scenario, scenario.method[0], scenario.method[1])
        times.append(time.perf_counter() - began)
    return float(np.median(times))


def random_tunings(count: int) -> Iterator[tuple[str, bool]]:
    """Tune random networks of random ships; say whether the proposal went through all runs.

    Searches that end without a proposal, because no setting is stable or meets the limits, are counted as
    gone through: nothing is proposed that could diverge.
    """
    rng = np.random.default_rng(36)
    ids = [name for name in NETWORKS if name not in LEFT_OUT]
    ids = [name for name in ids if parameters(random_ship(np.random.default_rng(0), name))]
    for k in range(count):
        scenario = random_ship(rng, ids[k % len(ids)])
        vary = [one.field for one in parameters(scenario)]
        objective = ("tilt_rms", "velocity_rms", "tilt_rms + velocity_rms")[int(rng.integers(3))]
        name = f"{ids[k % len(ids)]}, log {scenario.reference.rate_hz:.3g} Hz, {objective}"
        try:
            found = tune(scenario, objective, vary, default_limits=bool(rng.integers(2)))
        except InputError as error:
            yield f"{name}: {error}", True
            continue
        (method,) = found.scenario.method
        runs = outcomes(scenario, (method,), range(RUNS))
        yield name, all(one[0].ended for one in runs)


def main() -> int:
    """Print; 1 when a start ends more than 0.1 % above the best of the grid, or a search takes too long.

    Also 1 when a proposal of a random tuning diverges.
    """
    good = True
    for case in CASES:
        least, (found, times) = best_of_grid(case), from_starts(case)
        worst = max(found) / least - 1.0
        good &= worst <= WITHIN and float(np.median(times)) <= STEADY_S
        print(
            f"{case.name}: best of {GRID} x {GRID} points {least / ARCSEC:.4f} arcsec; {len(found)} starts "
            f"end at {min(found) / ARCSEC:.4f} to {max(found) / ARCSEC:.4f} arcsec, the worst "
            f"{100.0 * worst:+.3f} % off the grid; median {np.median(times):.2f} s",
            flush=True,
        )
    began = time.perf_counter()
    along = tune(
        day(seed=1), "position_rms", ["method.2.network.sigma=1e-3:0.05", "method.2.network.xi=0.3:2"]
    )
    took = time.perf_counter() - began
    good &= took <= ALONG_S
    print(
        f"24 h, moving ship, compass: position {along.before or np.nan:.0f} m before, "
        f"{along.objective:.0f} m after; {took:.1f} s"
    )
    took = confirmation_s()
    good &= took <= CONFIRMED_S
    print(f"confirmation, two settings, 32 seeds of 24 h: median {took:.2f} s", flush=True)
    count = int(sys.argv[1]) if len(sys.argv) > 1 else TUNINGS
    lost = [name for name, ended in random_tunings(count) if not ended]
    good &= not lost
    print(f"{count} random tunings: {len(lost)} proposals diverge when run", *lost, sep="\n  ")
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())

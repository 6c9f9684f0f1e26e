"""Searches over what Sun 2017 does not print: moments, poles, the setting of equation 8, the log's scale."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import product
from typing import Any

import numpy as np

from navcore.analysis import analyse
from navcore.design.sun import TuningSettings, sun_scenario, tune_table
from navcore.engine.run import Run
from navcore.engine.simulation import simulate
from navcore.foundation.earth import SPHERE
from navcore.foundation.units import ARCMIN, HOUR
from navcore.mechanization.recorder import PHI_N, XI_COLUMN
from navcore.networks import parse_network
from tools.papers.measure import attitude_error, peak
from tools.papers.runs import Runs, method, scenario_of
from tools.papers.search import Search

Numbers = dict[str, tuple[float, ...]]
OMEGA_S = SPHERE.schuler_frequency(0.0)
SCHULER_S = 2.0 * np.pi / OMEGA_S

# ---------------------------------------------------------------- figure 4

TILTS_ARCMIN = (0.0, 1.0, 6.0)
SPEEDS_MPS = (0.0, 0.1, 0.5)
"""Initial error of the velocity."""
MOMENTS = 24


def _figure_4(runs: Runs) -> Numbers:
    """Roll error after the switch over the oscillation before it."""

    def make() -> Numbers:
        found: Numbers = {}
        moments = 6.0 * HOUR + SCHULER_S * np.arange(MOMENTS) / MOMENTS
        for tilt, speed, switch_s in product(TILTS_ARCMIN, SPEEDS_MPS, moments):
            given = (
                f"reference.outage.0.duration_s={round(switch_s)}",
                f"initial_error.attitude_arcmin=[{tilt},{tilt},0]",
                f"initial_error.velocity_mps=[{speed},{speed}]",
                "run.duration_h=10",
            )
            one = method(simulate(scenario_of("sun-step", given)), "classic3")
            roll = one.rows[:, PHI_N]
            before = peak(one.t_s, roll, switch_s - SCHULER_S, switch_s)
            name = f"{tilt} arcmin and {speed} m/s at the start, switched {switch_s / HOUR:.2f} h after it"
            found[name] = (peak(one.t_s, roll, switch_s) / before,)
        return found

    return runs.keep("search: sun fig 4", make)


STEP_SEARCH = Search(
    f"the moment of the switch ({MOMENTS} of one Schuler oscillation), initial tilt 0 to 6 arcmin and "
    "velocity error 0 to 0.5 m/s; the preset has 0.1 deg (Sun 5.1). Claim 2 leaves nothing to search: the "
    "network is printed.",
    (3,),
    _figure_4,
)

# ---------------------------------------------------------------- table 1 with (18)

N1, N2 = (6.0, 8.0, 10.0, 14.0, 20.0, 30.0), (2.0, 3.0, 5.0, 8.0, 12.0)
TABLE_XI = (0.04, 0.05, 0.08, 0.10, 0.12, 0.22, 0.44, 0.64, 0.82, 0.99)


def _poles(runs: Runs) -> Numbers:
    """Numbers of claims 3 and 4 for other n1 and n2."""

    def damping(xi: float, n1: float, n2: float) -> float:
        network = parse_network({"id": "pole2", "xi": xi, "n1": n1, "n2": n2, "variant": "as_printed"})
        return analyse(network.transfer(OMEGA_S)).damping_ratio

    def make() -> Numbers:
        return {
            f"n1 = {n1:g}, n2 = {n2:g}": (
                damping(0.5, n1, n2),
                float(sum(damping(xi, n1, n2) < 0.0 for xi in TABLE_XI)),
            )
            for n1, n2 in product(N1, N2)
            if n1 > n2 and (n1 - n2) ** 2 + 4.0 > 4.0 * (n1 + n2)  # Sun 19: real w1, w2
        }

    return runs.keep("search: sun poles", make)


LAW_SEARCH = Search(
    "n1 (6 to 30) and n2 (2 to 12), though Sun gives 14 and 5. Claims 1 and 2 leave nothing to search: they "
    "are formulas.",
    (3, 4),
    _poles,
)

# ---------------------------------------------------------------- equation 8

NETWORKS: dict[str, dict[str, Any]] = {
    "pole2 as printed": {"id": "pole2", "variant": "as_printed"},
    "complementary": {"id": "complementary"},
}
HOURS = (6.0, 24.0)
LOG_NOISE_MPS = (0.0, 0.1, 0.5)
GYROS = {"6, 6 and 1": (0.006, 0.006, 0.001), "0": (0.0, 0.0, 0.0), "60, 60 and 10": (0.06, 0.06, 0.01)}


def _equation_8(runs: Runs) -> Numbers:
    """Best coefficient without a difference: with Sun's network, and with the complementary one."""

    def best(
        network: dict[str, Any], hours: float, noise: float, gyros: tuple[float, ...], tilt: float
    ) -> float:
        base = sun_scenario().canonical()
        base["run"] |= {"duration_h": hours}
        base["imu"] |= {"gyro_bias_dph": list(gyros)}
        base["reference"] |= {"noise_mps": noise}
        base["initial_error"] |= {"attitude_arcmin": [tilt, tilt, 0.0]}
        settings = TuningSettings.model_validate(
            {"step": 0.1, "differences_kn": [0.0, 3.0], "network": network}
        )
        rows = tune_table(type(sun_scenario()).parse(base), settings).pairs()
        return float(rows[0][1])

    def make() -> Numbers:
        found: Numbers = {}
        for hours, noise, (text, gyros), tilt in product(HOURS, LOG_NOISE_MPS, GYROS.items(), (0.0, 6.0)):
            if not (any(gyros) or noise or tilt):
                continue
            name = (
                f"{hours:g} h, gyros of {text} times 0.001 deg/h, {tilt:g} arcmin at the start, log with "
                f"{noise} m/s of noise"
            )
            found[name] = tuple(best(network, hours, noise, gyros, tilt) for network in NETWORKS.values())
        return found

    return runs.keep("search: sun equation 8", make)


EQUATION_8_SEARCH = Search(
    "6 or 24 h, drifts of the gyros (none to ten times the printed), initial tilt (0 or 6 arcmin) and noise "
    "of the log (0 to 0.5 m/s), the coefficient in steps of 0.1.",
    (1, 2),
    _equation_8,
)

# ---------------------------------------------------------------- figures 10 to 12

SCALES = (0.0, 0.02, 0.1)
ERRORS = {"0.1 deg and 1.5 deg": "[6,6,90]", "0.1 and 1 arcmin": "[0.1,0.1,1]"}
ARWS = (0.0006, 0.006)
BIASES = {"0.02": "[0.02,0.02,0.02]", "0.006, 0.006, 0.001": "[0.006,0.006,0.001]"}
LIMITS_MPS2 = (0.01, 0.03)
SHIP_NETWORKS = {"unity2": 'id="unity2",zeta=0.5', "pole2 exact": 'id="pole2",variant="exact"'}
METHODS = ("free", "conventional", "adaptive")


def _attitudes(run: Run, after: np.ndarray) -> np.ndarray:
    """Errors of pitch, roll and heading of the three methods, arcmin, shape (methods, n, 3)."""
    return np.array([attitude_error(run, method(run, name))[after] / ARCMIN for name in METHODS])


def ship(given: Iterable[str]) -> tuple[float, ...]:
    """Numbers of claims 1 to 6."""
    made = [
        simulate(scenario_of("sun-ship", (*given, *more))) for more in ((), ("motion.point.2.speed_kn=2",))
    ]
    adaptive = method(made[0], "adaptive")
    after = adaptive.t_s >= 10.0 * HOUR
    moved, still = (_attitudes(run, after) for run in made)
    over = np.max(np.abs(moved - still), axis=1)
    spread = np.std(moved[:, :, 0], axis=1)
    ratios = over[2] / over[1]
    return (
        *ratios,
        over[0, 1] / over[1, 1],
        spread[2] / spread[1],
        float(np.max(adaptive.rows[after, XI_COLUMN])),
    )


def _ship(runs: Runs) -> Numbers:
    def make() -> Numbers:
        found: Numbers = {}
        choices = product(SCALES, ERRORS.items(), ARWS, BIASES.items(), LIMITS_MPS2, SHIP_NETWORKS.items())
        for scale, (told, attitude), arw, (drifts, biases), limit, (network, text) in choices:
            name = (
                f"k = {scale}, initial errors {told}, gyros of {drifts} deg/h and {arw} deg/sqrt(h), "
                f"conventional undamped above {limit} m/s2, {network}"
            )
            found[name] = ship(
                (
                    "run.output_step_s=60",
                    "run.step_s=2",
                    f"reference.scale_ppm={1e6 * scale}",
                    f"initial_error.attitude_arcmin={attitude}",
                    f"imu.gyro_arw_dpsh={arw}",
                    f"imu.gyro_bias_dph={biases}",
                    f"method.1.policy.limit_mps2={limit}",
                    f"method.2.network={{{text}}}",
                )
            )
        return found

    return runs.keep("search: sun ship", make)


SHIP_SEARCH = Search(
    "the log's scale error k (0 to 0.1), initial errors and gyros as printed or small, the acceleration "
    "above which the conventional method is undamped, and the network of the adaptive one; one seed.",
    (1, 2, 3, 4, 5, 6),
    _ship,
)

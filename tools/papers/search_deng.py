"""Searches over what Deng 2019 does not print: loops, rate of the log, biases, axes of the log."""

from __future__ import annotations

from collections.abc import Callable
from itertools import product
from typing import Any

import numpy as np

from navcore.engine.alignment_start import aligned_start, start_errors
from navcore.engine.environment import truth_of
from navcore.engine.simulation import simulate
from navcore.foundation.units import DEG, HOUR
from navcore.mechanization.recorder import PHI_E, PHI_N
from tools.papers.deng_errors import SEEDS, TABLE_1, TABLE_2, TABLE_4, Printed, errors_of, log_at
from tools.papers.estimate import Estimate, rms_estimate
from tools.papers.measure import as_attitude, rms
from tools.papers.runs import Runs, scenario_of
from tools.papers.search import Axis, Search, Setting

READING = "spreads read as"
DEVIATIONS, VARIANCES = "standard deviations", "variances"
READINGS = Axis(READING, {name: name for name in (DEVIATIONS, VARIANCES)})
# ---------------------------------------------------------------- alignment

LOOP, GYROS, ACCELEROMETERS = "sigma of the loop", "signs of the gyros x, y, z", "sign of the accelerometers"
_SIGNS = {"".join("+" if s > 0 else "-" for s in signs): signs for signs in product((1, -1), repeat=3)}
ALIGNMENT_AXES = (
    Axis(LOOP, {f"{sigma} 1/s": sigma for sigma in (0.008, 0.012, 0.02, 0.03)}),
    Axis(GYROS, _SIGNS),
    Axis(ACCELEROMETERS, {"+": 1, "-": -1}),
)


def alignment_overrides(setting: Setting) -> tuple[str, ...]:
    """Overrides of deng-static for a setting."""
    return (
        "run.rate_hz=20",
        f"alignment.sigma={setting[LOOP]}",
        f"imu.gyro_bias_dph={[0.02 * sign for sign in setting[GYROS]]}",
        f"imu.accel_bias_ug={[50.0 * setting[ACCELEROMETERS]] * 3}",
    )


def _aligned(runs: Runs, setting: Setting) -> tuple[Estimate, ...]:
    """RMS of pitch, roll and heading error at the end of the alignment, deg."""

    def make() -> tuple[Estimate, ...]:
        errors = []
        for seed in SEEDS:
            given = (f"run.seed={seed}", *alignment_overrides(setting))
            scenario = scenario_of("deng-static", given)
            row = truth_of(scenario, 1, 1.0).values[0]
            phi = start_errors(aligned_start(scenario, row), row)[None, 4:7]
            errors.append(as_attitude(phi, row[None])[0] / DEG)
        return tuple(rms_estimate(np.array(errors)[:, k]) for k in range(3))

    return runs.keep(("search: deng alignment", *setting.values()), make)


ALIGNMENT_SEARCH = Search(
    ALIGNMENT_AXES, (1, 2, 3), _aligned, len(SEEDS), "Full simulated alignments at 20 Hz."
)

# ---------------------------------------------------------------- tables 1 and 2: turntable

SIGMA, XI, RATE, BIAS = "sigma", "xi", "log at", "accelerometers' biases"
TURNTABLE_AXES = (
    Axis(SIGMA, {f"{sigma} 1/s": sigma for sigma in (0.0088, 0.03, 0.13, 0.25)}),
    Axis(XI, {"0.707": 0.707, "1": 1.0}),
    Axis(RATE, {"2 Hz": 2.0, "200 Hz": 200.0}),
    Axis(BIAS, {"20 ug": 20.0, "50 ug": 50.0}),
    READINGS,
)


def _damped(sigma: float, xi: float = 0.707, form: str = "") -> dict[str, Any]:
    network = {"id": "compass", "sigma": sigma, "xi": xi} | ({"realisation": form} if form else {})
    return {"name": f"{sigma}, {xi} {form}".strip(), "damping": "external", "network": network}


def turntable_methods() -> list[dict[str, Any]]:
    """Free, and every loop of the search."""
    sigmas, xis = (axis.values.values() for axis in TURNTABLE_AXES[:2])
    return [{"name": "free", "damping": "free"}, *(_damped(*loop) for loop in product(sigmas, xis))]


def _turntable(preset: str, printed: Printed) -> Callable[[Runs, Setting], tuple[np.ndarray, ...]]:
    """Numbers of claims 2 to 10: tilt damped over free, and the spread of each row."""

    def every_loop(rate: float, bias: float) -> dict[str, np.ndarray]:
        """Tilt over free, then the spreads, of each loop, shape (seeds, 9)."""
        found: dict[str, list[list[float]]] = {}
        for seed in SEEDS:
            given = (f"run.seed={seed}", *log_at(rate), f"imu.accel_bias_ug={[bias] * 3}")
            run = simulate(scenario_of(preset, given, method=turntable_methods()))
            free = rms(run.methods[0].rows[:, [PHI_E, PHI_N]])
            for one in run.methods[1:]:
                tilt = rms(one.rows[:, [PHI_E, PHI_N]]) / free
                found.setdefault(one.method.name, []).append([tilt, *errors_of(run, one).std(axis=0)])
        return {name: np.array(rows) for name, rows in found.items()}

    def at(runs: Runs, setting: Setting) -> tuple[np.ndarray, ...]:
        rate, bias = setting[RATE], setting[BIAS]
        loops = runs.keep(("search: deng", preset, rate, bias), lambda: every_loop(rate, bias))
        rows = loops[_damped(setting[SIGMA], setting[XI])["name"]]
        return rows[:, 0], *_as_read(rows[:, 1:], printed, setting[READING])

    return at


def _as_read(spreads: np.ndarray, printed: Printed, reading: str) -> tuple[np.ndarray, ...]:
    """Spreads by row to be held against the printed numbers: as variances, against their square roots."""
    scales = [1.0 if reading == DEVIATIONS else variance**0.5 for _, variance in printed]
    return tuple(spreads[:, k] * scale for k, scale in enumerate(scales))


_ALL_ROWS = (
    "The reading is the same for all rows of the table. A log at 200 Hz is run at 50 Hz with the same "
    "density of its noise."
)
TABLE_1_SEARCH = Search(
    TURNTABLE_AXES, tuple(range(2, 11)), _turntable("deng-static", TABLE_1), len(SEEDS), _ALL_ROWS
)
TABLE_2_SEARCH = Search(
    TURNTABLE_AXES, tuple(range(2, 11)), _turntable("deng-swing", TABLE_2), len(SEEDS), _ALL_ROWS
)

# ---------------------------------------------------------------- table 4: the drive

FRAME, OWN = "log in the axes of", "reference good to"
REFERENCE_DEG = 0.01
DRIVE_AXES = (
    Axis(FRAME, {"the vehicle": "body", "east and north": "enu"}),
    Axis(SIGMA, {f"{sigma} 1/s": sigma for sigma in (0.0088, 0.03, 0.13)}),
    Axis(OWN, {"0 deg": 0.0, "0.01 deg (table 3)": REFERENCE_DEG}),
    READINGS,
)


def drive_methods() -> list[dict[str, Any]]:
    """Free, and every sigma of the search in the corrected form and as printed."""
    sigmas = DRIVE_AXES[1].values.values()
    forms = [_damped(sigma, form=form) for sigma in sigmas for form in ("", "as_printed")]
    return [{"name": "free", "damping": "free"}, *forms]


def _every_sigma(frame: str) -> dict[str, np.ndarray]:
    """Numbers of claims 2 to 13 by sigma, spreads in the table's units, shape (seeds, 12)."""
    found: dict[str, list[list[float]]] = {}
    for seed in SEEDS:
        given = (f"run.seed={seed}", f'reference.frame="{frame}"', *log_at(200.0), "run.output_step_s=5")
        run = simulate(scenario_of("deng-vehicle", given, method=drive_methods()))
        late = run.methods[0].t_s > HOUR / 6.0
        free, *loops = (errors_of(run, one) for one in run.methods)
        for right, printed, one in zip(loops[::2], loops[1::2], run.methods[1::2], strict=True):
            better = [rms(free[:, k]) / rms(right[:, k]) for k in (0, 4, 7)]
            largest = [float(np.max(np.abs(form[late, 0]))) for form in (printed, right)]
            row = [*better, *right.std(axis=0), largest[0] / largest[1]]
            found.setdefault(one.method.name, []).append(row)
    return {name: np.array(rows) for name, rows in found.items()}


def _drive(runs: Runs, setting: Setting) -> tuple[np.ndarray, ...]:
    """Numbers of claims 2 to 13."""
    frame = setting[FRAME]
    sigmas = runs.keep(("search: deng drive", frame), lambda: _every_sigma(frame))
    rows = sigmas[_damped(setting[SIGMA])["name"]].copy()
    cosine = float(np.cos(scenario_of("deng-vehicle").site.lat_deg * DEG))
    rows[:, 3:6] = np.hypot(rows[:, 3:6], setting[OWN] / np.array([1.0, 1.0, cosine]))
    return *rows[:, :3].T, *_as_read(rows[:, 3:11], TABLE_4, setting[READING]), rows[:, 11]


DRIVE_SEARCH = Search(DRIVE_AXES, tuple(range(2, 14)), _drive, len(SEEDS), _ALL_ROWS)

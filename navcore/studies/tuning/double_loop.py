"""Sun's double-loop optimisation (Sun 8, Table 1): the best damping coefficient per velocity difference.

For every coefficient the error model is run with constant damping; the objective is Sun's
J = integral of (dV_E^2 + dV_N^2) dt over the run. The model is linear in the log's error, so that

    J(xi, d) = J_0(xi) + d^2 J_1(xi)

with J_0 of the scenario as it is and J_1 of a log error of size 1 and nothing else: exactly, once averaged
over the error's sign and direction, which a norm |V_c - V_r| does not tell. So the inner loop runs once for
all differences, and the outer one costs nothing.

Sun's Table 1 does not come out: a network with H(0) = 1 rejects a constant error of the log, and the best
coefficient hardly depends on it. It falls with the difference, as Sun's does, where the log's error keeps
changing (``error = "drift"``) *and* the network approaches H = 1 as its coefficient falls: `complementary`
does, `unity2` does not.
"""

from __future__ import annotations

import threading
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from navcore.engine.simulation import Cancelled, Progress, simulate
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.units import HOUR, KNOT
from navcore.law.policy.adaptive import HIGHEST, LOWEST, SUN_TABLE
from navcore.scenario.model import MAX_METHODS, Alignment, InitialError, Method, Scenario
from navcore.sensors.imu import Imu
from navcore.sensors.reference import Reference
from navcore.studies.tuning.settings import TuningSettings


@dataclass(frozen=True, eq=False)
class Tuning:
    """What the double loop found.

    Attributes
    ----------
    settings : TuningSettings
        What was searched.
    coefficients : ndarray, shape (m,)
        Damping coefficients of the inner loop.
    differences : ndarray, shape (n,)
        Velocity differences of the outer loop, m/s.
    cost : ndarray, shape (n, m)
        J, m^2/s; inf where the loop is unstable or diverged, NaN where nothing was computed.
    best : ndarray, shape (n,)
        Coefficient with the least J for each difference, the smallest of equals; NaN when stopped.
    status : {"ok", "stopped"}
        How the search ended.
    warnings : tuple of str
        What the user should know about the table.
    """

    settings: TuningSettings
    coefficients: np.ndarray
    differences: np.ndarray
    cost: np.ndarray
    best: np.ndarray
    status: Literal["ok", "stopped"]
    warnings: tuple[str, ...] = field(default=())

    def beside_sun(self) -> list[tuple[float, float, float]]:
        """Difference (kn), best coefficient and that of Sun's Table 1 (interpolated between his rows)."""
        knots, xi = np.array(SUN_TABLE).T
        from scipy.interpolate import PchipInterpolator

        his = PchipInterpolator(knots, xi)(np.clip([row[0] for row in self.rows()], knots[0], knots[-1]))
        return [(row[0], row[1], float(value)) for row, value in zip(self.rows(), his, strict=True)]

    def rows(self) -> list[list[float]]:
        """The table as [difference (kn), damping coefficient], ascending; empty when stopped."""
        if self.status != "ok":
            return []
        return [
            [round(float(d) / KNOT, 6), round(float(xi), 6)]
            for d, xi in zip(self.differences, self.best, strict=True)
        ]


def sun_scenario() -> Scenario:
    """Sun's own setting for his table: 24 h, gyros 0.006, 0.006, 0.001 deg/h, a perfect log (Sun 3.2).

    At rest; the site is that of Sun 5.1; steps of 5 s, 1/160 of the loop's time constant.
    """
    return Scenario.parse(
        {
            "title": "Sun's setting for the adaptive damping table",
            "source": "Sun 2017, 3.2",
            "run": {"duration_h": 24.0, "step_s": 5.0, "output_step_s": 600.0},
            "site": {"lat_deg": 32.064703, "lon_deg": 118.801122},
            "imu": {"gyro_bias_dph": [0.006, 0.006, 0.001]},
            "reference": {"kind": "log", "rate_hz": 0.2},
        }
    )


def tune(
    scenario: Scenario | None = None,
    settings: TuningSettings | None = None,
    progress: Progress | None = None,
    cancelled: Cancelled | None = None,
) -> Tuning:
    """Find the best damping coefficient for each velocity difference.

    Parameters
    ----------
    scenario : Scenario, optional
        Duration, site, motion, sensor errors, initial errors and the log's own errors; its methods are not
        used. Always run on the linear error model. Default: `sun_scenario`.
    settings : TuningSettings, optional
        Differences, coefficients, network; Sun's by default.
    progress : callable, optional
        Called with the fraction done, 0..1, from any thread.
    cancelled : callable, optional
        Asked often; when it says True the search ends with status "stopped".

    Raises
    ------
    InputError
        The scenario has a recorded IMU, or the network does not exist for a coefficient.

    Examples
    --------
    >>> from navcore.studies.tuning import TuningSettings, tune
    >>> found = tune(settings=TuningSettings(differences_kn=(0.0, 3.0), step=0.33))
    >>> found.status, len(found.rows())
    ('ok', 2)
    """
    scenario, settings = scenario or sun_scenario(), settings or TuningSettings()
    progress = None if progress is None else _rising(progress)
    if getattr(scenario.imu, "file", None):
        raise InputError(Fault("", "imu.file", scenario.imu.file, "must be empty: tuning simulates the IMU"))
    coefficients = settings.coefficients()
    methods = tuple(
        Method.model_validate(
            {"name": f"{xi:g}", "damping": "external", "network": settings.with_coefficient(xi)}
        )
        for xi in coefficients
    )
    problems = [_base(scenario), *_unit_errors(scenario, settings)]
    costs = np.full((len(problems), len(coefficients)), np.nan)
    stopped = False
    for index, problem in enumerate(problems):
        share = _shared(progress, index, len(problems))
        stopped = not _inner_loop(problem, methods, costs[index], share, cancelled)
        if stopped:
            break
    base, unit = costs[0], np.mean(costs[1:], axis=0)
    differences = settings.differences()
    usable = np.isfinite(base) & np.isfinite(unit) | np.isnan(unit)
    cost = np.where(usable, base + np.square(differences)[:, None] * np.where(usable, unit, 0.0), np.inf)
    best = np.full(len(differences), np.nan) if stopped else coefficients[np.argmin(cost, axis=1)]
    return Tuning(
        settings=settings,
        coefficients=coefficients,
        differences=differences,
        cost=cost,
        best=best,
        status="stopped" if stopped else "ok",
        warnings=() if stopped else tuple(_warnings(cost, best, coefficients)),
    )


def _base(scenario: Scenario) -> Scenario:
    """The scenario on the linear model, with a perfect log if it has none."""
    log = scenario.reference if scenario.reference.kind != "none" else Reference(kind="log")
    run = scenario.run.model_copy(update={"fidelity": "error_model", "output_step_s": 86400.0})
    return scenario.model_copy(update={"run": run, "reference": log, "alignment": Alignment()})


def _unit_errors(scenario: Scenario, settings: TuningSettings) -> Iterator[Scenario]:
    """Scenarios in which nothing errs but the log, by an RMS of 1 m/s over both axes."""
    base = _base(scenario)
    own = base.reference
    log = {"kind": "log", "outage": own.outage, "rate_hz": own.rate_hz, "frame": own.frame}
    silent = base.model_copy(update={"imu": Imu(), "initial_error": InitialError()})
    if settings.error == "constant":
        for bias in ((1.0, 0.0), (0.0, 1.0)):  # their mean is that over all directions
            yield silent.model_copy(update={"reference": Reference(**log, bias_mps=bias)})
        return
    drift = Reference(**log, drift_mps=float(np.sqrt(0.5)), drift_tau_s=settings.drift_tau_s)
    for seed in range(settings.realisations):
        run = base.run.model_copy(update={"seed": (base.run.seed + seed) % 2**31})
        yield silent.model_copy(update={"reference": drift, "run": run})


def _inner_loop(
    problem: Scenario,
    methods: tuple[Method, ...],
    costs: np.ndarray,
    progress: Progress | None,
    cancelled: Cancelled | None,
) -> bool:
    """Fill the objective of every method, m^2/s; False when cancelled."""
    seconds = problem.run.duration_h * HOUR
    for first in range(0, len(methods), MAX_METHODS):
        if cancelled is not None and cancelled():
            return False
        some = methods[first : first + MAX_METHODS]
        share = None if progress is None else _part(progress, first / len(methods), len(some) / len(methods))
        run = simulate(problem.model_copy(update={"method": some}), share, cancelled)
        for index, result in enumerate(run.methods, start=first):
            if result.status == "stopped":
                return False
            squares = result.errors["dve_mps"]["rms"] ** 2 + result.errors["dvn_mps"]["rms"] ** 2
            # an unstable loop may still have the least J before it has grown
            usable = result.status == "ok" and result.loop.stable
            costs[index] = seconds * squares if usable else np.inf
    return True


def _rising(progress: Progress) -> Progress:
    """Leave out what comes late from another thread: the fraction never falls."""
    lock, highest = threading.Lock(), 0.0

    def report(fraction: float) -> None:
        nonlocal highest
        with lock:
            if fraction > highest:
                highest = fraction
                progress(fraction)

    return report


def _part(progress: Progress, start: float, size: float) -> Progress:
    return lambda fraction: progress(start + size * fraction)


def _shared(progress: Progress | None, index: int, count: int) -> Progress | None:
    return None if progress is None else _part(progress, index / count, 1.0 / count)


def _warnings(cost: np.ndarray, best: np.ndarray, coefficients: np.ndarray) -> Iterator[str]:
    if not np.all(np.isfinite(np.min(cost, axis=1))):
        yield "no coefficient makes a stable loop: the table is not usable"
    unstable = int(np.count_nonzero(~np.isfinite(cost[0])))
    if unstable:
        yield f"{unstable} of {len(coefficients)} coefficients make the loop unstable: left out"
    if len(coefficients) > 1 and np.ptp(best) == 0.0:
        yield f"the best coefficient is {best[0]:g} for every difference"
    if np.any(np.diff(best) > 0.0):
        yield "the best coefficient rises with the difference somewhere"
    if np.any((best < LOWEST) | (best > HIGHEST)):
        yield f"the adaptive law holds the coefficient within {LOWEST:g} and {HIGHEST:g}"

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

from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import chain, count
from typing import Any, Literal

import numpy as np

from navcore.design.sun_settings import TuningSettings
from navcore.engine.simulation import Cancelled, Progress, simulate
from navcore.foundation.answers import Answer, Column, Table, number
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.foundation.units import HOUR, KNOT
from navcore.law.policy.adaptive import HIGHEST, LOWEST, SUN_TABLE
from navcore.quantities import VELOCITY, components
from navcore.scenario.blocks import Alignment
from navcore.scenario.bounds import MAX_METHODS
from navcore.scenario.initial_error import InitialError
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario
from navcore.sensors.imu import Imu
from navcore.sensors.reference import Reference


@dataclass(frozen=True, eq=False)
class Tuning(Answer):
    """Result of the double loop.

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

    @property
    def complete(self) -> bool:
        """Whether it was not stopped."""
        return self.status == "ok"

    def document(self) -> dict[str, Any]:
        """Return the document of interface.md."""
        names = "difference_kn", "xi", "sun_xi"
        rows = [dict(zip(names, row, strict=True)) for row in self.beside_sun()]
        return {"network": self.settings.network.id, "rows": rows, "warnings": list(self.warnings)}

    def rows(self) -> Iterator[Table | str]:
        """Give the table beside Sun's, and the warnings."""
        best = Text("best coefficient, {network}", network=self.settings.network.id)
        heads = (Column(Text("difference, kn")), Column(best), Column(Text("Sun's table 1")))
        rows = tuple((number(first), *others) for first, *others in self.beside_sun())
        yield Table(heads, rows)
        if self.warnings:
            yield ""
        for text in self.warnings:
            yield Text("warning: {text}", text=text)

    def beside_sun(self) -> list[tuple[float, float, float]]:
        """Difference (kn), best coefficient and that of Sun's Table 1 (interpolated between his rows)."""
        knots, xi = np.array(SUN_TABLE).T
        from scipy.interpolate import PchipInterpolator

        his = PchipInterpolator(knots, xi)(np.clip([row[0] for row in self.pairs()], knots[0], knots[-1]))
        return [(row[0], row[1], float(value)) for row, value in zip(self.pairs(), his, strict=True)]

    def pairs(self) -> list[list[float]]:
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


def tune_table(
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
        Called with the fraction done, 0..1.
    cancelled : callable, optional
        Asked often; when it says True the search ends with status "stopped".

    Raises
    ------
    InputError
        The scenario has a recorded IMU, or the network does not exist for a coefficient.

    Examples
    --------
    >>> from navcore.design.sun import TuningSettings, tune_table
    >>> found = tune_table(settings=TuningSettings(differences_kn=(0.0, 3.0), step=0.33))
    >>> found.status, len(found.pairs())
    ('ok', 2)
    """
    scenario, settings = scenario or sun_scenario(), settings or TuningSettings()
    if scenario.imu.file is not None:
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
    pieces = [(i, first) for i in range(len(problems)) for first in range(0, len(methods), MAX_METHODS)]
    stopped = False
    for done, (index, first) in enumerate(pieces, start=1):
        some = slice(first, first + MAX_METHODS)
        part = _costs(problems[index], methods[some], cancelled)
        stopped = part is None
        if part is None:
            break
        costs[index, some] = part
        if progress is not None:
            progress(done / len(pieces))
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
    log: dict[str, Any] = {
        name: getattr(own, name) for name in ("outage", "min_speed_mps", "rate_hz", "frame")
    } | {"kind": "log"}
    silent = base.model_copy(update={"imu": Imu(), "initial_error": InitialError()})
    if settings.error == "constant":
        for bias in ((1.0, 0.0), (0.0, 1.0)):  # their mean is that over all directions
            yield silent.model_copy(update={"reference": Reference(**log, bias_mps=bias)})
        return
    drift = Reference(**log, drift_mps=float(np.sqrt(0.5)), drift_tau_s=settings.drift_tau_s)
    for seed in range(settings.realisations):
        run = base.run.model_copy(update={"seed": (base.run.seed + seed) % 2**31})
        yield silent.model_copy(update={"reference": drift, "run": run})


def _costs(problem: Scenario, methods: tuple[Method, ...], cancelled: Cancelled | None) -> list[float] | None:
    """Objective of every method, m^2/s; None when cancelled."""
    if cancelled is not None and cancelled():
        return None
    run = simulate(problem.model_copy(update={"method": methods}), cancelled=cancelled)
    if any(method.status == "stopped" for method in run.methods):
        return None
    costs = []
    for result in run.methods:
        squares = sum(result.errors[name]["rms"] ** 2 for name in components(VELOCITY))
        # an unstable loop may still have the least J before it has grown
        usable = result.status == "ok" and result.loop.stable
        costs.append(problem.run.duration_h * HOUR * squares if usable else np.inf)
    return costs


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


def with_table(scenario: Scenario, tuning: Tuning, method: int | None = None) -> Scenario:
    """Return the scenario with a method whose policy is `adaptive` with the table that was found.

    Parameters
    ----------
    scenario : Scenario
        Where the table goes.
    tuning : Tuning
        From `tune_table`, not stopped.
    method : int, optional
        Index of the method that takes the table (its network becomes the tuned one); a new method at the end
        when left out.

    Raises
    ------
    InputError
        The search was stopped, there is no such method, or the policy cannot re-tune the network.
    """
    table = tuning.pairs()
    if not table:
        raise InputError(Fault("", "table", None, "the search was stopped: there is no table"))
    data = scenario.canonical()
    methods = data["method"]
    if method is None:
        numbered = (f"adaptive (tuned {number})" for number in count(2))
        taken = {m["name"] for m in methods}
        name = next(name for name in chain(["adaptive (tuned)"], numbered) if name not in taken)
        methods.append({"name": name})
        method = len(methods) - 1
    if not 0 <= method < len(methods):
        raise InputError(Fault("", "method", method, f"must be 0 to {len(methods) - 1}"))
    network = tuning.settings.network.model_dump(mode="json", exclude_none=True)
    policy = {"id": "adaptive", "table": table}
    methods[method] |= {"damping": "external", "network": network, "policy": policy}
    if data["reference"]["kind"] == "none":
        data["reference"] = {"kind": "log"}
    return Scenario.parse(data)

"""The numbers of a run: one quantity by its key, or all as a document that JSON can hold (interface.md)."""

import math
import platform
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

from navcore.analysis.judged import JudgedLoop, loop_value
from navcore.analysis.report import whole_system_report
from navcore.engine.run import MethodRun, Run, Span
from navcore.foundation.text import Text
from navcore.foundation.units import HOUR
from navcore.foundation.version import __version__
from navcore.quantities import KINDS, NAMES, QUANTITIES, Quantity, limit_unit
from navcore.scenario.fields import SCHEMA
from navcore.scenario.model import Scenario
from navcore.scenario.requirement import OF_THE_SETTING, Requirement
from navcore.scenario.stochastic import drawn_as_zero

POSITION_ERROR = NAMES[-1]


@dataclass(frozen=True)
class SeedShare:
    """Share of seeds on which a method meets the limits of a scenario, beside what one run says.

    Attributes
    ----------
    seeds : int
        Runs, each with its own noise and constants (`navcore.engine.ensemble.drawn`).
    met : float
        Share that meets all limits.
    interval : tuple of float
        Wilson interval of it, 95 %.
    limits : tuple of (float, (float, float))
        The same for each limit, in the scenario's order.
    """

    seeds: int
    met: float
    interval: tuple[float, float]
    limits: tuple[tuple[float, tuple[float, float]], ...]

    def as_dict(self, place: int | None = None) -> dict[str, Any]:
        """Return the document of interface.md: of one limit by its place, or of all together."""
        met, (low, high) = (self.met, self.interval) if place is None else self.limits[place]
        return {"seeds": self.seeds, "met": met, "low": low, "high": high}


def metrics(run: Run, shares: Sequence[SeedShare] = ()) -> dict[str, Any]:
    """Return the metrics of a run as a document that JSON can hold.

    Parameters
    ----------
    run : Run
        From `navcore.engine.simulation.simulate`.
    shares : sequence of SeedShare, optional
        One a method: what seeds say of the limits.

    Returns
    -------
    dict
        The content of ``metrics.json``: ``schema``, ``scenario_sha256``, ``versions``, ``elapsed_s``,
        ``computed_on`` (the steps that the statistics cover), ``warnings`` (about the scenario as a whole)
        and ``methods``. Each method has ``name``, ``status``, ``warnings``, ``loop``, ``law`` (the share of
        the output rows that were damped, the damping coefficient in force) and ``errors``, in SI units and
        radians; ``requirements`` where the scenario has any: each with its value, whether
        it is met, the standard deviations that the run draws as 0, and the share of seeds that meet it. An
        infinite value, or one that is not a number,
        is None.

    Examples
    --------
    >>> from navcore import load, metrics, simulate
    >>> document = metrics(simulate(load("zha-fast", ["run.duration_h=1"])))
    >>> round(document["methods"][1]["loop"]["settling_s"] / 60)
    53
    """
    return {
        "schema": SCHEMA,
        "scenario_sha256": run.scenario_sha256,
        "versions": versions(),
        "elapsed_s": round(run.elapsed_s, 4),
        "computed_on": run.computed_on,
        "warnings": list(run.warnings),
        "methods": [
            _method(method) | _requirements(run.scenario, method, shares[k] if shares else None)
            for k, method in enumerate(run.methods)
        ],
    }


def judged(requirement: Requirement, run: MethodRun) -> tuple[float | None, bool]:
    """Value of a requirement's quantity, in the unit of its name, and whether a method's run meets it.

    Parameters
    ----------
    requirement : Requirement
        Of the run's scenario. One that begins after the end is not met.
    run : MethodRun
        Of a method. Null is not met, and what diverged meets nothing.
    """
    value = measure(run, requirement.quantity, begins_s(requirement)) / limit_unit(requirement.quantity)
    return _finite(value), run.status == "ok" and requirement.met(value)


def begins_s(requirement: Requirement) -> float:
    """Time from which a requirement's quantity is judged, s; 0 for one of the setting."""
    return 0.0 if requirement.quantity in OF_THE_SETTING else requirement.from_h * HOUR


def _requirements(scenario: Scenario, run: MethodRun, share: SeedShare | None) -> dict[str, Any]:
    rows = []
    for place, one in enumerate(scenario.requirement):
        value, met = judged(one, run)
        row = {**one.model_dump(mode="json", exclude_none=True), "value": value, "met": met}
        row["drawn_as_zero"] = list(drawn_as_zero(scenario))
        rows.append(row if share is None else row | {"share": share.as_dict(place)})
    if not rows:
        return {}
    return {"requirements": rows} | ({} if share is None else {"share": share.as_dict()})


def measure(run: MethodRun, key: str, from_s: float = 0.0) -> float:
    """Value of a quantity of a method's run, SI; infinite where there is none or the run did not end well.

    Parameters
    ----------
    run : MethodRun
        Its loop is the one in force, its errors those of the run or of a part of it.
    key : str
        A row of `navcore.quantities.QUANTITIES` that is judged of a loop or of a run.
    from_s : float
        Time from which errors count, s: 0, or that of a requirement of the scenario.
    """
    quantity = QUANTITIES[key]
    if quantity.kind is None:
        uses_log = run.method.kind.referenced
        return loop_value(
            key, JudgedLoop(run.network, run.loop, uses_log, lambda: run.whole, lambda: run.growth_per_s)
        )
    value = run_value(quantity, run.spans, run.errors[POSITION_ERROR]["final"], from_s)
    return value if run.status == "ok" and math.isfinite(value) else math.inf


def run_value(quantity: Quantity, spans: Sequence[Span], final_m: float, from_s: float = 0.0) -> float:
    """Value of a quantity of a run from its recorded lengths, SI; infinite where the run is shorter.

    Parameters
    ----------
    quantity : Quantity
        Judged of a run.
    spans : sequence of Span
        Of the run, in order.
    final_m : float
        Position error at the end, m.
    from_s : float
        Time from which errors count, s: 0, or that of a requirement of the scenario.
    """
    if quantity.statistic == "final":
        return final_m
    span = next((one for one in spans if one.from_s >= from_s - 1e-6), None)
    if span is None or quantity.kind is None:
        return math.inf
    lengths = span.rms if quantity.statistic == "rms" else span.largest
    return lengths[KINDS.index(quantity.kind)] * (math.sqrt(0.5) if quantity.axes == "per_axis" else 1.0)


def versions() -> dict[str, str]:
    """Versions of what the numbers depend on."""
    import numba
    import numpy

    return {
        "schuler-bench": __version__,
        "python": platform.python_version(),
        "numpy": numpy.__version__,
        "numba": numba.__version__,
    }


def _method(run: MethodRun) -> dict[str, Any]:
    return {
        "name": run.method.name,
        "status": run.status,
        "warnings": list(run.warnings),
        "loop": _loop(run),
        "law": {"computed_on": Text("output rows"), **asdict(run.law_in_force)},
        "errors": {
            name: {key: _finite(value) for key, value in statistics.items()}
            for name, statistics in run.errors.items()
        },
    }


def _loop(run: MethodRun) -> dict[str, Any]:
    loop = run.loop
    return {
        "stable": loop.stable,
        "poles": [[_finite(pole.real), _finite(pole.imag)] for pole in loop.poles],
        "h0": _finite(loop.h0),
        "damping_ratio": _finite(loop.damping_ratio),
        "settling_s": None if loop.settling_s is None else _finite(loop.settling_s),
        **whole_system_report(run.whole),
        "growth_per_s": None if run.growth_per_s is None else _finite(run.growth_per_s),
    }


def _finite(value: float) -> float | None:
    # + 0.0: no "-0.0" in a document
    return float(value) + 0.0 if math.isfinite(value) else None

"""The numbers of a run: one quantity by its key, or all as a document that JSON can hold (interface.md)."""

import math
import platform
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from navcore.analysis.judged import JudgedLoop, loop_value
from navcore.analysis.report import whole_system_report
from navcore.engine.readings import settle_point, settled_s
from navcore.engine.run import MethodRun, Run
from navcore.engine.spans import Span
from navcore.engine.to_log import lines_to_log
from navcore.engine.verdicts import Judgement, Verdict, together
from navcore.foundation.text import Text
from navcore.foundation.version import __version__
from navcore.quantities import NAMES, QUANTITIES, Quantity, value_unit
from navcore.scenario.fields import SCHEMA
from navcore.scenario.model import Scenario
from navcore.scenario.requirement import OVER_SEEDS, Requirement
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
    limits : tuple of Judgement
        Of each limit, in the scenario's order.
    """

    seeds: int
    met: float
    interval: tuple[float, float]
    limits: tuple[Judgement, ...]

    def as_dict(self) -> dict[str, Any]:
        """Return the document of interface.md, of all limits together."""
        low, high = self.interval
        return {"seeds": self.seeds, "met": self.met, "low": low, "high": high}


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
        radians; ``requirements`` where the scenario has any: each with its value, its verdict, the standard
        deviations that the run draws as 0, and the share of seeds that meet it; ``verdict`` on all of them.
        An infinite value, or one that is not a number, is None. ``refused`` names the methods that the rest
        of the scenario refuses, where there are any, with the reason. A run on ``[ins]`` has ``against``
        ("truth" or "recorded") and ``not_known``, the errors of which the reference says nothing; with a
        reference the INS as it was recorded is the first method.

    Examples
    --------
    >>> from navcore import load, metrics, simulate
    >>> document = metrics(simulate(load("zha-fast", ["run.duration_h=1"])))
    >>> round(document["methods"][1]["loop"]["settling_s"] / 60)
    53
    """
    refused = run.scenario.refused
    return {
        "schema": SCHEMA,
        "scenario_sha256": run.scenario_sha256,
        "versions": versions(),
        "elapsed_s": round(run.elapsed_s, 4),
        "computed_on": run.computed_on,
        **_against(run),
        "warnings": list(run.warnings),
        "methods": [
            _method(method) | _requirements(run.scenario, method, shares[k] if shares else None)
            for k, method in enumerate(run.lines)
        ],
        **({"refused": [one.as_dict() for one in refused]} if refused else {}),
    }


def _against(run: Run) -> dict[str, Any]:
    """What the errors of a run on ``[ins]`` are, and which of them are not known; nothing of another run."""
    if run.against is None:
        return {}
    told = {"against": run.against.what, "not_known": list(run.against.not_known)}
    return told | {"velocity_minus_log": lines_to_log(run)}


def judged(requirement: Requirement, run: MethodRun) -> tuple[float | None, bool]:
    """Value of a requirement's quantity, in the unit of its name, and whether a method's run meets it.

    Parameters
    ----------
    requirement : Requirement
        Of the run's scenario. One that begins after the end is not met.
    run : MethodRun
        Of a method. Null is not met, and what diverged meets nothing.
    """
    watch = requirement.begins_s, requirement.bound_m
    value = measure(run, requirement.quantity, *watch) / value_unit(requirement.quantity)
    met = run.status == "ok" and requirement.met(value)
    return finite(_up_to_the_end(requirement, value, run.t_s)), met


def _up_to_the_end(requirement: Requirement, value: float, t_s: np.ndarray) -> float:
    """Value; of a time within a bound that was never left the end of the run."""
    if QUANTITIES[requirement.quantity].statistic != "held" or not len(t_s):
        return value
    return min(value, float(t_s[-1]) / value_unit(requirement.quantity))


def verdict(
    requirement: Requirement, run: MethodRun, judgement: Judgement | None
) -> tuple[float | None, Verdict]:
    """Value of a requirement's quantity, in the unit of its name, and the verdict: of the seeds, or the run.

    Parameters
    ----------
    requirement : Requirement
        Of the run's scenario.
    run : MethodRun
        Of a method.
    judgement : Judgement or None
        What seeds say; without it a limit over seeds is open.

    Returns
    -------
    value : float or None
        Over the seeds where the verdict is theirs, else of the run; None for one that is infinite.
    verdict : {"met", "missed", "open"}
    """
    value, met = judged(requirement, run)
    if not needs_seeds(requirement):
        return value, "met" if met else "missed"
    if judgement is None or judgement.verdict is None:
        return value, "open"
    return finite(judgement.value), judgement.verdict


def needs_seeds(requirement: Requirement) -> bool:
    """Whether a limit is judged over seeds: it asks for a share, or its quantity is one of many seeds."""
    return requirement.share is not None or requirement.quantity in OVER_SEEDS


def _requirements(scenario: Scenario, run: MethodRun, share: SeedShare | None) -> dict[str, Any]:
    rows: list[dict[str, Any]] = []
    for place, one in enumerate(scenario.requirement):
        judgement = None if share is None else share.limits[place]
        value, said = verdict(one, run, judgement)
        row = limit_document(one) | {"value": value, "met": None if said == "open" else said == "met"}
        row |= {"verdict": said, "drawn_as_zero": list(drawn_as_zero(scenario))}
        if judgement is not None:
            row["seeds"] = judgement.as_dict()
            if needs_seeds(one):
                row |= {"value_low": finite(judgement.value_low), "value_high": finite(judgement.value_high)}
                row |= {"run_value": judged(one, run)[0], "more_seeds": judgement.more}
        rows.append(row)
    if not rows:
        return {}
    every: dict[str, Any] = {"requirements": rows, "verdict": together(row["verdict"] for row in rows)}
    return every | ({} if share is None else {"seeds": share.as_dict()})


def limit_document(one: Requirement) -> dict[str, Any]:
    """Return a limit as a document; ``at_most`` is in the unit of a number, ``words`` say it as written."""
    given = one.model_dump(mode="json", exclude_none=True)
    named = "at_least" if one.sense == ">=" else "at_most"
    return given | {named: one.limit, "words": one.words}


def measure(run: MethodRun, key: str, from_s: float = 0.0, bound_m: float = math.inf) -> float:
    """Value of a quantity of a method's run, SI; infinite where there is none or the run did not end well.

    Parameters
    ----------
    run : MethodRun
        Its loop is the one in force, its errors those of the run or of a part of it.
    key : str
        A row of `navcore.quantities.QUANTITIES` that is judged of a loop or of a run.
    from_s : float
        Time from which errors count, s: 0, or that of a requirement of the scenario.
    bound_m : float
        Position error that a requirement watches, m.
    """
    quantity = QUANTITIES[key]
    if quantity.kind is None:
        uses_log = run.method.kind.referenced
        whole, growth = lambda: run.whole, lambda: run.growth_per_s
        heading = lambda: run.heading_settling_s  # noqa: E731
        return loop_value(key, JudgedLoop(run.network, run.loop, uses_log, whole, growth, heading))
    value = run_value(quantity, run.spans, run.errors[POSITION_ERROR]["final"], from_s, bound_m)
    if run.status != "ok":
        return without_value(quantity)
    return math.inf if math.isnan(value) else value


def without_value(quantity: Quantity) -> float:
    """Value of a run that did not end well: the worst there is."""
    return 0.0 if quantity.statistic == "held" else math.inf


def run_value(
    quantity: Quantity, spans: Sequence[Span], final_m: float, from_s: float = 0.0, bound_m: float = math.inf
) -> float:
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
    bound_m : float
        Position error that a requirement watches, m.
    """
    if quantity.statistic in ("at", "final") and from_s == 0.0:
        return final_m
    alike = (one for one in spans if one.from_s >= from_s - 1e-6 and math.isclose(one.bound_m, bound_m))
    span = next(alike, None)
    if quantity.statistic in ("at", "final"):
        return final_m if span is None else span.opens_m
    if span is None or quantity.kind is None:
        return math.inf
    if quantity.statistic in ("settled", "point", "spread"):
        return _of_readings(quantity, spans[0])
    if quantity.statistic in ("rate", "held"):
        return span.rate_mps if quantity.statistic == "rate" else span.held_s
    lengths = span.rms if quantity.statistic == "rms" else span.largest
    return lengths[quantity.length] * (math.sqrt(0.5) if quantity.axes == "per_axis" else 1.0)


def _of_readings(quantity: Quantity, whole: Span) -> float:
    """Value of a quantity of a gyrocompass's readings; a settle point has a sign where seeds compare it."""
    readings = whole.readings, whole.reading_s
    if quantity.statistic == "settled":
        return settled_s(*readings)
    point, spread = settle_point(*readings)
    if quantity.statistic == "spread":
        return spread
    return point if quantity.over else abs(point)


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
            name: {key: finite(value) for key, value in statistics.items()}
            for name, statistics in run.errors.items()
            if not math.isnan(statistics["rms"])
        },
    }


def _loop(run: MethodRun) -> dict[str, Any]:
    loop = run.loop
    return {
        "stable": loop.stable,
        "poles": [[finite(pole.real), finite(pole.imag)] for pole in loop.poles],
        "h0": finite(loop.h0),
        "damping_ratio": finite(loop.damping_ratio),
        "settling_s": None if loop.settling_s is None else finite(loop.settling_s),
        **whole_system_report(run.whole),
        "growth_per_s": None if run.growth_per_s is None else finite(run.growth_per_s),
        "heading_settling_s": finite(run.heading_settling_s),
    }


def finite(value: float) -> float | None:
    """Return a number that JSON can hold; None for one that is infinite or none."""
    # + 0.0: no "-0.0" in a document
    return float(value) + 0.0 if math.isfinite(value) else None

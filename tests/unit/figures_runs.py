"""Runs that the tests of the figures share; each is simulated once."""

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np

from navcore.engine.run import MethodRun, PlotSeries, Run
from navcore.engine.simulation import simulate
from navcore.scenario.model import Scenario
from schuler_bench.plots.plotly_data import PlotlyFigure, values_of

THREE = (
    {"name": "free"},
    {"name": "classic2", "damping": "external", "network": {"id": "classic2"}},
    {"name": "compass", "damping": "external", "network": {"id": "compass", "sigma": 0.0088, "xi": 0.7}},
)
INTERNAL = {"name": "inner", "damping": "internal", "network": {"id": "unity2", "zeta": 0.5}}
UNSTABLE = {
    "name": "as printed",
    "damping": "external",
    "network": {"id": "pole2", "xi": 0.08, "variant": "as_printed"},
}
LEGS = {
    "kind": "legs",
    "leg": [
        {"duration_s": 3600.0, "speed_kn": 14.0, "heading_deg": 40.0},
        {"duration_s": 900.0, "heading_deg": 120.0, "turn_dps": 0.2},
        {"duration_s": 40000.0},
    ],
}


def scenario(**blocks: Any) -> Scenario:
    """Three methods, six hours, errors of every kind; ``blocks`` replace whole blocks."""
    data: dict[str, Any] = {
        "schema": 1,
        "run": {"duration_h": 6.0},
        "imu": {"gyro_bias_dph": [0.0, 0.01, 0.0], "accel_bias_ug": [50.0, 50.0, 0.0]},
        "reference": {"kind": "log", "bias_mps": [0.3, 0.1], "noise_mps": 0.2},
        "initial_error": {"attitude_arcmin": [1.0, -1.0, 5.0]},
        "method": list(THREE),
    }
    return Scenario.parse(data | blocks)


@lru_cache(maxsize=1)
def static_run() -> Run:
    """At rest."""
    return simulate(scenario())


@lru_cache(maxsize=1)
def moving_run() -> Run:
    """Under way, with a turn."""
    return simulate(scenario(motion=LEGS))


def run_of(**blocks: Any) -> Run:
    """Short run of another scenario."""
    return simulate(scenario(**({"run": {"duration_h": 1.0}} | blocks)))


def diverging(run: Run, index: int, rows: int) -> Run:
    """Return the run as if a method had grown without bound and ended after ``rows`` output rows."""
    method = run.methods[index]
    kept = len(method.plot.t_s) * rows // len(method.t_s)
    growth = np.exp(np.linspace(0.0, 12.0, kept))[:, None]
    growth_rows = np.exp(np.linspace(0.0, 12.0, rows))[:, None]
    errors = {name: stats | {"max_abs": stats["max_abs"] * 1e5} for name, stats in method.errors.items()}
    ended: MethodRun = replace(
        method,
        status="diverged",
        reason=f"the error left the range of the linear model at row {rows}",
        t_s=method.t_s[:rows],
        rows=method.rows[:rows] * growth_rows,
        errors=errors,
        plot=PlotSeries(method.plot.t_s[:kept], method.plot.values[:kept] * growth),
    )
    return replace(run, methods=(*run.methods[:index], ended, *run.methods[index + 1 :]))


@dataclass
class Pinned:
    """What a figure needs of a pin."""

    name: str
    hex: str
    run: Run | None


def of_trace(figure: PlotlyFigure, name: str, yaxis: str = "y") -> tuple[np.ndarray, np.ndarray]:
    """Numbers of the trace with this name on an axis."""
    trace = trace_of(figure, name, yaxis)
    return np.array(values_of(trace["x"]), float), np.array(values_of(trace["y"]), float)


def trace_of(figure: PlotlyFigure, name: str, yaxis: str = "y") -> dict[str, Any]:
    """The trace with this name on an axis."""
    return next(t for t in figure["data"] if t.get("name") == name and t.get("yaxis", "y") == yaxis)


def texts_of(figure: PlotlyFigure) -> list[str]:
    """Texts of the annotations."""
    return [note["text"] for note in figure["layout"]["annotations"]]

"""The numbers of a run as one document that JSON can hold (contract.md, metrics.json)."""

from __future__ import annotations

import math
import platform
from typing import Any

from navcore import __version__
from navcore.loop import Loop
from navcore.run import MethodRun, Run
from navcore.scenario import SCHEMA
from navcore.scenario_file import scenario_hash


def metrics(run: Run) -> dict[str, Any]:
    """Return the metrics of a run; what is infinite or not a number becomes None.

    Parameters
    ----------
    run : Run
        From `navcore.simulation.simulate`.

    Returns
    -------
    dict
        ``schema``, ``scenario_sha256``, ``versions``, ``elapsed_s``, ``computed_on`` (which steps the
        statistics cover), ``warnings`` (about the scenario as a whole) and, for each method, ``name``,
        ``status``, ``warnings``, ``loop`` and ``errors`` in SI.
    """
    return {
        "schema": SCHEMA,
        "scenario_sha256": scenario_hash(run.scenario),
        "versions": versions(),
        "elapsed_s": round(run.elapsed_s, 4),
        "computed_on": run.computed_on,
        "warnings": list(run.warnings),
        "methods": [_method(method) for method in run.methods],
    }


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
        "loop": _loop(run.loop),
        "errors": {
            name: {key: _finite(value) for key, value in statistics.items()}
            for name, statistics in run.errors.items()
        },
    }


def _loop(loop: Loop) -> dict[str, Any]:
    return {
        "stable": loop.stable,
        "poles": [[_finite(pole.real), _finite(pole.imag)] for pole in loop.poles],
        "h0": _finite(loop.h0),
        "damping_ratio": _finite(loop.damping_ratio),
        "settling_s": None if loop.settling_s is None else _finite(loop.settling_s),
    }


def _finite(value: float) -> float | None:
    # + 0.0: no "-0.0" in a document
    return float(value) + 0.0 if math.isfinite(value) else None
